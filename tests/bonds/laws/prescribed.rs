//! Bonds under motion that is prescribed: what a turn does to a load, and how errors fall with the step.

use crate::bonds::laws::placement::{RADII, law, turn};
use cograin::bond::formulation::engine_exact::EngineExact;
use cograin::bond::formulation::finite_rotation::FiniteRotation;
use cograin::bond::formulation::incremental::Incremental;
use cograin::bond::{Body, Elastic, Elasticity, Formulation, Pair, Rows};
use cograin::number::Vector;

/// Rotation vector and position of the two bodies at a time.
type Path<'a> = &'a dyn Fn(f64) -> [(Vector, Vector); 2];

/// Goes along a path in steps, with velocities and spins of mid-step, from this state (or a bond made at the start).
fn along<F: Formulation>(
    law: &Elasticity,
    path: Path,
    rows: Option<Rows>,
    from: f64,
    to: f64,
    steps: u32,
) -> Elastic<f64> {
    let step = (to - from) / f64::from(steps);
    let pair = |now: f64, before: f64| {
        let (places, earlier) = (path(now), path(before));
        let body = |index: usize| {
            let orientation = turn(places[index].0);
            let turned = orientation * turn(earlier[index].0).conjugate();
            // Twice the arcus sine of the vector part: the turn of one step is small.
            let sine = turned.vector.length();
            let spin = turned.vector * if sine > 0.0 { 2.0 * libm::asin(sine) / (sine * step) } else { 0.0 };
            Body {
                position: places[index].1,
                velocity: (places[index].1 - earlier[index].1) * (1.0 / step),
                spin: if turned.scalar < 0.0 { -spin } else { spin },
                orientation,
                radius: RADII[index],
                mass: 1.0,
                inertia: 1.0,
            }
        };
        Pair::of_spheres(&body(0), &body(1))
    };
    let still = law.at_step(0.0);
    let moving = law.at_step(step);
    let rows = rows.unwrap_or_else(|| F::create(&still, &pair(from, from)));
    let start = pair(from, from);
    let mut answer = F::respond(&still, &start, &rows).1;
    for number in 1..=steps {
        let at = |number: u32| from + step * f64::from(number);
        let pair = pair(at(number), at(number - 1));
        answer = F::respond(&moving, &pair, &answer.rows).1;
    }
    answer
}

/// A bond along x of length 1.6 that turns at this angular velocity as a whole.
fn rigid(spin: Vector) -> impl Fn(f64) -> [(Vector, Vector); 2] {
    move |time| {
        let whole = spin * time;
        [(whole, turn(whole).turn(Vector::new(1.6, 0.0, 0.0))), (whole, Vector::zero())]
    }
}

/// State with this shear force and otherwise none, as the two rate forms keep it.
fn sheared(force: [f64; 3]) -> Rows {
    let mut rows = [[0.0; 4]; 3];
    rows[0] = [force[0], force[1], force[2], 1.6];
    rows
}

#[test]
fn a_turning_bond_loses_its_shear_in_the_engine_alone() {
    let (law, path) = (law(), rigid(Vector::new(0.0, 0.0, 1.0)));
    let turn = std::f64::consts::TAU;
    for steps in [400, 4000] {
        // What the motion itself adds is taken away: both rate forms are linear in what they store.
        let loaded = along::<EngineExact>(&law, &path, Some(sheared([0.0, 0.1, 0.0])), 0.0, turn, steps);
        let empty = along::<EngineExact>(&law, &path, Some(sheared([0.0; 3])), 0.0, turn, steps);
        let left = (loaded.shear - empty.shear).y / 0.1;
        let expected = libm::exp(-turn * turn / 2.0 / f64::from(steps));
        // The next term of the exponent is π⁴ · 4/(3 n³).
        assert!((left - expected).abs() < 2e-4 / (f64::from(steps) / 400.0), "{left} for {expected}");

        let loaded = along::<Incremental<false>>(&law, &path, Some(sheared([0.0, 0.1, 0.0])), 0.0, turn, steps);
        let empty = along::<Incremental<false>>(&law, &path, Some(sheared([0.0; 3])), 0.0, turn, steps);
        assert!(((loaded.shear - empty.shear).y / 0.1 - 1.0).abs() < 1e-11);
    }
}

#[test]
fn a_shear_force_does_not_turn_about_the_axis_in_the_engine_alone() {
    let (law, path) = (law(), rigid(Vector::new(1.0, 0.0, 0.0)));
    let quarter = std::f64::consts::FRAC_PI_2;
    let engine = along::<EngineExact>(&law, &path, Some(sheared([0.0, 0.1, 0.0])), 0.0, quarter, 90);
    assert!((engine.shear - Vector::new(0.0, 0.1, 0.0)).length() < 1e-13, "{:?}", engine.shear);
    let turned = along::<Incremental<false>>(&law, &path, Some(sheared([0.0, 0.1, 0.0])), 0.0, quarter, 90);
    assert!((turned.shear - Vector::new(0.0, 0.0, 0.1)).length() < 1e-13, "{:?}", turned.shear);

    // finite_rotation keeps no force; its load is a displacement.
    let loading = |time: f64| {
        let mut places = path(time);
        places[0].1 += turn(places[0].0).turn(Vector::new(0.0, 0.01, 0.0));
        places
    };
    let rows = <FiniteRotation<false> as Formulation>::create(&law.at_step(0.0), &pair_at_rest(&path(0.0)));
    let before = along::<FiniteRotation<false>>(&law, &loading, Some(rows), 0.0, 1e-9, 1);
    let after = along::<FiniteRotation<false>>(&law, &loading, Some(rows), 0.0, quarter, 90);
    let expected = Vector::new(before.shear.x, -before.shear.z, before.shear.y);
    assert!(before.shear.length() > 0.01);
    assert!((after.shear - expected).length() < 1e-9, "{:?} for {expected:?}", after.shear);
}

/// Two bodies at rest.
fn pair_at_rest(places: &[(Vector, Vector); 2]) -> Pair {
    let body = |index: usize| Body {
        position: places[index].1,
        velocity: Vector::zero(),
        spin: Vector::zero(),
        orientation: turn(places[index].0),
        radius: RADII[index],
        mass: 1.0,
        inertia: 1.0,
    };
    Pair::of_spheres(&body(0), &body(1))
}

#[test]
fn incremental_converges_with_the_square_of_the_step() {
    // Large motion in all six ways, with a whole turn of the pair.
    let path = |time: f64| {
        let (s, k) = (libm::sin(time), libm::cos(time));
        let whole = Vector::new(0.9, -0.4, 1.3) * time;
        let own_i = Vector::new(0.3 * s, 0.2 * (1.0 - k), -0.4 * s);
        let own_j = Vector::new(-0.5 * s, 0.3 * s, 0.2 * (1.0 - k));
        let away = Vector::new(1.6 + 0.2 * s, 0.15 * (1.0 - k), -0.2 * s);
        [(whole + own_i, turn(whole).turn(away)), (whole + own_j, Vector::new(0.1 * s, 0.0, 0.2 * time))]
    };
    let law = law();
    let end = |steps| along::<Incremental<false>>(&law, &path, None, 0.0, 3.0, steps);
    let fine = end(16_000);
    let error = |steps| {
        let found = end(steps);
        [
            (found.force - fine.force).length(),
            (found.torque_i - fine.torque_i).length(),
            (found.torque_j - fine.torque_j).length(),
        ]
    };
    for ((coarse, middle), finer) in error(250).into_iter().zip(error(500)).zip(error(1000)) {
        let ratios = [coarse / middle, middle / finer];
        assert!(ratios.iter().all(|ratio| (ratio - 4.0).abs() < 0.15), "{ratios:?} {coarse:e}");
    }
}

#[test]
fn rate_form_and_stored_energy_agree_for_small_strain() {
    // Strains of 1e-3 along a path that turns far: the difference is of second order in them.
    let law = law();
    let apart = |size: f64| {
        let path = move |time: f64| {
            let (s, k) = (size * libm::sin(time), size * (1.0 - libm::cos(2.0 * time)));
            let whole = Vector::new(0.9, -0.4, 1.3) * time;
            let [i, j] = [Vector::new(s, k, -s), Vector::new(-k, s, k)];
            let away = Vector::new(1.6 + s, k, -s);
            // The own turns first, then that of the pair: a rotation vector for each through the product.
            [(compose(whole, i), turn(whole).turn(away)), (compose(whole, j), Vector::zero())]
        };
        let one = along::<Incremental<false>>(&law, &path, None, 0.0, 2.0, 4000);
        let other = along::<FiniteRotation<false>>(&law, &path, None, 0.0, 2.0, 4000);
        let worst = (one.force - other.force).length() + (one.torque_i - other.torque_i).length();
        worst / other.force.length()
    };
    let (large, small) = (apart(4e-3), apart(2e-3));
    assert!(small < 4e-3, "{small:e}");
    assert!((large / small - 2.0).abs() < 0.1, "{large:e} {small:e}");
}

/// Rotation vector of one turn after another.
fn compose(after: Vector, before: Vector) -> Vector {
    let product = turn(after) * turn(before);
    let sine = product.vector.length();
    let angle = 2.0 * libm::atan2(sine, product.scalar);
    product.vector * (angle / sine.max(1e-300))
}
