//! How bonds change with a few inputs: their law over numbers with slopes, on a register's worth of bonds at a time.

use super::BondPass;
use super::walls::WallBondPass;
use crate::bond::{Body, Coefficients, Law, Pair, Quaternion, Remembered, Sloped};
use crate::dual::{Dual, Slopes};
use crate::lanes::{Kernel, Lane, Places, columns_at, lanes_of, vectors_of};
use crate::number::Vector;
use crate::state::{BondList, Particles, State};
use crate::tangent::{AddSlopes, Alone, FollowPass, Group, InLanes, Inputs, ListSlopes, ParticleSlopes, Tangent};
use crate::tangent::{rows_at, slopes_of, spread};

/// Particles as bodies of bonds, with slopes.
#[inline(always)]
fn bodies<I: Inputs, N: Lane>(moved: &ParticleSlopes<I>, particles: &Particles, slots: &Places) -> Body<InLanes<I, N>> {
    let ([position, velocity], spin) = (moved.bodies(particles, slots), moved.spins(particles, slots));
    Body {
        position: Vector::of_row(position),
        velocity: Vector::of_row(velocity),
        spin: Vector::of_row(spin),
        orientation: moved.orientations(particles, slots),
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

/// What bonds do, with slopes; those of what they remember go on. The first so many `fixed` of their rows never change.
#[inline(always)]
fn react<I: Inputs, N: Lane>(
    law: &Law,
    coefficients: &Coefficients<InLanes<I, N>>,
    pair: &Pair<InLanes<I, N>>,
    (list, slopes, bonds, count): (&BondList, &mut ListSlopes<I>, &Places, usize),
    (remembered, fixed): (&mut Remembered<InLanes<I, N>>, usize),
) -> Sloped<I::Values<N>, I::Slopes<N>> {
    let (of_rows, of_rates) = slopes.rows.split_at_mut(list.rows.len());
    for (place, (row, values)) in remembered.rows.iter_mut().zip(&list.rows).enumerate() {
        *row = match place < fixed {
            true => Dual::constants(columns_at(values, bonds)),
            false => rows_at::<I, N>(values, &of_rows[place], bonds),
        };
    }
    for (row, (values, slopes)) in remembered.rates.iter_mut().zip(list.rate_columns().iter().zip(&*of_rates)) {
        *row = rows_at::<I, N>(values, slopes, bonds);
    }
    let found = law.react_with_slopes(coefficients, pair, remembered);
    let of_rows = of_rows.iter_mut().zip(&remembered.rows).skip(fixed);
    for (slopes, row) in of_rows.chain(of_rates.iter_mut().zip(&remembered.rates)) {
        I::put::<N>(slopes_of::<I, N>(*row), slopes, bonds.first(count));
    }
    let mut broken = found.broken & ((1 << count) - 1);
    while broken != 0 {
        let bond = bonds.at(broken.trailing_zeros() as usize);
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
        let mut remembered = Remembered::room();
        for first in (0..list.first.len()).step_by(I::Values::<N>::WIDTH) {
            let Group { entries, bodies: [i, j], count } =
                Group::from::<I::Values<N>>([&list.first, &list.second], first);
            if moved.reached(i.first(count)) | moved.reached(j.first(count)) == 0 {
                continue;
            }
            let pair = Pair::of_spheres(&bodies::<I, N>(moved, particles, &i), &bodies::<I, N>(moved, particles, &j));
            let bonds = (list, &mut *slopes, &entries, count);
            let found = react::<I, N>(&pass.law, &coefficients, &pair, bonds, (&mut remembered, fixed));
            let slots = [i.first(count), j.first(count)];
            moved.press_pairs(slots, found.force);
            moved.twist_pairs(slots, [found.torque_i, found.torque_j]);
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
        let mut remembered = Remembered::room();
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
            let bonds = (list, &mut *slopes, &entries, count);
            let found = react::<I, N>(&pass.law, &coefficients, &pair, bonds, (&mut remembered, fixed));
            moved.press(slots.first(count), found.force);
            moved.twist(slots.first(count), found.torque_i);
            let arm = |lane: usize| Vector::from(list.foot[entries.at(lane)]) - pass.reference;
            let moment = found.torque_j - moving::<I, N>(vectors_of(arm), [I::Each::none(); 3]).cross(found.force);
            I::sum::<N>((-found.force).slopes(), &mut boundary.force, count);
            I::sum::<N>(moment.slopes(), &mut boundary.moment, count);
        }
    }
}
