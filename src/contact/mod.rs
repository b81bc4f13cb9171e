//! What touching bodies do to each other: pure functions of one contact and its own history.
//!
//! A contact law is composed of four sub-models: normal, tangential, rolling, cohesion. Each is one file
//! and one row in the list beside it. Laws are written over [`Number`], so the same source runs one
//! contact at a time or several in a vector register.
//!
//! Signs: the normal points from body j to body i; a positive normal force pushes i along it. The
//! relative velocity is that of i seen from j; the normal velocity is negative while they approach.

pub mod cohesion;
pub mod normal;
pub mod rolling;
pub mod tangential;

use crate::number::{Number, Vector};
use serde::Deserialize;

/// Geometry and relative motion of one contact.
#[derive(Clone, Copy, Debug)]
pub struct Contact<N = f64> {
    /// Overlap δ, above 0 \[m\].
    pub overlap: N,
    /// Effective radius R*: R_i R_j/(R_i + R_j) of two spheres, R_i at a wall \[m\].
    pub radius: N,
    /// Effective mass m*: m_i m_j/(m_i + m_j) of two spheres, m_i at a wall \[kg\].
    pub mass: N,
    /// Area of the circle in which the undeformed bodies intersect \[m²\].
    pub section_area: N,
    /// Radius in the linearised section area 2π · radius · δ: 2 R* of two spheres, R_i at a wall \[m\].
    pub section_radius: N,
    /// Unit normal, from j to i.
    pub normal: Vector<N>,
    /// Relative velocity along the normal, negative while approaching \[m/s\].
    pub normal_velocity: N,
    /// Velocity of i over j at the point of contact, in the tangent plane \[m/s\].
    pub slip: Vector<N>,
    /// Angular velocity of i less that of j \[rad/s\].
    pub relative_spin: Vector<N>,
    /// What the normal model made of effective radius and mass when the pair was found
    /// ([`Normal::pair_constant`]).
    pub pair_constant: N,
}

/// What a normal model says of a contact: stiffnesses and damping coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Response<N = f64> {
    /// k_n in the normal force k_n δ − γ_n v_n \[N/m\].
    pub normal_stiffness: N,
    /// γ_n \[kg/s\].
    pub normal_damping: N,
    /// k_t of the tangential spring \[N/m\].
    pub tangential_stiffness: N,
    /// γ_t \[kg/s\].
    pub tangential_damping: N,
}

/// One material as a law sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name in the scene.
    pub name: String,
    /// Density \[kg/m³\].
    pub density: f64,
    /// Young's modulus \[Pa\], if the scene gives one.
    pub youngs_modulus: Option<f64>,
    /// Poisson's ratio, if the scene gives one.
    pub poissons_ratio: Option<f64>,
}

/// Properties of two materials in contact: `[pair.<a>.<b>]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairProperties {
    /// Coefficient of restitution e.
    pub restitution: Option<crate::quantity::Restitution>,
    /// Coefficient of friction µ.
    pub friction: Option<crate::quantity::NonNegative>,
    /// Coefficient of rolling friction µ_r.
    pub rolling_friction: Option<crate::quantity::NonNegative>,
    /// Cohesion energy density c \[J/m³\].
    pub cohesion_energy_density: Option<crate::quantity::NonNegative>,
    /// Given normal stiffness κ_n: of `hooke_stiffness` \[N/m\], of `hertz_stiffness` \[Pa\].
    pub normal_stiffness: Option<crate::quantity::NonNegative>,
    /// Given tangential stiffness κ_t: of `hooke_stiffness` \[N/m\], of `hertz_stiffness` \[Pa\].
    pub tangential_stiffness: Option<crate::quantity::NonNegative>,
    /// Given normal damping for each effective mass: of `hooke_stiffness` \[1/s\], of `hertz_stiffness` \[1/(m s)\].
    pub normal_damping: Option<crate::quantity::NonNegative>,
    /// Given tangential damping for each effective mass: of `hooke_stiffness` \[1/s\], of `hertz_stiffness` \[1/(m s)\].
    pub tangential_damping: Option<crate::quantity::NonNegative>,
    /// Given normal damping whatever the masses, with `absolute_damping` \[kg/s\].
    pub absolute_normal_damping: Option<crate::quantity::NonNegative>,
    /// Given tangential damping whatever the masses, with `absolute_damping` \[kg/s\].
    pub absolute_tangential_damping: Option<crate::quantity::NonNegative>,
    /// Viscosity of the fluid between the bodies, η \[Pa s\].
    pub fluid_viscosity: Option<crate::quantity::Positive>,
    /// Critical Stokes number of the fluid between the bodies.
    pub critical_stokes_number: Option<crate::quantity::Positive>,
    /// Largest coefficient of restitution, without fluid.
    pub maximum_restitution: Option<crate::quantity::Restitution>,
}

/// A property that the chosen law needs and the scene does not give.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing {
    /// The table where it belongs, as `material.glass` or `pair.glass.steel`.
    pub table: String,
    /// The key that is missing.
    pub key: &'static str,
}

/// Two materials in contact and their common properties: where laws take their coefficients from.
#[derive(Clone, Copy, Debug)]
pub struct MaterialPair<'a> {
    /// One material.
    pub a: &'a Material,
    /// The other, or the same.
    pub b: &'a Material,
    /// What the two have in common.
    pub properties: &'a PairProperties,
}

/// Declares accessors of [`PairProperties`] that say which key is missing.
macro_rules! needed {
    ($($(#[$doc:meta])* $name:ident),+ $(,)?) => {
        impl MaterialPair<'_> {
            $(
                $(#[$doc])*
                pub fn $name(&self) -> Result<f64, Missing> {
                    self.properties.$name.map(|value| value.get()).ok_or_else(|| Missing {
                        table: format!("pair.{}.{}", self.a.name, self.b.name),
                        key: stringify!($name),
                    })
                }
            )+
        }
    };
}

needed! {
    /// Coefficient of restitution e.
    restitution,
    /// Coefficient of friction µ.
    friction,
    /// Coefficient of rolling friction µ_r.
    rolling_friction,
    /// Cohesion energy density \[J/m³\].
    cohesion_energy_density,
    /// κ_n \[N/m\] or \[Pa\].
    normal_stiffness,
    /// κ_t \[N/m\] or \[Pa\].
    tangential_stiffness,
    /// Normal damping for each effective mass \[1/s\] or \[1/(m s)\].
    normal_damping,
    /// Tangential damping for each effective mass \[1/s\] or \[1/(m s)\].
    tangential_damping,
    /// Normal damping \[kg/s\].
    absolute_normal_damping,
    /// Tangential damping \[kg/s\].
    absolute_tangential_damping,
    /// Viscosity of the fluid \[Pa s\].
    fluid_viscosity,
    /// Critical Stokes number.
    critical_stokes_number,
    /// Largest coefficient of restitution.
    maximum_restitution,
}

impl MaterialPair<'_> {
    /// Young's moduli and Poisson's ratios of both materials.
    fn elastic(&self) -> Result<[(f64, f64); 2], Missing> {
        let of = |material: &Material| {
            let missing = |key| Missing { table: format!("material.{}", material.name), key };
            Ok((
                material.youngs_modulus.ok_or_else(|| missing("youngs_modulus"))?,
                material.poissons_ratio.ok_or_else(|| missing("poissons_ratio"))?,
            ))
        };
        Ok([of(self.a)?, of(self.b)?])
    }

    /// Effective Young's modulus: 1/E* = (1 − ν_i²)/E_i + (1 − ν_j²)/E_j \[Pa\].
    pub fn effective_youngs_modulus(&self) -> Result<f64, Missing> {
        let compliance: f64 = self.elastic()?.iter().map(|(e, nu)| (1.0 - nu * nu) / e).sum();
        Ok(1.0 / compliance)
    }

    /// Effective shear modulus: 1/G* = Σ 2 (2 − ν)(1 + ν)/E \[Pa\].
    pub fn effective_shear_modulus(&self) -> Result<f64, Missing> {
        let compliance: f64 = self.elastic()?.iter().map(|(e, nu)| 2.0 * (2.0 - nu) * (1.0 + nu) / e).sum();
        Ok(1.0 / compliance)
    }
}

/// The numbers a sub-model needs in its loop, one set for each pair of materials.
pub trait Coefficients: Copy + Send + Sync + 'static {
    /// The same set with a lane vector for each number.
    type Lanes<N: Number>: Copy;
    /// How many numbers there are.
    const COUNT: usize;
    /// Writes the numbers, in the order of declaration.
    fn write(&self, row: &mut Vec<f64>);
    /// Takes them back.
    fn read(row: &[f64]) -> Self;
    /// The lane form of a row of [`Coefficients::COUNT`] numbers.
    fn lanes<N: Number>(row: &[N]) -> Self::Lanes<N>;
}

/// Declares the coefficients of a sub-model: a struct of [`Number`]s that implements [`Coefficients`].
macro_rules! coefficients {
    ($(#[$doc:meta])* pub struct $name:ident { $($(#[$field_doc:meta])* $field:ident,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name<N = f64> {
            $($(#[$field_doc])* pub $field: N,)*
            /// Makes a struct without coefficients generic all the same.
            #[doc(hidden)]
            pub marker: std::marker::PhantomData<N>,
        }

        impl $name {
            /// The coefficients with these values, in the order of the fields.
            #[allow(clippy::new_without_default, reason = "a sub-model without coefficients has no default meaning")]
            pub fn new($($field: f64),*) -> Self {
                Self { $($field,)* marker: std::marker::PhantomData }
            }
        }

        impl crate::contact::Coefficients for $name {
            type Lanes<N: crate::number::Number> = $name<N>;
            const COUNT: usize = <[&str]>::len(&[$(stringify!($field)),*]);
            fn write(&self, _row: &mut Vec<f64>) {
                $(_row.push(self.$field);)*
            }
            fn read(row: &[f64]) -> Self {
                Self::lanes(row)
            }
            #[inline(always)]
            fn lanes<N: crate::number::Number>(row: &[N]) -> $name<N> {
                let mut _row = row.iter();
                $(let $field = *_row.next().expect("a row has as many numbers as the sub-model");)*
                $name { $($field,)* marker: std::marker::PhantomData }
            }
        }
    };
}
pub(crate) use coefficients;

/// A sub-model without keys of its own: `[contact.<law>.<kind>.<model>]` stays empty.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoKeys {}

/// Stiffness and damping of a contact; the force k_n δ − γ_n v_n follows from them.
pub trait Normal: Coefficients {
    /// What the scene writes under the model's name.
    type Keys: Copy + std::fmt::Debug + for<'de> Deserialize<'de>;
    /// Whether [`Normal::pair_constant`] says anything.
    const HAS_PAIR_CONSTANT: bool = false;
    /// The coefficients for two materials.
    fn between(pair: &MaterialPair, keys: &Self::Keys) -> Result<Self, Missing>;
    /// What depends on effective radius \[m\] and mass \[kg\] alone and is too dear for the loop
    /// (a fractional power): found once, when the pair comes near.
    fn pair_constant(&self, _radius: f64, _mass: f64) -> f64 {
        0.0
    }
    /// Stiffness and damping of the contact at hand.
    fn response<N: Number>(law: Self::Lanes<N>, contact: &Contact<N>) -> Response<N>;
    /// Largest d(force)/d(overlap) at this overlap, for the stable time step \[N/m\].
    fn tangent_stiffness(&self, contact: &Contact) -> f64;
}

/// Friction: force in the tangent plane.
pub trait Tangential: Coefficients {
    /// What the scene writes under the model's name.
    type Keys: Copy + std::fmt::Debug + for<'de> Deserialize<'de>;
    /// Whether there is a force at all; without one nothing tangential is evaluated.
    const ACTIVE: bool;
    /// Whether a tangential spring is carried from step to step.
    const HAS_SPRING: bool;
    /// The coefficients for two materials.
    fn between(pair: &MaterialPair, keys: &Self::Keys) -> Result<Self, Missing>;
    /// Force on i \[N\], the new spring \[m\], and where the spring is at its limit. `pressure` is the normal force that friction sees \[N\],
    /// `step` the time since the spring was last seen \[s\] (0 in the evaluation before the first step).
    fn force<N: Number>(
        law: Self::Lanes<N>,
        contact: &Contact<N>,
        response: &Response<N>,
        pressure: N,
        spring: Vector<N>,
        step: N,
    ) -> (Vector<N>, Vector<N>, N::Mask);
}

/// Resistance against rolling.
pub trait Rolling: Coefficients {
    /// What the scene writes under the model's name.
    type Keys: Copy + std::fmt::Debug + for<'de> Deserialize<'de>;
    /// Whether there is a torque at all.
    const ACTIVE: bool;
    /// The coefficients for two materials.
    fn between(pair: &MaterialPair, keys: &Self::Keys) -> Result<Self, Missing>;
    /// Torque taken from i and given to j \[N m\].
    fn torque<N: Number>(law: Self::Lanes<N>, contact: &Contact<N>, response: &Response<N>) -> Vector<N>;
}

/// Attraction of touching bodies.
pub trait Cohesion: Coefficients {
    /// What the scene writes under the model's name.
    type Keys: Copy + std::fmt::Debug + for<'de> Deserialize<'de>;
    /// Whether there is a force at all.
    const ACTIVE: bool;
    /// The coefficients for two materials.
    fn between(pair: &MaterialPair, keys: &Self::Keys) -> Result<Self, Missing>;
    /// Force along the normal, negative for a pull \[N\].
    fn force<N: Number>(law: Self::Lanes<N>, contact: &Contact<N>) -> N;
    /// The part of that force which the friction limit sees \[N\] (`tangential_reduce`).
    fn seen_by_friction<N: Number>(law: Self::Lanes<N>, force: N) -> N;
}

coefficients! {
    /// Switches that every normal model takes, as numbers so that the loop has no branch.
    pub struct Switches {
        /// Lower bound of the normal force \[N\]: −∞, or 0 with `limit_force`.
        least_force,
        /// Factor on γ_t: 1, or 0 without `tangential_damping`.
        tangential_damping_factor,
    }
}

/// What one contact does to its two bodies.
#[derive(Clone, Copy)]
pub struct Reaction<N: Number = f64> {
    /// Force on i; j gets the opposite \[N\].
    pub force: Vector<N>,
    /// n × F_t, which turns both bodies against their arms \[N\].
    pub couple: Vector<N>,
    /// Rolling torque taken from i and given to j \[N m\].
    pub rolling: Vector<N>,
    /// The tangential spring to remember \[m\].
    pub spring: Vector<N>,
    /// Where the tangential spring is at its limit.
    pub sliding: N::Mask,
}

/// A contact law, whole: what the pass in the time step is generic over.
pub trait Law: Send + Sync + 'static {
    /// How many coefficients a pair of materials has.
    const COUNT: usize;
    /// Whether a pair constant is kept for each near pair.
    const HAS_PAIR_CONSTANT: bool;
    /// Whether bodies feel torque from it.
    const HAS_TORQUE: bool;
    /// Whether bodies feel rolling torque from it.
    const HAS_ROLLING: bool;
    /// Whether a tangential spring is carried.
    const HAS_SPRING: bool;
    /// The coefficients of two materials, [`Law::COUNT`] of them.
    fn row(&self, pair: &MaterialPair) -> Result<Vec<f64>, Missing>;
    /// The pair constant of [`Normal::pair_constant`].
    fn pair_constant(row: &[f64], radius: f64, mass: f64) -> f64;
    /// Force and torque of one contact.
    fn react<N: Number>(row: &[N], contact: &Contact<N>, spring: Vector<N>, step: N) -> Reaction<N>;
    /// Tangent normal stiffness, tangential stiffness \[N/m\] and damping coefficients \[kg/s\].
    fn stiffness(row: &[f64], contact: &Contact) -> Response;
}

/// The law that the scene composed of four sub-models.
#[derive(Clone, Copy, Debug)]
pub struct Composed<A: Normal, B: Tangential, C: Rolling, D: Cohesion> {
    /// Normal sub-model's keys.
    pub normal: A::Keys,
    /// Tangential sub-model's keys.
    pub tangential: B::Keys,
    /// Rolling sub-model's keys.
    pub rolling: C::Keys,
    /// Cohesion sub-model's keys.
    pub cohesion: D::Keys,
    /// Switches of every law.
    pub switches: Switches,
}

impl<A, B, C, D> Law for Composed<A, B, C, D>
where
    A: Normal<Keys: Send + Sync + 'static>,
    B: Tangential<Keys: Send + Sync + 'static>,
    C: Rolling<Keys: Send + Sync + 'static>,
    D: Cohesion<Keys: Send + Sync + 'static>,
{
    const COUNT: usize = A::COUNT + B::COUNT + C::COUNT + D::COUNT + Switches::COUNT;
    const HAS_PAIR_CONSTANT: bool = A::HAS_PAIR_CONSTANT;
    const HAS_TORQUE: bool = B::ACTIVE || C::ACTIVE;
    const HAS_ROLLING: bool = C::ACTIVE;
    const HAS_SPRING: bool = B::HAS_SPRING;

    fn row(&self, pair: &MaterialPair) -> Result<Vec<f64>, Missing> {
        let mut row = Vec::with_capacity(Self::COUNT);
        A::between(pair, &self.normal)?.write(&mut row);
        B::between(pair, &self.tangential)?.write(&mut row);
        C::between(pair, &self.rolling)?.write(&mut row);
        D::between(pair, &self.cohesion)?.write(&mut row);
        self.switches.write(&mut row);
        Ok(row)
    }

    fn pair_constant(row: &[f64], radius: f64, mass: f64) -> f64 {
        A::read(row).pair_constant(radius, mass)
    }

    #[inline(always)]
    fn react<N: Number>(row: &[N], contact: &Contact<N>, spring: Vector<N>, step: N) -> Reaction<N> {
        let (normal, row) = (A::lanes(row), &row[A::COUNT..]);
        let (tangential, row) = (B::lanes(row), &row[B::COUNT..]);
        let (rolling, row) = (C::lanes(row), &row[C::COUNT..]);
        let (cohesion, row) = (D::lanes(row), &row[D::COUNT..]);
        let switches = Switches::lanes(row);

        let mut response = A::response(normal, contact);
        response.tangential_damping = response.tangential_damping * switches.tangential_damping_factor;
        let elastic = response.normal_stiffness * contact.overlap;
        let push = (elastic - response.normal_damping * contact.normal_velocity).max(switches.least_force);
        let mut along = push;
        let mut seen = push;
        if D::ACTIVE {
            let pull = D::force(cohesion, contact);
            along = along + pull;
            seen = seen + D::seen_by_friction(cohesion, pull);
        }
        let mut force = contact.normal * along;
        let never = N::zero().greater(N::zero());
        let mut reaction = Reaction { force, couple: Vector::zero(), rolling: Vector::zero(), spring, sliding: never };
        if B::ACTIVE {
            let (friction, spring, sliding) = B::force(tangential, contact, &response, seen.abs(), spring, step);
            force += friction;
            reaction.force = force;
            reaction.couple = contact.normal.cross(friction);
            reaction.spring = spring;
            reaction.sliding = sliding;
        }
        if C::ACTIVE {
            reaction.rolling = C::torque(rolling, contact, &response);
        }
        reaction
    }

    fn stiffness(row: &[f64], contact: &Contact) -> Response {
        let mut response = A::response(A::lanes(row), contact);
        response.normal_stiffness = A::read(row).tangent_stiffness(contact);
        if !B::ACTIVE {
            response.tangential_stiffness = 0.0;
            response.tangential_damping = 0.0;
        }
        if !B::HAS_SPRING {
            response.tangential_stiffness = 0.0;
        }
        response
    }
}
