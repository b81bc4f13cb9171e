//! The tables of keys in the documentation are those that the program reads.

use super::{
    BoundaryTable, ContactTable, DampingTable, DomainTable, FluidTable, ForceTable, HeatSourceTable, HeatTable,
    ListEntry, MaterialTable, ParticlesTable, RunTable, ScaleTable, Selection,
};
use crate::base::document::{Key, Table, printed, printed_by_model, printed_together};
use crate::laws::bond::breakage;
use crate::laws::contact::{NoKeys, cohesion, heat, normal, rolling, tangential};
use crate::laws::wear::{archard, finnie};
use crate::laws::{bond, region, surface};
use crate::scene::cell::{CellKeys, MotionKeys};
use crate::scene::clump::ClumpKeys;
use crate::scene::exchange::{InsertionKeys, MeterKeys, OutletKeys};
use crate::scene::grid::GridKeys;
use crate::scene::packing::{LatticeTable, PackingTable};
use crate::scene::{About, DerivedKeys, Output, ProbeKeys};
use std::any::TypeId;
use std::path::Path;
use std::{fs, io};

/// The name of a table's type, and the table as the documentation has it.
fn of<T: Table>() -> (&'static str, String) {
    (T::NAME, printed(T::KEYS))
}

/// Keys of the shapes of boundaries, but for meshes.
const SHAPES: [(&str, &[Key]); 6] = [
    ("plane", surface::plane::Keys::KEYS),
    ("disc", surface::disc::Keys::KEYS),
    ("rectangle", surface::rectangle::Keys::KEYS),
    ("cylinder", surface::cylinder::Keys::KEYS),
    ("cone", surface::cone::Keys::KEYS),
    ("revolution", surface::revolution::Keys::KEYS),
];

/// Keys of the rules of breakage.
const RULES: [(&str, &[Key]); 3] = [
    ("distance", breakage::distance::Keys::KEYS),
    ("stress", breakage::stress::Keys::KEYS),
    ("mohr_coulomb", breakage::mohr_coulomb::Keys::KEYS),
];

/// Keys of the models of wear.
const WEAR: [(&str, &[Key]); 2] = [("archard", archard::Keys::KEYS), ("finnie", finnie::Keys::KEYS)];

/// A type of keys that models of contacts have, and the keys.
fn own<T: Table + 'static>() -> (TypeId, &'static [Key]) {
    (TypeId::of::<T>(), T::KEYS)
}

/// Types of keys that models of contacts have.
fn of_contacts() -> [(TypeId, &'static [Key]); 9] {
    [
        own::<cohesion::sjkr::Keys>(),
        own::<heat::overlap_area::Keys>(),
        own::<normal::eepa::Keys>(),
        own::<normal::hooke::Keys>(),
        own::<normal::hooke_stiffness::Keys>(),
        own::<normal::jkr::Keys>(),
        own::<normal::sticky::Keys>(),
        own::<rolling::rocking::Keys>(),
        own::<tangential::turned_history::Keys>(),
    ]
}

/// The models of contacts, and the keys of each.
fn contacts() -> Vec<(&'static str, &'static [Key])> {
    let rows = (normal::STANDARD.iter().map(|row| (row.name(), row.keys())))
        .chain(tangential::STANDARD.iter().map(|row| (row.name(), row.keys())))
        .chain(rolling::STANDARD.iter().map(|row| (row.name(), row.keys())))
        .chain(cohesion::STANDARD.iter().map(|row| (row.name(), row.keys())))
        .chain(heat::STANDARD.iter().map(|row| (row.name(), row.keys())));
    let with_keys = rows.filter(|(_, keys)| *keys != TypeId::of::<NoKeys>());
    let declared = |name, keys| of_contacts().into_iter().find(|(own, _)| *own == keys).map(|(_, keys)| (name, keys));
    with_keys.map(|(name, keys)| declared(name, keys).unwrap_or_else(|| panic!("{name} declares no keys"))).collect()
}

/// Every table that declares its keys but those of [`SHAPES`], [`RULES`], [`WEAR`] and [`contacts`].
fn tables() -> Vec<(&'static str, String)> {
    vec![
        of::<About>(),
        of::<BoundaryTable>(),
        of::<CellKeys>(),
        of::<ClumpKeys>(),
        of::<ContactTable>(),
        of::<DampingTable>(),
        of::<DerivedKeys>(),
        of::<DomainTable>(),
        of::<FluidTable>(),
        of::<ForceTable>(),
        of::<GridKeys>(),
        of::<HeatSourceTable>(),
        of::<HeatTable>(),
        of::<InsertionKeys>(),
        of::<LatticeTable>(),
        of::<ListEntry>(),
        of::<MaterialTable>(),
        of::<MeterKeys>(),
        of::<MotionKeys>(),
        of::<OutletKeys>(),
        of::<Output>(),
        of::<PackingTable>(),
        of::<ParticlesTable>(),
        of::<ProbeKeys>(),
        of::<RunTable>(),
        of::<ScaleTable>(),
        of::<Selection>(),
        of::<bond::keys::Keys>(),
        of::<region::Keys>(),
        of::<surface::mesh::Keys>(),
    ]
}

/// Names of the types that files of a folder, and of those below it, declare by `keys!`.
fn declared(folder: &Path, names: &mut Vec<String>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            declared(&path, names)?;
            continue;
        }
        let text = fs::read_to_string(&path)?;
        let name = |rest: &str| rest.split("struct ").nth(1)?.split(' ').next().map(str::to_owned);
        names.extend(text.split("\nkeys! {\n").skip(1).filter_map(name));
    }
    Ok(())
}

#[test]
fn a_key_stands_in_the_documentation_as_it_is_declared() {
    let pages = [
        include_str!("../../../../docs/scene.md"),
        include_str!("../../../../docs/bonds.md"),
        include_str!("../../../../docs/wear.md"),
    ];
    let missing: Vec<String> = tables()
        .into_iter()
        .chain([("shapes", printed_together("shape", &SHAPES)), ("rules", printed_together("rule", &RULES))])
        .chain([("contacts", printed_by_model(&contacts())), ("wear", printed_by_model(&WEAR))])
        .filter(|(_, table)| !pages.iter().any(|page| page.contains(table)))
        .map(|(name, table)| format!("{name}\n{table}"))
        .collect();
    assert!(
        missing.is_empty(),
        "docs/scene.md, docs/bonds.md or docs/wear.md lack the tables\n\n{}",
        missing.join("\n")
    );
}

#[test]
fn every_table_that_declares_its_keys_is_looked_for_in_the_documentation() {
    let mut there = Vec::new();
    declared(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut there).unwrap();
    let mut looked_for: Vec<_> = tables().into_iter().map(|(name, _)| name).collect();
    looked_for.resize(looked_for.len() + SHAPES.len() + RULES.len() + WEAR.len() + of_contacts().len(), "Keys");
    there.sort();
    looked_for.sort_unstable();
    assert_eq!(there, looked_for);
}
