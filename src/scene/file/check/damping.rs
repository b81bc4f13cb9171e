//! Damping and applied forces: what is done to chosen particles.

use super::contacts::material_index;
use super::particles::ReadParticles;
use super::raw_tables::RawTables;
use super::selection::{ParticleOwners, members};
use crate::base::document::Faults;
use crate::base::document::Mistake;
use crate::laws::contact::Material;
use crate::scene::file::tables::{DampingTable, ScaleTable};
use crate::scene::{AppliedForce, Damping};

/// All damping.
pub(super) fn damping(
    written: &RawTables,
    materials: &[Material],
    born: &ReadParticles,
    faults: &mut Faults,
) -> Vec<Damping> {
    let mut owners = ParticleOwners::of(born);
    let mut list = Vec::new();
    for (name, damping) in &written.damping {
        let table = format!("damping.{name}");
        let members = match &damping.particles {
            Some(selection) => members(selection, born, &table, faults),
            None => (0..born.particles.len() as u32).collect(),
        };
        owners.claim(&members, &table, born, faults);
        let scales = scales(damping, &members, &table, materials, born, faults);
        let [linear, angular] = [damping.linear.get(), damping.angular.get()].map(|coefficient| {
            let mut each = vec![0.0; born.particles.len()];
            for (member, scale) in members.iter().zip(&scales) {
                each[*member as usize] = coefficient * scale;
            }
            each
        });
        let all = damping.particles.is_none();
        let newcomers = if all { [damping.linear.get(), damping.angular.get()] } else { [0.0; 2] };
        if all && damping.scale.is_some() && !written.insertions.is_empty() {
            let found = "a scale, which particles that come later have none of".to_owned();
            let expected = "particles = .. that names those to be damped, or no scale".to_owned();
            faults.add(&table, "scale", Mistake::Unexpected { found, expected });
        }
        let gravity = written.gravity.0 != [0.0; 3];
        let gravity_damped = said(damping.gravity_damped, gravity, &table, "gravity_damped", faults);
        let applied = !written.forces.is_empty();
        let forces_damped = said(damping.applied_forces_damped, applied, &table, "applied_forces_damped", faults);
        let name = name.clone();
        list.push(Damping { name, linear, angular, newcomers, gravity_damped, applied_forces_damped: forces_damped });
    }
    list
}

/// A choice that the scene must make where it matters.
fn said(choice: Option<bool>, matters: bool, table: &str, key: &str, faults: &mut Faults) -> bool {
    if choice.is_none() && matters {
        faults.add(table, key, Mistake::Missing { expected: "true or false".to_owned() });
    }
    choice.unwrap_or(false)
}

/// The factor on the damping of each member.
fn scales(
    damping: &DampingTable,
    members: &[u32],
    table: &str,
    materials: &[Material],
    born: &ReadParticles,
    faults: &mut Faults,
) -> Vec<f64> {
    let particle = |member: &u32| &born.particles[*member as usize];
    match &damping.scale {
        None => vec![1.0; members.len()],
        Some(ScaleTable { material: Some(scale), radius_divisor: None, column: None }) => {
            let mut factors = vec![1.0; materials.len()];
            for (name, factor) in scale {
                let key = format!("scale.material.{name}");
                if let Some(index) = material_index(materials, name, table, &key, faults) {
                    factors[index.index()] = factor.get();
                }
            }
            members.iter().map(|member| factors[particle(member).material.index()]).collect()
        }
        Some(ScaleTable { material: None, radius_divisor: Some(divisor), column: None }) => {
            members.iter().map(|member| particle(member).radius / divisor.get()).collect()
        }
        Some(ScaleTable { material: None, radius_divisor: None, column: Some(column) }) => {
            from_column(column, members, table, born, faults)
        }
        Some(scale) => {
            let expected = "one of material, radius_divisor and column".to_owned();
            let given = scale.material.is_some() || scale.radius_divisor.is_some() || scale.column.is_some();
            let found = if given { "several" } else { "none" }.to_owned();
            faults.add(table, "scale", Mistake::Unexpected { found, expected });
            Vec::new()
        }
    }
}

/// Factors from a column of the sets' files.
fn from_column(column: &str, members: &[u32], table: &str, born: &ReadParticles, faults: &mut Faults) -> Vec<f64> {
    let mut lacking = vec![false; born.sets.len()];
    let mut factors = Vec::with_capacity(members.len());
    for member in members.iter().map(|member| *member as usize) {
        let set = born.particles[member].set.index();
        match born.columns[set].get(column) {
            Some(values) => factors.push(values[born.rows[member] as usize]),
            None => lacking[set] = true,
        }
    }
    for (name, _) in born.sets.iter().zip(lacking).filter(|(_, lacking)| *lacking) {
        let found = format!("none in [particles.{name}]");
        let expected = format!("a column {column} in the file of every set that is damped");
        faults.add(table, "scale.column", Mistake::Unexpected { found, expected });
    }
    if let Some(factor) = factors.iter().find(|factor| **factor < 0.0) {
        let (found, expected) = (format!("{factor:?} in column {column}"), "factors of 0 or above".to_owned());
        faults.add(table, "scale.column", Mistake::Unexpected { found, expected });
    }
    factors
}

/// All applied forces.
pub(super) fn forces(written: &RawTables, born: &ReadParticles, faults: &mut Faults) -> Vec<AppliedForce> {
    let mut forces = Vec::new();
    for (name, force) in &written.forces {
        let members = members(&force.particles, born, &format!("force.{name}"), faults);
        forces.push(AppliedForce { name: name.clone(), members, force: force.force.0 });
    }
    forces
}
