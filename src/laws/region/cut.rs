//! A ball and the faces of a closed mesh, in closed form.
//!
//! All lengths are over the radius of the ball, whose centre is the origin. The cones from the centre to the faces fill the
//! inside of the mesh, those to faces that hide it counted as negative. What the ball has of them is, by the divergence
//! theorem,
//!
//! ```text
//! V = (Σ h A + S)/3
//! ```
//!
//! | symbol | meaning | from |
//! |---|---|---|
//! | h | distance of a face's plane from the centre along its outward normal n, below 0 where the centre is in front | |
//! | A | area of the part of the face that is in the ball | straight pieces and arcs of its rim |
//! | S | area of the part of the sphere that is inside of the mesh | below |
//!
//! S is known twice. The theorem of Gauss and Bonnet, over the rim of S, gives it up to whole turns of 2π, however near the centre is to a
//! face, an edge or a vertex:
//!
//! ```text
//! S = Σ h φ − Σ_entries α + Σ_exits α      (modulo 2π)
//! ```
//!
//! with φ the angle of the face's arcs and α the direction of the rim, p × n, where an edge of the face goes through the sphere at p,
//! measured in the sphere's tangent plane from a direction that depends on p alone. The solid angles Ω of the parts of the faces in the
//! ball give the whole of it, but lose their digits near an edge:
//!
//! ```text
//! S = 4π − Σ Ω  if the centre is inside, −Σ Ω otherwise
//! ```
//!
//! So the second, for a ball beside the place where digits are lost, tells the number of turns of the first.

use crate::base::number::Vector;
use std::f64::consts::TAU;

/// What a face, or several, have of a ball.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cut {
    /// Σ h A.
    pub(super) cone: f64,
    /// S up to whole turns.
    pub(super) turned: f64,
    /// Σ Ω.
    pub(super) angle: f64,
}

/// A corner of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Its number in the mesh.
    pub(super) number: u32,
    /// Where it is.
    pub(super) place: Vector,
}

/// A point of the rim of a face, on the way around it.
#[derive(Clone, Copy)]
struct Station {
    /// Where it is.
    place: Vector,
    /// Whether the way to the next point is in the ball.
    within: bool,
    /// Whether the rim goes through the sphere here.
    through: bool,
}

/// The way around a face, at most nine points long.
struct Rim {
    /// Its points.
    stations: [Station; 9],
    /// How many there are.
    count: usize,
}

impl Rim {
    /// Adds a point.
    fn add(&mut self, place: Vector, within: bool, through: bool) {
        self.stations[self.count] = Station { place, within, through };
        self.count += 1;
    }

    /// Adds an edge, from its beginning to before its end. Both faces of an edge find the same bits for the same point: they look
    /// at it from the corner with the lower number.
    fn add_edge(&mut self, from: Corner, to: Corner) {
        let [low, high] = if from.number < to.number { [from, to] } else { [to, from] };
        let [starts, ends] = [from, to].map(|corner| corner.place.dot(corner.place) < 1.0);
        if starts && ends {
            return self.add(from.place, true, false);
        }
        let way = high.place - low.place;
        let along = way * (1.0 / way.length());
        let behind = along.dot(low.place);
        let foot = low.place - along * behind;
        let half = (1.0 - foot.dot(foot)).max(0.0).sqrt();
        let cuts = starts || ends || (half > 0.0 && behind < 0.0 && along.dot(high.place) > 0.0);
        let half = if from.number < to.number { half } else { -half };
        self.add(from.place, starts, false);
        if cuts && !starts {
            self.add(foot - along * half, true, true);
        }
        if cuts && !ends {
            self.add(foot + along * half, false, true);
        }
    }

    /// In the face's plane at this height: the angle of the arcs, and of the straight pieces in the ball the area between them and the foot of
    /// the centre, and its solid angle.
    fn measures(&self, normal: Vector, height: f64) -> [f64; 3] {
        let side = 1.0_f64.copysign(height);
        let (mut sweep, mut area, mut angle) = (0.0, 0.0, 0.0);
        for number in 0..self.count {
            let (here, next) = (self.stations[number], self.stations[(number + 1) % self.count]);
            let (a, b) = (here.place, next.place);
            if here.within {
                let cross = normal.dot(a.cross(b));
                area += 0.5 * cross;
                let (one, other) = (a.length(), b.length());
                angle += 2.0 * libm::atan2(side * cross, one * other + height.abs() * (one + other) + a.dot(b));
            } else {
                // The circle of the plane and the sphere turns by as much as the way outside of it. Directions of its rim, not
                // points, agree with those of `direction` on the smallest circle.
                let (one, other) = (along_rim(a, normal), along_rim(b, normal));
                sweep += libm::atan2(normal.dot(one.cross(other)), one.dot(other));
            }
        }
        [sweep, area, angle]
    }

    /// Directions of the rim where it leaves the ball, less those where it enters.
    fn turns(&self, normal: Vector) -> f64 {
        let through = self.stations[..self.count].iter().filter(|station| station.through);
        let turn = |station: &Station| direction(station.place, normal);
        through.map(|station| if station.within { -turn(station) } else { turn(station) }).sum()
    }
}

impl Cut {
    /// Adds a face with this outward unit normal.
    pub(super) fn add(&mut self, corners: [Corner; 3], normal: Vector) {
        let height = normal.dot(corners[0].place);
        let nothing = Station { place: Vector::zero(), within: false, through: false };
        let mut rim = Rim { stations: [nothing; 9], count: 0 };
        for edge in 0..3 {
            rim.add_edge(corners[edge], corners[(edge + 1) % 3]);
        }
        // A plane that only touches the ball counts where an edge in it goes through the sphere: its neighbour counts that edge.
        let whole = !rim.stations[..rim.count].iter().any(|station| station.through);
        if height.abs() >= 1.0 && whole {
            return;
        }
        let [mut sweep, straight, angle] = rim.measures(normal, height);
        if whole {
            sweep = TAU * (sweep / TAU).round();
        }
        let area = straight + 0.5 * (1.0 - height) * (1.0 + height) * sweep;
        self.cone += height * area;
        self.turned += height * sweep + rim.turns(normal);
        self.angle += angle + (1.0_f64.copysign(height) - height) * sweep;
    }

    /// The volume of the part of the ball that is inside, where the area of the sphere inside is about so much; nothing if that
    /// contradicts the rim of this area.
    pub(super) fn volume(&self, about: f64) -> Option<f64> {
        let turns = ((about - self.turned) / TAU).round();
        let area = self.turned + TAU * turns;
        let agrees = (area - about).abs() < AGREE && (-AGREE..2.0 * TAU + AGREE).contains(&area);
        agrees.then(|| (self.cone + area.clamp(0.0, 2.0 * TAU)) / 3.0)
    }
}

/// How far the two areas of a sphere of radius 1 may be from each other: both are off by rounding, and one is that of a sphere beside.
const AGREE: f64 = 0.3;

/// The direction p × n of a rim at a point, of any length; where it has none, one that depends on p and n alone.
fn along_rim(point: Vector, normal: Vector) -> Vector {
    let rim = point.cross(normal);
    if rim.dot(rim) > 0.0 { rim } else { across(normal) }
}

/// A direction across another one, of any length.
fn across(way: Vector) -> Vector {
    let parts = way.to_array();
    let least = (0..3).fold(0, |least, axis| if parts[axis].abs() < parts[least].abs() { axis } else { least });
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    way.cross(axis.into())
}

/// The direction of a rim at a point of the sphere, as an angle from a direction across p \[rad\].
fn direction(point: Vector, normal: Vector) -> f64 {
    let (first, rim) = (across(point), along_rim(point, normal));
    libm::atan2(first.cross(rim).dot(point), first.dot(rim))
}
