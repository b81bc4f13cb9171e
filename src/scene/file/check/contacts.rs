//! Materials, what two of them have in common, and which law governs them.

use super::named_tables::Named;
use super::raw_tables::{Law, RawTables};
use crate::base::document::Faults;
use crate::base::document::Mistake;
use crate::base::quantity::{MaterialIndex, Positive};
use crate::laws::contact::{LawChoice, Material, Properties, Scheme, Switches, Thermal};
use crate::scene::ContactLaw;
use crate::scene::file::tables::MaterialPairs;

/// The materials, in the order of the text.
pub(super) fn materials(written: &RawTables) -> Vec<Material> {
    let material = |(name, table): &(String, crate::scene::file::tables::MaterialTable)| Material {
        name: name.clone(),
        density: table.density.get(),
        youngs_modulus: table.youngs_modulus.map(crate::base::quantity::Positive::get),
        poissons_ratio: table.poissons_ratio.map(crate::base::quantity::PoissonsRatio::get),
        thermal: Thermal {
            conductivity: table.conductivity.map(Positive::get),
            specific_heat: table.specific_heat.map(Positive::get),
            real_youngs_modulus: table.real_youngs_modulus.map(Positive::get),
        },
        properties: table.properties.clone(),
    };
    written.materials.iter().map(material).collect()
}

/// The place of a material; reports a name that no material has.
pub(super) fn material_index(
    materials: &[Material],
    name: &str,
    table: &str,
    key: &str,
    faults: &mut Faults,
) -> Option<MaterialIndex> {
    let index = materials.iter().position(|material| material.name == name);
    if index.is_none() {
        faults.add(table, key, unknown_material(materials, name));
    }
    index.map(|index| MaterialIndex(index as u32))
}

/// The refusal of a material's name.
pub(super) fn unknown_material(materials: &[Material], name: &str) -> Mistake {
    let known = materials.iter().map(|material| material.name.clone()).collect();
    Mistake::UnknownName { found: name.to_owned(), kind: "material", known }
}

/// Properties of each two materials, a square.
pub(super) fn pairs(written: &RawTables, materials: &[Material], faults: &mut Faults) -> Vec<Properties> {
    let count = materials.len();
    let mut square = vec![Properties::default(); count * count];
    for ([a, b], properties) in &written.pairs {
        let table = format!("pair.{a}.{b}");
        let i = material_index(materials, a, &table, "", faults);
        let j = if a == b { i } else { material_index(materials, b, &table, "", faults) };
        if let (Some(i), Some(j)) = (i, j) {
            square[i.index() * count + j.index()] = properties.clone();
            square[j.index() * count + i.index()] = properties.clone();
        }
    }
    square
}

/// The laws, each with the pairs it governs.
pub(super) fn laws(
    written: &Named<Law>,
    materials: &[Material],
    scheme: Scheme,
    faults: &mut Faults,
) -> Vec<ContactLaw> {
    let mut owner: Vec<Option<usize>> = vec![None; materials.len() * materials.len()];
    let mut laws = Vec::new();
    for (index, (name, law)) in written.iter().enumerate() {
        let table = format!("contact.{name}");
        let between = governed(law, materials, &table, faults);
        for (place, owner) in owner.iter_mut().enumerate().filter(|(place, _)| between[*place]) {
            let (a, b) = (place / materials.len(), place % materials.len());
            if let (Some(other), true) = (*owner, a <= b) {
                let (a, b) = (materials[a].name.clone(), materials[b].name.clone());
                faults.add(&table, "between", Mistake::TwoLaws { a, b, other: written[other].0.clone() });
            }
            *owner = Some(index);
        }
        laws.push(composed(name, law, between, scheme));
    }
    laws
}

/// The square of pairs that a law names; all, if it names none.
fn governed(law: &Law, materials: &[Material], table: &str, faults: &mut Faults) -> Vec<bool> {
    let count = materials.len();
    let Some(MaterialPairs(pairs)) = &law.table.between else { return vec![true; count * count] };
    let mut between = vec![false; count * count];
    for [a, b] in pairs {
        let i = material_index(materials, a, table, "between", faults);
        let j = if a == b { i } else { material_index(materials, b, table, "between", faults) };
        if let (Some(i), Some(j)) = (i, j) {
            between[i.index() * count + j.index()] = true;
            between[j.index() * count + i.index()] = true;
        }
    }
    between
}

/// The law as the program keeps it.
fn composed(name: &str, law: &Law, between: Vec<bool>, scheme: Scheme) -> ContactLaw {
    let &Law { ref table, normal, tangential, rolling, cohesion, heat } = law;
    let switches = Switches::of(table.limit_force, table.tangential_damping.unwrap_or(true));
    let choice = LawChoice { normal, tangential, rolling, cohesion, switches, scheme };
    ContactLaw { name: name.to_owned(), between, choice, heat }
}
