//! Spheres that are thrown at a rigid plane, and what they leave it with.

use crate::stage::Stage;
use cograin_chart::ChartError;
use std::f64::consts::PI;
use std::fmt::Write;

/// Aluminium oxide of A. H. Kharaz, D. A. Gorham & A. D. Salman, *Powder Technol.* 120 (2001) 281–291: radius \[m\].
pub(crate) const RADIUS: f64 = 0.0025;

/// Density \[kg/m³\].
const DENSITY: f64 = 4000.0;

/// Young's modulus \[Pa\] and Poisson's ratio.
const ELASTICITY: [f64; 2] = [380e9, 0.23];

/// Speed \[m/s\].
pub(crate) const SPEED: f64 = 3.9;

/// Moments within a time step at which contacts begin.
const PHASES: u32 = 16;

/// Contacts that a strongly damped sphere may need at most, in durations of the elastic one.
const PATIENCE: u32 = 20;

/// Mass of a sphere \[kg\].
fn mass() -> f64 {
    4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS * DENSITY
}

/// Effective modulus at the plane \[Pa\].
fn modulus() -> f64 {
    ELASTICITY[0] / (1.0 - ELASTICITY[1] * ELASTICITY[1])
}

/// Largest overlap of an elastic impact at this speed \[m/s\] along the normal \[m\].
fn deepest(speed: f64) -> f64 {
    libm::pow(15.0 * mass() * speed * speed / (16.0 * modulus() * RADIUS.sqrt()), 0.4)
}

/// Duration of an elastic Hertz contact at this speed \[m/s\] along the normal \[s\].
pub(crate) fn hertz_duration(speed: f64) -> f64 {
    2.943_28 * deepest(speed) / speed
}

/// Duration of an elastic contact with the spring of `hooke` at [`SPEED`] \[s\].
pub(crate) fn hooke_duration() -> f64 {
    // The spring stores at its largest overlap what Hertz's contact does there.
    let stiffness = 16.0 / 15.0 * RADIUS.sqrt() * modulus() * deepest(SPEED).sqrt();
    PI * (mass() / stiffness).sqrt()
}

/// Spheres that are thrown.
pub(crate) struct Throw<'a> {
    /// Tables of the contact law, named `touch`.
    pub law: &'a str,
    /// Coefficients of restitution and of friction.
    pub coefficients: [f64; 2],
    /// Angle of the path to the normal \[rad\].
    pub angle: f64,
    /// Duration of an elastic contact \[s\].
    pub duration: f64,
}

/// Velocity \[m/s\] and angular velocity \[rad/s\] after the impact.
pub(crate) type Rebound = [[f64; 3]; 2];

impl Throw<'_> {
    /// Speed along the normal \[m/s\].
    fn normal_speed(&self) -> f64 {
        SPEED * libm::cos(self.angle)
    }

    /// The scene: each sphere begins its contact at another moment within a step of this length \[s\].
    fn text(&self, run: &str, step: f64) -> String {
        let (normal, across) = (self.normal_speed(), SPEED * libm::sin(self.angle));
        let mut spheres = String::new();
        for phase in 0..PHASES {
            let height = RADIUS + normal * step * (f64::from(phase) + 0.5) / f64::from(PHASES);
            let y = 4.0 * RADIUS * f64::from(phase);
            writeln!(spheres, "{{ position = [0.0, {y:?}, {height:?}], radius = {RADIUS:?} }},").expect("a text grows");
        }
        let ([modulus, ratio], [restitution, friction], law) = (ELASTICITY, self.coefficients, self.law);
        let pair = format!("restitution = {restitution:?}\nfriction = {friction:?}\n");
        format!(
            "[run]\nthreads = 1\n{run}\n\
             [material.oxide]\ndensity = {DENSITY:?}\nyoungs_modulus = {modulus:?}\npoissons_ratio = {ratio:?}\n\
             [material.rigid]\ndensity = 1.0\nyoungs_modulus = 1e30\npoissons_ratio = 0.0\n\
             [pair.oxide.oxide]\n{pair}[pair.oxide.rigid]\n{pair}[pair.rigid.rigid]\n{pair}{law}\n\
             [particles.spheres]\nmaterial = \"oxide\"\nvelocity = [{across:?}, 0.0, -{normal:?}]\nlist = [\n{spheres}]\n\
             [boundary.floor]\nmaterial = \"rigid\"\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\n"
        )
    }

    /// What all spheres leave the plane with, and the time step \[s\].
    fn run(&self, run: &str, step: f64) -> Result<(Vec<Rebound>, f64), ChartError> {
        let mut stage = Stage::of(&self.text(run, step))?;
        let made = stage.step();
        // Whole steps: an interval that is none would be divided into shorter ones.
        let contact = (self.duration / made).ceil() * made;
        for _ in 0..PATIENCE {
            stage.advance(contact)?;
            if (0..stage.count()).all(|sphere| stage.position(sphere)[2] > RADIUS) {
                break;
            }
        }
        let rebounds = (0..stage.count()).map(|sphere| [stage.velocity(sphere), stage.spin(sphere)]);
        Ok((rebounds.collect(), made))
    }

    /// The same with so many time steps in an elastic contact, and more lines of `[run]`.
    pub(crate) fn steps(&self, steps: f64, run: &str) -> Result<Vec<Rebound>, ChartError> {
        let step = self.duration / steps;
        Ok(self.run(&format!("step = {step:?}\nallow_unstable = true\n{run}"), step)?.0)
    }

    /// The same with the step that the program chooses; with the time steps in an elastic contact.
    pub(crate) fn automatic(&self, run: &str) -> Result<(Vec<Rebound>, f64), ChartError> {
        // The first run tells how long the step is, the second one places the spheres by it.
        let (_, step) = self.run(run, self.duration / 10.0)?;
        let (rebounds, step) = self.run(run, step)?;
        Ok((rebounds, self.duration / step))
    }
}
