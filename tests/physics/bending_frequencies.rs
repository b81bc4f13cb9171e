//! A clamped chain swings with its own eigenfrequencies, and a long one with those of a Timoshenko beam that ends half a
//! bond behind its last centre.

use crate::physics::chain::{BENDING, CLAMP, INERTIA, LENGTH, MASS, Motion, SHEAR, chain, in_order};
use crate::physics::stage::assert_close;
use crate::support::start;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Longest time step \[s\], and looks in a period of the third mode: velocity Verlet shifts a frequency by (ω Δt)²/24 of
/// itself, which is 1.0e-4 at most.
const LONGEST: f64 = 1e-6;
const LOOKS: f64 = 128.0;

/// How many of the lowest modes are looked at.
const MODES: usize = 3;

/// Eigenfrequencies of the chain, rising \[rad/s\], and its modes in deflection and inclination, scaled so that the mass
/// matrix is the identity: deflections stand first, inclinations behind them.
fn modes(bonds: usize) -> (Vec<f64>, DMatrix<f64>) {
    let size = 2 * bonds;
    let scale = DVector::from_fn(size, |place, _| 1.0 / if place < bonds { MASS } else { INERTIA }.sqrt());
    let mut stiffness = DMatrix::zeros(size, size);
    for bond in 0..bonds {
        // Strains of the bond between the spheres bond − 1 (the clamp is −1) and bond: shear, and bending.
        let (mut shear, mut bending) = (DVector::zeros(size), DVector::zeros(size));
        for (sphere, sign) in [(bond.wrapping_sub(1), -1.0), (bond, 1.0)] {
            if sphere < bonds {
                shear[sphere] = sign;
                shear[bonds + sphere] = -0.5 * LENGTH;
                bending[bonds + sphere] = sign;
            }
        }
        stiffness += &shear * shear.transpose() * SHEAR + &bending * bending.transpose() * BENDING;
    }
    let scaled = DMatrix::from_diagonal(&scale) * stiffness * DMatrix::from_diagonal(&scale);
    let eigen = scaled.symmetric_eigen();
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let vectors: Vec<_> = order.iter().map(|&mode| eigen.eigenvectors.column(mode).component_mul(&scale)).collect();
    (order.iter().map(|&mode| eigen.eigenvalues[mode].sqrt()).collect(), DMatrix::from_columns(&vectors))
}

/// Angular frequencies with which the lowest modes swing, from the times of their zeros \[rad/s\].
///
/// All start together with velocities alone; each is told from the others by its shape.
fn found(bonds: usize, formulation: &str) -> [f64; MODES] {
    let (frequencies, shapes) = modes(bonds);
    // Speeds that give each mode the same largest deflection, a millionth of the length.
    let speed = |mode: usize| 1e-6 * LENGTH * bonds as f64 * frequencies[mode] / shapes.column(mode).amax();
    let motion = |sphere: usize| -> Motion {
        let sum = |row: usize| (0..MODES).map(|mode| speed(mode) * shapes[(row, mode)]).sum::<f64>();
        // The inclination w′ is a rotation about −y.
        [[0.0, 0.0, sum(sphere)], [0.0, -sum(bonds + sphere), 0.0]]
    };
    let motions: Vec<Motion> = std::iter::once([[0.0; 3]; 2]).chain((0..bonds).map(motion)).collect();
    let interval = 2.0 * PI / frequencies[MODES - 1] / LOOKS;
    let mut simulation = start(&chain(formulation, interval.min(LONGEST), &motions, CLAMP));
    let end = 2.1 * 2.0 * PI / frequencies[0];
    let mut zeros: [Vec<f64>; MODES] = Default::default();
    let mut before = [0.0; MODES];
    while simulation.time() < end {
        simulation.advance(interval).unwrap();
        let velocity: Vec<_> = in_order(&simulation, &simulation.state().particles.velocity).skip(1).collect();
        let spin: Vec<_> = in_order(&simulation, &simulation.state().particles.angular_velocity).skip(1).collect();
        for mode in 0..MODES {
            let shape = shapes.column(mode);
            let part = |sphere: usize| {
                MASS * shape[sphere] * velocity[sphere][2] - INERTIA * shape[bonds + sphere] * spin[sphere][1]
            };
            let now = (0..bonds).map(part).sum::<f64>();
            if now * before[mode] < 0.0 {
                zeros[mode].push(simulation.time() - interval * now / (now - before[mode]));
            }
            before[mode] = now;
        }
    }
    zeros.map(|zeros| PI * (zeros.len() - 1) as f64 / (zeros[zeros.len() - 1] - zeros[0]))
}

/// The lowest angular frequencies of a clamped Timoshenko beam of this length \[rad/s\], with the chain's mass, rotary
/// inertia and stiffnesses spread evenly: roots of the characteristic equation of Huang (1961), J. Appl. Mech. 28, 579.
fn timoshenko(length: f64) -> [f64; MODES] {
    let (flexural, shear) = (BENDING * LENGTH, SHEAR * LENGTH);
    let (mass, inertia) = (MASS / LENGTH, INERTIA / LENGTH);
    let rotary = inertia / (mass * length * length);
    let sheared = flexural / (shear * length * length);
    let equation = |frequency: f64| {
        let square = mass * length.powi(4) * frequency * frequency / flexural;
        let root = ((rotary - sheared).powi(2) + 4.0 / square).sqrt();
        let [alpha, beta] = [root - rotary - sheared, root + rotary + sheared].map(|part| (part / 2.0).sqrt());
        let b = square.sqrt();
        let product = (b * alpha).cosh() * (b * beta).cos();
        let odd = (b * alpha).sinh() * (b * beta).sin() * b * (rotary + sheared);
        2.0 + (square * (rotary - sheared).powi(2) + 2.0) * product - odd / (1.0 - square * rotary * sheared).sqrt()
    };
    // Between roots of the Euler beam's equation, βL = 0, π, 2π and 3π: those of this one lie below it.
    let euler = |root: f64| root * root * (flexural / (mass * length.powi(4))).sqrt();
    std::array::from_fn(|mode| {
        let (mut low, mut high) = (euler((mode as f64 * PI).max(0.1)), euler((mode as f64 + 1.0) * PI));
        assert!(equation(low) * equation(high) < 0.0, "mode {mode} is not between these");
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if equation(low) * equation(middle) <= 0.0 { high = middle } else { low = middle }
        }
        low
    })
}

#[test]
fn the_first_three_frequencies_are_the_chains_own() {
    for formulation in ["finite_rotation", "incremental"] {
        for bonds in [3, 10, 40] {
            let (frequencies, _) = modes(bonds);
            for (mode, found) in found(bonds, formulation).into_iter().enumerate() {
                let what = format!("{formulation}, {bonds} bonds, mode {}", mode + 1);
                assert_close(found, frequencies[mode], 1.1e-4, &what);
            }
        }
    }
}

#[test]
fn a_chain_of_forty_bonds_swings_as_a_timoshenko_beam() {
    let beam = timoshenko(40.5 * LENGTH);
    for (mode, found) in found(40, "finite_rotation").into_iter().enumerate() {
        assert_close(found, beam[mode], 5e-3, &format!("mode {}", mode + 1));
    }
}
