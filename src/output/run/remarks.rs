//! What is legal in a scene but risky: said once, by `check`, in `summary.json` and by the unit's logger.

use super::summary::DeepestContact;
use crate::base::geometry::lattice::STRAINS;
use crate::base::number::Vector;
use crate::engine::simulation::{COLLAPSING_COHESION, Simulation};
use crate::engine::state::{Clock, Separated, TouchedThrough};
use crate::interface::{Interface, MOST_COLUMNS};
use crate::laws::contact::{Material, MaterialPair, Properties, Thermal, property};
use crate::scene::exchange::Amount;
use crate::scene::{AxisMotion, Boundary, CellMotion, ContactLaw, Grid, Scene, Step};

/// Part of the stable step above which a given step is said to be near it.
const NEAR_THE_BOUND: f64 = 0.8;

/// Young's moduli that a widely used program of the field takes without further ado \[Pa\].
const USUAL_MODULI: [f64; 2] = [5e6, 1e9];

/// Cohesion energy density over effective modulus from which contacts at rest are visibly pulled together.
const DEEP_COHESION: f64 = 0.03;

/// Width of a crack between triangles over the smallest radius, below which a sphere over it touches both sides as if each were
/// there alone.
const OF_A_CRACK: f64 = 0.1;

/// Overlap over radius above which contact laws are hardly valid.
const DEEP_OVERLAP: f64 = 0.05;

/// Share of the target by which a servo misses it that is remarked.
const MISSED: f64 = 0.01;

/// The remarks on a scene in its present state.
pub fn remarks(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let mut remarks = Vec::new();
    remarks.extend(time_step(scene, simulation));
    remarks.extend(intervals(scene));
    remarks.extend(moduli(scene));
    remarks.extend(unusual(scene));
    remarks.extend(unread(scene));
    remarks.extend(scene.unread.iter().cloned());
    remarks.extend(idle(scene));
    remarks.extend(columns(scene));
    remarks.extend(passed_through(scene));
    remarks.extend(cracks(scene));
    remarks.extend(cells(scene));
    remarks.extend(dry(simulation));
    remarks.extend(cohesion(scene));
    remarks.extend(friction(scene));
    remarks.extend(falling(scene));
    remarks.extend(course(simulation));
    remarks
}

/// Those of them that follow from how a simulation went, not from its scene alone.
pub fn course(simulation: &Simulation) -> Vec<String> {
    let scene = simulation.scene();
    let mut remarks = Vec::new();
    remarks.extend(overlap(simulation));
    remarks.extend(through(simulation));
    remarks.extend(full(scene, simulation));
    remarks.extend(missed(scene, simulation));
    remarks
}

/// On edges of meshes that are nearly one.
fn cracks(scene: &Scene) -> Vec<String> {
    let within = OF_A_CRACK * scene.radii().fold(f64::INFINITY, f64::min);
    let crack = |boundary: &Boundary| Some((boundary.name.clone(), boundary.shape.crack(within)?));
    let told = scene.boundaries.iter().filter_map(crack);
    told.map(|(name, crack)| format!("[boundary.{name}] mesh: {crack}; weld_distance above that makes them one"))
        .collect()
}

/// On grids whose cells are smaller than particles.
fn cells(scene: &Scene) -> Vec<String> {
    let largest = 2.0 * scene.radii().fold(0.0, f64::max);
    let small = |grid: &Grid| {
        let least = grid.shape.edges().into_iter().fold(f64::INFINITY, f64::min);
        (least < largest).then(|| {
            format!(
                "[grid.{}] counts: cells are {least:.3e} m wide and particles up to {largest:.3e} m; fields show single particles there, \
                 cells of three diameters show the mean of many",
                grid.name
            )
        })
    };
    scene.grids.iter().filter_map(small).collect()
}

/// On particles outside of the box of a fluid.
fn dry(simulation: &Simulation) -> Option<String> {
    let (scene, state) = (simulation.scene(), simulation.state());
    let fluid = scene.fluid.as_ref()?;
    let grid = &scene.grids[fluid.grid?];
    let (all, centres) = (scene.particles.len(), grid.shape.centres());
    let slots = state.particles.slots();
    let outside = slots.filter(|&slot| !centres.holds(Vector::from(state.particles.position[slot]))).count();
    (outside > 0).then(|| {
        format!(
            "[fluid.{}] grid: the centres of {outside} of {all} particles are outside of [grid.{}]; no fluid acts there",
            fluid.name, grid.name
        )
    })
}

/// On a given step near the stable one.
fn time_step(scene: &Scene, simulation: &Simulation) -> Option<String> {
    let Step::Given(step) = scene.run.step else { return None };
    let stable = simulation.state().clock.stable;
    if scene.run.allow_unstable {
        let found = if stable.is_finite() { format!(" ({stable:.3e} s as last found)") } else { String::new() };
        return Some(format!(
            "[run] allow_unstable: nothing stops this run when its time step, {step:e} s, is above the stable one{found}; its numbers are worth nothing then"
        ));
    }
    let Clock { divided, steps, .. } = simulation.state().clock;
    if divided > 0 {
        return Some(format!(
            "[run] step: {divided} of {steps} time steps were made shorter than {step:e} s, as the stable one fell below that ({stable:.3e} s as last found)"
        ));
    }
    (step > NEAR_THE_BOUND * stable).then(|| {
        format!("[run] step: {step:e} s is {:.2} of the computed stable step, {stable:.3e} s; accuracy suffers well before stability", step / stable)
    })
}

/// On servos that press with another force than they are to, as a mean over the last interval.
pub(super) fn missed(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let mut missed = Vec::new();
    let largest = largest(simulation.state().boundaries.iter().flat_map(|moved| moved.mean_force));
    for (boundary, moved) in scene.boundaries.iter().zip(&simulation.state().boundaries) {
        for axis in (0..3).filter(|&axis| boundary.axes[axis].servo().is_some()) {
            let (found, target) = (moved.mean_force[axis], 0.5 * (moved.start[axis] + moved.end[axis]));
            if simulation.state().clock.steps > 0 && misses(found, target, largest) {
                let [name, axis] = [&boundary.name, AxisMotion::WORDS[axis]];
                missed.push(format!(
                    "[boundary.{name}] servo: the particles press with {found:.4e} N along {axis} in the last interval, to be {target:.4e} N"
                ));
            }
        }
    }
    missed.extend(missed_by_cell(scene, simulation));
    missed
}

/// The same of stresses of a periodic cell.
fn missed_by_cell(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let state = simulation.state();
    let (Some(cell), Some(moved)) = (&scene.cell, &state.cell) else { return Vec::new() };
    let served = (0..6).filter(|&component| matches!(cell.motion[component], CellMotion::Servo(_)));
    let largest = largest(moved.mean_stress);
    let told = served.filter_map(|component| {
        let found = cell.motion[component].served(component, &moved.mean_stress);
        let target = 0.5 * (moved.start[component] + moved.end[component]);
        let name = if cell.motion[component].serves_mean() { "the mean stress" } else { STRAINS[component] };
        (state.clock.steps > 0 && misses(found, target, largest))
            .then(|| format!("[cell] servo: {name} has {found:.4e} Pa in the last interval, to be {target:.4e} Pa"))
    });
    told.collect()
}

/// Whether a servo misses its target, of which a share is allowed; of one that is zero that share of the largest of its kind.
fn misses(found: f64, target: f64, largest: f64) -> bool {
    let scale = if target == 0.0 { largest } else { target.abs() };
    (found - target).abs() > MISSED * scale
}

/// The largest magnitude.
fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// On what insertions did not let come for want of room.
fn full(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let feeds = simulation.state().exchange.iter().flat_map(|exchange| &exchange.feeds);
    let told = scene.insertions.iter().zip(feeds).filter(|(_, feed)| feed.dropped > 0.0);
    told.map(|(insertion, feed)| {
        let what = match insertion.amount {
            Amount::CountRate(_) if insertion.has_clumps() => "clumps",
            Amount::CountRate(_) => "particles",
            Amount::MassRate(_) | Amount::Mass(_) => "kg",
        };
        format!(
            "[insertion.{}]: {:.4e} {what} found no room; a larger region, or one from which spheres move away faster, lets more come",
            insertion.name, feed.dropped
        )
    })
    .collect()
}

/// Remarks on intervals that end behind the run, or are not a whole number of given steps.
fn intervals(scene: &Scene) -> Vec<String> {
    let output = &scene.output;
    let named = [
        ("history_interval", output.history_interval),
        ("frame_interval", output.frame_interval),
        ("checkpoint_interval", output.checkpoint_interval),
    ];
    let mut remarks = Vec::new();
    for (key, interval) in named.into_iter().filter_map(|(key, interval)| Some((key, interval?))) {
        if let Some(end) = scene.run.end.filter(|end| interval > *end) {
            remarks.push(format!("[output] {key}: {interval:e} s is longer than the run, which ends at {end:e} s"));
        } else if let Step::Given(step) = scene.run.step
            && ((interval / step).round() * step - interval).abs() > 1e-6 * step
        {
            remarks.push(format!(
                "[output] {key}: {interval:e} s is not a whole number of steps of {step:e} s; they are shortened to fit"
            ));
        }
    }
    remarks
}

/// On moduli that others would ask to confirm.
fn moduli(scene: &Scene) -> Vec<String> {
    let [soft, hard] = USUAL_MODULI;
    let outside = |modulus: &f64| *modulus < soft || *modulus > hard;
    (scene.materials.iter())
        .filter_map(|material| material.youngs_modulus.filter(outside).map(|modulus| (&material.name, modulus)))
        .map(|(name, modulus)| {
            let effect = if modulus < soft { "overlaps will be large" } else { "time steps will be short" };
            format!("[material.{name}] youngs_modulus: {modulus:e} Pa is outside {soft:e} to {hard:e} Pa, which particle programs usually take; {effect}")
        })
        .collect()
}

/// Numbers that scenes usually have, in SI units; what is outside is often a slip of units or sign.
const USUAL_DENSITIES: [f64; 2] = [50.0, 25_000.0];
/// Radii from powders to boulders \[m\].
const USUAL_RADII: [f64; 2] = [1e-7, 2.0];
/// Coefficients of friction.
const USUAL_FRICTION: [f64; 2] = [0.0, 2.0];
/// Gravity, that of centrifuges included \[m/s²\].
const USUAL_GRAVITY: [f64; 2] = [0.0, 2000.0];
/// Surface energies \[J/m²\].
const USUAL_SURFACE_ENERGIES: [f64; 2] = [0.0, 10.0];

/// On numbers outside of the usual range, with the range.
fn unusual(scene: &Scene) -> Vec<String> {
    let mut remarks = Vec::new();
    let mut look = |key: String, value: f64, unit: &str, [least, most]: [f64; 2]| {
        if value < least || value > most {
            remarks
                .push(format!("{key}: expected {least:e} to {most:e}{unit} as usual, found {value:e}; check the unit"));
        }
    };
    for material in &scene.materials {
        look(format!("[material.{}] density", material.name), material.density, " kg/m³", USUAL_DENSITIES);
    }
    let gravity = scene.gravity.iter().map(|part| part * part).sum::<f64>().sqrt();
    look("gravity".to_owned(), gravity, " m/s²", USUAL_GRAVITY);
    for (set, name) in scene.sets.iter().enumerate() {
        let radii =
            || scene.particles.iter().filter(|particle| particle.set.index() == set).map(|particle| particle.radius);
        let key = || format!("[particles.{name}] radius");
        if let Some(least) = radii().reduce(f64::min).filter(|least| *least < USUAL_RADII[0]) {
            look(key(), least, " m", USUAL_RADII);
        }
        if let Some(most) = radii().reduce(f64::max).filter(|most| *most > USUAL_RADII[1]) {
            look(key(), most, " m", USUAL_RADII);
        }
    }
    for (table, properties) in pairs(scene) {
        let keys = [
            (&property::FRICTION, "", USUAL_FRICTION),
            (&property::ROLLING_FRICTION, "", USUAL_FRICTION),
            (&property::SURFACE_ENERGY, " J/m²", USUAL_SURFACE_ENERGIES),
        ];
        for (key, unit, range) in keys {
            if let Some(value) = properties.get(key) {
                look(format!("[{table}] {}", key.name), value, unit, range);
            }
        }
    }
    remarks
}

/// The tables of pairs of materials, by name, each once.
fn pairs(scene: &Scene) -> impl Iterator<Item = (String, &Properties)> {
    let count = scene.materials.len();
    let name = |index: usize| &scene.materials[index].name;
    let entries = (0..count).flat_map(move |a| (a..count).map(move |b| (a, b)));
    entries.map(move |(a, b)| (format!("pair.{}.{}", name(a), name(b)), &scene.pairs[a * count + b]))
}

/// On properties of pairs of materials that nothing reads.
fn unread(scene: &Scene) -> Vec<String> {
    let count = scene.materials.len();
    let entries = (0..count).flat_map(|a| (a..count).map(move |b| (a, b)));
    let mut remarks = Vec::new();
    for ((a, b), (table, properties)) in entries.zip(pairs(scene)) {
        let laws: Vec<_> = scene.contacts.iter().filter(|law| law.between[a * count + b]).collect();
        let with = |law: &ContactLaw, properties: &Properties| {
            let pair = MaterialPair { a: &scene.materials[a], b: &scene.materials[b], properties };
            (law.choice.coefficients(&pair).ok(), law.heat_between(&pair))
        };
        let is_read = |variants: &[Properties]| {
            laws.iter().any(|law| variants.iter().any(|other| with(law, other) != with(law, properties)))
        };
        let keys: Vec<_> =
            properties.variants().filter(|(_, variants)| !is_read(variants)).map(|(key, _)| key).collect();
        if keys.is_empty() {
            continue;
        }
        let expected = if laws.is_empty() {
            "a [contact] law for these materials"
        } else {
            "a sub-model of [contact] that takes it, or no such key"
        };
        remarks.push(format!("[{table}] {}: nothing reads it; expected {expected}", keys.join(", ")));
    }
    remarks
}

/// On materials of which nothing is made, laws that are for none that can meet, and moduli that no law reads.
fn idle(scene: &Scene) -> Vec<String> {
    let count = scene.materials.len();
    let particles =
        scene.particles.iter().map(|particle| particle.material).chain(scene.insertions.iter().map(|it| it.material));
    let (mut moving, mut there) = (vec![false; count], vec![false; count]);
    particles.for_each(|material| moving[material.index()] = true);
    there.clone_from(&moving);
    let walls = scene.boundaries.iter().filter_map(|boundary| boundary.shape.material());
    walls.for_each(|material| there[material.index()] = true);
    let mut remarks = Vec::new();
    for (index, material) in scene.materials.iter().enumerate() {
        if !there[index] {
            remarks.push(format!("[material.{}]: nothing is made of it", material.name));
            continue;
        }
        let own = material.thermal;
        if own.specific_heat.is_some() && !scene.has_heat() {
            remarks.push(format!(
                "[material.{}] specific_heat: nothing reads it; no heat flows without [contact.<law>.heat.<model>] or another table of heat",
                material.name
            ));
        }
        let elastic = [
            (
                "youngs_modulus",
                material.youngs_modulus.is_some(),
                Material { youngs_modulus: None, ..material.clone() },
            ),
            (
                "poissons_ratio",
                material.poissons_ratio.is_some(),
                Material { poissons_ratio: None, ..material.clone() },
            ),
        ];
        let declared = material.properties.iter().map(|(property, _)| {
            let without = material.properties.clone().without(property);
            (property.name, true, Material { properties: without, ..material.clone() })
        });
        let thermal = [
            ("conductivity", own.conductivity.is_some(), Thermal { conductivity: None, ..own }),
            ("real_youngs_modulus", own.real_youngs_modulus.is_some(), Thermal { real_youngs_modulus: None, ..own }),
        ];
        let thermal = thermal.map(|(key, given, thermal)| (key, given, Material { thermal, ..material.clone() }));
        let optional: Vec<_> = elastic.into_iter().chain(declared).chain(thermal).collect();
        let is_read = |other: &Material| {
            (0..count).any(|partner| {
                let entry = index * count + partner;
                let with = |own: &Material| {
                    let b = if partner == index { own } else { &scene.materials[partner] };
                    let pair = MaterialPair { a: own, b, properties: &scene.pairs[entry] };
                    let laws = scene.contacts.iter().filter(|law| law.between[entry]);
                    let read = |law: &ContactLaw| (law.choice.coefficients(&pair).ok(), law.heat_between(&pair));
                    laws.map(read).collect::<Vec<_>>()
                };
                with(other) != with(material)
            })
        };
        let keys: Vec<_> =
            optional.iter().filter(|(_, given, other)| *given && !is_read(other)).map(|(key, ..)| *key).collect();
        if !keys.is_empty() {
            remarks.push(format!(
                "[material.{}] {}: nothing reads it; no contact law takes it",
                material.name,
                keys.join(", ")
            ));
        }
    }
    let meet = |entry: usize| {
        let (a, b) = (entry / count, entry % count);
        moving[a] && there[b] || there[a] && moving[b]
    };
    for law in scene.contacts.iter().filter(|law| !(0..count * count).any(|entry| law.between[entry] && meet(entry))) {
        remarks.push(format!("[contact.{}]: no two bodies of the scene are of its materials", law.name));
    }
    remarks
}

/// On columns of `history.csv` that are left out because there would be very many.
fn columns(scene: &Scene) -> Option<String> {
    let interface = Interface::of(scene);
    let all = interface.outputs().filter(|(_, variable)| variable.element().is_none()).count();
    (scene.output.columns.is_none() && all > MOST_COLUMNS).then(|| {
        format!(
            "[output] columns: history.csv has {} of {all} outputs, without those of groups of particles; columns names those that you \
             want, [\"*\"] all of them",
            interface.recorded().count()
        )
    })
}

/// On particles that pass through boundaries because no law is for their contacts.
fn passed_through(scene: &Scene) -> Vec<String> {
    let count = scene.materials.len();
    let mut present: Vec<u32> = scene.particles.iter().map(|particle| particle.material.0).collect();
    present.extend(scene.insertions.iter().map(|insertion| insertion.material.0));
    present.sort_unstable();
    present.dedup();
    let mut remarks = Vec::new();
    for (index, boundary) in scene.boundaries.iter().enumerate() {
        let Some(material) = boundary.shape.material() else { continue };
        let bonded = scene.bonds.iter().any(|bond| bond.plane.is_some_and(|plane| plane.index() == index));
        let lawless = |particle: &&u32| {
            let entry = **particle as usize * count + material.index();
            !scene.contacts.iter().any(|law| law.between[entry])
        };
        if let Some(particle) = present.iter().find(lawless).filter(|_| !bonded) {
            let [particle, other] = [*particle as usize, material.index()].map(|index| &scene.materials[index].name);
            remarks.push(format!(
                "[boundary.{}]: particles of {particle} pass through it: expected a [contact] law for {particle} and {other}",
                boundary.name
            ));
        }
    }
    remarks
}

/// On cohesion that pulls contacts deep into each other.
fn cohesion(scene: &Scene) -> Vec<String> {
    let count = scene.materials.len();
    let pairs = (0..count).flat_map(|a| (a..count).map(move |b| (a, b)));
    let deep = pairs.filter_map(|(a, b)| {
        let ratio = scene.cohesion_ratio(a, b).filter(|ratio| *ratio > DEEP_COHESION)?;
        let density = scene.pairs[a * count + b].get(&property::COHESION_ENERGY_DENSITY)?;
        let effect = if ratio > COLLAPSING_COHESION { "contacts collapse" } else { "contacts rest deep in each other" };
        let [a, b] = [a, b].map(|index| &scene.materials[index].name);
        Some(format!(
            "[pair.{a}.{b}] cohesion_energy_density: {density:e} J/m³ is {ratio:.2e} of the effective modulus; above {DEEP_COHESION} {effect}"
        ))
    });
    deep.collect()
}

/// On friction whose dashpot stretches its spring backwards where it exceeds the limit, as it does at first touch: what follows then depends
/// on how deep the first time step finds the contact.
fn friction(scene: &Scene) -> Vec<String> {
    let named = scene.contacts.iter().filter(|law| law.choice.stretches_backwards());
    let told = named.map(|law| {
        format!(
            "[contact.{}] tangential: with {}, rebounds of impacts that slide first may depend on the time step by some percent, and a shorter one need not help; with backward_spring = false, or history, they converge",
            law.name,
            law.choice.tangential.name()
        )
    });
    told.collect()
}

/// On overlaps that contact laws are not made for.
fn overlap(simulation: &Simulation) -> Option<String> {
    let overlap = simulation.state().deepest.overlap;
    let DeepestContact { time, between: [one, other] } =
        DeepestContact::of(simulation).filter(|_| overlap > DEEP_OVERLAP)?;
    Some(format!(
        "the largest overlap is {overlap:.3} of a radius, of {one} and {other} at t = {time:e} s; contact laws hold for small ones"
    ))
}

/// On particles that touch each other through a surface, or soon may.
fn through(simulation: &Simulation) -> Option<String> {
    let (scene, state) = (simulation.scene(), simulation.state());
    let name = |boundary: u32| &scene.boundaries[boundary as usize].name;
    let advice = "contacts of particles do not know surfaces: let what is on each side be of a material of its own, without a [contact] law for both";
    if let Some(TouchedThrough { particles, boundary, time }) = state.through.first {
        let [one, other] = particles.map(|named| named.number.unwrap_or_else(|| simulation.number(named.index)));
        return Some(format!(
            "[boundary.{}]: particles {one} and {other} touched each other through it at t = {time:e} s; {advice}",
            name(boundary)
        ));
    }
    let Separated { list, entry, boundary } = *state.through.pairs.first()?;
    let (list, entry) = (&state.contacts[list as usize], entry as usize);
    let number = |slot: u32| {
        let index = state.particles.id[slot as usize];
        state.particles.number_of_inserted(index).unwrap_or_else(|| simulation.number(index))
    };
    let [one, other] = [list.first[entry], list.second[entry]].map(number);
    Some(format!(
        "[boundary.{}]: particles {one} and {other} are near each other on both sides of it and may touch through it; {advice}",
        name(boundary)
    ))
}

/// On particles that fall for ever.
fn falling(scene: &Scene) -> Option<String> {
    let endless =
        scene.boundaries.is_empty() && scene.domain.is_none() && scene.gravity.iter().any(|part| *part != 0.0);
    endless.then(|| "gravity acts and there is no boundary and no [domain]: particles fall for ever".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Source;

    /// A scene with these lines about the pair and the law.
    fn scene(pair: &str, law: &str, density: f64) -> Scene {
        let text = format!(
            "gravity = [0.0, 0.0, -9.81]\n[material.g]\ndensity = {density:?}\nyoungs_modulus = 1e7\npoissons_ratio = 0.25\n\
             [pair.g.g]\n{pair}\n{law}\n[particles.a]\nmaterial = \"g\"\nlist = [{{ position = [0.0, 0.0, 0.02], radius = 0.01 }}]\n\
             [boundary.floor]\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\nmaterial = \"g\"\n"
        );
        let source = Source { name: "scene.toml".into(), text, files: Default::default() };
        Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"))
    }

    #[test]
    fn what_nothing_reads_is_remarked() {
        let (pair, law) =
            ("restitution = 0.5\nfriction = 0.4", "[contact.c.normal.hertz]\n[contact.c.tangential.history]");
        assert!(unread(&scene(pair, law, 2500.0)).is_empty());
        let forgotten = scene(pair, "", 2500.0);
        assert_eq!(
            unread(&forgotten),
            ["[pair.g.g] restitution, friction: nothing reads it; expected a [contact] law for these materials"]
        );
        assert_eq!(
            passed_through(&forgotten),
            ["[boundary.floor]: particles of g pass through it: expected a [contact] law for g and g"]
        );
        let more = format!("{pair}\ncohesion_energy_density = 1e4\nrolling_friction = 0.3");
        let told = unread(&scene(&more, law, 2500.0));
        assert!(
            told[0].starts_with("[pair.g.g] rolling_friction, cohesion_energy_density: nothing reads it"),
            "{told:?}"
        );
        let read = format!("{law}\n[contact.c.rolling.cdt]\n[contact.c.cohesion.sjkr]");
        assert!(unread(&scene(&more, &read, 2500.0)).is_empty());
    }

    #[test]
    fn what_particles_and_sets_say_themselves_is_remarked_where_it_stands_once_more() {
        let unread = |more: &str| {
            let text = format!(
                "[material.g]\ndensity = 2500.0\n[clump.c]\nspheres = [{{ position = [0.0, 0.0, 0.0], radius = 1e-3 }}]\n{more}"
            );
            let source = Source { name: "scene.toml".into(), text, files: Default::default() };
            Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}")).unread.clone()
        };
        let list = |keys: &str| format!("list = [{{ position = [0.0, 0.0, 0.0]{keys} }}]\n");
        let spheres = "[particles.a]\nmaterial = \"g\"\nvelocity = [1.0, 0.0, 0.0]\n";
        let own = ", radius = 1e-3, velocity = [0.0, 0.0, 1.0]";
        assert_eq!(
            unread(&format!("{spheres}{}", list(own))),
            [
                "[clump.c] spheres: nothing reads it; no set or insertion has such clumps",
                "[particles.a] velocity: nothing reads it; each of its particles has its own"
            ]
        );
        let clumps = "[particles.a]\nclump = \"c\"\norientation = \"random\"\n";
        let told =
            unread(&format!("material = \"g\"\n{clumps}{}", list(", material = \"g\", orientation = [1, 0, 0, 0]")));
        assert_eq!(
            told,
            [
                "[clump.c] material: nothing reads it; all that place such clumps have their own",
                "[particles.a] orientation: nothing reads it; each of its particles has its own"
            ]
        );
        assert!(unread(&format!("material = \"g\"\n{clumps}{}", list(""))).is_empty());
    }

    #[test]
    fn materials_laws_and_moduli_that_nothing_takes_are_remarked() {
        let pair = "restitution = 0.5\nfriction = 0.4";
        let law = "[contact.c.normal.hertz]\n[contact.c.tangential.history]";
        assert!(idle(&scene(pair, law, 2500.0)).is_empty());
        let more = "[material.steel]\ndensity = 7800.0\nyoungs_modulus = 1e7\npoissons_ratio = 0.3\n";
        assert_eq!(idle(&scene(pair, &format!("{more}{law}"), 2500.0)), ["[material.steel]: nothing is made of it"]);
        let other = format!(
            "{more}[pair.g.steel]\nrestitution = 0.5\nfriction = 0.4\n[contact.c]\nbetween = [[\"g\", \"g\"]]\n{law}\n[contact.s]\n\
             between = [[\"g\", \"steel\"]]\n[contact.s.normal.hertz]\n[contact.s.tangential.history]"
        );
        let told = idle(&scene(pair, &other, 2500.0));
        assert_eq!(
            told,
            ["[material.steel]: nothing is made of it", "[contact.s]: no two bodies of the scene are of its materials"]
        );
        assert_eq!(
            idle(&scene(pair, "", 2500.0)),
            ["[material.g] youngs_modulus, poissons_ratio: nothing reads it; no contact law takes it"]
        );
    }

    #[test]
    fn what_heat_reads_is_not_remarked_and_what_it_does_not_read_is() {
        let told = |heat: &str, pair: &str| {
            let text = format!(
                "[material.g]\ndensity = 2500.0\nyoungs_modulus = 1e7\npoissons_ratio = 0.25\nspecific_heat = 800.0\nconductivity = 1.0\n\
                 real_youngs_modulus = 1e10\n[pair.g.g]\nrestitution = 0.5\n{pair}\n[contact.c.normal.hertz]\n{heat}\n[particles.a]\n\
                 material = \"g\"\ntemperature = 300.0\nlist = [{{ position = [0.0, 0.0, 0.02], radius = 0.01 }}]\n"
            );
            let source = Source { name: "scene.toml".into(), text, files: Default::default() };
            let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"));
            [unread(&scene), idle(&scene)].concat()
        };
        let transfer = "[contact.c.heat.transfer]";
        assert!(told("[contact.c.heat.constriction]", "").is_empty());
        assert_eq!(
            told(transfer, "heat_transfer_coefficient = 1e3"),
            ["[material.g] conductivity: nothing reads it; no contact law takes it"]
        );
        let both = "conductivity = 2.0\nheat_transfer_coefficient = 1e3";
        assert!(told(transfer, both)[0].starts_with("[pair.g.g] conductivity: nothing reads it"));
        let told_of_none = told("", "");
        assert!(told_of_none[0].starts_with("[material.g] specific_heat: nothing reads it; no heat flows"));
        assert!(told_of_none[1].starts_with("[material.g] conductivity, real_youngs_modulus: nothing reads it"));
    }

    #[test]
    fn what_is_outside_of_the_usual_range_is_remarked_with_the_range() {
        let law = "[contact.c.normal.hertz]\n[contact.c.tangential.history]";
        assert!(unusual(&scene("restitution = 0.5\nfriction = 0.4", law, 2500.0)).is_empty());
        let told = unusual(&scene("restitution = 0.5\nfriction = 40.0", law, 2.5));
        assert_eq!(
            told,
            [
                "[material.g] density: expected 5e1 to 2.5e4 kg/m³ as usual, found 2.5e0; check the unit",
                "[pair.g.g] friction: expected 0e0 to 2e0 as usual, found 4e1; check the unit",
            ]
        );
    }

    #[test]
    fn a_spring_that_its_dashpot_stretches_backwards_is_remarked() {
        let told = |tangential: &str, damping: &str| {
            let text = format!(
                "[material.a]\ndensity = 2500.0\nyoungs_modulus = 1e7\npoissons_ratio = 0.3\n[pair.a.a]\nrestitution = 0.5\nfriction = 0.5\n\
                 [contact.c]\ntangential_damping = {damping}\n[contact.c.normal.hertz]\n[contact.c.tangential.{tangential}]\n\
                 [particles.p]\nmaterial = \"a\"\nlist = [{{ position = [0.0, 0.0, 0.0], radius = 1e-3 }}]\n"
            );
            let source = Source { name: "scene.toml".into(), text, files: Default::default() };
            friction(&Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}")))
        };
        assert!(told("turned_history", "true")[0].starts_with("[contact.c] tangential: with turned_history, rebounds"));
        assert!(told("turned_history]\nbackward_spring = false\n[contact.c.rolling.none", "true").is_empty());
        for [tangential, damping] in [["turned_history", "false"], ["history", "true"], ["no_history", "true"]] {
            assert!(told(tangential, damping).is_empty(), "{tangential}, damping {damping}");
        }
    }
}
