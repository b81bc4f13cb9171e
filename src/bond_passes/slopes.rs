//! How bonds change with a few inputs: their law over numbers with slopes, on a register's worth of bonds at a time.

use super::BondPass;
use super::walls::WallBondPass;
use crate::bond::{Answer, Body, Coefficients, Law, Pair, Quaternion, Remembered, Sloped};
use crate::dual::Dual;
use crate::lanes::{self, Kernel, Lane, Places, columns_at, columns_from, lanes_of, put_at, rows_from, vectors_of};
use crate::number::Vector;
use crate::state::{BondList, Particles, Row, State};
use crate::tangent::{AddSlopes, FollowPass, Group, ListSlopes, Moving, ParticleSlopes, Tangent};
use crate::tangent::{rows_at, slopes_of, spread, sum, vector_slopes, with_slopes};

/// Particles as bodies of bonds, with slopes.
#[inline(always)]
fn bodies<N: Lane>(moved: &ParticleSlopes, particles: &Particles, slots: &Places) -> Body<Dual<N>> {
    let moving = Moving::of(&particles.position, &particles.velocity, &particles.angular_velocity);
    let [position, velocity] = moved.bodies(&moving, slots);
    body::<N>([position, velocity, moved.spins(&moving, slots)], moved.orientations(particles, slots))
}

/// A body of each bond, by positions with radii, velocities with masses, angular velocities with moments of inertia; and
/// orientations. (Closures would not always be compiled for the features of the registers.)
#[inline(always)]
fn body<N: Lane>([position, velocity, spin]: [[Dual<N>; 4]; 3], orientation: Quaternion<Dual<N>>) -> Body<Dual<N>> {
    Body {
        position: Vector::of_row(position),
        velocity: Vector::of_row(velocity),
        spin: Vector::of_row(spin),
        orientation,
        radius: position[3],
        mass: velocity[3],
        inertia: spin[3],
    }
}

/// The numbers of a law at a time step of this length \[s\].
#[inline(always)]
fn at_step<N: Lane>(law: &Law, step: Dual) -> Coefficients<Dual<N>> {
    Coefficients { step: spread::<N>(step), ..law.elasticity.at_step(step.value) }
}

/// Vectors, given as columns, that all change in the same way.
#[inline(always)]
fn moving<N: Lane>([x, y, z]: [N; 3], [dx, dy, dz]: [[f64; 1]; 3]) -> Vector<Dual<N>> {
    let slopes = [[N::splat(dx[0])], [N::splat(dy[0])], [N::splat(dz[0])]];
    Dual::vector(Vector::new(x, y, z), slopes)
}

/// Two particles as a pair of each bond, with slopes.
#[inline(always)]
fn pairs<N: Lane>(moved: &ParticleSlopes, particles: &Particles, [i, j]: [&Places; 2]) -> Pair<Dual<N>> {
    let moving = Moving::of(&particles.position, &particles.velocity, &particles.angular_velocity);
    let (positions, velocities) = (moved.positions::<N>(&moving, i, j), moved.velocities::<N>(&moving, i, j));
    let first = body::<N>([positions[0], velocities[0], moved.spins(&moving, i)], moved.orientations(particles, i));
    let second = body::<N>([positions[1], velocities[1], moved.spins(&moving, j)], moved.orientations(particles, j));
    Pair::of_spheres(&first, &second)
}

/// Room for what some bonds remember and do.
struct Room<N: Lane> {
    /// What they remember.
    remembered: Remembered<Dual<N>>,
    /// What their formulation answers.
    answer: Answer<Dual<N>>,
}

impl<N: Lane> Room<N> {
    /// Empty.
    #[inline(always)]
    fn new() -> Self {
        Self { remembered: Remembered::room(), answer: Answer::room() }
    }
}

/// Some bonds of a list, one after another from the first on: as many as there are lanes, or the last ones.
#[derive(Clone, Copy)]
struct Bonds<'a> {
    /// The list.
    list: &'a BondList,
    /// The first.
    first: usize,
    /// How many there are.
    count: usize,
}

impl Bonds<'_> {
    /// A row of theirs: values and slopes.
    #[inline(always)]
    fn row<N: Lane>(&self, values: &[Row], slopes: &[Row]) -> [Dual<N>; 4] {
        if self.count == N::WIDTH {
            return with_slopes::<N>(columns_from(values, self.first), columns_from(slopes, self.first));
        }
        rows_at::<N>(values, slopes, &self.places())
    }

    /// A row of theirs that does not change.
    #[inline(always)]
    fn fixed_row<N: Lane>(&self, values: &[Row]) -> [Dual<N>; 4] {
        Dual::constants(match self.count == N::WIDTH {
            true => columns_from(values, self.first),
            false => columns_at(values, &self.places()),
        })
    }

    /// Writes slopes of a row of theirs.
    #[inline(always)]
    fn put<N: Lane>(&self, row: [Dual<N>; 4], slopes: &mut [Row]) {
        match self.count == N::WIDTH {
            true => rows_from(slopes_of::<N>(row), slopes, self.first),
            false => put_at(slopes_of::<N>(row), slopes, &self.places()),
        }
    }

    /// Where they stand.
    fn places(&self) -> Places {
        Places::consecutive(self.first, self.count)
    }
}

/// What bonds do, with slopes; those of what they remember go on. The first so many `fixed` of their rows never change.
#[inline(always)]
fn react<N: Lane>(
    law: &Law,
    coefficients: &Coefficients<Dual<N>>,
    pair: &Pair<Dual<N>>,
    (bonds, slopes): (Bonds, &mut ListSlopes),
    (room, fixed): (&mut Room<N>, usize),
) -> Sloped<N, [N; 1]> {
    let (Room { remembered, answer }, list) = (room, bonds.list);
    let (of_rows, of_rates) = slopes.rows.split_at_mut(list.rows.len());
    for (place, (row, values)) in remembered.rows.iter_mut().zip(&list.rows).enumerate() {
        *row = match place < fixed {
            true => bonds.fixed_row::<N>(values),
            false => bonds.row::<N>(values, &of_rows[place]),
        };
    }
    for (row, (values, slopes)) in remembered.rates.iter_mut().zip(list.rate_columns().iter().zip(&*of_rates)) {
        *row = bonds.row::<N>(values, slopes);
    }
    let found = law.react_with_slopes(coefficients, pair, remembered, answer);
    let of_rows = of_rows.iter_mut().zip(&remembered.rows).skip(fixed);
    for (slopes, row) in of_rows.chain(of_rates.iter_mut().zip(&remembered.rates)) {
        bonds.put::<N>(*row, slopes);
    }
    let mut broken = found.broken & ((1 << bonds.count) - 1);
    while broken != 0 {
        let bond = bonds.first + broken.trailing_zeros() as usize;
        slopes.rows.iter_mut().for_each(|rows| rows[bond] = [0.0; 4]);
        broken &= broken - 1;
    }
    found
}

impl FollowPass for BondPass {
    fn add_slopes(&self, state: &State, tangent: &mut Tangent, step: Dual) {
        lanes::run_seldom(tangent.width, AddSlopes { pass: self, state, tangent, step });
    }
}

impl FollowPass for WallBondPass {
    fn add_slopes(&self, state: &State, tangent: &mut Tangent, step: Dual) {
        lanes::run_seldom(tangent.width, AddSlopes { pass: self, state, tangent, step });
    }
}

impl Kernel for AddSlopes<'_, &BondPass> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { pass, state, tangent, step } = self;
        let (list, particles) = (&state.bonds[pass.index], &state.particles);
        let (slopes, moved) = (&mut tangent.bonds[pass.index], &mut tangent.particles);
        let (coefficients, fixed) = (at_step::<N>(&pass.law, step), pass.law.one_bond().fixed_rows);
        let mut room = Room::<N>::new();
        for first in (0..list.first.len()).step_by(N::WIDTH) {
            let count = usize::min(list.first.len() - first, N::WIDTH);
            let some = first..first + count;
            let (i, j) = (Places::of(&list.first[some.clone()]), Places::of(&list.second[some]));
            if moved.reached(i.first(count)) | moved.reached(j.first(count)) == 0 {
                continue;
            }
            let pair = pairs::<N>(moved, particles, [&i, &j]);
            let bonds = (Bonds { list, first, count }, &mut *slopes);
            let found = react::<N>(&pass.law, &coefficients, &pair, bonds, (&mut room, fixed));
            moved.press_pairs([&i, &j], (count, (1 << count) - 1), found.force);
            moved.twist_pairs([&i, &j], count, [found.torque_i, found.torque_j]);
        }
    }
}

impl Kernel for AddSlopes<'_, &WallBondPass> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { pass, state, tangent, step } = self;
        let (list, particles) = (&state.bonds[pass.index], &state.particles);
        let Tangent { particles: moved, bonds, boundaries, .. } = tangent;
        let (slopes, boundary) = (&mut bonds[pass.index], &mut boundaries[pass.boundary.index()]);
        let (coefficients, moves) = (at_step::<N>(&pass.law, step), boundary.is_moved());
        let fixed = pass.law.one_bond().fixed_rows;
        let mut room = Room::<N>::new();
        for first in (0..list.first.len()).step_by(N::WIDTH) {
            let Group { entries, bodies: [slots], count } = Group::from::<N>([&list.first], first);
            if !moves && moved.reached(slots.first(count)) == 0 {
                continue;
            }
            let place = &state.boundaries[pass.boundary.index()];
            let mut at = [pass.foot(list.foot[entries.at(0)], place); 8];
            for (lane, at) in at.iter_mut().enumerate() {
                *at = pass.foot(list.foot[entries.at(lane)], place);
            }
            let foot = Body {
                position: moving::<N>(vectors_of(|lane| at[lane].position), boundary.displacement),
                velocity: moving::<N>(vectors_of(|lane| at[lane].velocity), boundary.velocity),
                spin: Vector::zero(),
                orientation: Quaternion::identity(),
                radius: Dual::constant(lanes_of(|lane| at[lane].radius)),
                mass: Dual::constant(lanes_of(|lane| at[lane].mass)),
                inertia: Dual::constant(lanes_of(|lane| at[lane].inertia)),
            };
            let pair = Pair::at_wall(&bodies::<N>(moved, particles, &slots), &foot);
            let bonds = (Bonds { list, first, count }, &mut *slopes);
            let found = react::<N>(&pass.law, &coefficients, &pair, bonds, (&mut room, fixed));
            moved.press(&slots, (count, (1 << count) - 1), found.force);
            moved.twist(&slots, count, found.torque_i);
            let arm = |lane: usize| Vector::from(list.foot[entries.at(lane)]) - pass.reference;
            let moment = found.torque_j - moving::<N>(vectors_of(arm), [[0.0]; 3]).cross(found.force);
            sum(vector_slopes(-found.force), &mut boundary.force, count);
            sum(vector_slopes(moment), &mut boundary.moment, count);
        }
    }
}
