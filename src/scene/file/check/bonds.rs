//! Bond laws: between whom, and which bonds are there at the start.

use super::particles::ReadParticles;
use super::raw_tables::RawTables;
use crate::base::document::{Faults, Mistake};
use crate::base::quantity::{BoundaryIndex, SetIndex};
use crate::laws::bond::creation::ListedPairs;
use crate::laws::bond::keys::Keys;
use crate::scene::Source;
use crate::scene::import::REPORTED;
use crate::scene::{Bond, Boundary, Cell, Particle, Run, SceneDraft, Step};

/// All bond laws.
pub(super) fn bonds(
    written: &RawTables,
    source: &Source,
    (born, cell): (&ReadParticles, Option<&Cell>),
    boundaries: &[Boundary],
    run: &Run,
    faults: &mut Faults,
) -> Vec<Bond> {
    let mut bonds = Vec::new();
    for (name, keys) in &written.bonds {
        let table = format!("bond.{name}");
        given_step(keys, &table, run.step, faults);
        let between = between((keys, &table), (written, boundaries), born, faults);
        if between.is_some_and(|between| between.1.is_some()) && !keys.create.needs_distance() {
            faults.add(&table, "create", listed_at_plane());
            continue;
        }
        let pairs = listed(keys, source, &table, born, faults);
        contradictions(keys, run, &table, faults);
        if let (Some((between, plane)), Some(pairs)) = (between, pairs) {
            let bond = Bond { name: name.clone(), keys: keys.clone(), between, plane, pairs };
            outside_sets(&bond, &table, (&born.particles, cell), faults);
            bonds.push(bond);
        }
    }
    bonds
}

/// Reports what speaks against the bond laws of a draft.
pub(super) fn check(draft: &SceneDraft, faults: &mut Faults) {
    for bond in &draft.bonds {
        let table = format!("bond.{}", bond.name);
        given_step(&bond.keys, &table, draft.run.step, faults);
        if bond.plane.is_some() && !bond.keys.create.needs_distance() {
            faults.add(&table, "create", listed_at_plane());
        }
        contradictions(&bond.keys, &draft.run, &table, faults);
        outside_sets(bond, &table, (&draft.particles, draft.cell.as_ref()), faults);
    }
}

/// Reports what keys contradict.
fn contradictions(keys: &Keys, run: &Run, table: &str, faults: &mut Faults) {
    for error in keys.law(run.scheme.predicts()).err().unwrap_or_default() {
        faults.add(table, &error.key, Mistake::Refused { message: error.message });
    }
}

/// Pairs cannot be listed where one of the two bodies is a plane.
fn listed_at_plane() -> Mistake {
    let (found, expected) = ("listed pairs".to_owned(), "a distance, as one of the two is a plane".to_owned());
    Mistake::Unexpected { found, expected }
}

/// Refuses `"auto"` where a bond needs to know the step, and a step above its relaxation times.
fn given_step(keys: &Keys, table: &str, step: Step, faults: &mut Faults) {
    match (step, keys.needs_given_step(), keys.shortest_relaxation()) {
        (Step::Automatic { .. } | Step::Following, Some(reason), _) => {
            let found = format!("\"auto\" beside [{table}]: {reason}");
            faults.add("run", "step", Mistake::Unexpected { found, expected: "a step in seconds".to_owned() });
        }
        (Step::Given(step), _, Some(shortest)) if step > shortest => {
            let expected = format!("{shortest:?} or less, the shortest relaxation time of [{table}]");
            faults.add("run", "step", Mistake::Unexpected { found: format!("{step:?}"), expected });
        }
        _ => {}
    }
}

/// The two particle sets that are bonded; at a plane, the same set twice and the plane.
fn between(
    (keys, table): (&Keys, &str),
    (written, boundaries): (&RawTables, &[Boundary]),
    born: &ReadParticles,
    faults: &mut Faults,
) -> Option<([SetIndex; 2], Option<BoundaryIndex>)> {
    // One with a mistake of its own is not there.
    let takes_bonds = |name: &str| boundaries.iter().find(|it| it.name == name).is_none_or(Boundary::takes_bonds);
    let mut sets = [None; 2];
    let mut plane = None;
    for (name, place) in keys.between.iter().zip(&mut sets) {
        *place = born.sets.iter().position(|set| set == name).map(|index| SetIndex(index as u32));
        if place.is_some() {
            continue;
        }
        let boundary = written.boundaries.iter().position(|(boundary, _)| boundary == name);
        let mistake = match boundary {
            Some(index) if takes_bonds(name) && plane.is_none() => {
                plane = Some(BoundaryIndex(index as u32));
                continue;
            }
            Some(_) => Mistake::Unexpected {
                found: format!("\"{name}\""),
                expected: "two particle sets, or a particle set and a plane that neither turns nor conveys".to_owned(),
            },
            None => Mistake::UnknownName { found: name.clone(), kind: "particle set", known: born.sets.clone() },
        };
        faults.add(table, "between", mistake);
        if keys.between[0] == keys.between[1] {
            break;
        }
    }
    match (sets, plane) {
        ([Some(a), Some(b)], _) => Some(([a, b], None)),
        ([Some(set), None] | [None, Some(set)], Some(_)) => Some(([set; 2], plane)),
        _ => None,
    }
}

/// The listed pairs, as indices of particles.
fn listed(
    keys: &Keys,
    source: &Source,
    table: &str,
    born: &ReadParticles,
    faults: &mut Faults,
) -> Option<Vec<[u32; 2]>> {
    let (ids, key) = match keys.create.listed() {
        Some(ListedPairs::Here(pairs)) => (pairs.to_vec(), "create.pairs"),
        Some(ListedPairs::InFile(file)) => (from_file(file, source, table, faults)?, "create.file"),
        None => return Some(Vec::new()),
    };
    let before = faults.count();
    let mut pairs = Vec::with_capacity(ids.len());
    for pair in &ids {
        let index = |id: u32| born.particles.binary_search_by_key(&id, |particle| particle.id.0);
        let found = match pair.map(index) {
            [Ok(a), Ok(b)] if a != b => {
                pairs.push([a as u32, b as u32]);
                continue;
            }
            _ => format!("{pair:?}"),
        };
        if faults.count() < before + REPORTED {
            let expected = "the numbers of two particles of this scene".to_owned();
            faults.add(table, key, Mistake::Unexpected { found, expected });
        }
    }
    let mut sorted: Vec<[u32; 2]> = pairs.iter().map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
    sorted.sort_unstable();
    if let Some([a, b]) = sorted.windows(2).find(|two| two[0] == two[1]).map(|two| two[0]) {
        let id = |index: u32| born.particles[index as usize].id.0;
        let (found, expected) = (format!("{} and {} twice", id(a), id(b)), "each pair once".to_owned());
        faults.add(table, key, Mistake::Unexpected { found, expected });
    }
    (faults.count() == before).then_some(pairs)
}

/// The pairs of a file, by numbers of particles.
fn from_file(file: &str, source: &Source, table: &str, faults: &mut Faults) -> Option<Vec<[u32; 2]>> {
    let bytes = source.files.get(file)?;
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(_) => {
            let (found, expected) = ("bytes that are not UTF-8".to_owned(), "a text file".to_owned());
            faults.in_file(file, None, table, "create.file", Mistake::Unexpected { found, expected });
            return None;
        }
    };
    match crate::laws::bond::list::read(text) {
        Ok(pairs) => Some(pairs),
        Err(error) => {
            let said = error.to_string();
            let with_line = said.strip_prefix("line ").and_then(|rest| rest.split_once(": "));
            let (line, message) = with_line.map_or((None, said.as_str()), |(line, rest)| (line.parse().ok(), rest));
            faults.in_file(file, line, table, "create.file", Mistake::Refused { message: message.to_owned() });
            None
        }
    }
}

/// Reports listed pairs that are not of the two sets, or further apart than the law allows.
fn outside_sets(bond: &Bond, table: &str, (particles, cell): (&[Particle], Option<&Cell>), faults: &mut Faults) {
    let particle = |index: u32| &particles[index as usize];
    let strange = bond.pairs.iter().find(|[a, b]| !bond.joins(particle(*a).set, particle(*b).set));
    if let Some([a, b]) = strange {
        let found = format!("the pair of {} and {}", particle(*a).id.0, particle(*b).id.0);
        let expected = "pairs of the two sets in between".to_owned();
        faults.add(table, "create", Mistake::Unexpected { found, expected });
    }
    let distance = |[a, b]: [u32; 2]| {
        let (p, q) = (particle(a).position, particle(b).position);
        match cell {
            Some(cell) => cell.lattice.distance(p, q),
            None => (0..3).map(|axis| (p[axis] - q[axis]) * (p[axis] - q[axis])).sum::<f64>().sqrt(),
        }
    };
    let far = |pair: &&[u32; 2]| bond.create_distance().is_some_and(|most| distance(**pair) >= most);
    if let Some([a, b]) = bond.pairs.iter().find(far) {
        let found = format!("{:.3e} between {} and {}", distance([*a, *b]), particle(*a).id.0, particle(*b).id.0);
        let expected = "listed pairs nearer than this distance".to_owned();
        faults.add(table, "create_distance", Mistake::Unexpected { found, expected });
    }
}
