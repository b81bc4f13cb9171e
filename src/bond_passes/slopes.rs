//! How bonds change with a few inputs.

use super::BondPass;
use super::walls::WallBondPass;
use crate::bond::{Body, Coefficients, Law, MOST_ROWS, Pair, Quaternion, Rows, Sloped};
use crate::dual::Dual;
use crate::lanes::{Kernel, Lane, run};
use crate::number::{Number, Vector};
use crate::state::{BondList, Particles, State};
use crate::tangent::{AddSlopes, ListSlopes, NONE, ParticleSlopes, Tangent};

/// A particle as a body of a bond, with slopes.
#[inline(always)]
fn body<N: Lane>(moved: &ParticleSlopes, particles: &Particles, slot: usize) -> Body<Dual<N>> {
    let ([position, velocity], spin) = (moved.body(particles, slot), moved.spin(particles, slot));
    let orientation = match (particles.orientation.get(slot), moved.orientation.get(slot)) {
        (Some(row), Some(slopes)) => Quaternion::from_row(Dual::row(*row, slopes)),
        _ => Quaternion::identity(),
    };
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
    Coefficients { step: Dual::new(step.value, &step.slopes), ..law.elasticity.at_step(step.value) }
}

/// What a bond does, with slopes; those of its rows go on. The first so many `fixed` rows never change. `rows` is room for them.
#[inline(always)]
fn react<N: Lane>(
    law: &Law,
    coefficients: &Coefficients<Dual<N>>,
    pair: &Pair<Dual<N>>,
    rows: &mut Rows<Dual<N>>,
    (list, slopes, bond, fixed): (&BondList, &mut ListSlopes, usize, usize),
) -> Option<Sloped<N>> {
    for (place, (row, values)) in rows.iter_mut().zip(&list.rows).enumerate() {
        *row = match place < fixed {
            true => values[bond].map(Dual::splat),
            false => Dual::row(values[bond], &slopes.rows[place][bond]),
        };
    }
    let found = law.react_with_slopes(coefficients, pair, rows);
    for (slopes, row) in slopes.rows.iter_mut().zip(&*rows).skip(fixed) {
        slopes[bond] = if found.is_some() { Dual::slopes_of(*row) } else { NONE };
    }
    found
}

impl BondPass {
    /// Adds the slopes of its loads to those of the particles.
    pub(super) fn add_bond_slopes(&self, state: &State, tangent: &mut Tangent, step: Dual) {
        run(tangent.width, AddSlopes { pass: self, state, tangent, step });
    }
}

impl WallBondPass {
    /// Adds the slopes of its loads to those of the particles and the plane.
    pub(super) fn add_bond_slopes(&self, state: &State, tangent: &mut Tangent, step: Dual) {
        run(tangent.width, AddSlopes { pass: self, state, tangent, step });
    }
}

impl Kernel for AddSlopes<'_, &BondPass> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { pass, state, tangent, step } = self;
        let (list, particles) = (&state.bonds[pass.index], &state.particles);
        let (slopes, moved) = (&mut tangent.bonds[pass.index], &mut tangent.particles);
        let (coefficients, fixed) = (at_step::<N>(&pass.law, step), pass.law.one_bond().fixed_rows);
        let mut rows = [[Dual::zero(); 4]; MOST_ROWS];
        for (bond, (&i, &j)) in list.first.iter().zip(&list.second).enumerate() {
            let (i, j) = (i as usize, j as usize);
            if !moved.reached[i] && !moved.reached[j] {
                continue;
            }
            let pair = Pair::of_spheres(&body(moved, particles, i), &body(moved, particles, j));
            if let Some(found) = react(&pass.law, &coefficients, &pair, &mut rows, (list, slopes, bond, fixed)) {
                moved.load(i, found.force, found.torque_i);
                moved.load(j, -found.force, found.torque_j);
            }
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
        let mut rows = [[Dual::zero(); 4]; MOST_ROWS];
        for (bond, &slot) in list.first.iter().enumerate() {
            let slot = slot as usize;
            if !moves && !moved.reached[slot] {
                continue;
            }
            let at = pass.foot(list.foot[bond], &state.boundaries[pass.boundary.index()]);
            let foot = Body {
                position: Dual::vector(at.position, &boundary.displacement),
                velocity: Dual::vector(at.velocity, &boundary.velocity),
                spin: Vector::zero(),
                orientation: Quaternion::identity(),
                radius: Dual::splat(at.radius),
                mass: Dual::splat(at.mass),
                inertia: Dual::splat(at.inertia),
            };
            let pair = Pair::at_wall(&body(moved, particles, slot), &foot);
            if let Some(found) = react(&pass.law, &coefficients, &pair, &mut rows, (list, slopes, bond, fixed)) {
                moved.load(slot, found.force, found.torque_i);
                let arm = Vector::from(list.foot[bond]) - pass.reference;
                let arm = Vector::new(Dual::splat(arm.x), Dual::splat(arm.y), Dual::splat(arm.z));
                boundary.add_load(&(-found.force).slopes(), &(found.torque_j - arm.cross(found.force)).slopes());
            }
        }
    }
}
