//! What is in the regions of a scene: found by looking, never in a time step.

mod probes;

pub use probes::{Sight, sights};

use crate::base::number::Vector;
use crate::engine::clumps;
use crate::engine::simulation::Simulation;
use crate::engine::state::State;
use crate::engine::state::contacts::is_told;
use crate::scene::{ClumpShape, Region};

/// Rows of a tensor: first index down, second along.
pub type Tensor = [[f64; 3]; 3];

/// The particles in a region, each by the part of its volume that is inside.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Content {
    /// Volume of the particles inside, of spheres of a clump their share of it; what two particles overlap counted twice \[m³\].
    pub solid: f64,
    /// Mass inside \[kg\].
    pub mass: f64,
    /// Mean velocity of that mass \[m/s\]; 0 where there is none.
    pub velocity: [f64; 3],
    /// Σ m (v − v̄) ⊗ (v − v̄) \[J\].
    pub fluctuation: Tensor,
}

impl Content {
    /// Granular temperature: a third of the mean square of the velocity less the mean velocity \[m²/s²\]; 0 where there is no
    /// mass.
    pub fn temperature(&self) -> f64 {
        let trace: f64 = (0..3).map(|axis| self.fluctuation[axis][axis]).sum();
        if self.mass > 0.0 { trace / (3.0 * self.mass) } else { 0.0 }
    }
}

/// Contacts of the particles in a region.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coordination {
    /// Particles whose centre is inside.
    pub particles: u64,
    /// Their contacts, those at boundaries included; one of two such particles counts for both.
    pub contacts: u64,
}

impl Coordination {
    /// Contacts of a particle in the mean; 0 where there is none.
    pub fn mean(&self) -> f64 {
        if self.particles > 0 { self.contacts as f64 / self.particles as f64 } else { 0.0 }
    }
}

/// The particles in each region of the scene.
pub fn contents(simulation: &Simulation) -> Vec<Content> {
    simulation.scene().regions.iter().map(|region| content(region, simulation)).collect()
}

/// Contacts of the particles in each region of the scene.
pub fn coordination(simulation: &Simulation) -> Vec<Coordination> {
    simulation.scene().regions.iter().map(|region| coordination_in(region, simulation.state())).collect()
}

/// What contacts and bonds carry in each region of the scene: −Σ s l ⊗ f \[J\], tension positive; the stress times the volume of
/// the region.
///
/// f is the force on a particle, l the way to its centre from that of the other particle or, at a boundary, from the point of
/// contact; s is the part of l that is inside.
pub fn carried(simulation: &Simulation) -> Vec<Tensor> {
    let (regions, state) = (&simulation.scene().regions, simulation.state());
    let shifts: Vec<Vector> = regions.iter().map(|region| shift(region, state)).collect();
    let mut sums = vec![Tensor::default(); regions.len()];
    let mut add = |to: Vector, from: Vector, force: Vector| {
        for ((region, shift), sum) in regions.iter().zip(&shifts).zip(&mut sums) {
            let share = region.shape.share_of_line(from - *shift, to - *shift);
            if share > 0.0 {
                add_product(sum, (to - from) * -share, force);
            }
        }
    };
    let centre = |index: u32| Vector::from(state.particles.position[state.particles.slot[index as usize] as usize]);
    simulation.each_contact(&mut |contact| {
        let force = Vector::from(contact.normal) * contact.normal_force + contact.tangential_force.into();
        add(centre(contact.first), contact.second.map_or_else(|| contact.point.into(), centre), force);
    });
    simulation.each_bond(&mut |bond| {
        add(centre(bond.first), bond.second.map_or_else(|| bond.other.into(), centre), bond.force.into());
    });
    sums
}

/// Adds a ⊗ b.
fn add_product(sum: &mut Tensor, a: Vector, b: Vector) {
    for (row, a) in sum.iter_mut().zip(a.to_array()) {
        for (entry, b) in row.iter_mut().zip(b.to_array()) {
            *entry += a * b;
        }
    }
}

/// How far a region moved since time 0 \[m\].
fn shift(region: &Region, state: &State) -> Vector {
    region.follows.map_or(Vector::zero(), |boundary| state.boundaries[boundary.index()].displacement.into())
}

/// The particles in a region.
fn content(region: &Region, simulation: &Simulation) -> Content {
    let (scene, state) = (simulation.scene(), simulation.state());
    let (particles, shift) = (&state.particles, shift(region, state));
    let fullness: Vec<f64> = scene.clump_shapes.iter().map(ClumpShape::fullness).collect();
    let mut inside = Vec::new();
    let mut content = Content::default();
    for (slot, position) in particles.position.iter().enumerate() {
        let radius = position[3];
        let volume = region.shape.volume_of_sphere(Vector::from(*position) - shift, radius);
        if volume > 0.0 {
            let mass = clumps::mass_of(scene, (particles, &state.clumps), slot) * (volume / sphere_volume(radius));
            content.solid +=
                volume * state.clump(slot).map_or(1.0, |clump| fullness[state.clumps.shape[clump] as usize]);
            content.mass += mass;
            for axis in 0..3 {
                content.velocity[axis] += mass * particles.velocity[slot][axis];
            }
            inside.push((slot, mass));
        }
    }
    if content.mass > 0.0 {
        content.velocity = content.velocity.map(|momentum| momentum / content.mass);
    }
    for (slot, mass) in inside {
        let apart = Vector::from(particles.velocity[slot]) - content.velocity.into();
        add_product(&mut content.fluctuation, apart * mass, apart);
    }
    content
}

/// Volume of a sphere \[m³\].
fn sphere_volume(radius: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius
}

/// Contacts of the particles in a region.
fn coordination_in(region: &Region, state: &State) -> Coordination {
    let shift = shift(region, state);
    let centre = |position: &[f64; 4]| region.shape.holds(Vector::from(*position) - shift);
    let inside: Vec<bool> = state.particles.position.iter().map(centre).collect();
    let ends = |slots: &[u32], flags: &[u8]| {
        let told = slots.iter().zip(flags).filter(|(slot, flags)| is_told(**flags) && inside[**slot as usize]);
        told.count() as u64
    };
    let pairs = state.contacts.iter().map(|list| ends(&list.first, &list.flags) + ends(&list.second, &list.flags));
    let walls = state.walls.iter().map(|list| ends(&list.particle, &list.flags));
    let particles = inside.iter().filter(|inside| **inside).count() as u64;
    Coordination { particles, contacts: pairs.chain(walls).sum() }
}
