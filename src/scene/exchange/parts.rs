//! Insertions, outlets and flow meters of a scene.

use crate::base::document::Mistake;
use crate::base::quantity::{BoundaryIndex, MaterialIndex};
use crate::scene::exchange::{Amount, BeyondKeys, InsertionKeys, MeterKeys, OutletKeys, Outside, Polygon, Sizes};
use crate::scene::{Boundary, ParticleShape, SceneDraft};

/// `[insertion.<name>]`: particles that come.
#[derive(Clone, Debug)]
pub struct Insertion {
    /// Its name in the scene and in the unit's variables.
    pub name: String,
    /// The region of the scene in which every new sphere lies whole.
    pub region: usize,
    /// What they are made of.
    pub material: MaterialIndex,
    /// Density \[kg/m³\].
    pub density: f64,
    /// Their radii.
    pub sizes: Sizes,
    /// How much comes.
    pub amount: Amount,
    /// Their velocity \[m/s\].
    pub velocity: [f64; 3],
    /// Largest difference of each component from that \[m/s\].
    pub scatter: f64,
}

impl Insertion {
    /// Mass of a new sphere of this radius \[m\] \[kg\].
    pub fn mass(&self, radius: f64) -> f64 {
        ParticleShape::Sphere.volume(radius) * self.density
    }

    /// What one sphere adds at least to what its rate counts: 1, or the mass of the smallest \[kg\].
    pub(crate) fn least_amount(&self) -> f64 {
        match self.amount {
            Amount::CountRate(_) => 1.0,
            Amount::MassRate(_) | Amount::Mass(_) => self.mass(self.sizes.bounds()[0]),
        }
    }

    /// Largest speed of a new sphere \[m/s\].
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
        let place = known.materials.iter().position(|(name, _)| *name == keys.material);
        if place.is_none() {
            let names = known.materials.iter().map(|(name, _)| (*name).to_owned()).collect();
            refuse("material", Mistake::UnknownName { found: keys.material.clone(), kind: "material", known: names });
        }
        let read = keys.read().map_err(|(key, mistake)| refuse(key, mistake)).ok();
        let ((sizes, amount, velocity, scatter), region, place) = (read?, region?, place?);
        let (density, material) = (known.materials[place].1, MaterialIndex(place as u32));
        let name = name.to_owned();
        Some(Self { name, region, material, density, sizes, amount, velocity, scatter })
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
        let steps = |insertion: &Insertion| {
            let [least, most] = insertion.sizes.bounds();
            let steps =
                std::iter::successors(Some(most), move |radius| Some(radius / 1.5).filter(|next| *next > least));
            steps.chain([least])
        };
        self.particles.iter().map(|particle| particle.radius).chain(self.insertions.iter().flat_map(steps))
    }

    /// Mean radius of the particles, or of what comes where there is none at the start \[m\].
    pub(crate) fn mean_radius(&self) -> f64 {
        let (mut sum, mut count) = (0.0, 0_usize);
        for particle in &self.particles {
            (sum, count) = (sum + particle.radius, count + 1);
        }
        if count == 0 {
            for insertion in &self.insertions {
                let [least, most] = insertion.sizes.bounds();
                (sum, count) = (sum + 0.5 * (least + most), count + 1);
            }
        }
        sum / count.max(1) as f64
    }
}
