//! What makes a run long, and what it would cost without: from the scene with the change, started anew, or from a formula that the line
//! states.

use super::trial;
use crate::base::quantity::BoundaryIndex;
use crate::base::words::counted;
use crate::engine::simulation::Simulation;
use crate::laws::contact::impact::LONGEST_PART;
use crate::laws::surface::Group;
use crate::scene::{
    Accuracy, AxisMotion, Body, Bond, Boundary, BoundaryTemperature, Cell, InputCourse, NodeMotion, Outside, Particle,
    Scene, SceneDraft, Shape, Step,
};
use std::f64::consts::PI;
use std::sync::Arc;
use std::time::Duration;

/// Factor of time below which nothing is told.
const LEAST: f64 = 1.3;

/// Factor between two radii that sets small grains apart.
const APART: f64 = 1.5;

/// Of so many grains at most one may be small: small ones in greater number belong to the packing.
const OTHERS: usize = 20;

/// Scenes with more particles are not built again for a comparison.
const MOST_PARTICLES: usize = 1_000_000;

/// Overlap over radius up to which contact laws are taken to hold.
const OVERLAP: f64 = 0.01;

/// How the steps of a run go with Young's modulus: as its power of 2/5, that of the duration of an impact.
const POWER: f64 = 0.4;

/// Edge of a facet over the smallest radius below which a mesh is finer than what touches it.
const FINE: f64 = 0.5;

/// Wall time of a trial.
const PATIENCE: Duration = Duration::from_millis(100);

/// A line for each thing that makes the run long. The largest speed to be expected is given \[m/s\].
pub(super) fn of(scene: &Arc<Scene>, present: &Simulation, speed: f64) -> Vec<String> {
    let mut lines = Vec::new();
    if scene.particles.len() <= MOST_PARTICLES {
        lines.extend(small_grains(scene, present));
        lines.extend(scene.bonds.iter().filter_map(|bond| as_a_group(scene, present, bond)));
    }
    lines.extend(soft_enough(scene, present, speed));
    lines.extend(safety(scene, present));
    lines.extend((0..scene.boundaries.len() as u32).filter_map(|index| fine_mesh(scene, BoundaryIndex(index))));
    lines
}

/// Some small grains that set the time step: the stable one is found with them as heavy as others.
fn small_grains(scene: &Scene, present: &Simulation) -> Option<String> {
    let mut radii: Vec<f64> = scene.particles.iter().map(|particle| particle.radius).collect();
    radii.sort_by(f64::total_cmp);
    let few = (radii.len() / OTHERS).max(1).min(radii.len().checked_sub(1)?);
    let gap = |count: usize| radii[count] / radii[count - 1];
    let count = (1..=few).max_by(|&one, &other| gap(one).total_cmp(&gap(other)))?;
    if gap(count) < APART {
        return None;
    }
    let (small, others) = (radii[count - 1], radii[count]);
    let mut without = SceneDraft::clone(scene);
    for particle in without.particles.iter_mut().filter(|particle| particle.radius <= small) {
        // Heavier than the others by far more than their contacts are stiffer.
        particle.density *= (others / particle.radius).powi(5);
    }
    let without = Simulation::new(Arc::new(without.build().ok()?)).ok()?;
    let factor = without.stable_step() / present.stable_step();
    (factor.is_finite() && factor > LEAST).then(|| {
        format!(
            "{} of radius {small:.2e} m at most, the others from {others:.2e} m on: without {} {factor:.1} times fewer steps",
            counted(count, "grain"),
            if count == 1 { "it" } else { "them" }
        )
    })
}

/// A bonded set that never breaks, as one rigid group: a trial of both.
fn as_a_group(scene: &Arc<Scene>, present: &Simulation, bond: &Bond) -> Option<String> {
    let [set, other] = bond.between;
    let is_whole =
        set == other && bond.plane.is_none() && bond.keys.breakage.is_empty() && bond.keys.relaxation.is_none();
    let members: Vec<u32> =
        (0..).zip(&scene.particles).filter(|(_, particle)| particle.set == set).map(|(index, _)| index).collect();
    let owned = |index: &u32| scene.boundaries.iter().any(|boundary| boundary.shape.members().contains(index));
    if !is_whole || members.iter().any(owned) {
        return None;
    }
    let mass: f64 = members.iter().map(|&index| scene.particles[index as usize].mass()).sum();
    let centre = |axis: usize| -> f64 {
        members
            .iter()
            .map(|&index| scene.particles[index as usize])
            .map(|it| it.mass() * it.position[axis])
            .sum::<f64>()
            / mass
    };
    let mut without = SceneDraft::clone(scene);
    without.bonds.retain(|it| it.name != bond.name);
    without.parameters.clear();
    without.boundaries.push(Boundary {
        name: format!("{}_as_a_group", bond.name),
        reference: [0, 1, 2].map(centre),
        shape: Shape::of(Group { members }),
        axes: [const { AxisMotion::Free }; 6],
        moves_with: None,
        nodes: NodeMotion::Rigid,
        input: InputCourse::Ramp,
        body: Body::default(),
        outside: Outside::default(),
        temperature: BoundaryTemperature::default(),
        wear: Vec::new(),
    });
    let without = Arc::new(without.build().ok()?);
    let cost = |scene: &Arc<Scene>| {
        let mut simulation = Simulation::new(Arc::clone(scene)).ok()?;
        let stable = simulation.stable_step();
        let trial = trial::steps(&mut simulation, None, PATIENCE);
        (trial.failed.is_none() && trial.step > 0.0).then_some((trial.step, stable))
    };
    let ((with, _), (less, stable)) = (cost(scene)?, cost(&without)?);
    let longer = stable / present.stable_step();
    let steps = match longer {
        longer if longer.is_finite() && longer > LEAST => format!(" and may be {longer:.1} times longer"),
        longer if longer.is_infinite() => " and has no bound".to_owned(),
        _ => String::new(),
    };
    (with / less > LEAST || !steps.is_empty()).then(|| {
        format!(
            "[bond.{}] never breaks: where its set need not deform, as a rigid group ([boundary] particles) a step takes {:.2} of the \
             time{steps}",
            bond.name,
            less / with
        )
    })
}

/// A modulus that is higher than small overlaps need: by Hertz's impact at the largest speed to be expected, by the weight of everything
/// over its cross-section, and by the overlaps at the start.
fn soft_enough(scene: &Scene, present: &Simulation, speed: f64) -> Option<String> {
    let given = |motion: &AxisMotion| motion.is_driven() || motion.takes_force() || motion.takes_load();
    let is_strained = scene.cell.as_ref().is_some_and(Cell::moves);
    let pushed = scene.boundaries.iter().any(|boundary| boundary.axes.iter().any(given)) || !scene.forces.is_empty();
    let hertzian = |law: &crate::scene::ContactLaw| law.choice.normal.name() == "hertz";
    let is_hertzian = !scene.contacts.is_empty() && scene.contacts.iter().all(hertzian);
    if pushed || is_strained || !is_hertzian || !scene.bonds.is_empty() || scene.particles.is_empty() {
        return None;
    }
    let effective = |particle: &Particle| {
        let material = &scene.materials[particle.material.index()];
        let (modulus, ratio) = (material.youngs_modulus?, material.poissons_ratio?);
        Some(0.5 * modulus / (1.0 - ratio * ratio))
    };
    let softest = scene.particles.iter().filter_map(effective).reduce(f64::min)?;
    let density = scene.particles.iter().map(|particle| particle.density).fold(0.0, f64::max);
    // Of two equal spheres at a speed v, and of those that carry a pressure p: δ/R = (1.25 π ρ v²/E*)^(2/5), (3 √2 p/E*)^(2/3).
    let by_impact = 1.25 * PI * density * speed * speed / libm::pow(OVERLAP, 2.5);
    let by_weight = 3.0 * std::f64::consts::SQRT_2 * pressure(scene) / libm::pow(OVERLAP, 1.5);
    let by_start = softest * libm::pow((present.largest_overlap() / OVERLAP).max(0.0), 1.5);
    let needed = by_impact.max(by_weight).max(by_start);
    let factor = libm::pow(needed / softest, -POWER);
    (needed > 0.0 && factor > LEAST).then(|| {
        let moduli: Vec<String> = (scene.materials.iter())
            .filter_map(|material| Some((material, material.youngs_modulus?)))
            .map(|(material, modulus)| {
                format!("[material.{}] youngs_modulus could be {:.1e} Pa", material.name, modulus * needed / softest)
            })
            .collect();
        format!(
            "{}: overlaps up to {OVERLAP} of the radius (impacts at {speed:.2} m/s, weight); {factor:.1} times fewer steps, which go as \
             E^{POWER}",
            moduli.join(", ")
        )
    })
}

/// Weight of all particles over the cross-section of the box around them \[Pa\].
fn pressure(scene: &Scene) -> f64 {
    let gravity = scene.gravity.iter().map(|part| part * part).sum::<f64>().sqrt();
    let down = (0..3).max_by(|&a, &b| scene.gravity[a].abs().total_cmp(&scene.gravity[b].abs())).unwrap_or(2);
    let extent = |axis: usize| {
        let ends = |sign: f64| scene.particles.iter().map(move |it| it.position[axis] + sign * it.radius);
        ends(1.0).fold(f64::NEG_INFINITY, f64::max) - ends(-1.0).fold(f64::INFINITY, f64::min)
    };
    let area: f64 = (0..3).filter(|&axis| axis != down).map(extent).product();
    gravity * scene.particles.iter().map(Particle::mass).sum::<f64>() / area
}

/// The time step at the start of a scene that names neither step nor accuracy \[s\].
pub(super) fn default_step(scene: &Scene) -> Option<f64> {
    let mut draft = SceneDraft::clone(scene);
    (draft.run.step, draft.run.accuracy) = (Step::Following, Accuracy::default());
    let simulation = Simulation::new(Arc::new(draft.build().ok()?)).ok()?;
    Some(simulation.state().clock.step)
}

/// A time step that is shorter than by default, or with which impacts are less accurate.
fn safety(scene: &Scene, present: &Simulation) -> Vec<String> {
    match scene.run.step {
        Step::Given(_) => Vec::new(),
        Step::Automatic { safety } => {
            let factor = LONGEST_PART / safety;
            let longer = (factor > LEAST)
                .then(|| format!("[run] safety = {safety}: up to {factor:.1} times the steps of the default in a bed"));
            longer.into_iter().chain(dissipation(present, safety)).collect()
        }
        Step::Following => exactness(scene, present).into_iter().collect(),
    }
}

/// An accuracy that costs more time steps than the default.
fn exactness(scene: &Scene, present: &Simulation) -> Option<String> {
    // The same costs as much: a scene of a million takes seconds to be built once more.
    if scene.run.accuracy.error() >= Accuracy::default().error() {
        return None;
    }
    let mut draft = SceneDraft::clone(scene);
    draft.run.accuracy = Accuracy::default();
    let usual = Simulation::new(Arc::new(draft.build().ok()?)).ok()?;
    let factor = usual.part_of_impacts() / present.part_of_impacts();
    let chosen = match scene.run.accuracy {
        Accuracy::Within(error) => format!("{error}"),
        word => format!("\"{word}\""),
    };
    (factor > LEAST).then(|| {
        format!("[run] accuracy = {chosen}: {factor:.1} times the steps of the default while two bodies collide")
    })
}

/// What a fraction of the stable step makes of the impact with the largest error.
fn dissipation(present: &Simulation, safety: f64) -> Option<String> {
    let tried = present.impacts().into_iter().map(|impact| {
        let restitution = impact.restitution();
        (restitution, impact.error(safety, restitution))
    });
    let (restitution, error) =
        tried.reduce(|most, next| if next.1.restitution > most.1.restitution { next } else { most })?;
    let (percent, word) = (100.0 * error.dissipation.abs(), if error.dissipation < 0.0 { "less" } else { "more" });
    let does = if error.kept > 1.0 {
        format!("gains {:.0} % of its energy in the mean", 100.0 * (error.kept - 1.0))
    } else {
        format!("dissipates {percent:.0} % {word} than it should")
    };
    (error.restitution > Accuracy::default().error())
        .then(|| format!("[run] safety = {safety}: an impact of two bodies alone with e = {restitution:.2} {does}"))
}

/// A mesh whose facets are smaller than what touches them.
fn fine_mesh(scene: &Scene, boundary: BoundaryIndex) -> Option<String> {
    let boundary = &scene.boundaries[boundary.index()];
    let (vertices, triangles) = (boundary.shape.vertices(), boundary.shape.triangles());
    let smallest = scene.particles.iter().map(|particle| particle.radius).reduce(f64::min)?;
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| vertices[corner as usize]);
        0.5 * (b - a).cross(c - a).length()
    };
    let mean = triangles.iter().map(area).sum::<f64>() / triangles.len() as f64;
    // The edge of an equilateral triangle of that area.
    let edge = (mean * 4.0 / 3.0_f64.sqrt()).sqrt();
    (edge < FINE * smallest).then(|| {
        format!(
            "[boundary.{}] mesh: {} with edges of about {edge:.1e} m; with edges of the smallest radius, {smallest:.1e} m, {:.0} times fewer \
             lie under a grain",
            boundary.name,
            counted(triangles.len(), "triangle"),
            (smallest / edge).powi(2)
        )
    })
}
