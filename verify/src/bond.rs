//! The bond laws of a case, translated to ours: one for each two types.

use super::build::positive;
use super::case::Case;
use super::error::Mistake;
use cograin::bond::breakage::{distance, stress};
use cograin::bond::creation::{ContactPolicy, Creation};
use cograin::bond::keys::{BreakageChoice, DampingChoice, FormulationChoice, Keys, PartKeys};
use cograin::quantity::{BoundaryIndex, Fraction, NonNegative, Positive, SetIndex};
use cograin::scene::Bond;

/// λ below which the other engine makes no bond.
const LEAST_MULTIPLIER: f64 = 1e-6;

/// What the other engine calls the bond's properties; those of the four parts end in `Bond` as well.
const PROPERTIES: [&str; 17] = [
    "radiusMultiplierBond",
    "normalBondStiffnessPerUnitArea",
    "tangentialBondStiffnessPerUnitArea",
    "createDistanceBond",
    "tsCreateBond",
    "maxDistanceBond",
    "maxSigmaBond",
    "maxTauBond",
    "ratioTensionCompression",
    "dampingNormalForceBond",
    "dampingTangentialForceBond",
    "dampingNormalTorqueBond",
    "dampingTangentialTorqueBond",
    "dissipationNormalForceBond",
    "dissipationTangentialForceBond",
    "dissipationNormalTorqueBond",
    "dissipationTangentialTorqueBond",
];

/// The angle of its friction \[degrees\].
const FRICTION_ANGLE: &str = "frictionAngle";

/// Flags, with their defaults.
const FLAGS: [(&str, bool); 15] = [
    ("stressBreak", false),
    ("temperatureBreak", false),
    ("tensionStress", true),
    ("compressionStress", true),
    ("shearStress", true),
    ("normalTorqueStress", true),
    ("shearTorqueStress", true),
    ("createBondAlways", false),
    ("dampingBond", true),
    ("dampingBondSmooth", false),
    ("dissipationBond", false),
    ("computeElasticPotential", false),
    ("computeDissipatedEnergy", false),
    ("druckerPrager", false),
    ("ratioTensionCompression", false),
];

/// A flag of the contact that belongs to bonds.
const WITHOUT_NORMAL: &str = "disableNormalWhenBonded";

/// Whether a pair property belongs to the bonds of this case.
pub(super) fn has_property(case: &Case, name: &str) -> bool {
    case.bonds() && (PROPERTIES.contains(&name) || name == FRICTION_ANGLE)
}

/// Whether a flag belongs to the bonds of this case.
pub(super) fn has_flag(case: &Case, name: &str) -> bool {
    case.bonds() && (FLAGS.iter().any(|(flag, _)| *flag == name) || name == WITHOUT_NORMAL)
}

/// The bond laws of a case, for each two types that bond.
pub(super) fn laws(case: &Case, formulation: FormulationChoice) -> Result<Vec<Bond>, Mistake> {
    if !case.bonds() {
        return Ok(Vec::new());
    }
    if flag(case, "temperatureBreak")? {
        return Err(Mistake::new("model.temperatureBreak", "expected false, as in the other engine, found true"));
    }
    let Some(create) = creation(case)? else { return Ok(Vec::new()) };
    let mut laws = Vec::new();
    for a in 0..case.materials.len() {
        for b in a..case.materials.len() {
            let types = Types { case, a, b };
            if types.given("radiusMultiplierBond")?.is_some_and(|multiplier| multiplier < LEAST_MULTIPLIER) {
                continue;
            }
            laws.push(types.law(formulation, &create)?);
        }
    }
    for (index, wall) in case.walls.iter().enumerate() {
        for a in 0..case.materials.len() {
            let types = Types { case, a, b: wall.material - 1 };
            if types.given("radiusMultiplierBond")?.is_none_or(|multiplier| multiplier >= LEAST_MULTIPLIER) {
                laws.push(at_plane(types.law(formulation, &create)?, index));
            }
        }
    }
    Ok(laws)
}

/// When bonds are made; `None`: never.
fn creation(case: &Case) -> Result<Option<Creation>, Mistake> {
    if flag(case, "createBondAlways")? {
        return Ok(Some(Creation::Always));
    }
    let field = "pair_properties.tsCreateBond";
    let value = case
        .pair_properties
        .get("tsCreateBond")
        .ok_or_else(|| Mistake::new(field, "expected a step, found nothing"))?;
    // The engine keeps all properties as floating-point numbers.
    let number = value.as_u64().or_else(|| value.as_f64().filter(|step| *step >= 0.0).map(|step| step as u64));
    let number = number.ok_or_else(|| Mistake::new(field, format!("expected the number of a step, found {value}")))?;
    Ok((number > 0).then_some(Creation::Step(number)))
}

/// A flag of the case or its default.
fn flag(case: &Case, name: &str) -> Result<bool, Mistake> {
    let default = FLAGS.iter().any(|(flag, on)| *flag == name && *on);
    match case.model.others.get(name) {
        None | Some(serde_json::Value::Null) => Ok(default),
        Some(serde_json::Value::Bool(value)) => Ok(*value),
        Some(serde_json::Value::String(word)) if word == "on" => Ok(true),
        Some(serde_json::Value::String(word)) if word == "off" => Ok(false),
        Some(other) => Err(Mistake::new(
            format!("model.{name}"),
            format!("expected true, false, \"on\" or \"off\", found {other}"),
        )),
    }
}

/// Two types of a case, from 0.
struct Types<'a> {
    /// The case.
    case: &'a Case,
    /// One type.
    a: usize,
    /// The other type, the same or a later one.
    b: usize,
}

impl Types<'_> {
    /// Where a property of these types stands.
    fn field(&self, name: &str) -> String {
        format!("pair_properties.{name}[{}][{}]", self.a, self.b)
    }

    /// A property, if the case gives it.
    fn given(&self, name: &str) -> Result<Option<f64>, Mistake> {
        let Some(value) = self.case.pair_properties.get(name) else { return Ok(None) };
        let entry = |a: usize, b: usize| value.get(a).and_then(|row| row.get(b)).and_then(serde_json::Value::as_f64);
        match (entry(self.a, self.b), entry(self.b, self.a)) {
            (Some(found), Some(mirrored)) if found == mirrored => Ok(Some(found)),
            _ => Err(Mistake::new(self.field(name), "no number, or not that of the mirrored entry")),
        }
    }

    /// A property that the flags need.
    fn needed(&self, name: &str) -> Result<f64, Mistake> {
        self.given(name)?.ok_or_else(|| Mistake::new(self.field(name), "absent; the bond's flags need it"))
    }

    /// A property above 0 that the flags need.
    fn positive(&self, name: &str) -> Result<Positive, Mistake> {
        positive(self.field(name), self.needed(name)?)
    }

    /// A property of 0 or above that the flags need.
    fn non_negative(&self, name: &str) -> Result<NonNegative, Mistake> {
        let value = self.needed(name)?;
        let expected = || Mistake::new(self.field(name), format!("expected 0 or above, found {value}"));
        NonNegative::new(value).ok_or_else(expected)
    }

    /// One number for each part of the bond.
    fn parts<T: Copy>(&self, kind: &str, expected: &str, make: fn(f64) -> Option<T>) -> Result<PartKeys<T>, Mistake> {
        let part = |part: &str| {
            let name = format!("{kind}{part}Bond");
            let value = self.needed(&name)?;
            let wrong = || Mistake::new(self.field(&name), format!("expected {expected}, found {value}"));
            make(value).map(Some).ok_or_else(wrong)
        };
        Ok(PartKeys {
            normal_force: part("NormalForce")?,
            tangential_force: part("TangentialForce")?,
            normal_torque: part("NormalTorque")?,
            tangential_torque: part("TangentialTorque")?,
        })
    }

    /// When bonds of these types break.
    fn breakage(&self) -> Result<BreakageChoice, Mistake> {
        if !flag(self.case, "stressBreak")? {
            let max_distance = self.positive("maxDistanceBond")?;
            return Ok(BreakageChoice::of::<distance::Distance>(distance::Keys { max_distance }));
        }
        let mut keys = stress::Keys {
            max_normal_stress: Some(self.positive("maxSigmaBond")?),
            max_shear_stress: Some(self.positive("maxTauBond")?),
            compression_breaks: Some(true),
            ..stress::Keys::default()
        };
        if flag(self.case, "ratioTensionCompression")? {
            keys.tension_ratio = Some(self.positive("ratioTensionCompression")?);
        }
        if flag(self.case, "druckerPrager")? {
            keys.friction_angle = NonNegative::new(self.non_negative(FRICTION_ANGLE)?.get().to_radians());
        }
        Ok(BreakageChoice::of::<stress::StressLimits>(keys))
    }

    /// Damping of these types.
    fn damping(&self) -> Result<Option<DampingChoice>, Mistake> {
        let smooth = flag(self.case, "dampingBondSmooth")?;
        if !smooth && !flag(self.case, "dampingBond")? {
            return Ok(None);
        }
        let parts = self.parts("damping", "a number from 0 to 1", Fraction::new)?;
        Ok(Some(if smooth { DampingChoice::Smooth(parts) } else { DampingChoice::Sign(parts) }))
    }

    /// The table that a scene would have.
    fn keys(&self, formulation: FormulationChoice, create: &Creation) -> Result<Keys, Mistake> {
        let case = self.case;
        let without_normal = flag(case, WITHOUT_NORMAL)?;
        let relaxes = flag(case, "dissipationBond")?;
        let relaxation = relaxes.then(|| self.parts("dissipation", "a time above 0", Positive::new)).transpose()?;
        Ok(Keys {
            formulation,
            between: [self.a, self.b].map(set_name),
            create: create.clone(),
            create_distance: Some(self.positive("createDistanceBond")?),
            radius_multiplier: self.given("radiusMultiplierBond")?.and_then(Positive::new),
            normal_stiffness: self.positive("normalBondStiffnessPerUnitArea")?,
            tangential_stiffness: self.non_negative("tangentialBondStiffnessPerUnitArea")?,
            tension: flag(case, "tensionStress")?,
            compression: flag(case, "compressionStress")?,
            shear: flag(case, "shearStress")?,
            torsion: flag(case, "normalTorqueStress")?,
            bending: flag(case, "shearTorqueStress")?,
            contact: if without_normal { ContactPolicy::WithoutNormal } else { ContactPolicy::Parallel },
            breakage: vec![self.breakage()?],
            damping: self.damping()?,
            relaxation,
            conductivity: None,
            temperature_break: None,
        })
    }

    /// The law.
    fn law(&self, formulation: FormulationChoice, create: &Creation) -> Result<Bond, Mistake> {
        let keys = self.keys(formulation, create)?;
        let name = format!("bond{}{}", self.a + 1, self.b + 1);
        let between = [self.a, self.b].map(|kind| SetIndex(kind as u32));
        Ok(Bond { name, keys, between, plane: None, pairs: Vec::new() })
    }
}

/// The same law between the particles of its first set and a plane.
fn at_plane(law: Bond, boundary: usize) -> Bond {
    let [set, _] = law.keys.between;
    Bond {
        name: format!("{}wall{boundary}", law.name),
        keys: Keys { between: [set, format!("wall{boundary}")], ..law.keys },
        between: [law.between[0]; 2],
        plane: Some(BoundaryIndex(boundary as u32)),
        ..law
    }
}

/// The set of the particles of one type, from 0.
pub(super) fn set_name(kind: usize) -> String {
    format!("type{}", kind + 1)
}
