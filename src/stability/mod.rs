//! How long a time step may be.
//!
//! Velocity Verlet with forces that see the half-step velocity is stable while 4 M − 2 Δt C − Δt² K is positive
//! definite (M masses, C dampers, K stiffnesses). Each interaction's share is bounded by twice what its two
//! particles would feel alone, |a − b|² ≤ 2 |a|² + 2 |b|², so a bound holds particle by particle: the largest
//! eigenvalue of its own 6 × 6 block. It is safe, and at most √2 below the true limit where only springs act.
//! A group that forces move is one such particle, with its own mass and inertia and the arms of its spheres.

use crate::boundaries::RigidBody;
use crate::interactions::{Link, Pass};
use crate::number::Vector;
use crate::scene::Scene;
use crate::state::{Particles, State};
use std::collections::BTreeMap;

/// A symmetric matrix over the six freedoms of a particle, scaled by its mass and moment of inertia.
type Block = [[f64; 6]; 6];

/// The rows of the lower triangle of such a matrix.
type Triangle = [f64; 21];

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
pub(crate) struct Network<'a> {
    /// Masses, radii and where everything stands.
    state: &'a State,
    /// Groups, by their boundary.
    bodies: &'a [Option<RigidBody>],
    /// Stiffness of the own block of each particle, doubled where the partner moves too \[1/s²\].
    stiffness: Vec<Triangle>,
    /// The same of each boundary.
    groups: Vec<Block>,
    /// The share of interactions whose partner does not move, where there are any, by the place of the block.
    unmoved: BTreeMap<usize, Block>,
    /// Damping of each particle, then of each boundary \[1/s\].
    damping: Vec<f64>,
}

impl<'a> Network<'a> {
    /// Without any interaction.
    pub(crate) fn of(state: &'a State, bodies: &'a [Option<RigidBody>]) -> Self {
        let count = state.particles.len();
        Self {
            state,
            bodies,
            stiffness: vec![[0.0; 21]; count],
            groups: vec![[[0.0; 6]; 6]; bodies.len()],
            unmoved: BTreeMap::new(),
            damping: vec![0.0; count + bodies.len()],
        }
    }

    /// Adds one interaction.
    pub(crate) fn add(&mut self, link: Link) {
        let first = self.mover(link.first);
        let second = link.second.and_then(|second| self.mover(second));
        if first.is_some() && first == second {
            return;
        }
        let both = first.is_some() && second.is_some();
        if let Some(mover) = first {
            self.add_side(mover, link.first, &link, link.first_arm, link.normal, both);
        }
        if let (Some(mover), Some(slot)) = (second, link.second) {
            self.add_side(mover, slot, &link, link.second_arm, -link.normal, both);
        }
    }

    /// What moves a particle, if forces do: the place of its block.
    fn mover(&self, slot: u32) -> Option<usize> {
        match (self.state.particles.owner[slot as usize] as usize).checked_sub(1) {
            None => Some(slot as usize),
            Some(group) => {
                self.bodies[group].as_ref().filter(|body| body.is_free()).map(|_| self.state.particles.len() + group)
            }
        }
    }

    /// Adds one end of an interaction to what moves there.
    fn add_side(&mut self, mover: usize, slot: u32, link: &Link, arm: f64, normal: Vector, both: bool) {
        match mover.checked_sub(self.state.particles.len()) {
            None => self.add_end(mover, link, arm, normal, both),
            Some(group) => self.add_to_group(group, slot, link, arm, normal, both),
        }
    }

    /// Adds one end of an interaction to the group of its particle.
    fn add_to_group(&mut self, group: usize, slot: u32, link: &Link, arm: f64, normal: Vector, both: bool) {
        let Some(body) = &self.bodies[group] else { return };
        let moved = &self.state.boundaries[group];
        let row = self.state.particles.position[slot as usize];
        let arm = Vector::from(row) - moved.pivot.into() - normal * arm;
        // The point of action moves with v + w × arm: what unit freedoms give along three axes.
        let (a, n) = (arm.to_array(), normal.to_array());
        let across = [[0.0, a[2], -a[1]], [-a[2], 0.0, a[0]], [a[1], -a[0], 0.0]];
        let gradient = |axis: usize, k: usize| if k < 3 { one_if(k == axis) } else { across[axis][k - 3] };
        let along = |k: usize| (0..3).map(|axis| n[axis] * gradient(axis, k)).sum::<f64>();
        let (kn, kt) = (link.response.normal_stiffness, link.response.tangential_stiffness);
        let mut stiffness = [[0.0; 6]; 6];
        for (p, row) in stiffness.iter_mut().enumerate() {
            for (q, entry) in row.iter_mut().enumerate() {
                let whole = (0..3).map(|axis| gradient(axis, p) * gradient(axis, q)).sum::<f64>();
                *entry = kt * whole + (kn - kt) * along(p) * along(q);
                if p >= 3 && q >= 3 {
                    let twist = n[p - 3] * n[q - 3];
                    *entry += link.torsion * twist + link.bending * (one_if(p == q) - twist);
                }
            }
        }
        let (mobility, doubled) = (body.mobility(moved), if both { 2.0 } else { 1.0 });
        let place = self.state.particles.len() + group;
        let mut block = [[0.0; 6]; 6];
        for p in 0..6 {
            for q in 0..6 {
                block[p][q] = doubled * (0..6).map(|k| mobility[p][k] * stiffness[k][q]).sum::<f64>();
            }
        }
        add(&mut self.groups[group], &block);
        if !both {
            add(self.unmoved.entry(place).or_default(), &block);
        }
        let damping = link.response.normal_damping.max(link.response.tangential_damping);
        self.damping[place] += doubled * damping * answer(&mobility, arm.length());
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
        let mut triangle = [0.0; 21];
        let mut place = 0;
        for a in 0..6 {
            for b in 0..=a {
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
                triangle[place] = doubled * sum;
                place += 1;
            }
        }
        for (sum, part) in self.stiffness[slot].iter_mut().zip(triangle) {
            *sum += part;
        }
        if !both {
            add(self.unmoved.entry(slot).or_default(), &whole(&triangle));
        }
        let damping = link.response.normal_damping.max(link.response.tangential_damping);
        let tangential = link.response.tangential_damping * (1.0 / mass + arm * arm / inertia);
        self.damping[slot] += doubled * (damping / mass).max(tangential);
    }

    /// The particle at the place of a block, of a group the first: index into the scene's particles.
    fn named(&self, place: usize) -> Option<u32> {
        match place.checked_sub(self.state.particles.len()) {
            None => Some(self.state.particles.id[place]),
            Some(group) => self.bodies[group].as_ref().map(|body| body.members[0]),
        }
    }

    /// The limit over all particles.
    pub(crate) fn limit(&self) -> Limit {
        let mut limit = Limit { safe: f64::INFINITY, unstable: f64::INFINITY, particle: None };
        // Root of k Δt² + 2 c Δt = 4, without cancellation.
        let step = |k: f64, c: f64| 4.0 / (c + (c * c + 4.0 * k).sqrt());
        for place in 0..self.damping.len() {
            let (block, c) = (self.block(place), self.damping[place]);
            // The eigenvalue is dear; most particles cannot be the one that limits the step.
            let most = ROOT_OF_SIX * row_sum(&block);
            if step(most, c) >= limit.safe && 2.0 / most.sqrt() >= limit.unstable {
                continue;
            }
            let k = largest_eigenvalue(&block);
            if k <= 0.0 && c <= 0.0 {
                continue;
            }
            let safe = step(k, c);
            if safe < limit.safe {
                limit.safe = safe;
                limit.particle = self.named(place);
            }
            // Moving this particle alone gives a Rayleigh quotient, hence a bound from below.
            let alone = largest_eigenvalue(&self.single(place)) / ROOT_OF_SIX;
            limit.unstable = limit.unstable.min(2.0 / alone.sqrt());
        }
        limit
    }

    /// Stiffness of the own block of a particle or, behind them, a boundary.
    fn block(&self, place: usize) -> Block {
        match place.checked_sub(self.stiffness.len()) {
            None => whole(&self.stiffness[place]),
            Some(group) => self.groups[group],
        }
    }

    /// The same, nothing doubled.
    fn single(&self, place: usize) -> Block {
        let mut block = self.block(place);
        if let Some(unmoved) = self.unmoved.get(&place) {
            add(&mut block, unmoved);
        }
        block.map(|row| row.map(|part| 0.5 * part))
    }
}

/// Adds one block to another.
fn add(sum: &mut Block, block: &Block) {
    for (sum, part) in sum.iter_mut().flatten().zip(block.iter().flatten()) {
        *sum += part;
    }
}

/// The matrix of which this is the lower triangle.
fn whole(triangle: &Triangle) -> Block {
    let mut block = [[0.0; 6]; 6];
    let mut place = 0;
    for a in 0..6 {
        for b in 0..=a {
            block[a][b] = triangle[place];
            block[b][a] = triangle[place];
            place += 1;
        }
    }
    block
}

/// The largest sum of magnitudes in a row, which no eigenvalue exceeds (Gershgorin).
fn row_sum(block: &Block) -> f64 {
    block.iter().map(|row| row.iter().map(|part| part.abs()).sum::<f64>()).fold(0.0, f64::max)
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

/// 1 where it holds, 0 otherwise.
fn one_if(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

/// The largest acceleration that a unit force at this arm \[m\] gives to where it acts, or above \[1/kg\].
fn answer(mobility: &Block, arm: f64) -> f64 {
    let (shift, turn) = (0..3)
        .fold((0.0, 0.0), |(shift, turn): (f64, f64), k| (shift.max(mobility[k][k]), turn + mobility[3 + k][3 + k]));
    shift + turn * arm * arm
}

/// What may meet something else next.
struct Meeting {
    /// Radius \[m\].
    radius: f64,
    /// Mass that it meets with \[kg\].
    mass: f64,
    /// Largest acceleration that a unit force across gives to where it acts \[1/kg\].
    turn: f64,
    /// The particle: index into the scene's particles.
    particle: u32,
}

/// The smallest particle that forces move.
fn smallest_particle(particles: &Particles) -> Option<Meeting> {
    let free = (0..particles.len()).filter(|&slot| particles.owner[slot] == 0);
    let slot = free.min_by(|&a, &b| particles.velocity[a][3].total_cmp(&particles.velocity[b][3]).then(a.cmp(&b)))?;
    let (mass, radius) = (particles.velocity[slot][3], particles.position[slot][3]);
    let turn = 1.0 / mass + radius * radius / particles.angular_velocity[slot][3];
    Some(Meeting { radius, mass, turn, particle: particles.id[slot] })
}

/// The bound for impacts still to come: the two smallest particles meeting at twice the largest present speed, with
/// what gravity adds over a radius; likewise of each group that forces move. Returns the step \[s\] and the particle.
pub(crate) fn impact_limit(
    scene: &Scene,
    state: &State,
    bodies: &[Option<RigidBody>],
    passes: &[Box<dyn Pass>],
) -> Option<(f64, u32)> {
    let speeds = state.particles.velocity.iter().map(|v| v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    let fastest = speeds.fold(0.0, f64::max).sqrt();
    let gravity = Vector::from(scene.gravity).length();
    let groups = bodies.iter().zip(&state.boundaries).filter_map(|(body, moved)| {
        let body = body.as_ref().filter(|body| body.is_free())?;
        let turn = answer(&body.mobility(moved), body.farthest + body.largest);
        Some(Meeting { radius: body.largest, mass: 1.0 / turn, turn, particle: body.members[0] })
    });
    let mut limit: Option<(f64, u32)> = None;
    for meeting in smallest_particle(&state.particles).into_iter().chain(groups) {
        let speed = 2.0 * fastest + (2.0 * gravity * meeting.radius).sqrt();
        let safe = passes.iter().filter_map(|pass| bound(pass.as_ref(), &meeting, speed)).fold(f64::INFINITY, f64::min);
        if safe < limit.map_or(f64::INFINITY, |(least, _)| least) {
            limit = Some((safe, meeting.particle));
        }
    }
    limit
}

/// The stable time step while something meets its like at this speed \[m/s\].
fn bound(pass: &dyn Pass, meeting: &Meeting, speed: f64) -> Option<f64> {
    let response = pass.impact(0.5 * meeting.radius, 0.5 * meeting.mass, speed)?;
    // Both move: their one spring acts on the reduced mass.
    let k = 2.0 * (response.normal_stiffness / meeting.mass).max(response.tangential_stiffness * meeting.turn);
    let c = 2.0 * (response.normal_damping / meeting.mass).max(response.tangential_damping * meeting.turn);
    (k > 0.0 || c > 0.0).then(|| 4.0 / (c + (c * c + 4.0 * k).sqrt()))
}
