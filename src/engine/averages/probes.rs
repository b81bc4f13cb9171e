//! What probes see: found by looking, never in a time step.

use crate::base::geometry::Lattice;
use crate::base::number::Vector;
use crate::base::quantity::{ParticleId, SetIndex};
use crate::engine::bodies::loads;
use crate::engine::simulation::Simulation;
use crate::engine::transfer;
use crate::scene::Probed;

/// What a probe sees at the present time; zeros of what has gone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sight {
    /// Place of the particle, mass centre of the set \[m\].
    pub position: [f64; 3],
    /// Velocity, that of the mass centre of a set \[m/s\].
    pub velocity: [f64; 3],
    /// Angular velocity of the particle \[rad/s\].
    pub angular_velocity: [f64; 3],
    /// Sum of all forces; of a contact that of the second particle on the first \[N\].
    pub force: [f64; 3],
    /// Sum of all torques on the particle \[N m\].
    pub torque: [f64; 3],
    /// Force along the line of the two centres, positive where they push \[N\].
    pub normal_force: f64,
    /// Sum of the two radii less the distance of the centres \[m\].
    pub overlap: f64,
    /// Temperature of the particle, mean of the set by heat capacity; 0 where no heat flows \[K\].
    pub temperature: f64,
}

/// What each probe of the scene sees.
pub fn sights(simulation: &Simulation) -> Vec<Sight> {
    let mut sights: Vec<Sight> = (simulation.scene().probes.iter())
        .map(|probe| match probe.of {
            Probed::Particle(id) => {
                slot_of(simulation, id).map_or_else(Sight::default, |slot| particle(simulation, slot))
            }
            Probed::Set(set) => all_of(simulation, set),
            Probed::Contact(_) => Sight::default(),
        })
        .collect();
    contacts(simulation, &mut sights);
    sights
}

/// Index of a particle of the scene.
fn index_of(simulation: &Simulation, id: ParticleId) -> Option<u32> {
    let place = simulation.scene().particles.binary_search_by_key(&id.0, |particle| particle.id.0).ok()?;
    Some(place as u32)
}

/// Where a particle of the scene stands in memory, unless it has gone.
fn slot_of(simulation: &Simulation, id: ParticleId) -> Option<usize> {
    simulation.state().particles.slot_of(index_of(simulation, id)?)
}

/// The first three numbers of a row.
fn three([x, y, z, _]: [f64; 4]) -> [f64; 3] {
    [x, y, z]
}

/// One particle.
fn particle(simulation: &Simulation, slot: usize) -> Sight {
    let particles = &simulation.state().particles;
    Sight {
        position: simulation.state().unwrapped(slot),
        velocity: three(particles.velocity[slot]),
        angular_velocity: three(particles.angular_velocity[slot]),
        force: loads::force_on(simulation.scene(), particles, slot),
        torque: three(particles.torque[slot]),
        temperature: transfer::temperature(simulation.state(), slot).unwrap_or(0.0),
        ..Sight::default()
    }
}

/// All particles of a set that are there, in the order of the scene.
fn all_of(simulation: &Simulation, set: SetIndex) -> Sight {
    let (scene, state) = (simulation.scene(), simulation.state());
    let (mut mass, mut place, mut momentum, mut force) = (0.0, Vector::zero(), Vector::zero(), Vector::zero());
    let of_set = |index: u32| scene.particles.get(index as usize).is_some_and(|particle| particle.set == set);
    for grain in state.grains().filter(|grain| of_set(grain.index)) {
        let own = grain.velocity[3];
        mass += own;
        place += Vector::from(state.unwrapped_grain(&grain)) * own;
        momentum += Vector::from(*grain.velocity) * own;
        force += Vector::from(*grain.force);
    }
    let (mut heat, mut capacity) = (0.0, 0.0);
    let members = (0..).zip(&scene.particles).filter(|(_, particle)| particle.set == set);
    for slot in members.filter_map(|(index, _)| state.particles.slot_of(index)) {
        let Some(temperature) = transfer::temperature(state, slot) else { break };
        let specific = transfer::specific_heat(scene, state, slot);
        let own = loads::mass_of(scene, (&state.particles, &state.clumps), slot) * specific;
        heat += own * temperature;
        capacity += own;
    }
    if mass == 0.0 {
        return Sight::default();
    }
    let mean = |sum: Vector| (sum * (1.0 / mass)).to_array();
    let temperature = if capacity > 0.0 { heat / capacity } else { 0.0 };
    Sight { position: mean(place), velocity: mean(momentum), force: force.to_array(), temperature, ..Sight::default() }
}

/// What the two particles of each probe of a contact do to each other, by contact and bond.
fn contacts(simulation: &Simulation, sights: &mut [Sight]) {
    let mut pairs = Vec::new();
    for (place, probe) in simulation.scene().probes.iter().enumerate() {
        let Probed::Contact(ids) = probe.of else { continue };
        if let [Some(first), Some(second)] = ids.map(|id| index_of(simulation, id)) {
            pairs.push((place, [first, second], Vector::zero()));
        }
    }
    if pairs.is_empty() {
        return;
    }
    let mut add = |a: u32, b: Option<u32>, force: Vector| {
        for (_, [first, second], sum) in &mut pairs {
            if (a, b) == (*first, Some(*second)) {
                *sum += force;
            } else if (a, b) == (*second, Some(*first)) {
                *sum += -force;
            }
        }
    };
    simulation.each_contact(&mut |contact| {
        let force = Vector::from(contact.normal) * contact.normal_force + contact.tangential_force.into();
        add(contact.first, contact.second, force);
    });
    simulation.each_bond(&mut |bond| add(bond.first, bond.second, bond.force.into()));
    let particles = &simulation.state().particles;
    for (place, ids, force) in pairs {
        let [Some(a), Some(b)] = ids.map(|index| particles.slot_of(index)) else { continue };
        let apart = match (&simulation.scene().cell, &simulation.state().cell) {
            (Some(cell), Some(lies)) => {
                let lattice = Lattice { edges: lies.edges, ..cell.lattice };
                let [a, b] = [a, b].map(|slot| Vector::from(particles.position[slot]).to_array());
                Vector::from(lattice.nearest(a, b))
            }
            _ => Vector::from(particles.position[a]) - Vector::from(particles.position[b]),
        };
        let distance = apart.length();
        sights[place] = Sight {
            force: force.to_array(),
            normal_force: if distance > 0.0 { force.dot(apart) / distance } else { 0.0 },
            overlap: particles.position[a][3] + particles.position[b][3] - distance,
            ..Sight::default()
        };
    }
}
