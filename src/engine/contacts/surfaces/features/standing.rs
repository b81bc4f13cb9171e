//! A surface of features where it stands, and a particle that touches it there.

use crate::base::geometry::Frame;
use crate::base::lanes::{Lane, vector};
use crate::base::number::Vector;
use crate::engine::bodies::RigidBody;
use crate::engine::contacts::batches::ContactGeometry;
use crate::engine::contacts::surfaces::nodes::Moving;
use crate::engine::contacts::surfaces::sphere::{SphereAt, along, lanes};
use crate::engine::contacts::surfaces::{AtSurface, Touched};
use crate::engine::state::heat::BoundaryHeat;
use crate::engine::state::{BoundaryState, Nodes, Row};
use crate::laws::contact::{Contact, Law, MOST_HISTORY};
use crate::laws::surface::{Features, Feet, Foot, Surface};
use std::sync::PoisonError;

/// A surface where it stands, as it moves.
#[derive(Clone, Copy)]
pub(in crate::engine::contacts::surfaces) struct MovingSurface<'a> {
    /// Its features, in its own axes.
    pub(super) features: &'a dyn Features,
    /// Where these axes are.
    pub(super) frame: Frame,
    /// The moved point of reference \[m\].
    pub(super) pivot: Vector,
    /// Velocity of that point \[m/s\].
    pub(super) velocity: Vector,
    /// Angular velocity \[rad/s\].
    pub(super) spin: Vector,
    /// Whether it turns.
    pub(super) turning: bool,
    /// How the surface runs in itself where it lies along this \[m/s\].
    pub(super) conveying: Vector,
    /// Whether it does.
    pub(super) conveys: bool,
    /// Its nodes, where they move one by one.
    pub(super) moving: Option<Moving<'a>>,
    /// Their temperatures; empty where they have none.
    pub(super) warm: &'a [BoundaryHeat],
    /// How forces accelerate it, where they move it.
    pub(super) mobility: Option<Mobility>,
}

/// How forces accelerate a surface.
#[derive(Clone, Copy)]
pub(super) struct Mobility {
    /// Acceleration of the point of reference along x, y, z by a force \[1/kg\].
    along: Vector,
    /// Angular acceleration by a moment about x, y, z \[1/(kg m²)\].
    about: [Vector; 3],
}

impl Mobility {
    /// Of a body where its boundary stands.
    fn of(body: &RigidBody, boundary: &BoundaryState) -> Self {
        let along = Vector::from([0, 1, 2].map(|axis| if body.moves[axis] { 1.0 / body.mass } else { 0.0 }));
        Self { along, about: body.turned_by_units(boundary) }
    }

    /// The acceleration along a normal of a point at this arm \[m\] by a force along it there \[1/kg\].
    #[inline(always)]
    fn along<N: Lane>(&self, normal: Vector<N>, arm: Vector<N>) -> N {
        let (own, moment) = (lanes::<N>(self.along), arm.cross(normal));
        let [x, y, z] = self.about.map(lanes::<N>);
        let turning = x * moment.x + y * moment.y + z * moment.z;
        let shift = normal.x * normal.x * own.x + normal.y * normal.y * own.y + normal.z * normal.z * own.z;
        shift + turning.dot(moment)
    }
}

impl<'a> MovingSurface<'a> {
    /// Where its axes are.
    pub(in crate::engine::contacts::surfaces) fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The mesh as its nodes stand, where they move one by one.
    pub(in crate::engine::contacts::surfaces) fn deformed(&self) -> Option<&'a dyn Surface> {
        self.moving.map(|moving| moving.shape.surface())
    }

    /// The same before its velocity and its angular velocity grew by this much.
    pub(super) fn before(self, kick: Vector, twist: Vector) -> Self {
        let spin = self.spin - twist;
        Self { velocity: self.velocity - kick, spin, turning: spin != Vector::zero(), ..self }
    }

    /// A surface of features where its boundary stands.
    pub(super) fn of(features: &'a dyn Features, surface: &AtSurface, boundary: &BoundaryState) -> Self {
        let frame = Frame::of(surface.reference, boundary.shift().into(), boundary.orientation.0);
        let spin = boundary.angular_velocity.into();
        let (pivot, turning) = (frame.pivot(), spin != Vector::zero());
        let (conveying, conveys) = (frame.outside(surface.conveying), surface.conveying != Vector::zero());
        let velocity = boundary.velocity.into();
        let mobility = surface.body.as_ref().map(|body| Mobility::of(body, boundary));
        Self { features, frame, pivot, velocity, spin, turning, conveying, conveys, moving: None, warm: &[], mobility }
    }

    /// The surface of a boundary, whose nodes may move one by one, where it stands.
    pub(super) fn with<T>(
        surface: &AtSurface,
        (boundary, nodes): (&BoundaryState, Option<&Nodes>),
        then: impl FnOnce(MovingSurface) -> T,
    ) -> Option<T> {
        match (&surface.touched, nodes) {
            (Touched::Features(shape), _) => Some(then(MovingSurface::of(shape.features()?, surface, boundary))),
            (Touched::Nodes(shape), Some(nodes)) => {
                let shape = shape.read().unwrap_or_else(PoisonError::into_inner);
                let moving = Some(Moving { shape: &shape, nodes });
                Some(then(MovingSurface { moving, ..MovingSurface::of(shape.features(), surface, boundary) }))
            }
            _ => None,
        }
    }

    /// Geometry and relative motion of spheres. The surface moves as at the point of contact, half an overlap behind it, where
    /// the loads act, too: so angular momentum is kept.
    #[inline(always)]
    pub(super) fn meet<N: Lane>(
        &self,
        sphere: &SphereAt<N>,
        position: [N; 4],
        motion: [[N; 4]; 2],
        moving: Option<[Vector<N>; 2]>,
        pair_constant: N,
    ) -> ContactGeometry<N> {
        let (mut velocity, mut relative_spin) = (lanes(self.velocity), vector(motion[1]));
        if self.turning {
            let (spin, point) = (lanes(self.spin), vector(position) - sphere.normal * sphere.arm());
            velocity += spin.cross(point - lanes(self.pivot));
            relative_spin = relative_spin - spin;
        }
        if let Some([along, about]) = moving {
            velocity += along;
            relative_spin = relative_spin - about;
        }
        if self.conveys {
            velocity += along(lanes(self.conveying), sphere.normal);
        }
        let mobility = self.mobility.map(|mobility| {
            let point = vector(position) - sphere.normal * sphere.arm();
            mobility.along(sphere.normal, point - lanes(self.pivot))
        });
        sphere.meet(motion, (velocity, relative_spin), mobility, pair_constant)
    }
}

/// A particle: position and radius, velocity and mass, angular velocity.
pub(super) type Body = [Row; 3];

/// What a particle touches, and by which coefficients.
pub(super) struct SphereOnSurface<'a> {
    /// The surface.
    pub(super) at: &'a MovingSurface<'a>,
    /// The particle.
    pub(super) body: Body,
    /// Coefficients.
    pub(super) row: &'a [f64],
    /// Pair constant.
    pub(super) constant: f64,
}

impl SphereOnSurface<'_> {
    /// The contact at a foot.
    pub(super) fn meet(&self, foot: &Foot) -> ContactGeometry {
        let moving = self.at.moving.map(|moving| moving.motion(foot, self.centre(), self.body[0][3]));
        self.meet_moving(foot, moving)
    }

    /// Its centre in the axes of the surface \[m\].
    pub(super) fn centre(&self) -> Vector {
        self.at.frame.inside(Vector::from(self.body[0]))
    }

    /// The contact at a foot, where the nodes give this motion to the surface.
    pub(super) fn meet_moving(&self, foot: &Foot, moving: Option<[Vector; 2]>) -> ContactGeometry {
        let [position, velocity, spin] = self.body;
        let normal = self.at.frame.outside(foot.normal);
        let sphere = SphereAt { normal, distance: foot.distance, radius: position[3] };
        self.at.meet(&sphere, position, [velocity, spin], moving, self.constant)
    }

    /// Elastic force of a foot without motion \[N\].
    pub(super) fn pressing(&self, law: &Law, foot: &Foot) -> f64 {
        let mut resting = Contact {
            normal_velocity: 0.0,
            slip: Vector::zero(),
            relative_spin: Vector::zero(),
            ..self.meet_moving(foot, None).contact
        };
        law.react(self.row, &mut resting, &mut [[0.0; 4]; MOST_HISTORY], 0.0).force.dot(resting.normal)
    }

    /// The share of friction that a foot has: none at a saddle, less than all at its faces.
    pub(super) fn friction(&self, law: &Law, foot: &Foot, feet: &Feet) -> f64 {
        let mut share = foot.weight;
        for saddle in &feet.saddles {
            let Some(place) = saddle.faces.iter().position(|face| *face == foot.feature) else { continue };
            let Some(edge) = feet.on(saddle.feature) else { continue };
            let force = self.pressing(law, foot);
            if force != 0.0 {
                share -= saddle.shares[place] * self.pressing(law, edge) / force;
            }
        }
        share.max(0.0)
    }
}
