//! Sweeps over the dashpots of bonds to planes that are integrated by themselves (`bond/damping/split.rs`), one bond after the other.

use super::body_of;
use crate::bond::damping::split::Moving;
use crate::bond::{Body, Law, Pair};
use crate::boundaries::felt::Swept;
use crate::interactions::Sweep;
use crate::number::Vector;
use crate::state::{BondList, BoundaryState, Particles, Row};

/// What a sweep over bonds at a plane works with.
pub(super) struct AtPlane<'a> {
    /// The law.
    pub(super) law: &'a Law,
    /// The feet of bonds, as bodies.
    pub(super) foot: &'a dyn Fn(Row) -> Body,
    /// Point about which the moment is taken, at time 0 \[m\].
    pub(super) reference: Vector,
    /// The plane's number.
    pub(super) boundary: usize,
}

impl AtPlane<'_> {
    /// Sweeps over a list. Each particle stands once in it. Returns the kinetic energy that particles moved by forces gained \[J\].
    pub(super) fn run(
        &self,
        list: &mut BondList,
        particles: &mut Particles,
        boundaries: &[BoundaryState],
        sweep: Sweep,
        felt: &mut [Swept],
    ) -> f64 {
        let Some(dashpots) = self.law.split else { return 0.0 };
        let (coefficients, mut gained) = (self.law.elasticity.at_step::<f64>(0.0), 0.0);
        for (bond, (&slot, &foot)) in list.first.iter().zip(&list.foot).enumerate() {
            let (slot, foot_body) = (slot as usize, (self.foot)(foot));
            let (owner, body) = (particles.owner[slot] as usize, body_of(particles, slot));
            let pair = Pair::at_wall(&body, &foot_body);
            let free = [f64::from(u8::from(owner == 0)), 0.0];
            let decay = dashpots.decay(&coefficients, &pair, free, sweep.time);
            let before = Moving { velocities: [body.velocity, foot_body.velocity], spins: [body.spin, foot_body.spin] };
            let mut moving = before;
            let impulse = decay.damp(&mut moving, sweep.backwards);
            particles.velocity[slot] = moving.velocities[0].row_with(body.mass);
            particles.angular_velocity[slot] = moving.spins[0].row_with(body.inertia);
            let motion = |body: usize| [before.velocities[body], before.spins[body]];
            let on_plane = Swept::at(&impulse, 1, Vector::from(foot) - self.reference, motion(1));
            let mut led = on_plane.energy;
            felt[self.boundary].add(&on_plane);
            if let Some(group) = owner.checked_sub(1) {
                let on_group = Swept::at(&impulse, 0, body.position - boundaries[group].pivot.into(), motion(0));
                led += on_group.energy;
                felt[group].add(&on_group);
            }
            list.lost[bond] += impulse.taken;
            list.damped += impulse.taken;
            gained -= impulse.taken + led;
        }
        gained
    }

    /// Adds the present loads of dashpots on the plane, and on groups.
    pub(super) fn add_loads(
        &self,
        list: &BondList,
        particles: &Particles,
        boundaries: &[BoundaryState],
        felt: &mut [Swept],
    ) {
        let Some(dashpots) = self.law.split else { return };
        let (coefficients, still) = (self.law.elasticity.at_step::<f64>(0.0), [Vector::zero(); 2]);
        for (&slot, &foot) in list.first.iter().zip(&list.foot) {
            let body = body_of(particles, slot as usize);
            let impulse = dashpots.loads(&coefficients, &Pair::at_wall(&body, &(self.foot)(foot)));
            felt[self.boundary].add(&Swept::at(&impulse, 1, Vector::from(foot) - self.reference, still));
            if let Some(group) = (particles.owner[slot as usize] as usize).checked_sub(1) {
                let arm = body.position - boundaries[group].pivot.into();
                felt[group].add(&Swept::at(&impulse, 0, arm, still));
            }
        }
    }
}
