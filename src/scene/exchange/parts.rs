//! Insertions, outlets and flow meters of a scene.

use crate::base::document::Mistake;
use crate::base::quantity::{BoundaryIndex, MaterialIndex, Positive};
use crate::scene::clump::{ClumpKeys, OrientationKey};
use crate::scene::exchange::kinds::{InsertedClump, Kind, widest};
use crate::scene::exchange::{Amount, BeyondKeys, InsertionKeys, MeterKeys, OutletKeys, Outside, Polygon};
use crate::scene::{Boundary, ClumpShape, SceneDraft};

/// `[insertion.<name>]`: particles that come.
#[derive(Clone, Debug)]
pub struct Insertion {
    /// Its name in the scene and in the unit's variables.
    pub name: String,
    /// The region of the scene in which every new sphere lies whole.
    pub region: usize,
    /// What they are made of.
    pub material: MaterialIndex,
    /// What comes, spheres or clumps; the one to come next is drawn.
    pub kinds: Vec<Kind>,
    /// How much comes.
    pub amount: Amount,
    /// Their velocity \[m/s\].
    pub velocity: [f64; 3],
    /// Largest difference of each component from that \[m/s\].
    pub scatter: f64,
    /// How the own frames of clumps are turned.
    pub orientation: OrientationKey,
}

impl Insertion {
    /// What one adds at least to what its rate counts: 1, or the mass of the smallest \[kg\].
    pub(crate) fn least_amount(&self) -> f64 {
        match self.amount {
            Amount::CountRate(_) => 1.0,
            Amount::MassRate(_) | Amount::Mass(_) => self.masses()[0],
        }
    }

    /// Least and largest mass of what comes \[kg\].
    pub(crate) fn masses(&self) -> [f64; 2] {
        widest(self.kinds.iter().map(|kind| kind.sizes.bounds().map(|radius| kind.mass(radius))))
    }

    /// Least and largest radius of the spheres that come \[m\].
    pub(crate) fn radii(&self) -> [f64; 2] {
        widest(self.kinds.iter().map(Kind::radii))
    }

    /// Whether clumps come.
    pub(crate) fn has_clumps(&self) -> bool {
        self.kinds.iter().any(|kind| kind.clump.is_some())
    }

    /// What comes next: the place of its kind, and its radius \[m\]. `uniform` hands out numbers from 0 to below 1, all equally likely.
    pub(crate) fn draw(&self, uniform: &mut dyn FnMut() -> f64) -> (u32, f64) {
        let last = self.kinds.len() - 1;
        let share = if last > 0 { uniform() } else { 0.0 };
        let place = self.kinds.iter().position(|kind| share < kind.up_to).unwrap_or(last);
        (place as u32, self.kinds[place].sizes.draw(uniform))
    }

    /// Largest speed of what comes \[m/s\].
    pub fn fastest(&self) -> f64 {
        self.velocity.iter().map(|part| (part.abs() + self.scatter).powi(2)).sum::<f64>().sqrt()
    }

    /// Lets nothing come by a rate.
    pub(crate) fn stop(&mut self) {
        if let Amount::MassRate(rate) | Amount::CountRate(rate) = &mut self.amount {
            *rate = 0.0;
        }
    }

    /// Its rate before the outside gives one \[kg/s or 1/s\]; none where a mass is to come.
    pub fn rate(&self) -> Option<f64> {
        match self.amount {
            Amount::MassRate(rate) | Amount::CountRate(rate) => Some(rate),
            Amount::Mass(_) => None,
        }
    }
}

/// `[outlet.<name>]`: where particles are taken away.
#[derive(Clone, Debug)]
pub struct Outlet {
    /// Its name in the scene and in the unit's variables.
    pub name: String,
    /// Which they are.
    pub place: OutletPlace,
}

/// Which particles an outlet takes away, by their centres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutletPlace {
    /// Those in one of the scene's regions.
    Region(usize),
    /// Those behind a plane: a point of it \[m\] and its unit normal, which points to what stays.
    Beyond([[f64; 3]; 2]),
    /// Those behind a boundary that is a plane which does not turn, wherever it is.
    Behind(BoundaryIndex),
}

/// `[flow_meter.<name>]`: what passes through a polygon.
#[derive(Clone, Debug)]
pub struct FlowMeter {
    /// Its name in the scene and in the unit's variables.
    pub name: String,
    /// The polygon.
    pub polygon: Polygon,
}

/// What names in the tables of this file mean.
pub(crate) struct Known<'a> {
    /// Names of the regions.
    pub(crate) regions: Vec<&'a str>,
    /// The boundaries.
    pub(crate) boundaries: &'a [Boundary],
    /// Names of the materials, each with its density \[kg/m³\].
    pub(crate) materials: Vec<(&'a str, f64)>,
    /// Shapes of clumps, and what their tables say of material and density.
    pub(in crate::scene) clumps: Vec<(&'a ClumpShape, &'a ClumpKeys)>,
}

impl Known<'_> {
    /// The place of a region; refuses an unknown one.
    fn region(&self, found: &str, refuse: &mut dyn FnMut(&str, Mistake)) -> Option<usize> {
        let place = self.regions.iter().position(|name| *name == found);
        if place.is_none() {
            let known = self.regions.iter().map(|&name| name.to_owned()).collect();
            refuse("region", Mistake::UnknownName { found: found.to_owned(), kind: "region", known });
        }
        place
    }

    /// The place of a clump; refuses an unknown one.
    fn clump(&self, found: &str, refuse: &mut dyn FnMut(&str, Mistake)) -> Option<u32> {
        let place = self.clumps.iter().position(|(shape, _)| shape.name == found);
        if place.is_none() {
            let known = self.clumps.iter().map(|(shape, _)| shape.name.clone()).collect();
            refuse("sizes.clump", Mistake::UnknownName { found: found.to_owned(), kind: "clump", known });
        }
        place.map(|place| place as u32)
    }

    /// The place of the material of what comes: the one that is named, or that of the clumps; refuses an unknown one.
    fn material(&self, keys: &InsertionKeys, clumps: &[u32], refuse: &mut dyn FnMut(&str, Mistake)) -> Option<usize> {
        let mut of_clumps = clumps.iter().map(|&index| self.clumps[index as usize].1.material.as_ref());
        let first = of_clumps.next().flatten().filter(|first| of_clumps.all(|other| other == Some(first)));
        let Some(found) = keys.material.as_ref().or(first) else {
            let expected =
                "the name of the material of what comes, here or, of clumps, in each of their tables".to_owned();
            refuse("material", Mistake::Missing { expected });
            return None;
        };
        let place = self.materials.iter().position(|(name, _)| name == found);
        if place.is_none() {
            let known = self.materials.iter().map(|(name, _)| (*name).to_owned()).collect();
            refuse("material", Mistake::UnknownName { found: found.clone(), kind: "material", known });
        }
        place
    }

    /// The boundary of this name that is a plane which does not turn; refuses any other.
    fn plane(&self, found: &str, refuse: &mut dyn FnMut(&str, Mistake)) -> Option<BoundaryIndex> {
        let Some(place) = self.boundaries.iter().position(|boundary| boundary.name == found) else {
            let known = self.boundaries.iter().map(|boundary| boundary.name.clone()).collect();
            refuse("beyond", Mistake::UnknownName { found: found.to_owned(), kind: "boundary", known });
            return None;
        };
        let boundary = &self.boundaries[place];
        if boundary.shifting_plane().is_none() {
            let turns = if boundary.shape.plane().is_some() { " that turns" } else { "" };
            let found = format!("[boundary.{found}], a {}{turns}", boundary.shape.words());
            refuse(
                "beyond",
                Mistake::Unexpected { found, expected: "a plane that does not turn, which has a far side".to_owned() },
            );
            return None;
        }
        Some(BoundaryIndex(place as u32))
    }
}

impl Insertion {
    /// The insertion that a scene writes so; refuses what is wrong, with its key.
    pub(crate) fn of(
        name: &str,
        keys: &InsertionKeys,
        known: &Known,
        refuse: &mut dyn FnMut(&str, Mistake),
    ) -> Option<Self> {
        let region = known.region(&keys.region, refuse);
        let read = keys.read().map_err(|(key, mistake)| refuse(key, mistake)).ok();
        let names = keys.sizes.clumps();
        let clumps: Vec<Option<u32>> = names.iter().map(|name| known.clump(name, refuse)).collect();
        let clumps = clumps.into_iter().collect::<Option<Vec<u32>>>();
        let material = known.material(keys, clumps.as_deref().unwrap_or_default(), refuse);
        let ((amount, velocity, scatter), region, clumps, material) = (read?, region?, clumps?, material?);
        let of = |&index: &u32| {
            let (shape, table) = known.clumps[index as usize];
            let density = table.density.map_or(known.materials[material].1, Positive::get);
            InsertedClump { index, shape: shape.clone(), density }
        };
        let clumps = clumps.iter().map(of).collect();
        let kinds = keys.sizes.kinds(clumps, known.materials[material].1);
        let kinds = kinds.map_err(|mistake| refuse("sizes", mistake)).ok()?;
        if let (Some(_), false) = (keys.orientation, kinds.iter().any(|kind| kind.clump.is_some())) {
            let (what, expected) = ("spheres come".to_owned(), "an orientation for clumps only".to_owned());
            refuse("orientation", Mistake::InvalidCombination { what, expected });
            return None;
        }
        let orientation = keys.orientation.unwrap_or(OrientationKey::Random);
        let (material, name) = (MaterialIndex(material as u32), name.to_owned());
        Some(Self { name, region, material, kinds, amount, velocity, scatter, orientation })
    }
}

impl Outlet {
    /// The outlet that a scene writes so; refuses what is wrong, with its key.
    pub(crate) fn of(
        name: &str,
        keys: &OutletKeys,
        known: &Known,
        refuse: &mut dyn FnMut(&str, Mistake),
    ) -> Option<Self> {
        let place = match (&keys.region, &keys.beyond) {
            (Some(region), None) => OutletPlace::Region(known.region(region, refuse)?),
            (None, Some(BeyondKeys::Boundary(name))) => OutletPlace::Behind(known.plane(name, refuse)?),
            (None, Some(BeyondKeys::Plane(plane))) => {
                OutletPlace::Beyond(plane.plane().map_err(|(key, mistake)| refuse(key, mistake)).ok()?)
            }
            (None, None) => {
                let expected =
                    "region = \"..\", beyond = { point, normal } or beyond = \"<boundary>\" says where".to_owned();
                refuse("", Mistake::Missing { expected });
                return None;
            }
            (Some(_), Some(_)) => {
                let (found, expected) = ("both".to_owned(), "one of region and beyond".to_owned());
                refuse("", Mistake::Unexpected { found, expected });
                return None;
            }
        };
        Some(Self { name: name.to_owned(), place })
    }
}

impl FlowMeter {
    /// The flow meter that a scene writes so; refuses what is wrong, with its key.
    pub(crate) fn of(name: &str, keys: &MeterKeys, refuse: &mut dyn FnMut(&str, Mistake)) -> Option<Self> {
        let polygon = keys.polygon().map_err(|(key, mistake)| refuse(key, mistake)).ok()?;
        Some(Self { name: name.to_owned(), polygon })
    }
}

impl SceneDraft {
    /// Whether particles come or go.
    pub fn changes_number(&self) -> bool {
        !self.insertions.is_empty() || self.removes()
    }

    /// Whether particles go.
    pub fn removes(&self) -> bool {
        let domain = self.domain.is_some() && self.outside == Outside::Remove;
        domain || !self.outlets.is_empty() || self.boundaries.iter().any(|it| it.outside == Outside::Remove)
    }

    /// Whether there are clumps, now or later.
    pub fn has_clumps(&self) -> bool {
        !self.clumps.is_empty() || self.insertions.iter().any(Insertion::has_clumps)
    }

    /// Whether there are particles, now or later.
    pub fn has_particles(&self) -> bool {
        !self.particles.is_empty() || !self.insertions.is_empty()
    }

    /// Whether each material is that of a particle, now or later.
    pub fn present(&self) -> Vec<bool> {
        let mut present = vec![false; self.materials.len()];
        let now = self.particles.iter().map(|particle| particle.material);
        now.chain(self.insertions.iter().map(|insertion| insertion.material))
            .for_each(|material| present[material.index()] = true);
        present
    }

    /// Radii of the particles, and of those to come the least, the largest and some between, so that any two that follow each other
    /// differ by less than a factor of 2 \[m\].
    pub(crate) fn radii(&self) -> impl Iterator<Item = f64> {
        let steps = |[least, most]: [f64; 2]| {
            let steps =
                std::iter::successors(Some(most), move |radius| Some(radius / 1.5).filter(|next| *next > least));
            steps.chain([least])
        };
        let coming = self.insertions.iter().flat_map(|insertion| &insertion.kinds).flat_map(Kind::each_radii);
        self.particles.iter().map(|particle| particle.radius).chain(coming.flat_map(steps))
    }

    /// Mean radius of the particles, or of what comes where there is none at the start \[m\].
    pub(crate) fn mean_radius(&self) -> f64 {
        let (mut sum, mut count) = (0.0, 0_usize);
        for particle in &self.particles {
            (sum, count) = (sum + particle.radius, count + 1);
        }
        if count == 0 {
            for insertion in &self.insertions {
                let [least, most] = insertion.radii();
                (sum, count) = (sum + 0.5 * (least + most), count + 1);
            }
        }
        sum / count.max(1) as f64
    }
}
