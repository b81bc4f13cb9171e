//! What acts on a sphere beside drag and the force of the pressure: added mass and lift.
//!
//! ```text
//! m_a (Du/Dt − dv/dt)        m_a = C ρ V        Du/Dt = ∂u/∂t + (u · ∇) u
//! µ d F(Re, Re_Ω) w × Ω/|Ω|        for each law of lift
//! ```
//!
//! The row of a load holds m dv/dt, and behind it the dashpot that belongs to it. Both are those of the load without added mass times
//! m/(m + m_a), so half kicks know nothing of it: they solve it exactly, however light the sphere is. The lift is that of the slip after the
//! half kick, which is found with it. In both half kicks around a load together it thus does no work against the slip, whatever the step.

use super::columns::{Columns, put, vector};
use super::particles::Work;
use super::stream::gain;
use super::{Flow, Here, Medium, Stream, volume};
use crate::base::number::Vector;
use crate::engine::bodies::Rigid;
use crate::engine::integration::{Load, kick};
use crate::engine::state::Row;
use crate::laws::lift::Rotation;
use crate::laws::region::Weights;

/// How a fluid moves around a point.
#[derive(Clone, Copy)]
pub(super) struct Around {
    /// Its acceleration Du/Dt \[m/s²\].
    acceleration: Vector,
    /// Its vorticity ∇ × u \[1/s\].
    vorticity: Vector,
}

/// What acts on a sphere beside drag and the force of the pressure.
#[derive(Clone, Copy)]
pub(super) struct Beside {
    /// Its added mass \[kg\].
    pub(super) mass: f64,
    /// Added mass times the acceleration of the fluid, and lift \[N\].
    pub(super) force: Vector,
    /// Its mass over that with the added one, where forces move it; 1 of one that is held.
    pub(super) share: f64,
}

impl Beside {
    /// Motion and load of a sphere as if its mass were that with the added one: what half kicks give is the same.
    pub(super) fn whole(&self, velocity: &Row, force: &Row) -> [Row; 2] {
        let [x, y, z, mass] = *velocity;
        [[x, y, z, mass + self.mass], force.map(|part| part / self.share)]
    }
}

impl Medium {
    /// Whether anything acts beside drag and the force of the pressure.
    pub(super) fn acts_beside(&self) -> bool {
        self.added_mass > 0.0 || !self.lift.is_empty()
    }

    /// What makes lift of a slip, w × this \[kg/s\]: of a sphere with this slip \[m/s\] and angular velocity \[rad/s\].
    fn across(&self, (porosity, diameter): (f64, f64), slip: Vector, spin: Vector, vorticity: Vector) -> Vector {
        let reynolds = self.reynolds(diameter, porosity, slip);
        let about = |sum: Vector, rotation: Vector, factor: &dyn Fn(f64) -> f64| {
            let speed = rotation.length();
            // Nothing turns: there is no direction across.
            if speed == 0.0 {
                return sum;
            }
            let number = self.density * diameter * diameter * speed / self.viscosity;
            sum + rotation * (self.viscosity * diameter * factor(number) / speed)
        };
        self.lift.iter().fold(Vector::zero(), |sum, law| {
            let rotation = match law.rotation() {
                Rotation::Vorticity => vorticity,
                Rotation::Spin => spin - vorticity * 0.5,
            };
            about(sum, rotation, &|number| law.factor(reynolds, number))
        })
    }
}

/// Lift on a sphere of this mass, the added one among it \[kg\], by what makes it of a slip \[kg/s\], at the slip \[m/s\] that a half kick of
/// this length \[s\] leaves. All other forces together are known, drag of the present slip among them \[N\].
fn lift(across: Vector, slip: Vector, drag: f64, (mass, known): (f64, Vector), half: f64) -> Vector {
    // Δ + Δ × κ = y, with κ and y over mass and dashpot.
    let per_mass = half / (mass + half * drag);
    let (turn, rest) = (across * per_mass, (known + slip.cross(across)) * per_mass);
    let gained = (rest + turn.cross(rest) + turn * turn.dot(rest)) * (1.0 / (1.0 + turn.dot(turn)));
    (slip - gained).cross(across)
}

impl Here<'_> {
    /// The same with the force of the pressure that accelerates the fluid where no gradient is given, and with what acts beside on a sphere
    /// of this diameter \[m\].
    pub(super) fn with(self, around: &Around, beside: &Beside, diameter: f64) -> Self {
        let push = around.acceleration * self.medium.inertial + beside.force * (1.0 / volume(diameter));
        Self { push: self.push + push, ..self }
    }
}

impl<'a> Stream<'a> {
    /// Whether anything acts beside drag and the force of the pressure.
    pub(super) fn acts_beside(&self) -> bool {
        self.medium.acts_beside()
    }

    /// How it moves around a point \[m\].
    pub(super) fn around(&self, point: Vector, velocity: Vector, weights: &Weights) -> Around {
        let mut found = Around { acceleration: Vector::zero(), vorticity: Vector::zero() };
        if self.medium.added_mass > 0.0 {
            found.acceleration = Vector::from(super::stream::between(self.accelerations, weights));
        }
        if let Some((centres, flow, _)) = &self.cells {
            let slopes = centres.slopes(point);
            let [x, y, z] = slopes.each_ref().map(|weights| Vector::from(super::stream::between(flow, weights)));
            found.vorticity = Vector::new(y.z - z.y, z.x - x.z, x.y - y.x);
            if self.medium.added_mass > 0.0 {
                found.acceleration += x * velocity.x + y * velocity.y + z * velocity.z;
            }
        }
        found
    }

    /// What acts on a sphere of this diameter \[m\] and mass \[kg\] beside drag and the force of the pressure, with this lift \[N\].
    pub(super) fn beside(&self, around: &Around, diameter: f64, (mass, is_free): (f64, bool), lift: Vector) -> Beside {
        let added = self.medium.added_mass * volume(diameter);
        let share = if is_free { mass / (mass + added) } else { 1.0 };
        Beside { mass: added, force: around.acceleration * added + lift, share }
    }

    /// What it does to a clump at this point \[m\], of the volume of a sphere of this diameter \[m\], on which other forces act \[N, N m\]; and
    /// the lift in it \[N\]. None where there is no fluid.
    pub(crate) fn on_clump(
        &self,
        (place, diameter): (Vector, f64),
        (rigid, spin): (&Rigid, Vector),
        other: Load,
        half: f64,
    ) -> Option<(Flow, Vector)> {
        let (here, weights) = self.at(place)?;
        let (motion, mass) = ([rigid.velocity, spin], rigid.mass);
        if !self.acts_beside() {
            return Some((here.on(diameter, motion, (mass, other[0]), half), Vector::zero()));
        }
        let around = self.around(place, here.velocity, &weights);
        let beside = self.beside(&around, diameter, (mass, true), Vector::zero());
        let (here, whole) = (here.with(&around, &beside, diameter), mass + beside.mass);
        let flow = here.on(diameter, motion, (whole, other[0]), half);
        let (slip, known) = (here.velocity - rigid.velocity, other[0] + flow.force);
        let later = slip - gain(slip, flow.drag, (whole, known - slip * flow.drag), half);
        let twisted = Rigid { moment: other[1] + flow.torque, dashpots: [0.0, flow.turning], ..*rigid }.kicked(half);
        let across = self.medium.across((here.porosity, diameter), later, twisted.spin(), around.vorticity);
        let lift = lift(across, slip, flow.drag, (whole, known), half);
        let force = (known + lift) * beside.share - other[0];
        Some((Flow { force, drag: flow.drag * beside.share, ..flow }, lift))
    }
}

impl Columns {
    /// Adds what acts beside drag and the force of the pressure as far as it is known before these: to what pushes, and to the masses.
    pub(super) fn gather_beside(&mut self, work: &Work) {
        for place in 0..self.count {
            // SAFETY: parts do not overlap, and each is worked on by one thread.
            let body = unsafe { work.rows.body(self.slots[place] as usize) };
            let (here, diameter) = (self.here(work.medium, place), self.diameter[place]);
            let around = work.stream.around(Vector::from(*body.position), here.velocity, &self.weights[place]);
            let known = (self.mass[place], body.owner == 0);
            let beside = work.stream.beside(&around, diameter, known, Vector::zero());
            self.mass[place] += beside.mass;
            (self.added[place], self.share[place]) = (beside.mass, beside.share);
            put(&mut self.beside, place, beside.force);
            put(&mut self.vorticity, place, around.vorticity);
            put(&mut self.push, place, here.with(&around, &beside, diameter).push);
        }
    }

    /// Finds the lift, behind drag and the other forces of the fluid.
    pub(super) fn find_lift(&mut self, work: &Work) {
        let Some(lifts) = work.lift else { return };
        for place in 0..self.count {
            let slot = self.slots[place] as usize;
            // SAFETY: parts do not overlap, and each is worked on by one thread.
            let body = unsafe { work.rows.body(slot) };
            let (diameter, porosity, half) = (self.diameter[place], self.porosity[place], self.half[place]);
            let (slip, drag) = (vector(&self.flow, place) - vector(&self.velocity, place), self.drag[place]);
            let known = vector(&self.other, place) + vector(&self.force, place);
            let later = slip - gain(slip, drag, (self.mass[place], known - slip * drag), half);
            let (spin, turning) = (Vector::from(*body.spin), work.medium.turning(diameter));
            let torque = (Vector::from(*body.torque) - spin * turning).row_with(turning);
            let spin = spin + Vector::from(torque) * kick(body.spin, &torque, half);
            let across = work.medium.across((porosity, diameter), later, spin, vector(&self.vorticity, place));
            let lift = lift(across, slip, drag, (self.mass[place], known), half);
            let push = vector(&self.push, place) + lift * (1.0 / volume(diameter));
            put(&mut self.push, place, push);
            let [beside, force] = [&self.beside, &self.force].map(|column| vector(column, place) + lift);
            put(&mut self.beside, place, beside);
            put(&mut self.force, place, force);
            // SAFETY: as above; there is a row for each particle.
            unsafe { *lifts.at(slot) = lift.row_with(0.0) };
        }
    }

    /// What acts on one of them beside drag and the force of the pressure.
    #[inline(always)]
    pub(super) fn beside_of(&self, place: usize) -> Beside {
        Beside { mass: self.added[place], force: vector(&self.beside, place), share: self.share[place] }
    }

    /// Makes of force and dashpot those that rows hold, behind which the mass of the sphere alone stands.
    pub(super) fn share_out(&mut self) {
        for place in 0..self.count {
            let (other, share) = (vector(&self.other, place), self.share[place]);
            let force = (other + vector(&self.force, place)) * share - other;
            put(&mut self.force, place, force);
            self.drag[place] *= share;
        }
    }
}
