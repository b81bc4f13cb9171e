//! Scenes built in code, for physics tests.

use cograin::contact::normal::hooke_stiffness;
use cograin::contact::{
    CohesionModel, LawChoice, Material, NoKeys, NormalModel, Properties, RollingModel, Scheme, Switches,
    TangentialModel, cohesion, normal, property, rolling, tangential,
};
use cograin::quantity::{MaterialIndex, ParticleId, SetIndex};
use cograin::scene::{
    AxisMotion, Body, Boundary, ContactLaw, InputCourse, NodeMotion, Outside, Particle, ParticleShape, Run, SceneDraft,
    Shape, Step,
};
use cograin::simulation::Simulation;
use cograin::surface::Plane;
use std::sync::Arc;

/// Hertz with a tangential spring.
pub(crate) const HERTZ: LawChoice = LawChoice {
    normal: NormalModel::fixed::<normal::hertz::Hertz>(&NoKeys {}),
    tangential: TangentialModel::fixed::<tangential::history::History>(&NoKeys {}),
    rolling: RollingModel::fixed::<rolling::none::None>(&NoKeys {}),
    cohesion: CohesionModel::fixed::<cohesion::none::None>(&NoKeys {}),
    switches: Switches {
        least_force: f64::NEG_INFINITY,
        tangential_damping_factor: 1.0,
        marker: std::marker::PhantomData,
    },
    scheme: Scheme::Engine,
};

/// Hertz without friction.
pub(crate) const SMOOTH: LawChoice =
    LawChoice { tangential: TangentialModel::fixed::<tangential::none::None>(&NoKeys {}), ..HERTZ };

/// A given linear spring without friction.
pub(crate) const SPRING: LawChoice = LawChoice {
    normal: NormalModel::fixed::<normal::hooke_stiffness::HookeStiffness>(&hooke_stiffness::Keys {
        absolute_damping: false,
    }),
    ..SMOOTH
};

/// A material with these moduli \[Pa, 1\].
pub(crate) fn material(youngs_modulus: f64, poissons_ratio: f64) -> Material {
    Material {
        name: "material".into(),
        density: 1.0,
        youngs_modulus: Some(youngs_modulus),
        poissons_ratio: Some(poissons_ratio),
        thermal: Default::default(),
        properties: Default::default(),
    }
}

/// A plane against which materials are soft.
pub(crate) fn rigid() -> Material {
    material(1e30, 0.0)
}

/// Restitution and friction of all pairs.
pub(crate) fn properties(restitution: f64, friction: f64) -> Properties {
    Properties::default().with(&property::RESTITUTION, restitution).with(&property::FRICTION, friction)
}

/// A sphere at rest at the origin, of the first material, with this radius \[m\] and density \[kg/m³\].
pub(crate) fn sphere(radius: f64, density: f64) -> Particle {
    Particle {
        id: ParticleId(0),
        set: SetIndex(0),
        material: MaterialIndex(0),
        shape: ParticleShape::Sphere,
        radius,
        density,
        position: [0.0; 3],
        velocity: [0.0; 3],
        angular_velocity: [0.0; 3],
    }
}

/// A fixed plane through this point \[m\] with this unit normal, of this material.
pub(crate) fn plane(point: [f64; 3], normal: [f64; 3], material: u32) -> Boundary {
    Boundary {
        name: "plane".into(),
        shape: Shape::of(Plane { material: MaterialIndex(material), point, normal }),
        axes: [const { AxisMotion::Fixed }; 6],
        moves_with: None,
        nodes: NodeMotion::Rigid,
        input: InputCourse::Ramp,
        reference: point,
        body: Body::default(),
        outside: Outside::default(),
        temperature: Default::default(),
        wear: Vec::new(),
    }
}

/// A scene with one law, one set of properties for all pairs, a given step \[s\], and ids in the order given.
pub(crate) fn scene(
    law: LawChoice,
    step: f64,
    materials: Vec<Material>,
    properties: Properties,
    particles: Vec<Particle>,
) -> SceneDraft {
    let pairs = materials.len() * materials.len();
    let named = materials.into_iter().zip(0..).map(|(it, place)| Material { name: format!("material_{place}"), ..it });
    let materials: Vec<Material> = named.collect();
    let numbered = particles.into_iter().zip(0..).map(|(particle, id)| Particle { id: ParticleId(id), ..particle });
    SceneDraft {
        run: Run { step: Step::Given(step), threads: Some(1), scheme: law.scheme, ..Run::default() },
        contacts: vec![ContactLaw { name: "contact".into(), between: vec![true; pairs], choice: law, heat: None }],
        pairs: vec![properties; pairs],
        materials,
        bonds: Vec::new(),
        sets: vec!["particles".into()],
        particles: numbered.collect(),
        ..SceneDraft::default()
    }
}

/// A running scene, looked at in the scene's order of particles.
pub(crate) struct Stage {
    /// The simulation.
    pub(crate) simulation: Simulation,
    /// Time step \[s\].
    pub(crate) step: f64,
}

impl Stage {
    /// Starts.
    pub(crate) fn of(scene: SceneDraft) -> Self {
        let Step::Given(step) = scene.run.step else { panic!("physics tests give the step") };
        Self { simulation: Simulation::new(Arc::new(scene.build().unwrap())).unwrap(), step }
    }

    /// Makes time steps.
    pub(crate) fn steps(&mut self, count: u64) {
        self.simulation.advance(count as f64 * self.step).unwrap();
    }

    /// A row of a particle.
    fn row(&self, rows: impl Fn(&Simulation) -> &Vec<[f64; 4]>, particle: usize) -> [f64; 3] {
        let slot = self.simulation.state().particles.slot[particle] as usize;
        let [x, y, z, _] = rows(&self.simulation)[slot];
        [x, y, z]
    }

    /// Position \[m\].
    pub(crate) fn position(&self, particle: usize) -> [f64; 3] {
        self.row(|simulation| &simulation.state().particles.position, particle)
    }

    /// Velocity \[m/s\].
    pub(crate) fn velocity(&self, particle: usize) -> [f64; 3] {
        self.row(|simulation| &simulation.state().particles.velocity, particle)
    }

    /// Angular velocity \[rad/s\].
    pub(crate) fn spin(&self, particle: usize) -> [f64; 3] {
        self.row(|simulation| &simulation.state().particles.angular_velocity, particle)
    }

    /// Force \[N\].
    pub(crate) fn force(&self, particle: usize) -> [f64; 3] {
        self.row(|simulation| &simulation.state().particles.force, particle)
    }

    /// Torque \[N m\].
    pub(crate) fn torque(&self, particle: usize) -> [f64; 3] {
        self.row(|simulation| &simulation.state().particles.torque, particle)
    }
}

/// What an impact of a sphere on a plane z = 0 left.
pub(crate) struct Rebound {
    /// Velocity \[m/s\].
    pub(crate) velocity: [f64; 3],
    /// Angular velocity \[rad/s\].
    pub(crate) spin: [f64; 3],
}

/// Lets a sphere of the first material hit a plane of the second; `steps` time steps make one contact, whose
/// duration \[s\] is given.
pub(crate) fn hit(
    law: LawChoice,
    materials: Vec<Material>,
    properties: Properties,
    mut body: Particle,
    duration: f64,
    steps: u64,
) -> Rebound {
    let step = duration / steps as f64;
    // Half a step short of touch, so that no phase is special.
    body.position = [0.0, 0.0, body.radius - 0.5 * step * body.velocity[2]];
    let mut scene = scene(law, step, materials, properties, vec![body]);
    scene.boundaries = vec![plane([0.0; 3], [0.0, 0.0, 1.0], 1)];
    let mut stage = Stage::of(scene);
    stage.steps(2 * steps);
    assert!(stage.position(0)[2] > body.radius, "the contact has not ended: {:?}", stage.position(0));
    Rebound { velocity: stage.velocity(0), spin: stage.spin(0) }
}

/// Duration of an elastic Hertz impact: 2.94328 δ_max/v, δ_max = (15 m* v²/(16 E* √R*))^(2/5) \[s\].
pub(crate) fn hertz_duration(modulus: f64, radius: f64, mass: f64, speed: f64) -> f64 {
    2.943_28 * hertz_overlap(modulus, radius, mass, speed) / speed
}

/// Largest overlap of an elastic Hertz impact \[m\].
pub(crate) fn hertz_overlap(modulus: f64, radius: f64, mass: f64, speed: f64) -> f64 {
    (15.0 * mass * speed * speed / (16.0 * modulus * radius.sqrt())).powf(0.4)
}

/// Fails, naming what, unless `found` is within `tolerance` of `expected` (relative to it).
#[track_caller]
pub(crate) fn assert_close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs() / expected.abs();
    assert!(error <= tolerance, "{what}: {found:e} found, {expected:e} expected, {error:.1e} apart");
}

/// Fails, naming what, unless `found` is within `margin` of `expected`.
#[track_caller]
pub(crate) fn assert_near(found: f64, expected: f64, margin: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(error <= margin, "{what}: {found:e} found, {expected:e} expected, {error:.1e} apart");
}
