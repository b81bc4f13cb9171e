//! A block of spheres that press on each other and on six planes: what the cost of a time step is measured on.
//!
//! It makes steps on one thread, with one feature after the other, in turn; the least time of several rounds counts. It is
//! processor time where the system tells it, so that other programs disturb less.

use crate::schemes::Scheme;
use crate::stage::Stage;
use cograin_chart::ChartError;
use std::time::Instant;

/// Spheres along each edge of the block.
pub(crate) const EDGE: usize = 20;

/// Density \[kg/m³\], Young's modulus \[Pa\], Poisson's ratio, radius \[m\], characteristic speed \[m/s\].
pub(crate) const SPHERE: [f64; 5] = [2500.0, 1e8, 0.25, 1e-3, 1.0];

/// Distance of centres \[m\].
const SPACING: f64 = 0.999 * 2e-3;

/// Time steps in a round.
const STEPS: f64 = 40.0;

/// Rounds.
const ROUNDS: u32 = 20;

/// Lines of a scene with spheres that are pressed.
pub(crate) const HERTZ: &str = "[contact.c.normal.hertz]\n";

/// The same with linear springs.
pub(crate) const HOOKE: &str = "[contact.c.normal.hooke]\ncharacteristic_velocity = 1.0\n";

/// Lines that give them friction.
pub(crate) const ROUGH: &str = "[contact.c.tangential.history]\n";

/// Lines that bond them; keys of the bond may follow.
pub(crate) const BOND: &str = "[bond.b]\nbetween = [\"block\", \"block\"]\ncreate_distance = 2.1e-3\nnormal_stiffness = 1e12\n\
                               tangential_stiffness = 4e11\n";

/// What the block has beside particles and planes.
#[derive(Clone, Copy)]
pub(crate) struct Feature {
    /// Its name.
    pub name: &'static str,
    /// Lines of laws, bonds and outputs, one after another.
    pub tables: &'static [&'static str],
    /// How springs and dashpots go on in time, if not as by default.
    pub scheme: Option<Scheme>,
    /// Coefficient of friction.
    pub friction: f64,
    /// Whether gravity acts.
    pub gravity: bool,
    /// Whether every time step is a communication step.
    pub single_steps: bool,
}

impl Feature {
    /// These lines.
    pub(crate) const fn new(name: &'static str, tables: &'static [&'static str]) -> Self {
        Self { name, tables, scheme: None, friction: 0.5, gravity: false, single_steps: false }
    }

    /// The same in this scheme.
    pub(crate) const fn with(self, scheme: Scheme) -> Self {
        Self { scheme: Some(scheme), ..self }
    }
}

/// Centres of the spheres \[m\].
pub(crate) fn centers() -> Vec<[f64; 3]> {
    let place = |number: usize| SPACING * number as f64;
    let number = |sphere: usize| [sphere % EDGE, sphere / EDGE % EDGE, sphere / (EDGE * EDGE)];
    (0..EDGE * EDGE * EDGE).map(|sphere| number(sphere).map(place)).collect()
}

/// The planes: across which axis, where \[m\], whether the spheres are above.
pub(crate) fn planes() -> [(usize, f64, bool); 6] {
    let [low, high] = [-0.5, EDGE as f64 - 0.5].map(|place| place * SPACING);
    std::array::from_fn(|plane| if plane % 2 == 0 { (plane / 2, low, true) } else { (plane / 2, high, false) })
}

/// The scene with a feature.
fn text(feature: &Feature) -> String {
    let gravity = if feature.gravity { "gravity = [0.0, 0.0, -9.81]\n" } else { "" };
    let (run, friction) = (feature.scheme.map_or("", |scheme| scheme.run), feature.friction);
    let own = feature.tables.concat();
    let mut walls = String::new();
    for (number, (axis, at, above)) in planes().into_iter().enumerate() {
        let vector = |value: f64| (0..3).map(|place| if place == axis { value } else { 0.0 }).collect::<Vec<_>>();
        let (point, normal) = (vector(at), vector(if above { 1.0 } else { -1.0 }));
        walls += &format!(
            "[boundary.wall{number}]\nmaterial = \"a\"\nplane = {{ point = {point:?}, normal = {normal:?} }}\n"
        );
    }
    let [density, modulus, ratio, radius, _] = SPHERE;
    format!(
        "{gravity}[run]\nthreads = 1\nmax_overlap = 0.1\n{run}\n\
         [material.a]\ndensity = {density:?}\nyoungs_modulus = {modulus:?}\npoissons_ratio = {ratio:?}\n\
         [pair.a.a]\nrestitution = 0.5\nfriction = {friction:?}\nrolling_friction = 0.1\ncohesion_energy_density = 1e3\n\
         surface_energy = 1e-3\ndamping_coefficient = 1e3\ntangential_damping_ratio = 1.0\nunloading_stiffness_ratio = 2.0\n\
         pull_off_force = 0.0\n{own}\n\
         [particles.block]\nmaterial = \"a\"\n\
         lattice = {{ kind = \"simple_cubic\", radius = {radius:?}, spacing = {SPACING:?}, counts = [{EDGE}, {EDGE}, {EDGE}] }}\n{walls}"
    )
}

/// Processor time of this thread \[s\], or wall time where the system does not tell it.
pub(crate) fn processor_time(begun: Instant) -> f64 {
    // The system counts when it looks for another thread to run, or some milliseconds later.
    std::thread::yield_now();
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| begun.elapsed().as_secs_f64(), |nanoseconds| 1e-9 * nanoseconds)
}

/// The block with a feature, timed.
pub(crate) struct Timed {
    /// Name of the feature.
    pub name: &'static str,
    /// The block.
    pub stage: Stage,
    /// Into how many communication steps a round is divided.
    pieces: u32,
    /// Least time of a time step \[s\].
    pub least: f64,
}

impl Timed {
    /// How many contacts it has.
    pub(crate) fn contacts(&self) -> f64 {
        self.stage.simulation.contact_count() as f64
    }

    /// How many bonds it has.
    pub(crate) fn bonds(&self) -> f64 {
        self.stage.simulation.state().bonds.iter().map(|list| list.first.len()).sum::<usize>() as f64
    }
}

/// Times the block with each of these features, in turn.
pub(crate) fn times(features: &[Feature]) -> Result<Vec<Timed>, ChartError> {
    let mut blocks = Vec::new();
    for feature in features {
        let mut stage = Stage::of(&text(feature))?;
        let pieces = if feature.single_steps { STEPS as u32 } else { 1 };
        stage.advance(STEPS / 4.0 * stage.step())?;
        blocks.push(Timed { name: feature.name, stage, pieces, least: f64::INFINITY });
    }
    let begun = Instant::now();
    for _ in 0..ROUNDS {
        for Timed { stage, pieces, least, .. } in &mut blocks {
            let (before, made) = (processor_time(begun), stage.simulation.state().clock.steps);
            for _ in 0..*pieces {
                stage.advance(STEPS / f64::from(*pieces) * stage.step())?;
            }
            let steps = stage.simulation.state().clock.steps - made;
            *least = least.min((processor_time(begun) - before) / steps as f64);
        }
    }
    Ok(blocks)
}
