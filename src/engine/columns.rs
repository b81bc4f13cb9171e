//! Declared columns of particles: whether a state's can be those of a scene, and how a later scene takes them over.

use crate::engine::state::{Particles, State, StateFault, demand};
use crate::scene::{ColumnStart, Scene};

/// Whether every value is one that its column takes, and particles of a body have one value of what they share.
pub(crate) fn check(scene: &Scene, particles: &Particles) -> Result<(), StateFault> {
    let count = particles.declared.len();
    demand(count == scene.columns.len(), "declared", count, "a column for each that the scene asks for")?;
    for (ColumnStart { column, .. }, values) in scene.columns.iter().zip(&particles.declared) {
        let wrong = values.iter().position(|value| !(column.takes)(*value));
        demand(wrong.is_none(), column.name, wrong.unwrap_or(0), column.expected)?;
        if column.shared.is_some() {
            check_shared(particles, column.name, values)?;
        }
    }
    Ok(())
}

/// Whether particles of a body have one value.
fn check_shared(particles: &Particles, name: &'static str, values: &[f64]) -> Result<(), StateFault> {
    let mut of_bodies: Vec<Option<u64>> = Vec::new();
    for (slot, value) in values.iter().enumerate() {
        let Some(body) = particles.group(slot) else { continue };
        of_bodies.resize(of_bodies.len().max(body + 1), None);
        let first = *of_bodies[body].get_or_insert(value.to_bits());
        demand(first == value.to_bits(), name, slot, "one value for all particles of a group or clump")?;
    }
    Ok(())
}

/// Takes over the values of columns of the same name from the particles of another state, whose columns have these names. `slots` lists
/// slots here and there. Returns what could not be taken over as it was, in words.
pub(crate) fn take_over(
    scene: &Scene,
    state: &mut State,
    (reached, names): (&State, &[String]),
    slots: &[[usize; 2]],
) -> Vec<String> {
    let mut left = Vec::new();
    for (ColumnStart { column, .. }, values) in scene.columns.iter().zip(&mut state.particles.declared) {
        match names.iter().position(|name| name == column.name).and_then(|place| reached.particles.declared.get(place))
        {
            Some(there) => slots.iter().for_each(|&[slot, from]| values[slot] = there[from]),
            None if slots.is_empty() => {}
            None => left.push(format!("{} is not in the other state; it begins as this scene has it", column.name)),
        }
    }
    for name in names.iter().filter(|name| scene.column(name).is_none()) {
        left.push(format!("{name} stays behind: this scene does not ask for it"));
    }
    left.extend(share(scene, &mut state.particles));
    left
}

/// Lets particles of a group have the mean of what they share. Returns of which groups that changes values, in words.
fn share(scene: &Scene, particles: &mut Particles) -> Vec<String> {
    let mut changed = Vec::new();
    for (ColumnStart { column, .. }, values) in scene.columns.iter().zip(&mut particles.declared) {
        let Some(weight) = column.shared else { continue };
        for (body, members) in scene.shared_by() {
            let slots: Vec<usize> = members.iter().map(|&member| particles.slot[member as usize] as usize).collect();
            let Some(&first) = slots.first() else { continue };
            if slots.iter().all(|&slot| values[slot] == values[first]) {
                continue;
            }
            let weights = members.iter().map(|&member| {
                let particle = &scene.particles[member as usize];
                weight(&scene.materials[particle.material.index()], particle.mass())
            });
            let [sum, whole] = slots
                .iter()
                .zip(weights)
                .fold([0.0; 2], |[sum, whole], (&slot, weight)| [sum + weight * values[slot], whole + weight]);
            slots.iter().for_each(|&slot| values[slot] = sum / whole);
            changed.push(format!("the particles of [{body}] take the mean {} of all", column.name));
        }
    }
    changed
}

/// The values of what comes by an insertion, column by column.
pub(crate) fn of_insertion(scene: &Scene, insertion: usize) -> Vec<f64> {
    scene.columns.iter().map(|start| start.insertions[insertion]).collect()
}
