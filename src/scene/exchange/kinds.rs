//! What an insertion lets come: spheres, or clumps of a shape.

use crate::base::document::Mistake;
use crate::base::geometry::Quaternion;
use crate::scene::sizes::{Radii, Sizes, SizesKeys};
use crate::scene::{Clump, ClumpShape, ParticleShape};

/// Spheres, or clumps of one shape, of which an insertion lets some come.
#[derive(Clone, Debug)]
pub struct Kind {
    /// The clump; none: spheres.
    pub clump: Option<InsertedClump>,
    /// Density of spheres \[kg/m³\].
    pub density: f64,
    /// Radii, of clumps those of the bounding sphere about the mass centre.
    pub sizes: Sizes,
    /// Share of the number that this kind and those before it have.
    pub up_to: f64,
}

/// A shape of clumps that come.
#[derive(Clone, Debug, PartialEq)]
pub struct InsertedClump {
    /// Index of the shape.
    pub index: u32,
    /// The shape.
    pub shape: ClumpShape,
    /// Density \[kg/m³\].
    pub density: f64,
}

impl Kind {
    /// Mass of one of this radius \[m\] \[kg\].
    pub fn mass(&self, radius: f64) -> f64 {
        match &self.clump {
            Some(clump) => clump.of(radius, ([0.0; 3], Quaternion::identity()), [0.0; 3]).mass,
            None => ParticleShape::Sphere.volume(radius) * self.density,
        }
    }

    /// How many spheres one has.
    pub fn spheres(&self) -> usize {
        self.clump.as_ref().map_or(1, |clump| clump.shape.spheres.len())
    }

    /// Least and largest radius of each of its spheres \[m\].
    pub(crate) fn each_radii(&self) -> Vec<[f64; 2]> {
        let bounds = self.sizes.bounds();
        let Some(InsertedClump { shape, .. }) = &self.clump else { return vec![bounds] };
        let scales = bounds.map(|radius| radius / shape.bounding_radius());
        shape.spheres.iter().map(|(_, radius)| scales.map(|scale| scale * radius)).collect()
    }

    /// Least and largest radius of its spheres \[m\].
    pub(crate) fn radii(&self) -> [f64; 2] {
        widest(self.each_radii().into_iter())
    }

    /// Radius \[m\] and mass \[kg\] of the smallest sphere of the lightest one.
    pub(crate) fn lightest(&self) -> [f64; 2] {
        let [radius, _] = self.sizes.bounds();
        let (mass, [smallest, _]) = (self.mass(radius), self.radii());
        let Some(InsertedClump { shape, .. }) = &self.clump else { return [radius, mass] };
        let cube = |radius: f64| radius * radius * radius;
        let scale = radius / shape.bounding_radius();
        let all: f64 = shape.spheres.iter().map(|(_, radius)| cube(scale * radius)).sum();
        [smallest, mass * (cube(smallest) / all)]
    }

    /// The lightest and the heaviest clump that comes; none where spheres do.
    pub(crate) fn extremes(&self) -> Vec<Clump> {
        let of = |clump: &InsertedClump| {
            self.sizes.bounds().map(|radius| clump.of(radius, ([0.0; 3], Quaternion::identity()), [0.0; 3]))
        };
        self.clump.iter().flat_map(of).collect()
    }

    /// A clump that comes with all lengths by this factor over those of its shape, anywhere; none where no such comes.
    pub(crate) fn clump_of_scale(&self, scale: f64) -> Option<Clump> {
        let clump = self.clump.as_ref()?;
        let bounding = clump.shape.bounding_radius();
        self.sizes.hold(scale, bounding).then(|| clump.scaled(scale, ([0.0; 3], Quaternion::identity()), [0.0; 3]))
    }
}

impl SizesKeys {
    /// What comes: spheres of this density \[kg/m³\] or, where clumps are named, these; otherwise what is wrong.
    pub(crate) fn kinds(&self, clumps: Vec<InsertedClump>, density: f64) -> Result<Vec<Kind>, Mistake> {
        let kind = |clump, sizes| Kind { clump, density, sizes, up_to: 1.0 };
        let as_written = !self.has_sizes();
        let own = |clump: &InsertedClump| Sizes::Fixed(clump.shape.bounding_radius());
        if clumps.len() > 1 {
            let sizes = match &self.radius {
                Some(Radii(radii)) if radii.len() > 1 && radii.len() != clumps.len() => {
                    let found = format!("{} radii and {} clumps", radii.len(), clumps.len());
                    let expected = "a radius for all, or for each clump".to_owned();
                    return Err(Mistake::Unexpected { found, expected });
                }
                Some(Radii(radii)) => radii.iter().cycle().take(clumps.len()).map(|it| Sizes::Fixed(*it)).collect(),
                None if as_written => clumps.iter().map(own).collect(),
                None => vec![self.sizes()?; clumps.len()],
            };
            let kinds = clumps.into_iter().zip(sizes).map(|(clump, sizes)| kind(Some(clump), sizes));
            return self.shared(kinds.collect());
        }
        let Some(clump) = clumps.into_iter().next() else { return Ok(vec![kind(None, self.sizes()?)]) };
        let sizes = if as_written && !self.has_shares() { own(&clump) } else { self.sizes()? };
        Ok(vec![kind(Some(clump), sizes)])
    }

    /// Kinds with their shares.
    fn shared(&self, kinds: Vec<Kind>) -> Result<Vec<Kind>, Mistake> {
        // Sizes that all have say nothing of the shares: any radius does.
        let mass = |kind: &Kind| kind.mass(kind.sizes.bounds()[0]);
        let masses: Vec<f64> = kinds.iter().map(mass).collect();
        let shares = self.shares(&masses, ["clump", "clumps"])?;
        let with_share = kinds.into_iter().zip(shares).filter_map(|(kind, up_to)| Some(Kind { up_to: up_to?, ..kind }));
        Ok(with_share.collect())
    }
}

impl InsertedClump {
    /// A clump whose bounding sphere has this radius \[m\], there \[m\] and so turned, with this velocity \[m/s\].
    pub(crate) fn of(&self, radius: f64, place: ([f64; 3], Quaternion), velocity: [f64; 3]) -> Clump {
        self.scaled(radius / self.shape.bounding_radius(), place, velocity)
    }

    /// One with all lengths by this factor over those of the shape.
    fn scaled(&self, scale: f64, place: ([f64; 3], Quaternion), velocity: [f64; 3]) -> Clump {
        Clump::of((&self.shape, self.index), (scale, self.density), place, [velocity, [0.0; 3]])
    }
}

/// The least and the largest of some ranges.
pub(crate) fn widest(ranges: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    ranges.fold([f64::INFINITY, 0.0], |[low, high], [least, most]| [low.min(least), high.max(most)])
}
