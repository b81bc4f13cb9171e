//! Materials and contact law of a case, translated to ours.

use super::bond;
use super::build::positive;
use super::case::Case;
use super::error::Mistake;
use cograin::contact::cohesion::sjkr;
use cograin::contact::normal::{eepa, hooke, hooke_stiffness, jkr, sticky};
use cograin::contact::rolling::rocking;
use cograin::contact::tangential::turned_history::Keys as Turned;
use cograin::contact::{LawChoice, Material, NoKeys, Properties, Property, Scheme, Switches, Thermal, property};
use cograin::quantity::{PoissonsRatio, Positive};
use cograin::scene::Models;

/// The other engine's name of each pair property, with ours.
const PROPERTIES: [(&str, &str); 23] = [
    ("coefficientRestitution", "restitution"),
    ("coefficientFriction", "friction"),
    ("coefficientRollingFriction", "rolling_friction"),
    ("cohesionEnergyDensity", "cohesion_energy_density"),
    ("kn", "normal_stiffness"),
    ("kt", "tangential_stiffness"),
    ("gamman", "normal_damping"),
    ("gammat", "tangential_damping"),
    ("gamman_abs", "absolute_normal_damping"),
    ("gammat_abs", "absolute_tangential_damping"),
    ("FluidViscosity", "fluid_viscosity"),
    ("CriticalStokes", "critical_stokes_number"),
    ("MaximumRestitution", "maximum_restitution"),
    ("coefficientRollingViscousDamping", "rolling_viscous_damping"),
    ("surfaceEnergy", "surface_energy"),
    ("dampingCoefficient", "damping_coefficient"),
    ("tangentialDampingRatio", "tangential_damping_ratio"),
    ("tangentialStiffness", "tangential_stiffness"),
    ("UnloadingStiffness", "unloading_stiffness_ratio"),
    ("pullOffForce", "pull_off_force"),
    ("coefficientAdhesionStiffness", "adhesion_stiffness_ratio"),
    ("thermalConductivity", "conductivity"),
    ("heatTransferCoefficient", "heat_transfer_coefficient"),
];

/// A property that the model needs and the case does not give.
pub(super) fn absent(key: &str) -> Mistake {
    match PROPERTIES.iter().find(|(_, ours)| *ours == key) {
        Some((theirs, _)) => Mistake::new(format!("pair_properties.{theirs}"), "absent; the chosen model needs it"),
        None => Mistake::new(format!("materials.{key}"), "absent; the chosen model needs it"),
    }
}

/// The materials, named by their type.
pub(super) fn materials(case: &Case) -> Result<Vec<Material>, Mistake> {
    let all = (1..).zip(&case.materials).map(|(kind, material)| {
        let place = |key: &str| format!("materials[{}].{key}", kind - 1);
        if let Some(value) = material.youngs_modulus {
            positive(place("youngs_modulus"), value)?;
        }
        if let Some(value) = material.poissons_ratio.filter(|value| PoissonsRatio::new(*value).is_none()) {
            return Err(Mistake::new(
                place("poissons_ratio"),
                format!("expected a number from 0 to 0.5, found {value}"),
            ));
        }
        Ok(Material {
            name: format!("type{kind}"),
            density: 1.0, // of no use: each particle has its own
            youngs_modulus: material.youngs_modulus,
            poissons_ratio: material.poissons_ratio,
            thermal: Thermal {
                conductivity: material.conductivity,
                specific_heat: material.specific_heat,
                real_youngs_modulus: material.real_youngs_modulus,
            },
            properties: Properties::default(),
        })
    });
    let all: Vec<Material> = all.collect::<Result<_, Mistake>>()?;
    if all.is_empty() { Err(Mistake::new("materials", "expected at least one, found none")) } else { Ok(all) }
}

/// Properties of each two materials.
pub(super) fn pairs(case: &Case) -> Result<Vec<Properties>, Mistake> {
    let count = case.materials.len();
    let mut pairs = vec![Properties::default(); count * count];
    let own = case.pair_properties.iter().filter(|(name, _)| !bond::has_property(case, name));
    for (name, value) in own {
        let Some((_, ours)) = PROPERTIES.iter().find(|(theirs, _)| theirs == name) else {
            return Err(Mistake::new(format!("pair_properties.{name}"), "not known here"));
        };
        for (at, mut value) in matrix(name, value, count)?.into_iter().enumerate() {
            if *ours == "pull_off_force" {
                value = -value + 0.0; // the engine's is positive where it repels
            }
            let field = || format!("pair_properties.{name}[{}][{}]", at / count, at % count);
            let pair = std::mem::take(&mut pairs[at]);
            pairs[at] = with(pair, ours, value).map_err(|message| Mistake::new(field(), message))?;
        }
    }
    if case.model.mixing == "lammps" {
        mixed(case, &mut pairs);
    }
    Ok(pairs)
}

/// The properties with a value of one more, where there is one.
fn given(properties: Properties, property: &'static Property, value: Option<f64>) -> Properties {
    match value {
        Some(value) => properties.with(property, value),
        None => properties,
    }
}

/// Gives unlike materials geometric means, and a tangential stiffness from E* and the mean of Poisson's ratios.
fn mixed(case: &Case, pairs: &mut [Properties]) {
    let count = case.materials.len();
    for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
        let (a, b) = (pairs[i * count + i].clone(), pairs[j * count + j].clone());
        let mean = |of: &Property| {
            let product = a.get(of)? * b.get(of)?;
            Some(if i == j { a.get(of)? } else { product.sqrt() })
        };
        let stiffness = |material: &super::case::Material| {
            let (modulus, ratio) = (material.youngs_modulus?, material.poissons_ratio?);
            Some((modulus, ratio))
        };
        let modulus = || {
            let ((e, nu), (f, mu)) = (stiffness(&case.materials[i])?, stiffness(&case.materials[j])?);
            let effective = 1.0 / ((1.0 - nu * nu) / e + (1.0 - mu * mu) / f);
            let shear = |compliance: f64| 1.0 / compliance;
            let true_shear = shear(2.0 * (2.0 - nu) * (1.0 + nu) / e + 2.0 * (2.0 - mu) * (1.0 + mu) / f);
            let ratio = (nu * mu).sqrt();
            let own = if i == j { true_shear } else { effective / (4.0 * (2.0 - ratio) * (1.0 + ratio)) };
            Some(8.0 * own)
        };
        let own = pairs[i * count + j].clone();
        let mut mixed = Properties::default();
        for property in [
            &property::FRICTION,
            &property::SURFACE_ENERGY,
            &property::DAMPING_COEFFICIENT,
            &property::TANGENTIAL_DAMPING_RATIO,
        ] {
            mixed = given(mixed, property, mean(property));
        }
        mixed = given(mixed, &property::TANGENTIAL_STIFFNESS, modulus());
        for property in [&property::CONDUCTIVITY, &property::HEAT_TRANSFER_COEFFICIENT] {
            mixed = given(mixed, property, own.get(property));
        }
        pairs[i * count + j] = mixed;
    }
}

/// A symmetric square matrix, row by row.
fn matrix(name: &str, value: &serde_json::Value, count: usize) -> Result<Vec<f64>, Mistake> {
    let field = || format!("pair_properties.{name}");
    let rows: Vec<Vec<f64>> = serde_json::from_value(value.clone())
        .map_err(|cause| Mistake::new(field(), format!("expected a matrix of numbers: {cause}")))?;
    if rows.len() != count || rows.iter().any(|row| row.len() != count) {
        return Err(Mistake::new(field(), format!("not {count} rows of {count} numbers, one for each type")));
    }
    for (i, row) in rows.iter().enumerate() {
        for j in 0..i {
            if row[j] != rows[j][i] {
                let found = format!("[{i}][{j}] is {} and [{j}][{i}] is {}", row[j], rows[j][i]);
                return Err(Mistake::new(field(), format!("expected a symmetric matrix, found {found}")));
            }
        }
    }
    Ok(rows.concat())
}

/// The properties with that of this name of ours, or what was expected instead of the value.
fn with(pair: Properties, name: &str, value: f64) -> Result<Properties, String> {
    let property = property::STANDARD.iter().find(|property| property.name == name);
    let property = property.expect("the list above names properties of the program");
    property.range.check(value)?;
    Ok(pair.with(property, value))
}

/// The contact law.
pub(super) fn law(case: &Case) -> Result<LawChoice, Mistake> {
    let model = &case.model;
    let unknown = |field: &str, found: &str, expected: &str| {
        Mistake::new(format!("model.{field}"), format!("expected {expected}, found \"{found}\""))
    };
    for (flag, value) in model.others.iter().filter(|(flag, _)| !bond::has_flag(case, flag)) {
        let off = value.is_null() || *value == serde_json::json!(false) || *value == serde_json::json!("off");
        if !off {
            return Err(Mistake::new(
                format!("model.{flag}"),
                format!("expected no flag of this name, found it ({value})"),
            ));
        }
    }
    let speed = || {
        let value = case.scalar_properties.get("characteristicVelocity").copied();
        let field = "scalar_properties.characteristicVelocity";
        let value = value.ok_or_else(|| Mistake::new(field, "absent; the chosen model needs it"))?;
        Ok(hooke::Keys { characteristic_velocity: positive(field, value)? })
    };
    let models = Models::standard();
    let normal = match model.normal.as_str() {
        "hertz" => models.normal("hertz", NoKeys {}),
        "hertz/stiffness" => models.normal("hertz_stiffness", NoKeys {}),
        "hooke" if model.viscous => models.normal("hooke_viscous", speed()?),
        "hooke" => models.normal("hooke", speed()?),
        "hooke/stiffness" => {
            let keys = hooke_stiffness::Keys { absolute_damping: model.absolute_damping };
            models.normal("hooke_stiffness", keys)
        }
        "edinburgh" => models.normal("eepa", eepa(case)?),
        "jkr" => models.normal("jkr", jkr(case)?),
        "dmt" => models.normal("dmt", sticky(case)?),
        other => {
            let expected = "hertz, hooke, hertz/stiffness, hooke/stiffness, edinburgh, jkr or dmt";
            return Err(unknown("normal", other, expected));
        }
    };
    misplaced(case)?;
    let turned = Turned::default();
    let rocking =
        rocking::Keys { torsion: model.torsion_torque, engine_exact: true, set_up_step: Positive::new(case.dt) };
    let tangential = match model.tangential.as_str() {
        "off" => models.tangential("none", NoKeys {}),
        "history" => models.tangential("history", NoKeys {}),
        "no_history" | "linear_nohistory" => models.tangential("no_history", NoKeys {}),
        "linear_history" => models.tangential("turned_history", Turned { given_stiffness: true, ..turned }),
        "mindlin" => models.tangential("turned_history", turned),
        "mindlin_rescale" => models.tangential("turned_history", Turned { rescale: true, ..turned }),
        other => {
            let expected = "history, no_history, linear_history, linear_nohistory, mindlin, mindlin_rescale or off";
            return Err(unknown("tangential", other, expected));
        }
    };
    let rolling = match model.rolling_friction.as_str() {
        "off" => models.rolling("none", NoKeys {}),
        "cdt" => models.rolling("cdt", NoKeys {}),
        "epsd" => models.rolling("epsd", rocking),
        "epsd2" => models.rolling("epsd2", rocking),
        other => return Err(unknown("rolling_friction", other, "cdt, epsd, epsd2 or off")),
    };
    let keys = sjkr::Keys { tangential_reduce: model.tangential_reduce };
    let cohesion = match model.cohesion.as_str() {
        "off" | "bond" => models.cohesion("none", NoKeys {}),
        "sjkr" => models.cohesion("sjkr", keys),
        "sjkr2" => models.cohesion("sjkr2", keys),
        other => return Err(unknown("cohesion", other, "sjkr, sjkr2, bond or off")),
    };
    /// Sub-models of the program are asked for by name: so they are compiled with it, and not here once more.
    const OURS: &str = "the program has this sub-model, with keys of this type";
    Ok(LawChoice {
        normal: normal.expect(OURS),
        tangential: tangential.expect(OURS),
        rolling: rolling.expect(OURS),
        cohesion: cohesion.expect(OURS),
        scheme: Scheme::Engine,
        switches: Switches::of(model.limit_force, model.tangential_damping),
    })
}

/// Keys of `edinburgh`, as the engine has it.
fn eepa(case: &Case) -> Result<eepa::Keys, Mistake> {
    let number = |name: &str| {
        let value = case.scalar_properties.get(name).copied();
        value.ok_or_else(|| Mistake::new(format!("scalar_properties.{name}"), "absent; the chosen model needs it"))
    };
    Ok(eepa::Keys {
        overlap_exponent: number("overlapExponent")?,
        adhesion_exponent: number("adhesionExponent")?,
        adhesion: if case.model.fix_kc { eepa::AdhesionKind::Fixed } else { eepa::AdhesionKind::Patch },
        engine_exact: true,
    })
}

/// Keys of `jkr` and `dmt`.
fn sticky(case: &Case) -> Result<sticky::Keys, Mistake> {
    let damping = match case.model.damping.as_deref() {
        None | Some("viscoelastic") => sticky::DampingKind::Viscoelastic,
        Some("mass_velocity") => sticky::DampingKind::MassVelocity,
        Some("velocity") => sticky::DampingKind::Velocity,
        Some(other) => {
            let message = format!("expected viscoelastic, mass_velocity or velocity, found \"{other}\"");
            return Err(Mistake::new("model.damping", message));
        }
    };
    let engine_exact = match case.model.arms.as_str() {
        "lammps" => true,
        "overlap" => false,
        other => return Err(Mistake::new("model.arms", format!("expected lammps or overlap, found \"{other}\""))),
    };
    Ok(sticky::Keys { damping, given_tangential_modulus: case.model.mixing == "lammps", engine_exact })
}

/// Keys of `jkr`.
fn jkr(case: &Case) -> Result<jkr::Keys, Mistake> {
    let sticky::Keys { damping, given_tangential_modulus, engine_exact } = sticky(case)?;
    Ok(jkr::Keys { damping, given_tangential_modulus, engine_exact, ..jkr::Keys::default() })
}

/// Flags that the other engine refuses with the model at hand.
fn misplaced(case: &Case) -> Result<(), Mistake> {
    let model = &case.model;
    let refused = |flag: &str, home: &str| {
        Err(Mistake::new(
            format!("model.{flag}"),
            format!(
                "expected false, as this flag belongs to {home} alone, \
                                                           found true"
            ),
        ))
    };
    if model.viscous && model.normal != "hooke" {
        return refused("viscous", "hooke");
    }
    if model.absolute_damping && model.normal != "hooke/stiffness" {
        return refused("absolute_damping", "hooke/stiffness");
    }
    if model.tangential_reduce && model.cohesion == "off" {
        return refused("tangential_reduce", "cohesion");
    }
    Ok(())
}
