//! `prescribed = { z = { sine = .. } }`: a displacement in time, which begins at displacement 0.

use super::{Motion, ShownVariables};
use crate::base::quantity::{Finite, NonNegative, Positive};
use serde::Deserialize;
use std::f64::consts::TAU;

/// A displacement as a function of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Schedule {
    /// To and fro.
    Sine(Sine),
    /// To another place and there it stays.
    Trapezoid(Trapezoid),
}

/// ```text
/// u = A (sin(2π f t + φ) − sin φ)
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sine {
    /// A \[m, rad\].
    amplitude: Finite,
    /// f \[1/s\].
    frequency: Positive,
    /// φ \[rad\].
    phase: Option<Finite>,
}

/// The velocity rises at constant acceleration, stays, and falls at the same rate; where the way is too short for the whole
/// velocity, it falls at once.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trapezoid {
    /// The whole way, with its sign \[m, rad\].
    distance: Finite,
    /// The largest speed \[m/s, rad/s\].
    speed: Positive,
    /// The rate at which it is reached \[m/s², rad/s²\].
    acceleration: Positive,
    /// When it begins \[s\].
    start: Option<NonNegative>,
}

impl Sine {
    /// Displacement and velocity.
    fn at(&self, time: f64) -> [f64; 2] {
        let (amplitude, rate) = (self.amplitude.get(), TAU * self.frequency.get());
        let phase = self.phase.map_or(0.0, Finite::get);
        let angle = rate * time + phase;
        [amplitude * (libm::sin(angle) - libm::sin(phase)), amplitude * rate * libm::cos(angle)]
    }
}

impl Trapezoid {
    /// Displacement and velocity.
    fn at(&self, time: f64) -> [f64; 2] {
        let (way, rate) = (self.distance.get().abs(), self.acceleration.get());
        let sign = if self.distance.get() < 0.0 { -1.0 } else { 1.0 };
        let speed = self.speed.get().min((way * rate).sqrt());
        let (ramp, time) = (speed / rate, time - self.start.map_or(0.0, NonNegative::get));
        let whole = if speed > 0.0 { way / speed + ramp } else { 0.0 };
        let [place, velocity] = if time <= 0.0 {
            [0.0, 0.0]
        } else if time < ramp {
            [0.5 * rate * time * time, rate * time]
        } else if time <= whole - ramp {
            [speed * (time - 0.5 * ramp), speed]
        } else if time < whole {
            let left = whole - time;
            [way - 0.5 * rate * left * left, rate * left]
        } else {
            [way, 0.0]
        };
        [sign * place, sign * velocity]
    }
}

impl Motion for Schedule {
    fn words(&self, _unit: &str) -> Option<String> {
        Some(match self {
            Self::Sine(_) => "to and fro as a sine".to_owned(),
            Self::Trapezoid(_) => "along a trapezoid of velocity".to_owned(),
        })
    }

    fn seen(&self) -> ShownVariables {
        ShownVariables::Place
    }

    fn at(&self, time: f64) -> Option<[f64; 2]> {
        Some(match self {
            Self::Sine(sine) => sine.at(time),
            Self::Trapezoid(trapezoid) => trapezoid.at(time),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Schedules of each kind.
    fn schedules() -> Vec<Schedule> {
        let finite = |value| Finite::new(value).unwrap();
        let positive = |value| Positive::new(value).unwrap();
        let trapezoid = |distance, speed| {
            let (distance, speed, acceleration) = (finite(distance), positive(speed), positive(4.0));
            Schedule::Trapezoid(Trapezoid { distance, speed, acceleration, start: NonNegative::new(0.25) })
        };
        let sine = Sine { amplitude: finite(0.3), frequency: positive(2.0), phase: Some(finite(0.7)) };
        vec![Schedule::Sine(sine), trapezoid(3.0, 2.0), trapezoid(-0.5, 2.0)]
    }

    #[test]
    fn every_schedule_begins_at_0_and_its_velocity_is_the_rate_of_its_displacement() {
        for law in schedules() {
            let at = |time| law.at(time).unwrap();
            assert_eq!(at(0.0)[0].abs(), 0.0);
            for number in 1..300 {
                let (time, h) = (0.01 * f64::from(number) + 0.003, 1e-6);
                let rate = (at(time + h)[0] - at(time - h)[0]) / (2.0 * h);
                assert!((rate - at(time)[1]).abs() < 1e-5, "{law:?} at {time} s: {rate}, not {}", at(time)[1]);
            }
        }
    }

    #[test]
    fn a_trapezoid_arrives_after_distance_over_speed_and_the_ramp() {
        // 3 m at 2 m/s and a ramp of ½ s, from 0.25 s on: 1.5 + 0.5 + 0.25 s.
        let [_, long, short] = schedules()[..] else { panic!("three schedules") };
        assert_eq!(long.at(2.25), Some([3.0, 0.0]));
        assert!(long.at(2.24).unwrap()[0] < 3.0);
        // ½ m at 4 m/s²: √2 m/s is never exceeded.
        assert!((short.at(0.25 + 0.125_f64.sqrt()).unwrap()[1] + 2.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(short.at(9.0), Some([-0.5, 0.0]));
    }
}
