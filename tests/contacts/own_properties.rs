//! Laws of other crates: properties that they declare, and dashpots of their own.

use cograin::contact::{
    Contact, Friction, MaterialPair, Missing, NoKeys, NormalForce, Property, PropertyUnit, Tangential,
};
use cograin::number::Number;
use cograin::quantity::Range;
use cograin::scene::{Models, Scene, Source};
use cograin::simulation::Simulation;
use std::sync::Arc;

/// Damping of a film of grease between two materials \[kg/s\].
static FILM_DAMPING: Property = Property {
    name: "film_damping",
    unit: PropertyUnit::Always("kg/s"),
    range: Range::POSITIVE,
    tunable: true,
    about: "damping of the film of grease",
};

/// How much of a material's surface the film covers.
static COVER: Property = Property {
    name: "cover",
    unit: PropertyUnit::Always("1"),
    range: Range::FRACTION,
    tunable: false,
    about: "part of the surface that the film covers",
};

cograin::coefficients! {
    /// A film that damps slip: F_t = −c v_t.
    pub struct Film {
        /// c \[kg/s\].
        damping,
    }
}

impl Tangential for Film {
    const NAME: &'static str = "film";
    type Keys = NoKeys;
    const PAIR_PROPERTIES: &'static [&'static Property] = &[&FILM_DAMPING];
    const MATERIAL_PROPERTIES: &'static [&'static Property] = &[&COVER];
    const ACTIVE: bool = true;
    const HAS_SPRING: bool = false;
    const HAS_DASHPOT: bool = false;

    fn between(pair: &MaterialPair, _keys: &NoKeys, _damped_at_touch: bool) -> Result<Self, Missing> {
        let [a, b] = pair.of_each(&COVER)?;
        Ok(Self::new(pair.get(&FILM_DAMPING)? * a * b))
    }

    fn damping(&self, from_normal_model: f64) -> f64 {
        from_normal_model + self.damping
    }

    fn force<N: Number>(
        law: Film<N>,
        contact: &Contact<N>,
        _normal: &NormalForce<N>,
        history: [N; 4],
        _step: N,
    ) -> Friction<N> {
        Friction { force: -(contact.slip * law.damping), history, sliding: N::zero().greater(N::zero()) }
    }
}

/// Two spheres that are pressed together and slide past each other.
const SCENE: &str = r#"
[material.a]
density = 2000.0
cover = 0.5
[pair.a.a]
normal_stiffness = 1000.0
normal_damping = 0.0
film_damping = 2.0
[contact.all.normal.hooke_stiffness]
[contact.all.tangential.film]
[particles.two]
material = "a"
list = [
  { position = [0.0, 0.0, 0.0], radius = 1e-3 },
  { position = [1.99e-3, 0.0, 0.0], radius = 1e-3, velocity = [0.0, 1e-3, 0.0] },
]
"#;

/// What the program makes of a text.
fn scene(text: &str) -> Result<Scene, String> {
    let source = Source { name: "scene.toml".into(), text: text.into(), ..Source::default() };
    Models::standard().with_tangential::<Film>().scene(&source, &[]).map_err(|errors| errors.to_string())
}

/// The scene with this in place of that.
fn told(from: &str, to: &str) -> String {
    assert!(SCENE.contains(from));
    scene(&SCENE.replace(from, to)).unwrap_err()
}

#[test]
fn properties_of_pairs_and_materials_that_a_law_declares_are_read_and_checked() {
    let found = scene(SCENE).unwrap();
    assert_eq!(found.pairs[0].get(&FILM_DAMPING), Some(2.0));
    assert_eq!(found.materials[0].properties.get(&COVER), Some(0.5));
    assert_eq!(
        told("film_damping = 2.0", "film_damping = 0.0"),
        "scene.toml, line 8, [pair.a.a] film_damping: expected a number above 0, found 0.0"
    );
    assert_eq!(
        told("film_damping = 2.0", "film_dampin = 2.0"),
        "scene.toml, line 8, [pair.a.a] film_dampin: no such key; the nearest is film_damping"
    );
    assert_eq!(
        told("film_damping = 2.0", ""),
        "scene.toml, line 5, [pair.a.a] film_damping: missing; [contact.all] needs it for a and a"
    );
    assert_eq!(
        told("cover = 0.5", "cover = 1.5"),
        "scene.toml, line 4, [material.a] cover: expected a number from 0 to 1, found 1.5"
    );
    assert_eq!(
        told("cover = 0.5", ""),
        "scene.toml, line 2, [material.a] cover: missing; [contact.all] needs it for a and a"
    );
}

#[test]
fn a_scene_of_the_program_alone_knows_no_property_of_another_crate() {
    let text = SCENE.replace("[contact.all.tangential.film]", "");
    let errors = text.parse::<Scene>().unwrap_err().to_string();
    assert!(errors.contains("[material.a] cover: no such key"), "{errors}");
    assert!(errors.contains("[pair.a.a] film_damping: no such key"), "{errors}");
}

#[test]
fn they_are_parameters_of_the_unit() {
    let found = scene(SCENE).unwrap();
    let parameter = |name: &str| found.parameters.iter().find(|parameter| parameter.name == name).unwrap();
    let film = parameter("pair.a.a.film_damping");
    assert_eq!((film.value, film.unit.as_deref(), film.tunable), (2.0, Some("kg/s"), true));
    let cover = parameter("material.a.cover");
    assert_eq!((cover.value, cover.unit.as_deref(), cover.tunable), (0.5, Some("1"), false));
}

/// The relative velocity of the two along y after 2 ms, over that at the start.
fn kept(damping: f64) -> f64 {
    let text = SCENE.replace("film_damping = 2.0", &format!("film_damping = {damping:?}"));
    let mut simulation = Simulation::new(Arc::new(scene(&text).unwrap())).unwrap();
    for _ in 0..20 {
        simulation.advance(1e-4).unwrap();
    }
    let slip = |slot: usize| simulation.state().particles.velocity[slot][1];
    (slip(1) - slip(0)) / 1e-3
}

#[test]
fn the_stable_step_follows_a_dashpot_that_the_law_tells() {
    // Untold, a dashpot 1e4 times as strong as the springs would ask for makes slip grow in each step.
    for damping in [2.0, 200.0, 2e4] {
        let kept = kept(damping);
        assert!(kept.abs() < 1.0, "damping {damping}: slip is {kept} of what it was");
    }
}
