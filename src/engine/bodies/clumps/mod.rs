//! Clumps: bodies whose spheres have their places by a shape, many of them, moved in lanes (`motion`).

mod check;
mod motion;
mod strikers;

pub(crate) use check::{check, is_made};
pub(crate) use strikers::Striker;

use crate::base::geometry::Quaternion;
use crate::base::number::Vector;
use crate::base::threads::CHUNK;
use crate::engine::bodies::{Body, Rigid};
use crate::engine::state::{ClumpRows, Clumps, Row};
use crate::scene::{Clump, Scene};

/// Clumps in one piece of work.
const PIECE: usize = CHUNK / 4;

/// What never changes of the clumps of a scene: their shapes.
pub(crate) struct ClumpBodies {
    /// Where the arms of each shape end.
    ends: Vec<u32>,
    /// From the mass centre to each sphere at scale 1, in principal axes \[m\], shape by shape.
    arms: Vec<Row>,
    /// The turn of principal axes into the own frame, of each shape.
    frames: Vec<Quaternion>,
    /// What stands for them where impacts are foreseen.
    strikers: Vec<Striker>,
}

impl ClumpBodies {
    /// Those of a scene, if it has any, now or later.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let (mut ends, mut arms) = (Vec::new(), Vec::new());
        for shape in &scene.clump_shapes {
            arms.extend((0..shape.spheres.len()).map(|sphere| Vector::from(shape.arm(sphere)).row_with(0.0)));
            ends.push(arms.len() as u32);
        }
        let frames = scene.clump_shapes.iter().map(|shape| Quaternion::from_row(shape.axes).conjugate()).collect();
        scene.has_clumps().then(|| Self { ends, arms, frames, strikers: strikers::of(scene) })
    }

    /// The clumps of a scene at time 0.
    pub(crate) fn begun(scene: &Scene) -> Clumps {
        let mut begun = Clumps::default();
        for (number, clump) in (0..).zip(&scene.clumps) {
            begun.add(&rows(scene, clump), number);
            begun.add_spheres(scene.spheres_of(clump).map(|index| index as u32));
        }
        begun
    }

    /// From the mass centre to each sphere at scale 1, of a shape, in principal axes \[m\].
    #[inline(always)]
    fn arms(&self, shape: u32) -> &[Row] {
        let shape = shape as usize;
        let start = if shape == 0 { 0 } else { self.ends[shape - 1] };
        &self.arms[start as usize..self.ends[shape] as usize]
    }

    /// What stands for all where impacts are foreseen.
    pub(crate) fn strikers(&self) -> &[Striker] {
        &self.strikers
    }
}

/// How many pieces of work so many clumps are.
pub(super) fn pieces(clumps: usize) -> usize {
    clumps.div_ceil(PIECE)
}

/// The clumps of a piece.
#[inline(always)]
pub(super) fn piece(piece: usize, clumps: usize) -> std::ops::Range<usize> {
    piece * PIECE..((piece + 1) * PIECE).min(clumps)
}

/// The rows of a clump of a scene.
pub(crate) fn rows(scene: &Scene, clump: &Clump) -> ClumpRows {
    let shape = &scene.clump_shapes[clump.shape as usize];
    let Clump { position, velocity, orientation, angular_velocity, mass, .. } = *clump;
    let length = |sphere: usize| Vector::from(clump.arm(shape, sphere)).length();
    let farthest = (0..shape.spheres.len()).map(length).fold(0.0, f64::max);
    let smallest = shape.spheres.iter().map(|(_, radius)| clump.scale * radius).fold(f64::INFINITY, f64::min);
    let turn = Quaternion::from_row(orientation);
    let [a, b, c] = turn.conjugate().turn(angular_velocity.into()).to_array();
    let [x, y, z] = clump.moments;
    ClumpRows {
        position: Vector::from(position).row_with(farthest),
        moments: [x, y, z, smallest],
        velocity: Vector::from(velocity).row_with(mass),
        orientation,
        angular_momentum: turn.turn(Vector::new(x * a, y * b, z * c)).row_with(0.0),
        angular_velocity: Vector::from(angular_velocity).row_with(0.0),
        scale: clump.scale,
        shape: clump.shape,
    }
}

/// The largest distance of the centre of a sphere from the mass centre of its clump \[m\].
pub(crate) fn farthest(clumps: &Clumps) -> f64 {
    clumps.position.iter().map(|row| row[3]).fold(0.0, f64::max)
}

/// A clump, numbered from 0, without its loads.
#[inline(always)]
pub(super) fn unloaded(clumps: &Clumps, clump: usize) -> Body<'_> {
    let none = [Vector::zero(); 2];
    Body {
        number: clump,
        rigid: Rigid {
            velocity: Vector::from(clumps.velocity[clump]),
            mass: clumps.velocity[clump][3],
            turn: Quaternion::from_row(clumps.orientation[clump]),
            inertia: Vector::from(clumps.moments[clump]),
            momentum: Vector::from(clumps.angular_momentum[clump]),
            force: none[0],
            moment: none[1],
            dashpots: [0.0; 2],
        },
        moves: [true; 3],
        point: Vector::from(clumps.position[clump]),
        mass_centre: Vector::zero(),
        members: clumps.spheres_of(clump),
        reach: clumps.position[clump][3],
        smallest: clumps.moments[clump][3],
        braking: none,
        boundary: None,
        cell: None,
    }
}

/// How a clump moves.
#[inline(always)]
fn rigid(clumps: &Clumps, clump: usize) -> Rigid {
    let rows = [clumps.force[clump], clumps.moment[clump]];
    let [force, moment] = rows.map(Vector::from);
    Rigid { force, moment, dashpots: rows.map(|row| row[3]), ..unloaded(clumps, clump).rigid }
}

/// A clump, numbered from 0.
pub(super) fn body(clumps: &Clumps, clump: usize) -> Body<'_> {
    let braking = clumps.braking.get(clump).map_or([Vector::zero(); 2], |load| load.map(Vector::from));
    Body { rigid: rigid(clumps, clump), braking, ..unloaded(clumps, clump) }
}

/// Finds the angular velocity of a clump from its angular momentum.
pub(crate) fn set_spin(clumps: &mut Clumps, clump: usize) {
    clumps.angular_velocity[clump] = rigid(clumps, clump).spin().row_with(0.0);
}

/// What kicks of these lengths \[s\] with the present load give to the angular velocity of a clump \[rad/s\].
pub(crate) fn turns(clumps: &Clumps, clump: usize, lengths: [f64; 2]) -> [Vector; 2] {
    let still = Rigid { momentum: Vector::zero(), ..rigid(clumps, clump) };
    lengths.map(|length| still.kicked(length).spin())
}

/// What half a kick of a step of this length \[s\] with the present load gives to the motion of a clump \[m/s, rad/s\].
pub(super) fn last_kick(clumps: &Clumps, clump: usize, step: f64) -> [Vector; 2] {
    let still = Rigid { velocity: Vector::zero(), momentum: Vector::zero(), ..rigid(clumps, clump) };
    let kicked = still.kicked(0.5 * step);
    [kicked.velocity, kicked.spin()]
}
