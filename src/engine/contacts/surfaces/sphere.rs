//! A sphere at a surface: geometry of the contact, and what it does to both.

use crate::base::lanes::{Lane, Shared, vector};
use crate::base::number::{Number, Vector, add, subtract};
use crate::engine::boundaries::passing::MovedParticles;
use crate::engine::contacts::batches::{ContactGeometry, Lost};
use crate::engine::state::heat::{Level, exchange};
use crate::engine::state::{Particles, Row};
use crate::laws::contact::{Contact, Needs};
use std::f64::consts::PI;

/// A sphere that touches a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphereAt<N = f64> {
    /// Unit normal, from the surface to the centre.
    pub(super) normal: Vector<N>,
    /// Distance of the centre \[m\].
    pub(super) distance: N,
    /// Radius \[m\].
    pub(super) radius: N,
}

impl<N: Number> SphereAt<N> {
    /// Arm at the particle: to half an overlap behind the surface, where the loads act \[m\].
    #[inline(always)]
    pub(super) fn arm(&self) -> N {
        self.radius - (self.radius - self.distance) * N::splat(0.5)
    }

    /// Area of the circle in which the sphere stands in the surface \[m²\].
    #[inline(always)]
    pub(super) fn section(&self) -> N {
        let overlap = self.radius - self.distance;
        N::splat(PI) * overlap * (self.radius + self.radius - overlap)
    }

    /// Geometry and relative motion, where the surface has this velocity \[m/s\] at the point of contact, and the sphere turns
    /// by so much more than the surface \[rad/s\]. A surface that forces move is accelerated so much there by a force along the
    /// normal \[1/kg\].
    #[inline(always)]
    pub(super) fn meet(
        &self,
        [velocity, spin]: [[N; 4]; 2],
        (surface_velocity, relative_spin): (Vector<N>, Vector<N>),
        mobility: Option<N>,
        pair_constant: N,
    ) -> ContactGeometry<N> {
        let Self { normal, distance, radius } = *self;
        let overlap = radius - distance;
        let arm = self.arm();
        let relative = vector(velocity) - surface_velocity;
        let normal_velocity = relative.dot(normal);
        let turning = vector(spin) * arm;
        let contact = Contact {
            overlap,
            radius,
            mass: mobility.map_or(velocity[3], |mobility| velocity[3] / (N::splat(1.0) + velocity[3] * mobility)),
            section_area: self.section(),
            section_radius: radius,
            normal,
            normal_velocity,
            slip: relative - normal * normal_velocity - turning.cross(normal),
            relative_spin,
            spin_sum: vector(spin),
            turning,
            per_distance: N::zero(),
            per_reach: N::zero(),
            rolling_inertia: velocity[3] * radius * radius,
            pair_constant,
        };
        ContactGeometry { contact, first_arm: arm, second_arm: N::zero() }
    }
}

/// The part of a vector along a surface with this normal.
#[inline(always)]
pub(super) fn along<N: Number>(v: Vector<N>, normal: Vector<N>) -> Vector<N> {
    v - normal * v.dot(normal)
}

/// A vector in lanes.
#[inline(always)]
pub(super) fn lanes<N: Number>(v: Vector) -> Vector<N> {
    Vector::new(N::splat(v.x), N::splat(v.y), N::splat(v.z))
}

/// The particles, while loads are added to them. Each belongs to one piece of work.
#[derive(Clone, Copy)]
pub(super) struct ParticleLoads<'a> {
    /// Positions and radii.
    pub(super) position: &'a [Row],
    /// Velocities and masses.
    velocity: &'a [Row],
    /// Angular velocities.
    angular_velocity: &'a [Row],
    /// Materials.
    pub(super) material: &'a [u32],
    /// 0, or the boundary that carries the particle and 1.
    owner: &'a [u32],
    /// Forces.
    force: Shared<Row>,
    /// Torques.
    torque: Shared<Row>,
    /// Heat of losses \[J\]; empty where none warms the particles.
    heat: Shared<f64>,
    /// Temperatures and heat flows; empty where nothing conducts.
    present: Shared<Row>,
}

impl<'a> ParticleLoads<'a> {
    /// The particles of a state, heat that losses give to them \[J\], and their temperatures and heat flows.
    pub(super) fn of(particles: &'a mut Particles, heat: &'a mut [f64], present: &'a mut [Row]) -> Self {
        let (force, torque) = (Shared::new(&mut particles.force), Shared::new(&mut particles.torque));
        let (heat, present) = (Shared::new(heat), Shared::new(present));
        Self { force, torque, heat, present, ..Self::looking(particles) }
    }

    /// The particles of a state that is looked at alone: nothing is added to them.
    pub(super) fn looking(particles: &'a Particles) -> Self {
        Self {
            position: &particles.position,
            velocity: &particles.velocity,
            angular_velocity: &particles.angular_velocity,
            material: &particles.material,
            owner: &particles.owner,
            force: Shared::new(&mut []),
            torque: Shared::new(&mut []),
            heat: Shared::new(&mut []),
            present: Shared::new(&mut []),
        }
    }

    /// Adds heat of a loss \[J\], of which the surface takes this share, to a particle and the surface.
    ///
    /// # Safety
    /// The particle belongs to the piece of work that asks.
    pub(super) unsafe fn warm(&self, slot: u32, heat: f64, share: f64, load: &mut Load) {
        // SAFETY: the caller's promise.
        unsafe { *self.heat.at(slot as usize) += heat * (1.0 - share) };
        load.heat += heat * share;
    }

    /// Lets heat flow between a particle and a surface of this temperature over a conductance \[W/K\]. Returns the flow into the surface \[W\].
    ///
    /// # Safety
    /// The particle belongs to the piece of work that asks.
    #[inline(always)]
    pub(super) unsafe fn conduct(&self, slot: u32, level: Level, conductance: f64, load: &mut Load) -> f64 {
        let mut surface = [level[0], level[1], 0.0, 0.0];
        // SAFETY: the caller's promise.
        unsafe { exchange([self.present.at(slot as usize), &mut surface], conductance) };
        let [_, _, flow, sum] = surface;
        load.heat_flow = [load.heat_flow[0] + flow, load.heat_flow[1] + sum];
        flow
    }

    /// Velocities and, where there is torque, angular velocities of some particles.
    ///
    /// # Safety
    /// `slots` points to [`Lane::WIDTH`] slots of particles.
    #[inline(always)]
    pub(super) unsafe fn motion<N: Lane, const TORQUE: bool>(&self, slots: *const u32) -> [[N; 4]; 2] {
        // SAFETY: the caller's promise.
        unsafe {
            let spin = if TORQUE { N::load_rows(self.angular_velocity.as_ptr(), slots) } else { [N::zero(); 4] };
            [N::load_rows(self.velocity.as_ptr(), slots), spin]
        }
    }

    /// How they moved in a time step of this length \[s\].
    pub(super) fn moved(&self, step: f64) -> MovedParticles<'a> {
        MovedParticles { position: self.position, velocity: self.velocity, owner: self.owner, step }
    }

    /// Position, velocity and angular velocity of a particle.
    pub(super) fn body(&self, slot: usize) -> [Row; 3] {
        [self.position[slot], self.velocity[slot], self.angular_velocity[slot]]
    }

    /// Adds what a contact does to its particle and to the surface: force on the particle \[N\], n × friction \[N\] and rolling
    /// torque \[N m\] (anything where the law has none). Moments on the surface are about `pivot`.
    ///
    /// # Safety
    /// The particle belongs to the piece of work that asks.
    #[inline(always)]
    pub(super) unsafe fn add(
        &self,
        slot: usize,
        (normal, arm): (Vector, f64),
        [force, couple, rolling]: &[Row; 3],
        needs: Needs,
        (pivot, load): (Vector, &mut Load),
    ) {
        // SAFETY: the caller's promise.
        unsafe {
            add(self.force.at(slot), force);
            if needs.torque {
                let mut torque = couple.map(|part| -(part * arm));
                if needs.spin {
                    subtract(&mut torque, rolling);
                }
                add(self.torque.at(slot), &torque);
            }
        }
        let point = Vector::from(self.position[slot]) - normal * arm;
        let mut moment = (point - pivot).cross((*force).into());
        if needs.spin {
            moment = moment - (*rolling).into();
        }
        for (axis, part) in moment.to_array().into_iter().enumerate() {
            load.force[axis] -= force[axis];
            load.moment[axis] -= part;
        }
    }
}

/// What a piece of the particles does to a surface.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Load {
    /// Force on the surface \[N\].
    pub(super) force: [f64; 3],
    /// Moment about the moved reference point \[N m\].
    pub(super) moment: [f64; 3],
    /// Power of the surface that runs in itself, on the particles \[W\].
    pub(super) conveying_power: f64,
    /// What was lost, where that is booked.
    pub(super) lost: Lost,
    /// What of it warms the surface \[J\].
    pub(super) heat: f64,
    /// Heat flow into the surface \[W\], and the sum of the conductances \[W/K\].
    pub(super) heat_flow: [f64; 2],
    /// A particle (slot) whose centre is behind the surface, or went through it.
    pub(super) behind: Option<u32>,
}
