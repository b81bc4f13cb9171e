//! The scene: its particles, laws, boundaries and settings, checked, in SI units.
//!
//! A [`SceneDraft`] has public parts that code may fill in; [`SceneDraft::build`] checks all of them and makes a [`Scene`], which nothing
//! changes any more. The text of a scene becomes a draft, too, and passes the same checks. Later code need not check again.

mod about;
mod accuracy;
mod body;
mod boundary;
pub(crate) mod cell;
mod checked;
pub(crate) mod clump;
mod column;
mod damping;
pub mod exchange;
pub(crate) mod file;
mod fluid;
mod governing;
mod grid;
pub(crate) mod heat;
pub(crate) mod import;
mod models;
mod output;
pub(crate) mod packing;
mod parameters;
mod plane;
mod probe;
mod region;
pub(crate) mod sizes;
mod source;
mod statics;

pub use crate::base::document::{Mistake, SceneError, SceneErrors, Setting, SettingError};
pub use crate::base::quantity::Range;
pub use crate::laws::motion::{AxisMotion, InputCourse, NodeMotion};
pub use crate::laws::surface::Shape;
pub use crate::scene::exchange::{InsertedClump, Kind, Outside};
pub use crate::scene::packing::{PackingProgress, Packings};
pub use about::About;
pub use accuracy::Accuracy;
pub use body::Body;
pub use boundary::Boundary;
pub use cell::{Cell, CellMotion, ServedStress, StressServo};
pub use checked::Scene;
pub use clump::{Clump, ClumpShape, OrientationKey};
pub use column::ColumnStart;
pub use damping::{AppliedForce, Damping};
pub(crate) use exchange::parts::Known;
pub use exchange::parts::{FlowMeter, Insertion, Outlet, OutletPlace};
pub use fluid::{Fluid, FluidHeat, FluidVelocity, Pressure};
pub use governing::GoverningLaws;
pub use grid::{Grid, GridOutput};
pub use heat::{BondWarming, BoundaryTemperature, HeatGiven, HeatSettings, HeatSource};
pub use models::Models;
pub(crate) use models::{DRY, ROLLING_FREELY, SMOOTH};
pub use output::{EnergyBins, Impacts, Output};
pub use parameters::Parameter;
pub(crate) use plane::objections as plane_objections;
pub use plane::{MotionPlane, ParticleShape};
pub use probe::{Derived, Probe, Probed};
pub(crate) use probe::{DerivedKeys, ProbeKeys};
pub use region::Region;
pub use sizes::Sizes;
pub use source::Source;

use crate::base::lanes::Width;
use crate::base::quantity::{BoundaryIndex, MaterialIndex, ParticleId, SetIndex};
use crate::laws::contact::{self, HeatModel, LawChoice, Material, Properties, Scheme};

/// Everything that a scene says, in SI units, before it is checked as a whole.
///
/// The default is the empty scene, from which code builds others:
///
/// ```
/// use cograin::contact::Material;
/// use cograin::quantity::{MaterialIndex, ParticleId, SetIndex};
/// use cograin::scene::{Particle, SceneDraft};
///
/// let glass = Material { name: "glass".into(), density: 2500.0, youngs_modulus: None, poissons_ratio: None, thermal: Default::default(), properties: Default::default() };
/// let marble = Particle {
///     id: ParticleId(1), set: SetIndex(0), material: MaterialIndex(0), shape: Default::default(), radius: 0.01,
///     density: 2500.0, position: [0.0, 0.0, 0.02], velocity: [0.0; 3], angular_velocity: [0.0; 3],
/// };
/// let mut draft = SceneDraft {
///     gravity: [0.0, 0.0, -9.81],
///     materials: vec![glass],
///     pairs: vec![Default::default()],
///     sets: vec!["marbles".into()],
///     particles: vec![marble],
///     ..SceneDraft::default()
/// };
/// assert_eq!(draft.clone().build()?.particles.len(), 1);
/// draft.particles[0].radius = -0.01;
/// assert!(draft.build().is_err());
/// # Ok::<(), cograin::scene::SceneErrors>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct SceneDraft {
    /// What the scene says of itself.
    pub about: About,
    /// Settings of the run.
    pub run: Run,
    /// Acceleration of gravity \[m/s²\].
    pub gravity: [f64; 3],
    /// Materials, in the order of the file.
    pub materials: Vec<Material>,
    /// Properties of each two materials, `materials.len()²` of them, row by row, symmetric.
    pub pairs: Vec<Properties>,
    /// Contact laws; each two materials belong to at most one.
    pub contacts: Vec<ContactLaw>,
    /// Bond laws, in the order of the file.
    pub bonds: Vec<Bond>,
    /// Names of the particle sets.
    pub sets: Vec<String>,
    /// All particles of all sets, by ascending id.
    pub particles: Vec<Particle>,
    /// Declared columns that the scene asks for, and what they begin with.
    pub columns: Vec<ColumnStart>,
    /// Shapes of clumps, in the order of the file.
    pub clump_shapes: Vec<ClumpShape>,
    /// Clumps, whose spheres are among the particles.
    pub clumps: Vec<Clump>,
    /// Boundaries, in the order of the file.
    pub boundaries: Vec<Boundary>,
    /// Cundall damping; a particle belongs to at most one.
    pub damping: Vec<Damping>,
    /// Constant forces on particles.
    pub forces: Vec<AppliedForce>,
    /// How heat flows.
    pub heat: HeatSettings,
    /// What warms or cools particles, in the order of the file.
    pub heat_sources: Vec<HeatSource>,
    /// The fluid around the particles, if there is one.
    pub fluid: Option<Fluid>,
    /// Parts of space of which stress, porosity and motion are outputs, in the order of the file.
    pub regions: Vec<Region>,
    /// Boxes divided into cells, each of which is looked at, in the order of the file.
    pub grids: Vec<Grid>,
    /// The box that particles may not leave \[m\]: lower and upper corner.
    pub domain: Option<[[f64; 3]; 2]>,
    /// What happens to particles outside of it.
    pub outside: Outside,
    /// The cell that repeats, if there is one.
    pub cell: Option<Cell>,
    /// Particles that come, in the order of the file.
    pub insertions: Vec<Insertion>,
    /// Where particles are taken away, in the order of the file.
    pub outlets: Vec<Outlet>,
    /// Polygons at which is counted what passes, in the order of the file.
    pub meters: Vec<FlowMeter>,
    /// Particles, sets and contacts that are looked at, in the order of the file.
    pub probes: Vec<Probe>,
    /// Sums of outputs, in the order of the file.
    pub derived: Vec<Derived>,
    /// What a run writes.
    pub output: Output,
    /// Numbers of the text that a unit shows as its parameters; none in a scene built in code.
    pub parameters: Vec<Parameter>,
    /// Fingerprint of the text, every file it names and the program's version; 0 for a scene built in code.
    pub fingerprint: u64,
    /// The text and every file that it names, each with a fingerprint of its own; empty for a scene built in code.
    pub parts: Vec<(String, u64)>,
    /// Sets of spheres that a random packing made, and the digest of what decided it; none in a scene that is built in code, which may have moved them.
    pub packed: Vec<(SetIndex, u64)>,
    /// Keys of the text that nothing reads, and why.
    pub unread: Vec<String>,
}

/// `[run]`
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// Where `cograin run` ends and the unit's default experiment stops \[s\].
    pub end: Option<f64>,
    /// The time step.
    pub step: Step,
    /// The accuracy for which scheme and time step are chosen, where the scene does not name them.
    pub accuracy: Accuracy,
    /// How springs and dashpots of contacts are integrated in time.
    pub scheme: Scheme,
    /// Whether a given step above the stable one may run on.
    pub allow_unstable: bool,
    /// Whether a run stops where the stable step falls below a given one, instead of dividing it.
    pub strict_step: bool,
    /// Threads; `None`: as many as the machine offers.
    pub threads: Option<usize>,
    /// Lane width; `None`: the widest that the processor offers.
    pub width: Option<Width>,
    /// Seed of everything random.
    pub seed: u64,
    /// Distance beyond touch up to which neighbours are searched \[m\]; `None`: chosen from motion and list length.
    pub skin: Option<f64>,
    /// Unbalanced force, over the mean contact force, below which `cograin settle` is done.
    pub settle_tolerance: f64,
    /// Global damping coefficient (Cundall) that `cograin settle` adds to particles which have none; `None`: what suits the scene.
    pub settle_damping: Option<f64>,
    /// Largest overlap that is accepted at the start, over the smaller radius.
    pub max_overlap: f64,
    /// The plane in which all particles stay, if the scene says so: a run in which one leaves it stops.
    pub plane: Option<MotionPlane>,
    /// Whether derivatives are differences of both sides.
    pub central_derivatives: bool,
    /// How far derivatives displace inputs, over what the program chooses.
    pub derivative_displacement: f64,
}

impl Default for Run {
    fn default() -> Self {
        Self {
            end: None,
            step: Step::Following,
            accuracy: Accuracy::Standard,
            scheme: Scheme::default(),
            allow_unstable: false,
            strict_step: false,
            threads: None,
            width: None,
            seed: 1,
            skin: None,
            settle_tolerance: 1e-4,
            settle_damping: None,
            max_overlap: 0.05,
            plane: None,
            central_derivatives: false,
            derivative_displacement: 1.0,
        }
    }
}

/// The time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// This long \[s\].
    Given(f64),
    /// A fraction of the computed stable step, computed again as the packing changes.
    Automatic {
        /// The fraction, above 0 and below 1.
        safety: f64,
    },
    /// The longest at which what is in contact now is as accurate as [`Run::accuracy`] says.
    Following,
}

impl Step {
    /// Whether the program chooses it.
    pub fn is_automatic(self) -> bool {
        !matches!(self, Self::Given(_))
    }
}

/// `[contact.<name>]`: one composed law and the materials it is for.
#[derive(Clone, Debug)]
pub struct ContactLaw {
    /// Its name in the scene.
    pub name: String,
    /// The pairs of materials that it governs; `between[a * materials + b]` and the mirrored entry are equal.
    pub between: Vec<bool>,
    /// Its sub-models and switches; its scheme is that of [`SceneDraft::run`].
    pub choice: LawChoice,
    /// Its heat sub-model; none where its contacts conduct nothing.
    pub heat: Option<HeatModel>,
}

/// `[bond.<name>]`: a bond law and the particles it is for.
#[derive(Clone, Debug)]
pub struct Bond {
    /// Its name in the scene.
    pub name: String,
    /// As the scene writes it, its numbers included; the law follows from it ([`Scene::bond_law`]).
    pub keys: crate::laws::bond::keys::Keys,
    /// The two sets of particles that it bonds (one twice: inside it, or at a plane).
    pub between: [SetIndex; 2],
    /// The plane to which the set is bonded; none where particles are bonded to each other.
    pub plane: Option<BoundaryIndex>,
    /// Listed pairs: indices into [`SceneDraft::particles`].
    pub pairs: Vec<[u32; 2]>,
}

impl Bond {
    /// Centres nearer than this are bonded \[m\].
    pub fn create_distance(&self) -> Option<f64> {
        self.keys.create_distance.map(crate::base::quantity::Positive::get)
    }

    /// Whether the law is for particles of these two sets.
    pub(crate) fn joins(&self, a: SetIndex, b: SetIndex) -> bool {
        self.plane.is_none() && (self.between == [a, b] || self.between == [b, a])
    }
}

/// A particle as the scene starts it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Its number, unique in the scene.
    pub id: ParticleId,
    /// The set it belongs to.
    pub set: SetIndex,
    /// What it is made of.
    pub material: MaterialIndex,
    /// The body whose mass and moment of inertia it has.
    pub shape: ParticleShape,
    /// Radius \[m\].
    pub radius: f64,
    /// Density \[kg/m³\]: its own, or the material's.
    pub density: f64,
    /// Position of the centre \[m\].
    pub position: [f64; 3],
    /// Velocity \[m/s\].
    pub velocity: [f64; 3],
    /// Angular velocity \[rad/s\].
    pub angular_velocity: [f64; 3],
}

impl Particle {
    /// How far from the origin numbers still say what a particle of this radius touches \[m\]: their spacing is a millionth
    /// of the radius there.
    pub(crate) fn farthest(radius: f64) -> f64 {
        1e-6 * radius / f64::EPSILON
    }

    /// Mass \[kg\].
    pub fn mass(&self) -> f64 {
        self.shape.volume(self.radius) * self.density
    }

    /// Moment of inertia \[kg m²\].
    pub fn inertia(&self) -> f64 {
        self.shape.inertia(self.mass(), self.radius)
    }
}

impl SceneDraft {
    /// Cohesion energy density of two materials (by their index) over their effective modulus, where a law has both.
    pub fn cohesion_ratio(&self, a: usize, b: usize) -> Option<f64> {
        let entry = a * self.materials.len() + b;
        let cohesive = |law: &ContactLaw| law.between[entry] && law.choice.cohesion.row().is_active();
        if !self.contacts.iter().any(cohesive) {
            return None;
        }
        let pair = crate::laws::contact::MaterialPair {
            a: &self.materials[a],
            b: &self.materials[b],
            properties: &self.pairs[entry],
        };
        let density = pair.properties.get(&contact::property::COHESION_ENERGY_DENSITY)?;
        Some(density / pair.effective_youngs_modulus().ok()?)
    }
}
