//! How long a time step may be.
//!
//! Velocity Verlet with forces that see the half-step velocity is stable while 4 M − 2 Δt C − Δt² K is positive
//! definite (M masses, C dampers, K stiffnesses). Each interaction's share is bounded by twice what its two
//! particles would feel alone, |a − b|² ≤ 2 |a|² + 2 |b|², so a bound holds particle by particle: the largest
//! eigenvalue of its own 6 × 6 block. It is safe, and at most √2 below the true limit where only springs act.

use super::pass::{Link, Pass};
use crate::number::Vector;
use crate::scene::Scene;
use crate::state::State;

/// A symmetric matrix over the six freedoms of a particle, scaled by its mass and moment of inertia.
type Block = [[f64; 6]; 6];

/// Squarings in the bound of the largest eigenvalue: the trace of the 32nd power.
const SQUARINGS: u32 = 5;

/// 32nd root of 6: how far the bound of the largest of six eigenvalues may be above it.
const ROOT_OF_SIX: f64 = 1.057_590_4;

/// What limits the time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// A safe bound of the time step \[s\]; infinite where nothing is stiff.
    pub safe: f64,
    /// A time step that is certainly unstable \[s\].
    pub unstable: f64,
    /// The particle that limits it: index into the scene's particles.
    pub particle: Option<u32>,
}

/// Stiffness and damping that the interactions of each particle put on it.
pub(super) struct Network<'a> {
    /// Masses, radii and where everything stands.
    state: &'a State,
    /// Stiffness of each particle's own block, doubled where the partner moves too \[1/s²\].
    stiffness: Vec<Block>,
    /// The same, not doubled.
    single: Vec<Block>,
    /// Damping \[1/s\].
    damping: Vec<f64>,
}

impl<'a> Network<'a> {
    /// Without any interaction.
    pub(super) fn of(state: &'a State) -> Self {
        let count = state.particles.len();
        Self {
            state,
            stiffness: vec![[[0.0; 6]; 6]; count],
            single: vec![[[0.0; 6]; 6]; count],
            damping: vec![0.0; count],
        }
    }

    /// Adds one interaction.
    pub(super) fn add(&mut self, link: Link) {
        let owner = &self.state.particles.owner;
        let moving = |slot: u32| owner[slot as usize] == 0;
        let both = link.second.is_some_and(moving) && moving(link.first);
        if moving(link.first) {
            self.add_end(link.first as usize, &link, link.first_arm, link.normal, both);
        }
        if let Some(second) = link.second.filter(|&second| moving(second)) {
            self.add_end(second as usize, &link, link.second_arm, -link.normal, both);
        }
    }

    /// Adds one end of an interaction to its particle.
    fn add_end(&mut self, slot: usize, link: &Link, arm: f64, normal: Vector, both: bool) {
        let mass = self.state.particles.velocity[slot][3];
        let inertia = self.state.particles.angular_velocity[slot][3];
        let doubled = if both { 2.0 } else { 1.0 };
        // The sliding point moves with v − arm ω × n: its gradient over the scaled freedoms, along three axes.
        let (v, w) = (1.0 / mass.sqrt(), arm / inertia.sqrt());
        let n = normal.to_array();
        let across = [[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]];
        let (kn, kt) = (link.response.normal_stiffness, link.response.tangential_stiffness);
        for a in 0..6 {
            for b in 0..6 {
                let mut sum = 0.0;
                for axis in 0..3 {
                    let gradient = |k: usize| {
                        if k < 3 {
                            v * (f64::from(u8::from(k == axis)) - n[axis] * n[k])
                        } else {
                            w * across[axis][k - 3]
                        }
                    };
                    sum += kt * gradient(a) * gradient(b);
                }
                if a < 3 && b < 3 {
                    sum += kn * v * v * n[a] * n[b];
                }
                if a >= 3 && b >= 3 {
                    let along = n[a - 3] * n[b - 3];
                    let across = f64::from(u8::from(a == b)) - along;
                    sum += (link.torsion * along + link.bending * across) / inertia;
                }
                self.single[slot][a][b] += sum;
                self.stiffness[slot][a][b] += doubled * sum;
            }
        }
        let damping = link.response.normal_damping.max(link.response.tangential_damping);
        let tangential = link.response.tangential_damping * (1.0 / mass + arm * arm / inertia);
        self.damping[slot] += doubled * (damping / mass).max(tangential);
    }

    /// The limit over all particles.
    pub(super) fn limit(&self) -> Limit {
        let mut limit = Limit { safe: f64::INFINITY, unstable: f64::INFINITY, particle: None };
        for (slot, block) in self.stiffness.iter().enumerate() {
            let (k, c) = (largest_eigenvalue(block), self.damping[slot]);
            if k <= 0.0 && c <= 0.0 {
                continue;
            }
            // Root of k Δt² + 2 c Δt = 4, without cancellation.
            let safe = 4.0 / (c + (c * c + 4.0 * k).sqrt());
            if safe < limit.safe {
                limit.safe = safe;
                limit.particle = Some(self.state.particles.id[slot]);
            }
            // Moving this particle alone gives a Rayleigh quotient, hence a bound from below.
            let alone = largest_eigenvalue(&self.single[slot]) / ROOT_OF_SIX;
            limit.unstable = limit.unstable.min(2.0 / alone.sqrt());
        }
        limit
    }
}

/// An upper bound of the largest eigenvalue of a positive semidefinite matrix: the 32nd root of the trace of its
/// 32nd power, at most 6 % above it. Roots are square roots, exactly rounded on every processor.
fn largest_eigenvalue(block: &Block) -> f64 {
    let trace: f64 = (0..6).map(|k| block[k][k]).sum();
    if trace <= 0.0 {
        return 0.0;
    }
    let mut power = block.map(|row| row.map(|part| part / trace));
    for _ in 0..SQUARINGS {
        let mut square = [[0.0; 6]; 6];
        for a in 0..6 {
            for b in 0..6 {
                square[a][b] = (0..6).map(|k| power[a][k] * power[k][b]).sum();
            }
        }
        power = square;
    }
    let mut root: f64 = (0..6).map(|k| power[k][k]).sum();
    for _ in 0..SQUARINGS {
        root = root.sqrt();
    }
    trace * root
}

/// The bound for impacts still to come: the two smallest particles meeting at twice the largest present speed, with
/// what gravity adds over a radius. Returns the step \[s\] and the particle.
pub(super) fn impact_limit(scene: &Scene, state: &State, passes: &[Box<dyn Pass>]) -> Option<(f64, u32)> {
    let particles = &state.particles;
    let free = (0..particles.len()).filter(|&slot| particles.owner[slot] == 0);
    let smallest =
        free.min_by(|&a, &b| particles.velocity[a][3].total_cmp(&particles.velocity[b][3]).then(a.cmp(&b)))?;
    let (mass, radius) = (particles.velocity[smallest][3], particles.position[smallest][3]);
    let speeds = particles.velocity.iter().map(|v| v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    let fastest = speeds.fold(0.0, f64::max).sqrt();
    let gravity = Vector::from(scene.gravity).length();
    let speed = 2.0 * fastest + (2.0 * gravity * radius).sqrt();
    let inertia = particles.angular_velocity[smallest][3];
    let mut safe = f64::INFINITY;
    for pass in passes {
        let Some(response) = pass.impact(0.5 * radius, 0.5 * mass, speed) else { continue };
        let turn = 1.0 / mass + radius * radius / inertia;
        // Both move: their one spring acts on the reduced mass.
        let k = 2.0 * (response.normal_stiffness / mass).max(response.tangential_stiffness * turn);
        let c = 2.0 * (response.normal_damping / mass).max(response.tangential_damping * turn);
        if k > 0.0 || c > 0.0 {
            safe = safe.min(4.0 / (c + (c * c + 4.0 * k).sqrt()));
        }
    }
    (safe < f64::INFINITY).then(|| (safe, particles.id[smallest]))
}
