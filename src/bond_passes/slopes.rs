//! How bonds change with a few inputs: their law over numbers with slopes, on a register's worth of bonds at a time.

use super::BondPass;
use super::walls::WallBondPass;
use crate::bond::{Answer, Body, Coefficients, Law, Pair, Quaternion, Remembered, Sloped};
use crate::dual::{Dual, Slopes};
use crate::lanes::{Kernel, Lane, Places, columns_at, columns_from, lanes_of, vectors_of};
use crate::number::Vector;
use crate::state::{BondList, Particles, Row, State};
use crate::tangent::{
    AddSlopes, Alone, FollowPass, Group, InLanes, Inputs, ListSlopes, Moving, ParticleSlopes, Tangent,
};
use crate::tangent::{rows_at, slopes_of, spread, with_slopes};

/// Particles as bodies of bonds, with slopes.
#[inline(always)]
fn bodies<I: Inputs, N: Lane>(moved: &ParticleSlopes<I>, particles: &Particles, slots: &Places) -> Body<InLanes<I, N>> {
    let moving = Moving::of(&particles.position, &particles.velocity, &particles.angular_velocity);
    let [position, velocity] = moved.bodies(&moving, slots);
    body::<I, N>([position, velocity, moved.spins(&moving, slots)], moved.orientations(particles, slots))
}

/// A body of each bond, by positions with radii, velocities with masses, angular velocities with moments of inertia; and
/// orientations. (Closures would not always be compiled for the features of the registers.)
#[inline(always)]
fn body<I: Inputs, N: Lane>(
    [position, velocity, spin]: [[InLanes<I, N>; 4]; 3],
    orientation: Quaternion<InLanes<I, N>>,
) -> Body<InLanes<I, N>> {
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
fn at_step<I: Inputs, N: Lane>(law: &Law, step: Alone<I>) -> Coefficients<InLanes<I, N>> {
    Coefficients { step: spread::<I, N>(step), ..law.elasticity.at_step(step.value) }
}

/// Vectors, given as columns, that all change in the same way.
#[inline(always)]
fn moving<I: Inputs, N: Lane>([x, y, z]: [I::Values<N>; 3], [dx, dy, dz]: [I::Each; 3]) -> Vector<InLanes<I, N>> {
    let slopes = [I::spread::<N>(dx), I::spread::<N>(dy), I::spread::<N>(dz)];
    Dual::vector(Vector::new(x, y, z), slopes)
}

/// Two particles as a pair of each bond, with slopes.
#[inline(always)]
fn pairs<I: Inputs, N: Lane>(
    moved: &ParticleSlopes<I>,
    particles: &Particles,
    [i, j]: [&Places; 2],
) -> Pair<InLanes<I, N>> {
    let moving = Moving::of(&particles.position, &particles.velocity, &particles.angular_velocity);
    let (positions, velocities) = (moved.positions::<N>(&moving, i, j), moved.velocities::<N>(&moving, i, j));
    let first = body::<I, N>([positions[0], velocities[0], moved.spins(&moving, i)], moved.orientations(particles, i));
    let second = body::<I, N>([positions[1], velocities[1], moved.spins(&moving, j)], moved.orientations(particles, j));
    Pair::of_spheres(&first, &second)
}

/// Room for what some bonds remember and do.
struct Room<I: Inputs, N: Lane> {
    /// What they remember.
    remembered: Remembered<InLanes<I, N>>,
    /// What their formulation answers.
    answer: Answer<InLanes<I, N>>,
}

impl<I: Inputs, N: Lane> Room<I, N> {
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
    fn row<I: Inputs, N: Lane>(&self, values: &[Row], slopes: &[I::Row]) -> [InLanes<I, N>; 4] {
        if self.count == I::Values::<N>::WIDTH {
            return with_slopes::<I, N>(columns_from(values, self.first), I::rows_from::<N>(slopes, self.first));
        }
        rows_at::<I, N>(values, slopes, &self.places())
    }

    /// A row of theirs that does not change.
    #[inline(always)]
    fn fixed_row<I: Inputs, N: Lane>(&self, values: &[Row]) -> [InLanes<I, N>; 4] {
        Dual::constants(match self.count == I::Values::<N>::WIDTH {
            true => columns_from(values, self.first),
            false => columns_at(values, &self.places()),
        })
    }

    /// Writes slopes of a row of theirs.
    #[inline(always)]
    fn put<I: Inputs, N: Lane>(&self, row: [InLanes<I, N>; 4], slopes: &mut [I::Row]) {
        match self.count == I::Values::<N>::WIDTH {
            true => I::put_from::<N>(slopes_of::<I, N>(row), slopes, self.first),
            false => I::put::<N>(slopes_of::<I, N>(row), slopes, &self.places()),
        }
    }

    /// Where they stand.
    fn places(&self) -> Places {
        Places::consecutive(self.first, self.count)
    }
}

/// What bonds do, with slopes; those of what they remember go on. The first so many `fixed` of their rows never change.
#[inline(always)]
fn react<I: Inputs, N: Lane>(
    law: &Law,
    coefficients: &Coefficients<InLanes<I, N>>,
    pair: &Pair<InLanes<I, N>>,
    (bonds, slopes): (Bonds, &mut ListSlopes<I>),
    (room, fixed): (&mut Room<I, N>, usize),
) -> Sloped<I::Values<N>, I::Slopes<N>> {
    let (Room { remembered, answer }, list) = (room, bonds.list);
    let (of_rows, of_rates) = slopes.rows.split_at_mut(list.rows.len());
    for (place, (row, values)) in remembered.rows.iter_mut().zip(&list.rows).enumerate() {
        *row = match place < fixed {
            true => bonds.fixed_row::<I, N>(values),
            false => bonds.row::<I, N>(values, &of_rows[place]),
        };
    }
    for (row, (values, slopes)) in remembered.rates.iter_mut().zip(list.rate_columns().iter().zip(&*of_rates)) {
        *row = bonds.row::<I, N>(values, slopes);
    }
    let found = law.react_with_slopes(coefficients, pair, remembered, answer);
    let of_rows = of_rows.iter_mut().zip(&remembered.rows).skip(fixed);
    for (slopes, row) in of_rows.chain(of_rates.iter_mut().zip(&remembered.rates)) {
        bonds.put::<I, N>(*row, slopes);
    }
    let mut broken = found.broken & ((1 << bonds.count) - 1);
    while broken != 0 {
        let bond = bonds.first + broken.trailing_zeros() as usize;
        slopes.rows.iter_mut().for_each(|rows| rows[bond] = I::NONE);
        broken &= broken - 1;
    }
    found
}

impl<I: Inputs> FollowPass<I> for BondPass {
    fn add_slopes(&self, state: &State, tangent: &mut Tangent<I>, step: Alone<I>) {
        I::run(tangent.width, AddSlopes { pass: self, state, tangent, step });
    }
}

impl<I: Inputs> FollowPass<I> for WallBondPass {
    fn add_slopes(&self, state: &State, tangent: &mut Tangent<I>, step: Alone<I>) {
        I::run(tangent.width, AddSlopes { pass: self, state, tangent, step });
    }
}

impl<I: Inputs> Kernel for AddSlopes<'_, &BondPass, I> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { pass, state, tangent, step } = self;
        let (list, particles) = (&state.bonds[pass.index], &state.particles);
        let (slopes, moved) = (&mut tangent.bonds[pass.index], &mut tangent.particles);
        let (coefficients, fixed) = (at_step::<I, N>(&pass.law, step), pass.law.one_bond().fixed_rows);
        let mut room = Room::<I, N>::new();
        for first in (0..list.first.len()).step_by(I::Values::<N>::WIDTH) {
            let count = usize::min(list.first.len() - first, I::Values::<N>::WIDTH);
            let some = first..first + count;
            let (i, j) = (Places::of(&list.first[some.clone()]), Places::of(&list.second[some]));
            if moved.reached(i.first(count)) | moved.reached(j.first(count)) == 0 {
                continue;
            }
            let pair = pairs::<I, N>(moved, particles, [&i, &j]);
            let bonds = (Bonds { list, first, count }, &mut *slopes);
            let found = react::<I, N>(&pass.law, &coefficients, &pair, bonds, (&mut room, fixed));
            moved.press_pairs([&i, &j], (count, (1 << count) - 1), found.force);
            moved.twist_pairs([&i, &j], count, [found.torque_i, found.torque_j]);
        }
    }
}

impl<I: Inputs> Kernel for AddSlopes<'_, &WallBondPass, I> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { pass, state, tangent, step } = self;
        let (list, particles) = (&state.bonds[pass.index], &state.particles);
        let Tangent { particles: moved, bonds, boundaries, .. } = tangent;
        let (slopes, boundary) = (&mut bonds[pass.index], &mut boundaries[pass.boundary.index()]);
        let (coefficients, moves) = (at_step::<I, N>(&pass.law, step), boundary.is_moved());
        let fixed = pass.law.one_bond().fixed_rows;
        let mut room = Room::<I, N>::new();
        for first in (0..list.first.len()).step_by(I::Values::<N>::WIDTH) {
            let Group { entries, bodies: [slots], count } = Group::from::<I::Values<N>>([&list.first], first);
            if !moves && moved.reached(slots.first(count)) == 0 {
                continue;
            }
            let place = &state.boundaries[pass.boundary.index()];
            let mut at = [pass.foot(list.foot[entries.at(0)], place); 8];
            for (lane, at) in at.iter_mut().enumerate() {
                *at = pass.foot(list.foot[entries.at(lane)], place);
            }
            let foot = Body {
                position: moving::<I, N>(vectors_of(|lane| at[lane].position), boundary.displacement),
                velocity: moving::<I, N>(vectors_of(|lane| at[lane].velocity), boundary.velocity),
                spin: Vector::zero(),
                orientation: Quaternion::identity(),
                radius: Dual::constant(lanes_of(|lane| at[lane].radius)),
                mass: Dual::constant(lanes_of(|lane| at[lane].mass)),
                inertia: Dual::constant(lanes_of(|lane| at[lane].inertia)),
            };
            let pair = Pair::at_wall(&bodies::<I, N>(moved, particles, &slots), &foot);
            let bonds = (Bonds { list, first, count }, &mut *slopes);
            let found = react::<I, N>(&pass.law, &coefficients, &pair, bonds, (&mut room, fixed));
            moved.press(&slots, count, found.force);
            moved.twist(&slots, count, found.torque_i);
            let arm = |lane: usize| Vector::from(list.foot[entries.at(lane)]) - pass.reference;
            let moment = found.torque_j - moving::<I, N>(vectors_of(arm), [I::Each::none(); 3]).cross(found.force);
            I::sum::<N>((-found.force).slopes(), &mut boundary.force, count);
            I::sum::<N>(moment.slopes(), &mut boundary.moment, count);
        }
    }
}
