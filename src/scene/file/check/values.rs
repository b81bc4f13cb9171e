//! What the types of a draft leave open: numbers in their range, indices that point at something, lists of the right length, names of
//! their own. A scene file cannot get any of this wrong; code can.

use super::named_tables::is_name;
use crate::base::document::{Faults, Mistake};
use crate::base::quantity::{Porosity, SetIndex};
use crate::laws::bond::creation::ListedPairs;
use crate::laws::contact::Properties;
use crate::scene::file::tables::is_positive_definite;
use crate::scene::{AxisMotion, Boundary, ColumnStart, Fluid, Grid, Insertion, Outlet, OutletPlace, SceneDraft, Step};
use std::collections::BTreeSet;

/// Reports every value that its key does not take.
pub(super) fn check(draft: &SceneDraft, faults: &mut Faults) {
    let mut at = Table { name: String::new(), faults };
    names(draft, &mut at);
    run(draft, &mut at);
    materials(draft, &mut at);
    particles(draft, &mut at);
    columns(draft, &mut at);
    chosen(draft, &mut at);
    for boundary in &draft.boundaries {
        at.name = format!("boundary.{}", boundary.name);
        body(boundary, draft, &mut at);
    }
    bonds(draft, &mut at);
    for it in &draft.grids {
        at.name = format!("grid.{}", it.name);
        grid(it, &mut at);
    }
    if let Some(it) = &draft.fluid {
        at.name = format!("fluid.{}", it.name);
        fluid(it, &mut at);
        at.points("grid", it.grid.unwrap_or(0), draft.grids.len().max(usize::from(it.grid.is_none())));
    }
    for insertion in &draft.insertions {
        at.name = format!("insertion.{}", insertion.name);
        comes(insertion, draft, &mut at);
    }
    for outlet in &draft.outlets {
        at.name = format!("outlet.{}", outlet.name);
        goes(outlet, draft, &mut at);
    }
    for region in &draft.regions {
        at.name = format!("region.{}", region.name);
        at.points("follows", region.follows.map_or(0, |it| it.index()), draft.boundaries.len().max(1));
    }
}

/// `[grid.<name>]`
fn grid(grid: &Grid, at: &mut Table) {
    let [lower, upper] = grid.shape.corners;
    at.finite("box", &[lower, upper].concat());
    if let Some(axis) = (0..3).find(|&axis| lower[axis] >= upper[axis]) {
        let found = format!("{:?} to {:?} along {}", lower[axis], upper[axis], ["x", "y", "z"][axis]);
        at.wrong("box", found, "the lower corner before the upper one");
    }
    if grid.shape.counts.contains(&0) {
        at.wrong("counts", format!("{:?}", grid.shape.counts), "at least one cell along each axis");
    }
}

/// Where a table's mistakes go.
struct Table<'f, 'd, 'a> {
    /// Its name, as `particles.beam`.
    name: String,
    /// All mistakes.
    faults: &'f mut Faults<'d, 'a>,
}

impl Table<'_, '_, '_> {
    /// Reports a value that is not what its key takes.
    fn wrong(&mut self, key: &str, found: String, expected: &str) {
        self.faults.add(&self.name, key, Mistake::Unexpected { found, expected: expected.to_owned() });
    }

    /// A number above 0.
    fn positive(&mut self, key: &str, value: f64) {
        if !(value > 0.0 && value.is_finite()) {
            self.wrong(key, format!("{value:?}"), "a number above 0");
        }
    }

    /// A number of 0 or above.
    fn not_negative(&mut self, key: &str, value: f64) {
        if !(value >= 0.0 && value.is_finite()) {
            self.wrong(key, format!("{value:?}"), "a number of 0 or above");
        }
    }

    /// Finite numbers.
    fn finite(&mut self, key: &str, values: &[f64]) {
        if !values.iter().all(|value| value.is_finite()) {
            self.wrong(key, format!("{values:?}"), "finite numbers");
        }
    }

    /// An index into a list of so many.
    fn points(&mut self, key: &str, index: usize, count: usize) {
        if index >= count {
            self.wrong(key, format!("index {index}"), &format!("an index below {count}"));
        }
    }

    /// A list of so many.
    fn length(&mut self, key: &str, found: usize, expected: usize) {
        if found != expected {
            self.wrong(key, format!("a list of {found}"), &format!("a list of {expected}"));
        }
    }

    /// A square table of two materials: the same above its diagonal as below.
    fn mirrored(&mut self, key: &str, count: usize, same: impl Fn(usize, usize) -> bool) {
        let below = (0..count).flat_map(|a| (0..a).map(move |b| (a, b)));
        if let Some((a, b)) = below.into_iter().find(|(a, b)| !same(a * count + b, b * count + a)) {
            self.wrong(
                key,
                format!("one entry for materials {a} and {b} and another for {b} and {a}"),
                "the same entry",
            );
        }
    }

    /// Indices of particles, ascending.
    fn members(&mut self, key: &str, members: &[u32], count: usize) {
        if !members.is_sorted_by(|a, b| a < b) {
            self.wrong(key, "indices that do not ascend".to_owned(), "indices of particles, ascending, each once");
        }
        self.points(key, members.last().map_or(0, |&last| last as usize), count.max(usize::from(members.is_empty())));
    }
}

/// Names are names, and each is there once in its kind.
fn names(draft: &SceneDraft, at: &mut Table) {
    let materials: Vec<&str> = draft.materials.iter().map(|it| &*it.name).collect();
    let kinds: [(&str, Vec<&str>); 13] = [
        ("material", materials),
        ("contact", draft.contacts.iter().map(|it| &*it.name).collect()),
        ("bond", draft.bonds.iter().map(|it| &*it.name).collect()),
        ("particles", draft.sets.iter().map(|it| &**it).collect()),
        ("boundary", draft.boundaries.iter().map(|it| &*it.name).collect()),
        ("damping", draft.damping.iter().map(|it| &*it.name).collect()),
        ("force", draft.forces.iter().map(|it| &*it.name).collect()),
        ("region", draft.regions.iter().map(|it| &*it.name).collect()),
        ("grid", draft.grids.iter().map(|it| &*it.name).collect()),
        ("insertion", draft.insertions.iter().map(|it| &*it.name).collect()),
        ("outlet", draft.outlets.iter().map(|it| &*it.name).collect()),
        ("probe", draft.probes.iter().map(|it| &*it.name).collect()),
        ("derived", draft.derived.iter().map(|it| &*it.name).collect()),
    ];
    for (kind, names) in kinds {
        let mut known = BTreeSet::new();
        for name in names {
            at.name = format!("{kind}.{name}");
            if !is_name(name) {
                at.faults.add(&at.name, "", Mistake::Name { found: name.to_owned() });
            } else if !known.insert(name) {
                at.wrong("", "two of this name".to_owned(), "a name of its own");
            }
        }
    }
}

/// `[fluid.<name>]`
fn fluid(fluid: &Fluid, at: &mut Table) {
    at.positive("density", fluid.density);
    at.positive("viscosity", fluid.viscosity);
    if let Some(porosity) = fluid.porosity.filter(|it| Porosity::new(*it).is_none()) {
        at.wrong("porosity", format!("{porosity:?}"), "a number above 0 and at most 1");
    }
    at.finite("velocity", &fluid.velocity.at_start());
    if let Some(heat) = fluid.heat {
        at.positive("temperature", heat.temperature);
        at.positive("conductivity", heat.conductivity);
        at.positive("specific_heat", heat.specific_heat);
    }
}

/// `[run]`, `gravity` and `[domain]`
fn run(draft: &SceneDraft, at: &mut Table) {
    at.name = String::new();
    at.finite("gravity", &draft.gravity);
    at.name = "run".to_owned();
    let run = &draft.run;
    match run.step {
        Step::Given(step) => at.positive("step", step),
        Step::Automatic { safety } if safety > 0.0 && safety < 1.0 => {}
        Step::Automatic { safety } => at.wrong("safety", format!("{safety:?}"), "a number above 0 and below 1"),
        Step::Following => {}
    }
    let error = run.accuracy.error();
    if !(error > 0.0 && error < 1.0) {
        at.wrong("accuracy", format!("{error:?}"), "a number above 0 and below 1");
    }
    for (key, value) in [("end", run.end), ("skin", run.skin), ("settle_tolerance", Some(run.settle_tolerance))] {
        at.positive(key, value.unwrap_or(1.0));
    }
    at.not_negative("max_overlap", run.max_overlap);
    if let Some(damping) = run.settle_damping.filter(|damping| !(0.0..=1.0).contains(damping)) {
        at.wrong("settle_damping", format!("{damping:?}"), "a number from 0 to 1");
    }
    if run.threads == Some(0) {
        at.wrong("threads", "0".to_owned(), "a number of 1 or above");
    }
    at.name = "output".to_owned();
    let output = &draft.output;
    let intervals = [
        ("history_interval", output.history_interval),
        ("frame_interval", output.frame_interval),
        ("checkpoint_interval", output.checkpoint_interval),
    ];
    for (key, interval) in intervals {
        at.positive(key, interval.unwrap_or(1.0));
    }
    at.name = "domain".to_owned();
    if let Some(corners) = draft.domain {
        at.finite("box", corners.as_flattened());
        if (0..3).any(|axis| corners[0][axis] >= corners[1][axis]) {
            at.wrong("box", format!("{corners:?}"), "the lower corner before the upper one");
        }
    }
}

/// Properties that laws declare.
fn properties(given: &Properties, at: &mut Table) {
    for (property, value) in given.iter() {
        if let Err(message) = property.range.check(value) {
            let expected = message.trim_start_matches("expected ").split(", found").next().unwrap_or_default();
            at.wrong(property.name, format!("{value:?}"), expected);
        }
    }
}

/// `[material.<name>]`, `[pair.<a>.<b>]` and which of them the contact laws are for.
fn materials(draft: &SceneDraft, at: &mut Table) {
    for material in &draft.materials {
        at.name = format!("material.{}", material.name);
        at.positive("density", material.density);
        at.positive("youngs_modulus", material.youngs_modulus.unwrap_or(1.0));
        if let Some(ratio) = material.poissons_ratio.filter(|ratio| !(0.0..=0.5).contains(ratio)) {
            at.wrong("poissons_ratio", format!("{ratio:?}"), "a number from 0 to 0.5");
        }
        properties(&material.properties, at);
    }
    let count = draft.materials.len();
    at.name = "pair".to_owned();
    at.length("", draft.pairs.len(), count * count);
    draft.pairs.iter().for_each(|pair| properties(pair, at));
    if draft.pairs.len() == count * count {
        at.mirrored("", count, |one, other| draft.pairs[one] == draft.pairs[other]);
    }
    let mut governed = vec![false; count * count];
    for law in &draft.contacts {
        at.name = format!("contact.{}", law.name);
        at.length("between", law.between.len(), count * count);
        if law.choice.scheme != draft.run.scheme {
            let expected = format!("{:?}, as in [run]", draft.run.scheme.name());
            at.wrong("scheme", format!("{:?}", law.choice.scheme.name()), &expected);
        }
        if law.between.len() == count * count {
            at.mirrored("between", count, |one, other| law.between[one] == law.between[other]);
            if law.between.iter().zip(&governed).any(|(this, before)| *this && *before) {
                at.wrong(
                    "between",
                    "two materials that another law governs".to_owned(),
                    "one law for each two materials",
                );
            }
            governed.iter_mut().zip(&law.between).for_each(|(any, this)| *any |= this);
        }
    }
}

/// The particles, and the lists that have an entry for each.
fn particles(draft: &SceneDraft, at: &mut Table) {
    at.name = "particles".to_owned();
    for two in draft.particles.windows(2).filter(|two| two[0].id >= two[1].id).take(1) {
        at.wrong("id", format!("{} behind {}", two[1].id.0, two[0].id.0), "ascending numbers, each once");
    }
    let before = at.faults.count();
    for particle in &draft.particles {
        at.points("set", particle.set.index(), draft.sets.len());
        at.points("material", particle.material.index(), draft.materials.len());
        at.positive("radius", particle.radius);
        at.positive("density", particle.density);
        at.finite("position", &particle.position);
        at.finite("velocity", &particle.velocity);
        at.finite("angular_velocity", &particle.angular_velocity);
        if at.faults.count() > before {
            at.wrong("id", format!("{} with such a value", particle.id.0), "particles whose values are permitted");
            break;
        }
    }
}

/// Declared columns have a value that they take for each particle and each insertion.
fn columns(draft: &SceneDraft, at: &mut Table) {
    at.name = "particles".to_owned();
    let mut known = BTreeSet::new();
    for ColumnStart { column, particles, insertions } in &draft.columns {
        if !known.insert(column.name) {
            at.wrong(column.name, "two columns of this name".to_owned(), "a name of its own");
        }
        let takes = |value: &&f64| value.is_finite() && (column.takes)(**value);
        for (table, values, count) in
            [("particles", particles, draft.particles.len()), ("insertion", insertions, draft.insertions.len())]
        {
            at.name = table.to_owned();
            at.length(column.name, values.len(), count);
            if let Some(value) = values.iter().find(|value| !takes(value)) {
                at.wrong(column.name, format!("{value:?}"), column.expected);
            }
        }
    }
}

/// Which particles damping and forces are for.
fn chosen(draft: &SceneDraft, at: &mut Table) {
    let count = draft.particles.len();
    let mut damped = vec![false; count];
    for damping in &draft.damping {
        at.name = format!("damping.{}", damping.name);
        for (key, each) in [("linear", &damping.linear), ("angular", &damping.angular)] {
            at.length(key, each.len(), count);
            each.iter().chain(&damping.newcomers).find(|it| !(**it >= 0.0 && it.is_finite())).into_iter().for_each(
                |it| {
                    at.not_negative(key, *it);
                },
            );
        }
        let mut twice = None;
        for (place, (linear, angular)) in damping.linear.iter().zip(&damping.angular).enumerate().take(count) {
            if (*linear != 0.0 || *angular != 0.0) && std::mem::replace(&mut damped[place], true) {
                twice = Some(place);
            }
        }
        if let Some(place) = twice {
            let found = format!("particle {}, which another damping has", draft.particles[place].id.0);
            at.wrong("linear", found, "one damping for each particle");
        }
    }
    for force in &draft.forces {
        at.name = format!("force.{}", force.name);
        at.members("particles", &force.members, count);
        at.finite("force", &force.force);
    }
}

/// A boundary by itself.
fn body(boundary: &Boundary, draft: &SceneDraft, at: &mut Table) {
    at.members("particles", boundary.shape.members(), draft.particles.len());
    if let Some(material) = boundary.shape.material() {
        at.points("material", material.index(), draft.materials.len());
    }
    at.finite("reference", &boundary.reference);
    for axis in &boundary.axes {
        if let AxisMotion::Conveying(value) | AxisMotion::Prescribed(value) | AxisMotion::Loaded(value) = axis {
            at.finite("motion", &[*value]);
        }
    }
    let body = &boundary.body;
    at.not_negative("mass", body.mass);
    at.finite("centre", &body.centre);
    if body.inertia != [[0.0; 3]; 3] && !is_positive_definite(&body.inertia) {
        at.wrong("inertia", format!("{:?}", body.inertia), "a symmetric, positive definite matrix [kg m²]");
    }
    for (key, support) in [("stiffness", &body.stiffness), ("damping", &body.damping)] {
        support.iter().for_each(|value| at.not_negative(key, *value));
    }
}

/// What bond laws refer to.
fn bonds(draft: &SceneDraft, at: &mut Table) {
    for bond in &draft.bonds {
        at.name = format!("bond.{}", bond.name);
        for set in bond.between {
            at.points("between", set.index(), draft.sets.len());
        }
        if let Some(plane) = bond.plane {
            at.points("between", plane.index(), draft.boundaries.len());
            if draft.boundaries.get(plane.index()).is_some_and(|it| !it.takes_bonds()) {
                let found = "a boundary that is no plane, or turns or conveys".to_owned();
                at.wrong("between", found, "a plane that neither turns nor conveys");
            }
        }
        let set = |set: SetIndex| draft.sets.get(set.index());
        let plane = bond.plane.and_then(|it| draft.boundaries.get(it.index())).map(|it| &it.name);
        let mut names = [set(bond.between[0]), plane.or(set(bond.between[1]))];
        let mut written = bond.keys.between.each_ref().map(Some);
        names.sort_unstable();
        written.sort_unstable();
        if names != written {
            at.wrong("between", format!("{:?}", bond.keys.between), &format!("the names of what it bonds, {names:?}"));
        }
        let id = |index: u32| draft.particles.get(index as usize).map_or(0, |particle| particle.id.0);
        let pairs = || bond.pairs.iter().map(|pair| pair.map(id));
        match bond.keys.create.listed() {
            Some(ListedPairs::Here(listed)) if !pairs().eq(listed.iter().copied()) => {
                at.wrong(
                    "create.pairs",
                    format!("{listed:?}"),
                    &format!("{:?}, the pairs", pairs().collect::<Vec<_>>()),
                );
            }
            None if !bond.pairs.is_empty() => {
                at.wrong("create", format!("{} listed pairs", bond.pairs.len()), "none, as the keys list none");
            }
            _ => {}
        }
        for pair in &bond.pairs {
            at.points("create.pairs", pair[0].max(pair[1]) as usize, draft.particles.len());
            if pair[0] == pair[1] {
                at.wrong("create.pairs", format!("{pair:?}"), "two particles");
            }
        }
    }
}

/// An insertion by itself.
fn comes(insertion: &Insertion, draft: &SceneDraft, at: &mut Table) {
    at.points("region", insertion.region, draft.regions.len());
    at.points("material", insertion.material.index(), draft.materials.len());
    at.positive("kinds", insertion.kinds.len() as f64);
    for kind in &insertion.kinds {
        let [least, most] = kind.sizes.bounds();
        let clump = kind.clump.as_ref().map_or(kind.density, |clump| clump.density);
        for (key, number) in [("density", kind.density), ("density", clump), ("sizes", least), ("sizes", most)] {
            at.positive(key, number);
        }
    }
    at.not_negative("rate", insertion.rate().unwrap_or(0.0));
    at.finite("velocity", &insertion.velocity);
    at.not_negative("scatter", insertion.scatter);
}

/// An outlet by itself.
fn goes(outlet: &Outlet, draft: &SceneDraft, at: &mut Table) {
    match &outlet.place {
        OutletPlace::Region(region) => at.points("region", *region, draft.regions.len()),
        OutletPlace::Beyond(plane) => at.finite("beyond", plane.as_flattened()),
        OutletPlace::Behind(boundary) => at.points("beyond", boundary.index(), draft.boundaries.len()),
    }
}
