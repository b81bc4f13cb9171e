//! How a contact moved from its last evaluation to this one, as at mid-step, and what that does to what is remembered.

use super::touch::{is_near_touch, share_of_step, weight_of};
use crate::base::number::{Number, Vector};
use crate::laws::contact::{Contact, NormalForce, Onset};

/// What happened to a contact from its last evaluation to this one: how its normal turned and how far its bodies slipped, as
/// at the middle of the step.
#[derive(Clone, Copy, Debug)]
pub struct Carry<N = f64> {
    /// Way of i over j in the tangent plane while they touched \[m\].
    pub stretch: Vector<N>,
    /// What the normal gained from mid-step to the end.
    pub tilt: Vector<N>,
    /// Tangent of half the angle by which both bodies turned about the normal.
    pub twist: N,
    /// Part of the step in which the bodies touched.
    pub share: N,
}

impl<N: Number> Carry<N> {
    /// The motion of a contact in a step \[s\]. `touches`: bodies touch where they overlap and nowhere else, so that an overlap
    /// smaller than their approach began in this step.
    #[inline(always)]
    pub fn of(contact: &Contact<N>, step: N, touches: bool) -> Self {
        let (half, one) = (N::splat(0.5) * step, N::splat(1.0));
        let quarter = N::splat(0.5) * half;
        let Contact { normal, normal_velocity, slip, turning, spin_sum, per_distance, overlap, .. } = *contact;
        let across = slip + turning.cross(normal);
        let tilt = across * (half * per_distance);
        // The arms at mid-step, and what the velocities do along what the normal gains.
        let turned = tilt * turning.dot(normal) - spin_sum * (quarter * normal_velocity);
        let rate = slip + normal.cross(turned) + tilt * normal_velocity;
        let share = if touches { share_of_step(overlap, normal_velocity * step) } else { one };
        let twist = N::select(per_distance.greater(N::zero()), quarter * spin_sum.dot(normal), N::zero());
        Self { stretch: rate * (step * share), tilt, twist, share }
    }

    /// A vector of the tangent plane a step ago, turned with the contact; a part of it, `late`, came on the way and turns half.
    #[inline(always)]
    fn spun(&self, normal: Vector<N>, flat: Vector<N>, late: Vector<N>) -> Vector<N> {
        let (one, square) = (N::splat(1.0), self.twist * self.twist);
        let per = one / (one + square);
        flat * ((one - square) * per) + normal.cross(flat - late * N::splat(0.5)) * ((self.twist + self.twist) * per)
    }

    /// A spring of the tangent plane a step ago, turned with the contact and stretched: it is in the tangent plane. The fourth
    /// number stays.
    #[inline(always)]
    pub fn spring(&self, normal: Vector<N>, row: [N; 4]) -> [N; 4] {
        let whole = Vector::of_row(row) + self.stretch;
        // Along the normal of mid-step, as long as its part along the normal of the end is 1.
        let flat = whole - (normal - self.tilt) * whole.dot(normal);
        self.spun(normal, flat, self.stretch).row_with(row[3])
    }

    /// A torque turned with the contact, the part along the normal with it. The fourth number stays.
    #[inline(always)]
    pub fn torque(&self, normal: Vector<N>, row: [N; 4]) -> [N; 4] {
        let whole = Vector::of_row(row);
        let middle = normal - self.tilt;
        let before = middle * (N::splat(2.0) / middle.dot(middle)) - normal;
        let along = whole.dot(before);
        let rest = whole - before * along;
        let flat = rest - middle * rest.dot(normal);
        (self.spun(normal, flat, Vector::zero()) + normal * along).row_with(row[3])
    }

    /// A vector of mid-step, turned to the end of the step.
    #[inline(always)]
    pub fn to_end(&self, normal: Vector<N>, vector: Vector<N>) -> Vector<N> {
        vector + self.tilt * vector.dot(normal) - normal * vector.dot(self.tilt)
    }

    /// Gives a contact the velocities at the end of the step, from those of its middle and of the step before, which `row`
    /// holds and which are remembered in their turn. A contact that begins keeps those of the middle.
    #[inline(always)]
    pub fn foresee(&self, contact: &mut Contact<N>, row: [N; 4], step: N) -> [N; 4] {
        let normal = contact.normal;
        let across = contact.slip + contact.turning.cross(normal);
        let along = contact.normal_velocity - across.dot(self.tilt);
        let per = N::splat(1.0) / (step * self.share);
        let moved = step.greater(N::zero());
        let rate = Vector::select(moved, self.stretch * per, contact.slip);
        let [before, x, y, z] = row;
        let unturned = Vector::new(x, y, z);
        let flat = unturned - (normal - self.tilt) * unturned.dot(normal);
        let slip = self.spun(normal, flat, Vector::zero());
        let known = N::both(moved, (before * before + unturned.dot(unturned)).greater(N::zero()));
        let half = N::splat(0.5);
        let along_then = N::select(known, along + half * (along - before), contact.normal_velocity);
        contact.slip = Vector::select(known, rate + (rate - slip) * half, contact.slip);
        contact.normal_velocity = along_then;
        let [a, b, c, d] = [along, rate.x, rate.y, rate.z];
        let [e, f, g, h] = row;
        [N::select(moved, a, e), N::select(moved, b, f), N::select(moved, c, g), N::select(moved, d, h)]
    }

    /// Weighs the velocities that a dashpot sees of a contact which began within the step, or which ends within the next, so
    /// that its force is that of the part of the time between both mid-steps in which the bodies touch. `rates` are the
    /// velocities along the normal at the middle of this step and of the step before it, 0 where none is remembered \[m/s\]:
    /// a contact that seemed to end and did not is weighed for what is left of its time.
    #[inline(always)]
    pub fn weigh(&self, contact: &mut Contact<N>, onset: Onset, step: N, [rate, before]: [N; 2]) {
        if onset == Onset::Unweighed {
            return;
        }
        let ways = [rate * step, before * step];
        if is_near_touch(contact.overlap, ways) {
            let weight = weight_of(contact.overlap, self.share, onset, ways);
            contact.normal_velocity = contact.normal_velocity * weight;
            contact.slip = contact.slip * weight;
        }
    }

    /// The stiffnesses by which a rolling spring grows in a step: the means of those before, of which `before` is k_n \[N/m\],
    /// and those now.
    #[inline(always)]
    pub fn mean_stiffness(&self, normal: &NormalForce<N>, before: N) -> NormalForce<N> {
        let (one, now) = (N::splat(1.0), normal.response.normal_stiffness);
        let known = N::both(before.greater(N::zero()), now.greater(N::zero()));
        let mean = N::splat(0.5) * (one + N::select(known, before, one) / N::select(known, now, one));
        let mut normal = *normal;
        normal.response.normal_stiffness = now * mean;
        normal.response.tangential_stiffness = normal.response.tangential_stiffness * mean;
        normal
    }
}

#[cfg(test)]
mod tests;
