//! Every contact law between two planes: the stated stable step against the true one.
//!
//! A sphere that two planes press stands still but for trials in all its freedoms. The dashpot of `epsd` is one of what limits it.

use super::linearised::{largest_step, measured, scaled};
use super::{stated, with_step};
use crate::contacts::every_law::laws;
use crate::support::{checked, read};
use cograin::contact::Scheme;
use cograin::scene::Models;
use nalgebra::DMatrix;

/// Radius of the sphere \[m\].
const RADIUS: f64 = 5e-3;

/// Bounds of the stated step over the true one.
const RANGE: std::ops::RangeInclusive<f64> = 0.75..=1.0;

/// A law as the tables of a scene.
struct Tables<'a> {
    /// Normal model.
    normal: &'a str,
    /// Its keys.
    keys: &'a str,
    /// Tangential model.
    tangential: &'a str,
    /// Rolling model.
    rolling: &'a str,
    /// Its keys.
    rolling_keys: &'a str,
    /// Cohesion model.
    cohesion: &'a str,
    /// Share of critical damping against rolling.
    rolling_damping: f64,
}

impl Tables<'_> {
    /// A sphere between two planes by a part of its radius nearer than touch. With k₂ above k₁ it is held from the first unloading on: ratio 1.
    fn scene(&self, depth: f64, scheme: Scheme) -> String {
        let Self { normal, keys, tangential, rolling, rolling_keys, cohesion, rolling_damping } = self;
        let (stiffness, damping) = if *normal == "hertz_stiffness" { ("1e7", "3e5") } else { ("1e4", "300.0") };
        let apart = RADIUS * (1.0 - depth);
        format!(
            r#"
[run]
threads = 1
max_overlap = 0.5
scheme = "{}"
[material.a]
density = 2500.0
youngs_modulus = 5e7
poissons_ratio = 0.3
[pair.a.a]
restitution = 0.6
friction = 5.0
rolling_friction = 0.3
rolling_viscous_damping = {rolling_damping:?}
cohesion_energy_density = 1e4
fluid_viscosity = 1e-3
critical_stokes_number = 10.0
maximum_restitution = 0.9
surface_energy = 2.0
damping_coefficient = 1e4
tangential_damping_ratio = 0.5
unloading_stiffness_ratio = 1.0
pull_off_force = 1e-3
normal_stiffness = {stiffness}
tangential_stiffness = {stiffness}
normal_damping = {damping}
tangential_damping = {damping}
[contact.c.normal.{normal}]
{keys}
[contact.c.tangential.{tangential}]
[contact.c.rolling.{rolling}]
{rolling_keys}
[contact.c.cohesion.{cohesion}]
[particles.p]
material = "a"
list = [{{ position = [0.0, 0.0, 0.0], radius = {RADIUS:?} }}]
[boundary.f]
plane = {{ point = [0.0, 0.0, {:?}], normal = [0.0, 0.0, 1.0] }}
material = "a"
[boundary.t]
plane = {{ point = [0.0, 0.0, {apart:?}], normal = [0.0, 0.0, -1.0] }}
material = "a"
"#,
            scheme.name(),
            -apart,
        )
    }
}

/// Springs, and dashpots along the normal, across it and against rolling, scaled by masses.
struct Parts {
    /// K.
    stiffness: DMatrix<f64>,
    /// C of each.
    damping: [DMatrix<f64>; 3],
}

impl Parts {
    /// Those of a law at about this time step \[s\].
    fn of(law: &Tables, depth: f64, near: f64) -> Self {
        let of = |law: Tables| measured(&checked(&law.scene(depth, Scheme::Engine)), near);
        let (stiffness, whole) = of(Tables { ..*law });
        let across = of(Tables { rolling: "none", rolling_keys: "", ..*law }).1;
        let along = of(Tables { rolling: "none", rolling_keys: "", tangential: "none", ..*law }).1;
        let masses = with_step(&checked(&law.scene(depth, Scheme::Engine)), 1e-12);
        let scaled = |matrix| scaled(&masses, &matrix);
        let damping = [along.clone(), &across - &along, &whole - &across].map(scaled);
        Self { stiffness: scaled(stiffness), damping }
    }

    /// The true stable step with a scheme \[s\].
    fn stable(&self, scheme: Scheme, near: f64) -> f64 {
        let [normal, tangential] = scheme.damping_factors();
        let [along, across, rolling] = &self.damping;
        largest_step(&self.stiffness, &(along * normal + across * tangential + rolling), near)
    }
}

#[test]
#[allow(clippy::print_stdout, reason = "the figures of docs/stability.md are what this test prints with --nocapture")]
fn of_every_law_between_two_planes() {
    let models = Models::standard();
    let (mut tried, mut least, mut most) = (0, f64::INFINITY, 0.0_f64);
    let mut wrong = Vec::new();
    for (normal, keys) in laws::normal(&models) {
        for tangential in models.tangential_names() {
            for (rolling, rolling_keys, rolling_damping) in laws::rolling(&models) {
                for cohesion in models.cohesion_names() {
                    for depth in [3e-3, 3e-2] {
                        let law = Tables { normal, keys, tangential, rolling, rolling_keys, cohesion, rolling_damping };
                        // What the scene refuses is no law.
                        let schemes = Scheme::ALL.into_iter().filter(|scheme| read(&law.scene(depth, *scheme)).is_ok());
                        let schemes: Vec<Scheme> = schemes.collect();
                        if schemes.is_empty() {
                            continue;
                        }
                        let near = stated(&checked(&law.scene(depth, Scheme::Engine)));
                        let parts = Parts::of(&law, depth, near);
                        for scheme in schemes {
                            let found = stated(&checked(&law.scene(depth, scheme)));
                            let ratio = found / parts.stable(scheme, found);
                            (tried, least, most) = (tried + 1, least.min(ratio), most.max(ratio));
                            if !RANGE.contains(&ratio) {
                                wrong.push(format!(
                                    "{ratio:.3}: {normal} ({keys}) {tangential} {rolling} ({rolling_keys}, {rolling_damping}) {cohesion} {} at {depth}",
                                    scheme.name()
                                ));
                            }
                        }
                    }
                }
            }
        }
    }
    println!("{tried} laws between two planes: stated over true {least:.3} to {most:.3}");
    assert!(tried > 1000, "{tried} laws");
    assert!(wrong.is_empty(), "{} of {tried}, {least:.3} to {most:.3}\n{}", wrong.len(), wrong.join("\n"));
}
