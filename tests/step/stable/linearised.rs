//! The whole time step, linearised by trying it: the engine makes one time step from rest with each freedom of each sphere
//! moving a little, and the loads that follow are stiffness and damping, as full matrices.

use crate::step::stable::with_step;
use crate::support::checked;
use cograin::scene::Scene;
use cograin::simulation::Simulation;
use nalgebra::DMatrix;

/// The stable time step of a scene \[s\]: the largest with 4 M − 2 Δt C − Δt² K positive definite, where dashpots that see
/// extrapolated velocities count twice.
///
/// Times about `near` are tried.
pub(crate) fn stable_step(text: &str, near: f64) -> f64 {
    let masses = with_step(&checked(text), 1e-12);
    let (stiffness, damping) = counted(text, near);
    largest_step(&scaled(&masses, &stiffness), &scaled(&masses, &damping), near)
}

/// A matrix of the free spheres, symmetric and scaled by the roots of masses and moments of inertia.
pub(crate) fn scaled(simulation: &Simulation, matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let per_root = masses(simulation).map(|mass| 1.0 / mass.sqrt());
    let matrix = 0.5 * (matrix + matrix.transpose());
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |a, b| per_root[a] * matrix[(a, b)] * per_root[b])
}

/// The largest time step with 4 − 2 Δt C − Δt² K positive definite, about `near` \[s\].
pub(crate) fn largest_step(stiffness: &DMatrix<f64>, damping: &DMatrix<f64>, near: f64) -> f64 {
    let is_stable = |step: f64| {
        let rest = DMatrix::identity(stiffness.nrows(), stiffness.ncols()) * 4.0
            - damping * (2.0 * step)
            - stiffness * (step * step);
        rest.cholesky().is_some()
    };
    let (mut stable, mut unstable) = (0.3 * near, 4.0 * near);
    assert!(is_stable(stable) && !is_stable(unstable), "the true step is not about {near:e} s");
    while unstable / stable > 1.0 + 1e-5 {
        let middle = 0.5 * (stable + unstable);
        if is_stable(middle) { stable = middle } else { unstable = middle }
    }
    stable
}

/// Stiffness and damping, the latter as often as it counts.
fn counted(text: &str, near: f64) -> (DMatrix<f64>, DMatrix<f64>) {
    let scheme = checked(text).run.scheme;
    let [normal, tangential] = scheme.damping_factors();
    let engine = match text.contains("\nscheme = ") {
        true => text.replace(&format!("\nscheme = {:?}\n", scheme.name()), "\nscheme = \"engine\"\n"),
        false => text.replace("threads = 1\n", "threads = 1\nscheme = \"engine\"\n"),
    };
    let (stiffness, damping) = measured(&checked(&engine), near);
    if !text.contains("[contact.c.") || [normal, tangential] == [1.0; 2] {
        return (stiffness, damping);
    }
    assert!(!text.contains(".damping.viscous"), "dashpots of bonds and of contacts cannot be told apart here");
    let without = engine.replace("[contact.c.normal", "[contact.c]\ntangential_damping = false\n[contact.c.normal");
    let along = measured(&checked(&without), near).1;
    let across = &damping - &along;
    (stiffness, normal * along + tangential * across)
}

/// Stiffness and damping of a scene whose dashpots see the velocities of mid-step.
pub(crate) fn measured(scene: &Scene, near: f64) -> (DMatrix<f64>, DMatrix<f64>) {
    // A freedom that moves with speed 1 for a time step h answers with h K + C.
    let [long, short] = [0.02, 0.01].map(|part| answers(scene, part * near));
    ((&long - &short) / (0.01 * near), 2.0 * short - long)
}

/// Masses and moments of inertia of the free spheres, six for each.
fn masses(simulation: &Simulation) -> nalgebra::DVector<f64> {
    let particles = &simulation.state().particles;
    let of = |slot: u32| {
        let (mass, inertia) = (particles.velocity[slot as usize][3], particles.angular_velocity[slot as usize][3]);
        [mass, mass, mass, inertia, inertia, inertia]
    };
    let all: Vec<f64> = free(simulation).into_iter().flat_map(|id| of(particles.slot[id as usize])).collect();
    nalgebra::DVector::from_vec(all)
}

/// The spheres that forces move, by their index in the scene.
fn free(simulation: &Simulation) -> Vec<u32> {
    let particles = &simulation.state().particles;
    (0..particles.len() as u32).filter(|&id| particles.owner[particles.slot[id as usize] as usize] == 0).collect()
}

/// What a unit velocity of each freedom lets the loads fall by after one time step: step · K + C.
fn answers(scene: &Scene, step: f64) -> DMatrix<f64> {
    /// Way of the trials \[m\] and turn \[rad\]: far below every overlap.
    const TRIALS: [f64; 2] = [1e-11, 1e-8];
    let mut simulation = with_step(scene, step);
    let mut rest = simulation.state().clone();
    for row in rest.particles.velocity.iter_mut().chain(&mut rest.particles.angular_velocity) {
        row[..3].fill(0.0);
    }
    // Nobody is to look how far such a fast motion may come.
    (rest.foresight.speed, rest.foresight.reach) = (1e30, 1e30);
    let free = free(&simulation);
    let mut loads = |freedom: usize, speed: f64| {
        let mut state = rest.clone();
        let slot = state.particles.slot[free[freedom / 6] as usize] as usize;
        let axis = freedom % 6;
        let row =
            if axis < 3 { &mut state.particles.velocity[slot] } else { &mut state.particles.angular_velocity[slot] };
        row[axis % 3] = speed;
        simulation.restore(&state).expect("it is a state of this scene");
        simulation.advance(step).expect("one time step");
        let particles = &simulation.state().particles;
        let of = |id: &u32| {
            let slot = particles.slot[*id as usize] as usize;
            let ([x, y, z, _], [u, v, w, _]) = (particles.force[slot], particles.torque[slot]);
            [x, y, z, u, v, w]
        };
        free.iter().flat_map(of).collect::<Vec<f64>>()
    };
    let count = 6 * free.len();
    let mut matrix = DMatrix::zeros(count, count);
    for freedom in 0..count {
        let speed = TRIALS[freedom % 6 / 3] / step;
        let [forth, back] = [speed, -speed].map(|speed| loads(freedom, speed));
        for (row, (forth, back)) in forth.iter().zip(&back).enumerate() {
            matrix[(row, freedom)] = (back - forth) / (2.0 * speed);
        }
    }
    matrix
}
