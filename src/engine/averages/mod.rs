//! What is in the regions and the cells of grids of a scene: found by looking, never in a time step.

mod counts;
pub(crate) mod look;
mod probes;

pub use counts::{Count, counts, counts_of_regions, lacey_index};
pub use probes::{Sight, sights};

use crate::base::number::Vector;
use crate::engine::bodies::loads;
use crate::engine::cell::near;
use crate::engine::simulation::{ContactRecord, Simulation};
use crate::engine::state::State;
use crate::engine::state::contacts::is_told;
use crate::engine::transfer;
use look::{Fullness, Look, inside};

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
    /// Heat capacity of that mass; 0 where no heat flows \[J/K\].
    pub heat_capacity: f64,
    /// Mean temperature by heat capacity; 0 where there is none \[K\].
    pub temperature: f64,
}

impl Content {
    /// Granular temperature: a third of the mean square of the velocity less the mean velocity \[m²/s²\]; 0 where there is no
    /// mass.
    pub fn granular_temperature(&self) -> f64 {
        let trace: f64 = (0..3).map(|axis| self.fluctuation[axis][axis]).sum();
        if self.mass > 0.0 { trace / (3.0 * self.mass) } else { 0.0 }
    }

    /// A component of the stress of what contacts and bonds carry \[J\] and of the velocities less their mean, over a volume \[m³\],
    /// symmetric \[Pa\].
    pub fn stress(&self, carried: &Tensor, volume: f64, [row, column]: [usize; 2]) -> f64 {
        let carried = 0.5 * (carried[row][column] + carried[column][row]);
        (carried - self.fluctuation[row][column]) / volume
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
    let looks = looks_at_regions(simulation);
    looks.iter().flat_map(|look| content(look, simulation)).collect()
}

/// The particles in each cell of a grid of the scene.
pub fn contents_of_cells(simulation: &Simulation, grid: usize) -> Vec<Content> {
    let (scene, state) = (simulation.scene(), simulation.state());
    content(&Look::at_grid(&scene.grids[grid].shape, scene, state), simulation)
}

/// Contacts of the particles in each region of the scene.
pub fn coordination(simulation: &Simulation) -> Vec<Coordination> {
    looks_at_regions(simulation).iter().map(|look| coordination_in(look, simulation.state())).collect()
}

/// What contacts and bonds carry in each region of the scene: −Σ s l ⊗ f \[J\], tension positive; the stress times the volume of
/// the region.
///
/// f is the force on a particle, l the way to its centre from that of the other particle or, at a boundary, from the point of
/// contact; s is the part of l that is inside. In a clump the way goes on between the centre of the sphere and the mass centre, where the
/// forces on the clump meet.
pub fn carried(simulation: &Simulation) -> Vec<Tensor> {
    carried_in(&looks_at_regions(simulation), simulation).into_iter().flatten().collect()
}

/// The same in each cell of a grid of the scene.
pub fn carried_in_cells(simulation: &Simulation, grid: usize) -> Vec<Tensor> {
    let shape = &simulation.scene().grids[grid].shape;
    let look = Look::at_grid(shape, simulation.scene(), simulation.state());
    carried_in(&[look], simulation).swap_remove(0)
}

/// Looks at all regions.
fn looks_at_regions(simulation: &Simulation) -> Vec<Look<'_>> {
    let (scene, state) = (simulation.scene(), simulation.state());
    scene.regions.iter().map(|region| Look::at_region(region, scene, state)).collect()
}

/// What contacts and bonds carry in each part of what is looked at.
fn carried_in(looks: &[Look], simulation: &Simulation) -> Vec<Vec<Tensor>> {
    let state = simulation.state();
    let mut sums: Vec<_> = looks.iter().map(|look| vec![Tensor::default(); look.count()]).collect();
    let mut add = |to: Vector, from: Vector, force: Vector| {
        for (look, sums) in looks.iter().zip(&mut sums) {
            let way = to - from;
            look.parts_of_line(to, way, |part, share| add_product(&mut sums[part], way * -share, force));
        }
    };
    let row = |index: u32| state.particles.position[state.particles.slot[index as usize] as usize];
    let centre = |index: u32| Vector::from(row(index));
    // In a cell what is touched may be an image, which is behind the contact.
    let touched = |contact: &ContactRecord, other: u32| match state.cell {
        None => centre(other),
        Some(_) => {
            let apart = row(contact.first)[3] + row(other)[3] - contact.overlap;
            centre(contact.first) - Vector::from(contact.normal) * apart
        }
    };
    let inward = |index: u32| state.inward(state.particles.slot[index as usize] as usize);
    let mut carry = |(first, to): (u32, Vector), (second, from): (Option<u32>, Vector), force: Vector| {
        add(to, from, force);
        if let Some(arm) = inward(first) {
            add(to + arm, to, force);
        }
        if let Some(arm) = second.and_then(inward) {
            add(from, from + arm, force);
        }
    };
    simulation.each_contact(&mut |contact| {
        let force = Vector::from(contact.normal) * contact.normal_force + contact.tangential_force.into();
        let other = contact.second.map_or_else(|| contact.point.into(), |other| touched(&contact, other));
        carry((contact.first, centre(contact.first)), (contact.second, other), force);
    });
    simulation.each_bond(&mut |bond| {
        carry((bond.first, bond.position.into()), (bond.second, bond.other.into()), bond.force.into());
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

/// The particles in each part of what is looked at.
fn content(look: &Look, simulation: &Simulation) -> Vec<Content> {
    let (scene, state) = (simulation.scene(), simulation.state());
    let particles = &state.particles;
    let fullness = Fullness::of(scene);
    // How a body turns is no part of the flow.
    let velocity = |slot: usize| state.velocity_of_grain(slot);
    let mut contents = vec![Content::default(); look.count()];
    let mut masses = Vec::new();
    for inside in inside(look, state, &simulation.quiet()) {
        let (slot, content) = (inside.slot as usize, &mut contents[inside.part as usize]);
        let share = inside.volume / sphere_volume(particles.position[slot][3]);
        let mass = loads::mass_of(scene, (particles, &state.clumps), slot) * share;
        content.solid += fullness.volume(state, &inside);
        content.mass += mass;
        for axis in 0..3 {
            content.velocity[axis] += mass * velocity(slot)[axis];
        }
        if let Some(temperature) = transfer::temperature(state, slot) {
            let capacity = mass * transfer::specific_heat(scene, state, slot);
            content.heat_capacity += capacity;
            content.temperature += capacity * temperature;
        }
        masses.push((slot, inside.part as usize, mass));
    }
    for content in &mut contents {
        if content.mass > 0.0 {
            content.velocity = content.velocity.map(|momentum| momentum / content.mass);
        }
        if content.heat_capacity > 0.0 {
            content.temperature /= content.heat_capacity;
        }
    }
    for (slot, part, mass) in masses {
        let apart = Vector::from(velocity(slot)) - contents[part].velocity.into();
        add_product(&mut contents[part].fluctuation, apart * mass, apart);
    }
    contents
}

/// Volume of a sphere \[m³\].
fn sphere_volume(radius: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius
}

/// Contacts of the particles in all that is looked at.
fn coordination_in(look: &Look, state: &State) -> Coordination {
    let particles = &state.particles;
    let mut inside = vec![0_u64; particles.len()];
    for slot in near::particles(state) {
        look.parts_at(particles.position[slot].into(), |_| inside[slot] += 1);
    }
    let ends = |slots: &[u32], flags: &[u8]| -> u64 {
        let told = slots.iter().zip(flags).filter(|(_, flags)| is_told(**flags));
        told.map(|(slot, _)| inside[particles.original(*slot) as usize]).sum()
    };
    let pairs = state.contacts.iter().map(|list| ends(&list.first, &list.flags) + ends(&list.second, &list.flags));
    let walls = state.walls.iter().map(|list| ends(&list.particle, &list.flags));
    Coordination { particles: inside.iter().sum(), contacts: pairs.chain(walls).sum() }
}
