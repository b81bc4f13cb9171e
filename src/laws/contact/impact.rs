//! A head-on impact of two like spheres, tried with the code of their law: what a long time step makes of its restitution.
//!
//! Time steps are counted by the impact's own stable one, 2/μ of two bodies alone ([`Impact::stable`]). Laws whose force is a power
//! of the overlap answer alike at any speed; the others are tried at the speed of a reference overlap.

use super::{Contact, Law, MOST_HISTORY};
use crate::base::number::Vector;
use std::f64::consts::PI;

/// Overlap over the effective radius that the impact reaches,
const OVERLAP: f64 = 0.01;

/// or up to this one, where bodies that attract each other would stick.
const DEEPEST: f64 = 0.64;

/// An overlap at which only attraction is felt, if there is any, over that.
const SHALLOW: f64 = 1e-6;

/// Restitution over that of the deepest impact below which one is close to sticking: there it depends on the speed without bound.
const STICKING: f64 = 0.5;

/// Impacts that are tried at a time step, each with another moment within it at which the contact begins.
const TRIALS: u32 = 48;

/// The largest error that any impact has over that of so many trials, at most.
const MISSED: f64 = 1.1;

/// Lengths of the time step among them: so the contact ends at any moment of one, too.
const ENDS: u32 = 6;

/// How much shorter than the first the last of them is: not longer than the next that is tried.
const SHORTER: f64 = 1.0 - NEXT;

/// Part of the energy below which nothing is said of what an impact dissipates too much.
const LEAST_LOST: f64 = 1e-3;

/// The golden section: its multiples lie evenly between 0 and 1, however many there are.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Stable steps after which bodies that still touch count as stuck; an impact takes two to six.
const LONGEST: f64 = 60.0;

/// A time step over the stable one that leaves no error to speak of.
const FINE: f64 = 1.0 / 256.0;

/// A time step over the next longer one that is tried: the fourth root of ½.
const NEXT: f64 = 0.840_896_415_253_714_6;

/// The longest time step that the program chooses over the stable one. At that itself an impact of two bodies has two to three.
pub(crate) const LONGEST_PART: f64 = 0.8;

/// The shortest that is tried: below it the error is taken to be of first order.
const SHORTEST_PART: f64 = 1.0 / 64.0;

/// What a time step makes of restitution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct StepError {
    /// The largest error of the coefficient of restitution, over the moments at which the contact may begin.
    pub(crate) restitution: f64,
    /// What is dissipated too much, in the mean over them, over what is dissipated with short steps; 0 where nothing is.
    pub(crate) dissipation: f64,
    /// What is left of the energy, in the mean over them.
    pub(crate) kept: f64,
}

/// An impact to be tried.
#[derive(Clone)]
pub(crate) struct Impact {
    /// The law.
    law: Law,
    /// Its coefficients.
    row: Vec<f64>,
    /// Radius \[m\] and mass \[kg\] of each sphere.
    body: [f64; 2],
    /// Speed of the approach \[m/s\].
    speed: f64,
    /// The stable time step \[s\].
    stable: f64,
}

impl Impact {
    /// An impact of two spheres of this radius \[m\] and mass \[kg\]; none where the law has no stiffness. Bodies that attract each other
    /// meet so fast that they do not nearly stick: an impact that ends stuck has no restitution that could be wrong.
    pub(crate) fn of(law: &Law, row: &[f64], body: [f64; 2]) -> Option<Self> {
        let constant = law.pair_constant(row, 0.5 * body[0], 0.5 * body[1]);
        let mut shallow = contact(body, SHALLOW * OVERLAP * 0.5 * body[0], 0.0, constant);
        let normal = shallow.normal;
        let mut history = [[0.0; 4]; MOST_HISTORY];
        let force = law.react(row, &mut shallow, &mut history[..law.history().len()], 0.0).force;
        let attracts = force.dot(normal) < 0.0;
        if !attracts {
            return Self::reaching(OVERLAP, (law, row, constant), body);
        }
        let overlaps = std::iter::successors(Some(OVERLAP), |overlap| Some(2.0 * overlap));
        let deeper = overlaps.take_while(|overlap| *overlap <= DEEPEST);
        let tried: Vec<Self> = deeper.filter_map(|it| Self::reaching(it, (law, row, constant), body)).collect();
        let least = STICKING * tried.last()?.restitution();
        tried.into_iter().find(|impact| impact.restitution() >= least)
    }

    /// The impact that reaches this overlap over the effective radius; none where no energy is held there.
    fn reaching(overlap: f64, (law, row, constant): (&Law, &[f64], f64), body: [f64; 2]) -> Option<Self> {
        let deep = contact(body, overlap * 0.5 * body[0], 0.0, constant);
        let (energy, mass) = (law.normal_energy(row, &deep, 0.0, &[[0.0; 4]; MOST_HISTORY]), deep.mass);
        let response = law.stiffness(row, &deep);
        let (k, c) = (response.normal_stiffness / mass, response.normal_damping / mass);
        let (speed, stable) = ((2.0 * energy / mass).sqrt(), 4.0 / (c + (c * c + 4.0 * k).sqrt()));
        let holds = [speed, stable].into_iter().all(|it| it.is_finite() && it > 0.0);
        holds.then(|| Self { law: law.clone(), row: row.to_vec(), body, speed, stable })
    }

    /// What is left of the speed after an impact in time steps that are this part of the stable one; the contact begins at this part
    /// of the first one.
    fn rebound(&self, part: f64, phase: f64) -> f64 {
        let Self { law, row, body, speed, stable } = self;
        let (step, mass) = (part * stable, 0.5 * body[1]);
        let constant = law.pair_constant(row, 0.5 * body[0], mass);
        let mut history = [[0.0; 4]; MOST_HISTORY];
        let remembered = &mut history[..law.history().len()];
        let (mut overlap, mut velocity, mut force) = ((phase - 1.0) * speed * step, -speed, 0.0);
        let mut touched = false;
        for _ in 0..(LONGEST / part) as u32 {
            velocity += 0.5 * step * force / mass;
            overlap -= step * velocity;
            let reach = if touched && law.holds_beyond_touch() { constant } else { 0.0 };
            if overlap >= -reach {
                touched = true;
                let mut contact = contact(*body, overlap, velocity, constant);
                force = law.react(row, &mut contact, remembered, step).force.dot(contact.normal);
                velocity += 0.5 * step * force / mass;
            } else if touched {
                return velocity / speed;
            }
        }
        0.0
    }

    /// What is left of the speed with short time steps.
    pub(crate) fn restitution(&self) -> f64 {
        self.rebound(FINE, 0.5)
    }

    /// What time steps that are this part of the stable one, or a little shorter, make of it, where this restitution is right.
    pub(crate) fn error(&self, part: f64, right: f64) -> StepError {
        let (mut most, mut kept) = (0.0_f64, 0.0);
        for trial in 0..TRIALS {
            let part = part * (1.0 - SHORTER * f64::from(trial % ENDS) / f64::from(ENDS));
            let found = self.rebound(part, (f64::from(trial) * GOLDEN).fract());
            most = most.max((found - right).abs());
            kept += found * found / f64::from(TRIALS);
        }
        let lost = 1.0 - right * right;
        let dissipation = if lost > LEAST_LOST { (1.0 - kept) / lost - 1.0 } else { 0.0 };
        StepError { restitution: MISSED * most, dissipation, kept }
    }
}

/// The largest error of restitution over the time step, of several impacts: what their own code makes of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct ErrorCurve {
    /// Parts of the stable step, ascending up to [`LONGEST_PART`] or to the longest with which no impact gains energy, and the largest
    /// error of any that is not longer; empty where nothing can touch.
    points: Vec<[f64; 2]>,
}

impl ErrorCurve {
    /// The curve of these impacts, down to this error.
    pub(crate) fn of(impacts: &[Impact], least: f64) -> Self {
        let right: Vec<f64> = impacts.iter().map(Impact::restitution).collect();
        let (mut points, mut part, mut within) = (Vec::new(), LONGEST_PART, 0);
        // One small error may be that of an accident.
        while !impacts.is_empty() && part >= SHORTEST_PART && within < 2 {
            let (mut error, mut gains) = (0.0_f64, false);
            for (impact, right) in impacts.iter().zip(&right) {
                let found = impact.error(part, *right);
                error = error.max(found.restitution);
                // What changes restitution by this changes the energy by twice that.
                gains |= found.kept > (right * right).max(1.0) + 2.0 * least;
            }
            within = if error <= least { within + 1 } else { 0 };
            if gains {
                // Bodies that have little energy would gain more in each impact.
                points.clear();
            } else {
                points.push([part, error]);
            }
            part *= NEXT;
        }
        points.reverse();
        let mut most = 0.0_f64;
        for [_, error] in &mut points {
            most = most.max(*error);
            *error = most;
        }
        Self { points }
    }

    /// The longest time step over the stable one, of those that were tried, whose error is not above this.
    pub(crate) fn longest(&self, error: f64) -> f64 {
        let within = self.points.partition_point(|point| point[1] <= error);
        match (within.checked_sub(1), self.points.first()) {
            (Some(place), _) => self.points[place][0],
            (None, Some([part, least])) => part * error / least,
            (None, None) => LONGEST_PART,
        }
    }
}

/// The contact of two like spheres of this radius \[m\] and mass \[kg\] at this overlap \[m\] and velocity along the normal \[m/s\].
fn contact([radius, mass]: [f64; 2], overlap: f64, velocity: f64, pair_constant: f64) -> Contact {
    let distance = 2.0 * radius - overlap;
    Contact {
        overlap,
        radius: 0.5 * radius,
        mass: 0.5 * mass,
        section_area: PI * (radius * radius - 0.25 * distance * distance).max(0.0),
        section_radius: radius,
        normal: Vector::new(1.0, 0.0, 0.0),
        normal_velocity: velocity,
        per_distance: 1.0 / distance,
        per_reach: 0.5 / radius,
        rolling_inertia: 0.5 * mass * radius * radius,
        pair_constant,
        ..Contact::zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::quantity::Positive;
    use crate::laws::contact::fixtures::*;
    use crate::laws::contact::property;
    use crate::laws::contact::{
        CohesionModel, LawChoice, NoKeys, NormalModel, Properties, RollingModel, Scheme, Switches, TangentialModel,
        cohesion, normal, rolling, tangential,
    };

    /// A law without friction, and its coefficients.
    fn case(name: &str, restitution: f64, scheme: Scheme) -> (Law, Vec<f64>) {
        case_with(name, properties().with(&property::RESTITUTION, restitution), scheme)
    }

    /// The same of any properties.
    fn case_with(name: &str, properties: Properties, scheme: Scheme) -> (Law, Vec<f64>) {
        let speed = normal::hooke::Keys { characteristic_velocity: Positive::new(2.0).unwrap() };
        let choice = LawChoice {
            normal: match name {
                "hertz" => NormalModel::of::<normal::hertz::Hertz>(NoKeys {}),
                "jkr" => NormalModel::of::<normal::jkr::Jkr>(normal::jkr::Keys::default()),
                _ => NormalModel::of::<normal::hooke::Hooke>(speed),
            },
            tangential: TangentialModel::of::<tangential::none::None>(NoKeys {}),
            rolling: RollingModel::of::<rolling::none::None>(NoKeys {}),
            cohesion: CohesionModel::of::<cohesion::none::None>(NoKeys {}),
            switches: Switches::of(false, true),
            scheme,
        };
        let row = with_pair(&properties, |pair| choice.coefficients(pair)).unwrap();
        (Law::of(&choice), row)
    }

    #[test]
    fn short_time_steps_give_the_restitution_that_the_law_was_given() {
        for restitution in [0.1, 0.5, 0.9] {
            for name in ["hertz", "hooke"] {
                let (law, row) = case(name, restitution, Scheme::PredictedNormal);
                let found = Impact::of(&law, &row, [1e-3, 1e-5]).unwrap().restitution();
                assert!((found - restitution).abs() < 1e-4, "{name}: {found}, {restitution} expected");
            }
        }
    }

    #[test]
    fn the_longest_step_of_an_error_has_no_larger_one_and_a_little_longer_one_has() {
        for scheme in Scheme::ALL {
            for name in ["hertz", "hooke"] {
                let (law, row) = case(name, 0.7, scheme);
                let impact = Impact::of(&law, &row, [1e-3, 1e-5]).unwrap();
                let right = impact.restitution();
                let curve = ErrorCurve::of(std::slice::from_ref(&impact), 5e-3);
                for most in [5e-3, 2e-2, 5e-2] {
                    let part = curve.longest(most);
                    let error = impact.error(part, right).restitution;
                    assert!(error <= most, "{name}, {}: {error} at {part}, {most} allowed", scheme.name());
                    let more = [1.2, 1.5, 2.0].map(|times| impact.error(times * part, right).restitution);
                    assert!(
                        part == LONGEST_PART || more.iter().any(|error| *error > most),
                        "{name}, {}: {more:?} beyond {part}, {most} allowed",
                        scheme.name()
                    );
                }
            }
        }
    }

    #[test]
    fn no_longer_step_is_taken_than_one_with_which_impacts_gain_no_energy() {
        for (name, restitution, longest) in
            [("hooke", 0.8, LONGEST_PART), ("hertz", 1.0, LONGEST_PART), ("hooke", 1.0, 0.6)]
        {
            let (law, row) = case(name, restitution, Scheme::PredictedNormal);
            let impact = Impact::of(&law, &row, [1e-3, 1e-5]).unwrap();
            let curve = ErrorCurve::of(std::slice::from_ref(&impact), 1e-2);
            let part = curve.longest(f64::INFINITY);
            assert!(part <= longest && part > 0.5 * longest, "{name}, e = {restitution}: {part}");
            let kept = impact.error(part, restitution).kept;
            assert!(kept <= 1.02, "{name}, e = {restitution}: {kept} at {part}");
        }
        // A spring without a dashpot in steps of ω Δt = 1.6, that are long enough to leave it after a single one with up to 1.56 v.
        let (law, row) = case("hooke", 1.0, Scheme::PredictedNormal);
        let kept = Impact::of(&law, &row, [1e-3, 1e-5]).unwrap().error(0.8, 1.0).kept;
        assert!(kept > 1.05, "{kept}");
    }

    #[test]
    fn bodies_that_attract_each_other_are_tried_where_they_do_not_stick() {
        for surface_energy in [1e-12, 1e-9, 1e-6, 1e-5] {
            let properties =
                properties().with(&property::SURFACE_ENERGY, surface_energy).with(&property::DAMPING_COEFFICIENT, 0.0);
            let (law, row) = case_with("jkr", properties, Scheme::PredictedNormal);
            let impact = Impact::of(&law, &row, [1e-3, 1e-5]).unwrap();
            assert!(impact.restitution() > 0.4, "{surface_energy}: {}", impact.restitution());
            let curve = ErrorCurve::of(std::slice::from_ref(&impact), 1e-3);
            let [standard, high] = [1e-2, 1e-3].map(|error| curve.longest(error));
            assert!(high < standard && standard < LONGEST_PART, "{surface_energy}: {standard} and {high}");
        }
    }

    #[test]
    fn an_impact_is_the_same_at_any_size_and_mass() {
        let (law, row) = case("hooke", 0.5, Scheme::PredictedNormal);
        let error = |body| {
            let impact = Impact::of(&law, &row, body).unwrap();
            impact.error(0.4, impact.restitution())
        };
        let [small, large] = [error([1e-3, 1e-5]), error([10.0, 3.0])];
        assert!((small.restitution - large.restitution).abs() < 1e-9, "{small:?}, {large:?}");
    }

    #[test]
    fn without_impacts_nothing_is_in_the_way_of_the_longest_step() {
        assert_eq!(ErrorCurve::of(&[], 1e-2).longest(1e-9), LONGEST_PART);
        let (law, row) = case("hertz", 0.5, Scheme::PredictedNormal);
        let impact = Impact::of(&law, &row, [1e-3, 1e-5]).unwrap();
        let curve = ErrorCurve::of(std::slice::from_ref(&impact), 1e-2);
        assert_eq!(curve.longest(1.0), LONGEST_PART);
        // Below the least error that was tried the step goes with the error.
        assert_eq!(curve.longest(2e-6), 2.0 * curve.longest(1e-6));
    }
}
