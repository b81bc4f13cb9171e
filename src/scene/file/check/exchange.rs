//! Particles that come and go: names, and what must hold of them.

use super::finding::Finding;
use super::raw_tables::RawTables;
use crate::base::document::{Faults, Mistake};
use crate::laws::contact::Material;
use crate::scene::exchange::{Amount, widest};
use crate::scene::packing::generator::{generator_after, uniform};
use crate::scene::{Boundary, ClumpShape, FlowMeter, Insertion, Kind, Known, Outlet, Outside, Region, SceneDraft};

/// What a scene has of particles that come and go.
pub(super) struct Parts {
    /// Particles that come.
    pub(super) insertions: Vec<Insertion>,
    /// Where particles are taken away.
    pub(super) outlets: Vec<Outlet>,
    /// Polygons that are passed.
    pub(super) meters: Vec<FlowMeter>,
}

/// Reads all of it.
pub(super) fn parts(
    written: &RawTables,
    (regions, boundaries): (&[Region], &[Boundary]),
    (materials, shapes): (&[Material], &[ClumpShape]),
    faults: &mut Faults,
) -> Parts {
    names(written, faults);
    let regions = regions.iter().map(|region| region.name.as_str()).collect();
    let materials = materials.iter().map(|material| (material.name.as_str(), material.density)).collect();
    let clumps = shapes.iter().zip(written.clumps.iter().map(|(_, keys)| keys)).collect();
    let known = Known { regions, boundaries, materials, clumps };
    let (mut insertions, mut outlets, mut meters) = (Vec::new(), Vec::new(), Vec::new());
    for (name, keys) in &written.insertions {
        let table = format!("insertion.{name}");
        insertions.extend(Insertion::of(name, keys, &known, &mut |key, mistake| faults.add(&table, key, mistake)));
    }
    for (name, keys) in &written.outlets {
        let table = format!("outlet.{name}");
        outlets.extend(Outlet::of(name, keys, &known, &mut |key, mistake| faults.add(&table, key, mistake)));
    }
    for (name, keys) in &written.meters {
        let table = format!("flow_meter.{name}");
        meters.extend(FlowMeter::of(name, keys, &mut |key, mistake| faults.add(&table, key, mistake)));
    }
    Parts { insertions, outlets, meters }
}

/// Refuses a name that two of those have whose variables begin with it.
fn names(written: &RawTables, faults: &mut Faults) {
    let boundaries = written.boundaries.iter().map(|(name, _)| ("boundary", name));
    let regions = written.regions.iter().map(|(name, _)| ("region", name));
    let grids = written.grids.iter().map(|(name, _)| ("grid", name));
    let insertions = written.insertions.iter().map(|(name, _)| ("insertion", name));
    let outlets = written.outlets.iter().map(|(name, _)| ("outlet", name));
    let meters = written.meters.iter().map(|(name, _)| ("flow_meter", name));
    let probes = written.probes.iter().map(|(name, _)| ("probe", name));
    let derived = written.derived.iter().map(|(name, _)| ("derived", name));
    let mut told: Vec<(&str, &String)> = boundaries.chain(regions).collect();
    let fluids = written.fluid.iter().map(|fluid| ("fluid", &fluid.name));
    for (kind, name) in fluids.chain(grids).chain(insertions).chain(outlets).chain(meters).chain(probes).chain(derived)
    {
        if let Some((other, _)) = told.iter().find(|(_, known)| *known == name) {
            let (found, expected) = (format!("that of [{other}.{name}]"), "a name of its own".to_owned());
            faults.add(&format!("{kind}.{name}"), "", Mistake::Unexpected { found, expected });
        }
        told.push((kind, name));
    }
}

/// What speaks against particles that come and go in this scene.
pub(super) fn objections(scene: &SceneDraft) -> Vec<Finding> {
    scene.insertions.iter().flat_map(|insertion| of_insertion(scene, insertion)).collect()
}

/// What speaks against an insertion.
fn of_insertion(scene: &SceneDraft, insertion: &Insertion) -> Vec<Finding> {
    let (mut findings, table) = (Vec::new(), format!("insertion.{}", insertion.name));
    let region = &scene.regions[insertion.region];
    let [_, most] = widest(insertion.kinds.iter().map(|kind| kind.sizes.bounds()));
    let mut random = generator_after(scene.run.seed, &table, 0);
    if region.shape.place(most, &mut || uniform(&mut random)).is_none() {
        let what = if insertion.has_clumps() { "a clump within a sphere" } else { "a sphere" };
        let found = format!("[region.{}], which is too narrow for {what} of radius {most:?} m", region.name);
        let expected = "a region that holds the largest sphere whole".to_owned();
        findings.push(Finding::at(table.clone(), "region", Mistake::Unexpected { found, expected }));
    }
    let holds = |kind: &Kind| {
        let of = |[radius, mass]: [f64; 2]| mass.is_normal() && (0.4 * mass * radius * radius).is_normal();
        let largest = kind.sizes.bounds().map(|radius| [radius, kind.mass(radius)]);
        largest.into_iter().chain([kind.lightest()]).all(of)
            && kind.extremes().iter().all(|clump| clump.moments.iter().all(|moment| moment.is_normal()))
    };
    if !insertion.kinds.iter().all(holds) {
        let [least, most] = insertion.radii();
        let found = format!("spheres of radius {least:?} to {most:?} m");
        let expected = "radii whose mass and moment of inertia 64 bits hold".to_owned();
        findings.push(Finding::at(table.clone(), "sizes", Mistake::Unexpected { found, expected }));
    }
    if let Amount::Mass(mass) = insertion.amount
        && mass < insertion.masses()[0]
    {
        let what = if insertion.has_clumps() { "clump" } else { "sphere" };
        let found = format!("{mass:?} kg, less than the smallest {what} has");
        let expected = format!("{:?} kg or more", insertion.masses()[0]);
        findings.push(Finding::at(table.clone(), "mass", Mistake::Unexpected { found, expected }));
    }
    if scene.outside == Outside::Stop
        && let Some([lower, upper]) = scene.domain
        && region.follows.is_none()
    {
        let [low, high] = region.shape.bounds();
        if (0..3).any(|axis| low[axis] < lower[axis] || high[axis] > upper[axis]) {
            let found = format!("[region.{}], which reaches beyond it", region.name);
            let expected = "a region inside of [domain]".to_owned();
            findings.push(Finding::at(table, "region", Mistake::Unexpected { found, expected }));
        }
    }
    findings
}
