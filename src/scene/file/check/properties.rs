//! Declared properties of materials and of pairs of them.

use super::named_tables::{Named, names};
use crate::base::document::{Document, Faults, Mistake, Part, messages};
use crate::base::quantity::Finite;
use crate::laws::contact::{NoKeys, Properties, Property};
use crate::scene::file::tables::MaterialTable;

/// All materials, with the properties that laws declare.
pub(super) fn materials(document: &Document, keys: &[&'static Property], faults: &mut Faults) -> Named<MaterialTable> {
    let declared: Vec<&str> = keys.iter().map(|property| property.name).collect();
    let mut materials = Vec::new();
    for name in names(document, "material", faults) {
        let path = format!("material.{name}");
        let table: Option<MaterialTable> = document.read_part(&path, "", Part::Except(&declared), faults);
        let properties = given(document, &path, keys, faults);
        materials.extend(table.map(|table| (name, MaterialTable { properties, ..table })));
    }
    materials
}

/// The properties of two materials in the table at this path.
pub(super) fn of_pair(
    document: &Document,
    path: &str,
    keys: &[&'static Property],
    faults: &mut Faults,
) -> Option<Properties> {
    let before = faults.count();
    if !document.is_table(path) {
        // Says what stands there instead.
        document.read::<NoKeys>(path, faults);
        return None;
    }
    for found in document.names(path) {
        if !keys.iter().any(|property| property.name == found) {
            let known = keys.iter().map(|property| property.name.to_owned()).collect();
            let unknown = || Mistake::UnknownKey { found: found.clone(), known };
            faults.add(path, &found, messages::absent(&found).unwrap_or_else(unknown));
        }
    }
    let properties = given(document, path, keys, faults);
    (faults.count() == before).then_some(properties)
}

/// Those of these properties that stand in a table.
fn given(document: &Document, path: &str, keys: &[&'static Property], faults: &mut Faults) -> Properties {
    let mut properties = Properties::default();
    for property in keys.iter().copied().filter(|property| document.has(&format!("{path}.{}", property.name))) {
        let Some(value) = document.read_key::<Finite>(path, property.name, faults) else { continue };
        match property.range.check(value.get()) {
            Ok(()) => properties = properties.with(property, value.get()),
            Err(message) => faults.add(path, property.name, Mistake::Refused { message }),
        }
    }
    properties
}
