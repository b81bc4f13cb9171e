//! Where the value of each variable is found, and what is said of it.

use super::{Causality, Quantity, Value, Variability, Variable};
use crate::quantity::BoundaryIndex;
use crate::scene::Scene;
use crate::step::Simulation;

/// Names of the axes in variables.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Where the value of a variable is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// Displacement of a boundary along an axis \[m\].
    Displacement(BoundaryIndex, usize),
    /// Rotation of a boundary about an axis \[rad\].
    Rotation(BoundaryIndex, usize),
    /// Velocity of a boundary along an axis \[m/s\].
    Velocity(BoundaryIndex, usize),
    /// Angular velocity of a boundary about an axis \[rad/s\].
    AngularVelocity(BoundaryIndex, usize),
    /// Force on a boundary along an axis \[N\].
    Force(BoundaryIndex, usize),
    /// Moment on a boundary about an axis \[N m\].
    Moment(BoundaryIndex, usize),
    /// Mean of the force over the last communication step \[N\].
    MeanForce(BoundaryIndex, usize),
    /// Mean of the moment over the last communication step \[N m\].
    MeanMoment(BoundaryIndex, usize),
    /// Work of a boundary on the particles \[J\].
    Work(BoundaryIndex),
    /// Mass of a group of particles \[kg\].
    Mass(BoundaryIndex),
    /// Kinetic energy of the particles \[J\].
    KineticEnergy,
    /// Elastic energy of contacts and bonds \[J\].
    ElasticEnergy,
    /// What contacts, bonds and global damping took \[J\].
    DissipatedEnergy,
    /// Elastic energy of the bonds \[J\].
    BondElasticEnergy,
    /// What left the bonds \[J\].
    BondDissipatedEnergy,
    /// What the algorithmic energy book leaves over \[J\].
    EnergyResidual,
    /// Number of contacts.
    ContactCount,
    /// Largest overlap over radius.
    LargestOverlap,
    /// Number of living bonds.
    IntactBonds,
    /// Number of bonds that broke.
    BrokenBonds,
    /// The time step \[s\].
    TimeStep,
    /// The largest stable time step \[s\].
    StableStep,
}

impl Meaning {
    /// Its present value.
    pub(super) fn value(self, simulation: &Simulation) -> Value {
        let state = simulation.state();
        let of = |boundary: BoundaryIndex| &state.boundaries[boundary.index()];
        Value::Real(match self {
            Self::Displacement(boundary, axis) if self.is_input(simulation.scene()) => of(boundary).target[axis],
            Self::Rotation(boundary, axis) if self.is_input(simulation.scene()) => of(boundary).target[3 + axis],
            Self::Displacement(boundary, axis) => of(boundary).displacement[axis],
            Self::Rotation(boundary, axis) => of(boundary).rotation[axis],
            Self::Velocity(boundary, axis) => of(boundary).velocity[axis],
            Self::AngularVelocity(boundary, axis) => of(boundary).angular_velocity[axis],
            Self::Force(boundary, axis) => of(boundary).force[axis],
            Self::Moment(boundary, axis) => of(boundary).moment[axis],
            Self::MeanForce(boundary, axis) => of(boundary).mean_force[axis],
            Self::MeanMoment(boundary, axis) => of(boundary).mean_moment[axis],
            Self::Work(boundary) => of(boundary).work,
            Self::Mass(boundary) => mass(simulation.scene(), boundary),
            Self::KineticEnergy => simulation.kinetic_energy(),
            Self::ElasticEnergy => simulation.elastic_energy(),
            Self::DissipatedEnergy => simulation.dissipated_energy().unwrap_or(0.0),
            Self::BondElasticEnergy => simulation.bond_elastic_energy(),
            Self::BondDissipatedEnergy => state.bonds.iter().map(crate::state::BondList::dissipated).sum(),
            Self::EnergyResidual => simulation.energy_residual().unwrap_or(0.0),
            Self::ContactCount => return count(simulation.contact_count() as u64),
            Self::IntactBonds => return count(state.bonds.iter().map(|list| list.first.len() as u64).sum()),
            Self::BrokenBonds => return count(state.bonds.iter().map(|list| list.broken).sum()),
            Self::LargestOverlap => simulation.largest_overlap(),
            Self::TimeStep => state.clock.step,
            // where nothing is stiff there is no bound, and infinity is no value of a variable
            Self::StableStep => state.clock.stable.min(f64::MAX),
        })
    }

    /// The variable that shows it.
    pub(super) fn variable(self, scene: &Scene) -> Variable {
        let is_input = self.is_input(scene);
        let start = match self {
            _ if is_input => Some(0.0),
            Self::Mass(boundary) => Some(mass(scene, boundary)),
            _ => None,
        };
        let variability = match self {
            Self::Mass(_) => Variability::Constant,
            Self::ContactCount | Self::IntactBonds | Self::BrokenBonds | Self::TimeStep | Self::StableStep => {
                Variability::Discrete
            }
            _ => Variability::Continuous,
        };
        let starts_at_rest = matches!(
            self,
            Self::Displacement(..)
                | Self::Rotation(..)
                | Self::Velocity(..)
                | Self::AngularVelocity(..)
                | Self::Work(_)
                | Self::Mass(_)
                | Self::KineticEnergy
                | Self::DissipatedEnergy
                | Self::BondDissipatedEnergy
                | Self::EnergyResidual
        );
        Variable {
            name: self.name(scene),
            description: self.description(scene),
            quantity: self.quantity(),
            causality: if is_input { Causality::Input } else { Causality::Output },
            variability,
            start,
            minimum: self.minimum(),
            follows_inputs_at_start: !is_input && !starts_at_rest,
            meaning: self,
        }
    }

    /// The axis (0 to 5) whose place it is.
    pub(super) fn axis(self) -> Option<(BoundaryIndex, usize)> {
        match self {
            Self::Displacement(boundary, axis) => Some((boundary, axis)),
            Self::Rotation(boundary, axis) => Some((boundary, 3 + axis)),
            _ => None,
        }
    }

    /// Whether the outside gives it.
    fn is_input(self, scene: &Scene) -> bool {
        self.axis().is_some_and(|(boundary, axis)| scene.boundaries[boundary.index()].axes[axis].is_driven())
    }

    /// What it measures.
    fn quantity(self) -> Quantity {
        match self {
            Self::Displacement(..) => Quantity::Length,
            Self::Rotation(..) => Quantity::Angle,
            Self::Velocity(..) => Quantity::Velocity,
            Self::AngularVelocity(..) => Quantity::AngularVelocity,
            Self::Force(..) | Self::MeanForce(..) => Quantity::Force,
            Self::Moment(..) | Self::MeanMoment(..) => Quantity::Torque,
            Self::Work(_)
            | Self::KineticEnergy
            | Self::ElasticEnergy
            | Self::DissipatedEnergy
            | Self::BondElasticEnergy
            | Self::BondDissipatedEnergy
            | Self::EnergyResidual => Quantity::Energy,
            Self::Mass(_) => Quantity::Mass,
            Self::ContactCount | Self::IntactBonds | Self::BrokenBonds => Quantity::Count,
            Self::LargestOverlap => Quantity::Ratio,
            Self::TimeStep | Self::StableStep => Quantity::Time,
        }
    }

    /// Its lower bound, where nature sets one.
    fn minimum(self) -> Option<f64> {
        match self {
            Self::Mass(_)
            | Self::KineticEnergy
            | Self::ElasticEnergy
            | Self::BondElasticEnergy
            | Self::ContactCount
            | Self::IntactBonds
            | Self::BrokenBonds
            | Self::LargestOverlap
            | Self::TimeStep
            | Self::StableStep => Some(0.0),
            _ => None,
        }
    }

    /// The name of its variable.
    fn name(self, scene: &Scene) -> String {
        let of = |boundary: BoundaryIndex| &scene.boundaries[boundary.index()].name;
        match self {
            Self::Displacement(boundary, axis) => format!("{}.displacement.{}", of(boundary), AXES[axis]),
            Self::Rotation(boundary, axis) => format!("{}.rotation.{}", of(boundary), AXES[axis]),
            Self::Velocity(boundary, axis) => format!("{}.velocity.{}", of(boundary), AXES[axis]),
            Self::AngularVelocity(boundary, axis) => format!("{}.angular_velocity.{}", of(boundary), AXES[axis]),
            Self::Force(boundary, axis) => format!("{}.force.{}", of(boundary), AXES[axis]),
            Self::Moment(boundary, axis) => format!("{}.moment.{}", of(boundary), AXES[axis]),
            Self::MeanForce(boundary, axis) => format!("{}.mean_force.{}", of(boundary), AXES[axis]),
            Self::MeanMoment(boundary, axis) => format!("{}.mean_moment.{}", of(boundary), AXES[axis]),
            Self::Work(boundary) => format!("{}.work", of(boundary)),
            Self::Mass(boundary) => format!("{}.mass", of(boundary)),
            Self::KineticEnergy => "energy.kinetic".to_owned(),
            Self::ElasticEnergy => "energy.elastic".to_owned(),
            Self::DissipatedEnergy => "energy.dissipated".to_owned(),
            Self::BondElasticEnergy => "bonds.elastic_energy".to_owned(),
            Self::BondDissipatedEnergy => "bonds.dissipated_energy".to_owned(),
            Self::EnergyResidual => "energy.residual".to_owned(),
            Self::ContactCount => "contacts.count".to_owned(),
            Self::IntactBonds => "bonds.intact".to_owned(),
            Self::BrokenBonds => "bonds.broken".to_owned(),
            Self::LargestOverlap => "overlap.max".to_owned(),
            Self::TimeStep => "time_step.current".to_owned(),
            Self::StableStep => "time_step.stable".to_owned(),
        }
    }

    /// What it is, with its sign.
    fn description(self, scene: &Scene) -> String {
        let of = |boundary: BoundaryIndex| &scene.boundaries[boundary.index()];
        match self {
            Self::Displacement(boundary, axis) if self.is_input(scene) => format!(
                "displacement of {} along {} since the scene's time 0, to be reached at the end of the \
                 communication step; at initialisation taken without motion",
                of(boundary).name,
                AXES[axis]
            ),
            Self::Displacement(boundary, axis) => {
                format!("displacement of {} along {} since the scene's time 0", of(boundary).name, AXES[axis])
            }
            Self::Rotation(boundary, axis) if self.is_input(scene) => format!(
                "rotation of {} about {} since the scene's time 0, to be reached at the end of the communication \
                 step; at initialisation taken without motion",
                of(boundary).name,
                AXES[axis]
            ),
            Self::Rotation(boundary, axis) => {
                format!("rotation of {} about {} since the scene's time 0", of(boundary).name, AXES[axis])
            }
            Self::Velocity(boundary, axis) => format!("velocity of {} along {}", of(boundary).name, AXES[axis]),
            Self::AngularVelocity(boundary, axis) => {
                format!("angular velocity of {} about {}", of(boundary).name, AXES[axis])
            }
            Self::Force(boundary, axis) => {
                format!("force of the particles on {} along {}", of(boundary).name, AXES[axis])
            }
            Self::Moment(boundary, axis) => format!(
                "moment of the particles on {} about {} through its moved reference point",
                of(boundary).name,
                AXES[axis]
            ),
            Self::MeanForce(boundary, axis) => format!(
                "force of the particles on {} along {}, mean over the last communication step",
                of(boundary).name,
                AXES[axis]
            ),
            Self::MeanMoment(boundary, axis) => format!(
                "moment of the particles on {} about {}, mean over the last communication step",
                of(boundary).name,
                AXES[axis]
            ),
            Self::Work(boundary) => {
                format!("work done by {} on the particles since the start", of(boundary).name)
            }
            Self::Mass(boundary) => {
                format!("mass of the particles of {}; their weight and inertia are not in its force", of(boundary).name)
            }
            Self::KineticEnergy => "kinetic energy of the particles and groups that move freely".to_owned(),
            Self::ElasticEnergy => "elastic energy of normal forces, tangential springs and bonds".to_owned(),
            Self::DissipatedEnergy => {
                "energy that contacts, bonds and global damping took in and do not hold as elastic energy, since the \
                 scene's time 0"
                    .to_owned()
            }
            Self::BondElasticEnergy => "elastic energy of the living bonds".to_owned(),
            Self::BondDissipatedEnergy => {
                "energy that damping and relaxation took of the bonds and that broken bonds released, since the scene's \
                 time 0"
                    .to_owned()
            }
            Self::EnergyResidual => {
                "change of the kinetic energy less the work of every force, as the time steps do it".to_owned()
            }
            Self::ContactCount => "number of contacts, those with boundaries included".to_owned(),
            Self::IntactBonds => "number of living bonds".to_owned(),
            Self::BrokenBonds => "number of bonds that broke since the scene's time 0".to_owned(),
            Self::LargestOverlap => "largest overlap over the smaller radius".to_owned(),
            Self::TimeStep => "the time step".to_owned(),
            Self::StableStep => "the largest stable time step, as last computed".to_owned(),
        }
    }
}

/// A number of things.
fn count(number: u64) -> Value {
    Value::Integer(i32::try_from(number).unwrap_or(i32::MAX))
}

/// Mass of the particles of a boundary; 0 for one that has none \[kg\].
fn mass(scene: &Scene, boundary: BoundaryIndex) -> f64 {
    let members = scene.boundaries[boundary.index()].shape.members().iter();
    members.filter_map(|&member| scene.particles.get(member as usize)).map(crate::scene::Particle::mass).sum()
}
