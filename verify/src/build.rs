//! From a case to a scene: names are translated and values checked, nothing is computed.

use super::bond;
use super::case::{Axis, Case, GlobalDamping, Scale, Wall, WallMotion};
use super::error::Mistake;
use super::heat;
use super::law;
use cograin::bond::keys::FormulationChoice;
use cograin::contact::MaterialPair;
use cograin::quantity::{MaterialIndex, NonNegative, ParticleId, Positive, SetIndex};
use cograin::scene::{
    AppliedForce, AxisMotion, Body, Boundary, BoundaryTemperature, ContactLaw, Damping, HeatSettings, InputCourse,
    NodeMotion, Outside, Particle, ParticleShape, Run, Scene, SceneDraft, Shape, Step,
};
use cograin::surface::{Group, Plane, cylinder, mesh};
use std::collections::BTreeMap;
use std::path::Path;

/// The scene that a case describes, its bonds in this formulation.
pub(super) fn scene(case: &Case, folder: &Path, formulation: FormulationChoice) -> Result<Scene, Mistake> {
    if case.steps == 0 || case.sample_every == 0 {
        return Err(Mistake::new("steps, sample_every", "expected numbers above 0, found 0"));
    }
    let step = positive("dt", case.dt)?.get();
    let law = law::law(case)?;
    if let Some(objection) = law.objection() {
        return Err(Mistake::new(format!("model.{}", objection.table), objection.reason));
    }
    let materials = law::materials(case)?;
    let pairs = law::pairs(case)?;
    for (at, properties) in pairs.iter().enumerate() {
        let (a, b) = (&materials[at / materials.len()], &materials[at % materials.len()]);
        if let Err(missing) = law.coefficients(&MaterialPair { a, b, properties }) {
            return Err(law::absent(missing[0].key));
        }
    }
    let contact =
        ContactLaw { name: "contact".into(), between: vec![true; pairs.len()], choice: law, heat: heat::model(case)? };
    let particles = particles(case)?;
    let index_of = particles.iter().map(|particle| particle.id.0).zip(0..).collect();
    let draft = SceneDraft {
        // Cases may begin with any overlap.
        run: Run {
            step: Step::Given(step),
            allow_unstable: true,
            threads: Some(1),
            max_overlap: f64::MAX,
            scheme: law.scheme,
            ..Run::default()
        },
        gravity: finite("gravity", case.gravity)?,
        materials,
        pairs,
        contacts: vec![contact],
        boundaries: boundaries(case, folder, &index_of)?,
        bonds: bond::laws(case, formulation)?,
        sets: (0..case.materials.len()).map(bond::set_name).collect(),
        damping: damping(case, &particles)?,
        forces: forces(case, &index_of)?,
        columns: heat::columns(case)?,
        heat: HeatSettings { frozen: case.frozen, ..HeatSettings::default() },
        heat_sources: heat::sources(case, &index_of)?,
        particles,
        ..SceneDraft::default()
    };
    draft.build().map_err(|errors| Mistake::new("scene", errors.to_string()))
}

/// A number above 0.
pub(super) fn positive(field: impl Into<String>, value: f64) -> Result<Positive, Mistake> {
    Positive::new(value).ok_or_else(|| Mistake::new(field, format!("expected a number above 0, found {value}")))
}

/// Three finite numbers.
fn finite(field: impl Into<String>, value: [f64; 3]) -> Result<[f64; 3], Mistake> {
    if value.iter().all(|number| number.is_finite()) {
        Ok(value)
    } else {
        Err(Mistake::new(field, format!("expected finite numbers, found {value:?}")))
    }
}

/// The place of a material that a case counts from 1.
fn material(field: impl Into<String>, kind: usize, case: &Case) -> Result<MaterialIndex, Mistake> {
    if (1..=case.materials.len()).contains(&kind) {
        Ok(MaterialIndex((kind - 1) as u32))
    } else {
        Err(Mistake::new(field, format!("expected a material from 1 to {}, found {kind}", case.materials.len())))
    }
}

/// The spheres, by ascending id.
fn particles(case: &Case) -> Result<Vec<Particle>, Mistake> {
    let one = |index: usize| {
        let particle = &case.particles[index];
        let place = |key: &str| format!("particles[{index}].{key}");
        let material = material(place("type"), particle.kind, case)?;
        Ok(Particle {
            id: ParticleId(particle.id),
            set: SetIndex(material.0),
            material,
            shape: ParticleShape::Sphere,
            radius: positive(place("radius"), particle.radius)?.get(),
            density: positive(place("density"), particle.density)?.get(),
            position: finite(place("position"), particle.position)?,
            velocity: finite(place("velocity"), particle.velocity)?,
            angular_velocity: finite(place("omega"), particle.omega)?,
        })
    };
    let all: Vec<Particle> = case.by_id().into_iter().map(one).collect::<Result<_, Mistake>>()?;
    match all.windows(2).find(|two| two[0].id == two[1].id) {
        Some(two) => Err(Mistake::new("particles", format!("two of them have id {}", two[0].id.0))),
        None if all.is_empty() => Err(Mistake::new("particles", "expected at least one, found none")),
        None => Ok(all),
    }
}

/// Planes, then groups of particles with a motion of their own.
fn boundaries(case: &Case, folder: &Path, index_of: &BTreeMap<u32, u32>) -> Result<Vec<Boundary>, Mistake> {
    let mut all = Vec::new();
    let joined: Vec<&String> = case.walls.iter().flat_map(|wall| &wall.joined_with).collect();
    for (index, wall) in case.walls.iter().enumerate() {
        // What is joined to another wall is a part of that one.
        if !wall.file.as_ref().is_some_and(|file| joined.contains(&file)) {
            all.push(boundary(case, folder, index, wall)?);
        }
    }
    for (index, motion) in case.prescribed_motion.iter().enumerate() {
        let place = format!("prescribed_motion[{index}]");
        if motion.kind != "constant_velocity" {
            return Err(Mistake::new(place, format!("expected constant_velocity, found \"{}\"", motion.kind)));
        }
        let velocity = finite(format!("{place}.velocity"), motion.velocity)?;
        let members = members(&place, &motion.ids, index_of)?;
        let first = members.first().map_or(0, |member| *member as usize);
        all.push(Boundary {
            name: format!("motion{index}"),
            shape: Shape::of(Group { members }),
            axes: [0, 1, 2, 3, 4, 5].map(|axis| match velocity.get(axis) {
                Some(&speed) if speed != 0.0 => AxisMotion::Prescribed(speed),
                _ => AxisMotion::Fixed,
            }),
            moves_with: None,
            nodes: NodeMotion::Rigid,
            input: InputCourse::Ramp,
            reference: case.particles[case.by_id()[first]].position,
            body: Body::default(),
            outside: Outside::default(),
            temperature: BoundaryTemperature::None,
            wear: Vec::new(),
        });
    }
    let held = |member: u32| Boundary {
        name: format!("held{member}"),
        shape: Shape::of(Group { members: vec![member] }),
        axes: [const { AxisMotion::Fixed }; 6],
        moves_with: None,
        nodes: NodeMotion::Rigid,
        input: InputCourse::Ramp,
        reference: case.particles[case.by_id()[member as usize]].position,
        body: Body::default(),
        outside: Outside::default(),
        temperature: BoundaryTemperature::None,
        wear: Vec::new(),
    };
    all.extend(heat::held(case, index_of, &held)?);
    Ok(all)
}

/// One wall.
fn boundary(case: &Case, folder: &Path, index: usize, wall: &Wall) -> Result<Boundary, Mistake> {
    let place = |key: &str| format!("walls[{index}].{key}");
    let missing = |key: &str| Mistake::new(place(key), format!("absent; a {} needs one", wall.kind));
    let of = material(place("type"), wall.material, case)?;
    let shape = match wall.kind.as_str() {
        "plane" => return plane(case, index, wall),
        "mesh" => {
            let file = wall.file.as_ref().ok_or_else(|| missing("file"))?;
            let read = |name: &String| {
                std::fs::read(folder.join(name))
                    .map_err(|cause| Mistake::new(place("file"), format!("{name}: {cause}")))
            };
            let files = std::iter::once(file).chain(&wall.joined_with).map(read).collect::<Result<Vec<_>, _>>()?;
            mesh::of_files(of, &files, Some(2)).map_err(|wrong| Mistake::new(place("file"), wrong))?
        }
        "cylinder" => {
            let radius = positive(place("radius"), wall.radius.ok_or_else(|| missing("radius"))?)?.get();
            let point = wall.point.ok_or_else(|| missing("point"))?;
            let Some(Axis::Direction(axis)) = wall.axis else { return Err(missing("axis")) };
            cylinder::infinite(of, point, axis, radius).ok_or_else(|| missing("axis"))?
        }
        other => {
            return Err(Mistake::new(place("kind"), format!("expected plane, mesh or cylinder, found \"{other}\"")));
        }
    };
    let (mut axes, mut reference) = ([const { AxisMotion::Fixed }; 6], [0.0; 3]);
    let moves = |speed: f64| if speed == 0.0 { AxisMotion::Fixed } else { AxisMotion::Prescribed(speed) };
    match &wall.motion {
        None => {}
        Some(WallMotion::Linear { velocity }) => (0..3).for_each(|axis| axes[axis] = moves(velocity[axis])),
        Some(WallMotion::Rotate { point, axis, period }) => {
            let spin = std::f64::consts::TAU / positive(place("motion.period"), *period)?.get();
            (0..3).for_each(|about| axes[3 + about] = moves(spin * axis[about]));
            reference = *point;
        }
    }
    Ok(Boundary {
        name: format!("wall{index}"),
        shape,
        axes,
        moves_with: None,
        nodes: NodeMotion::Rigid,
        input: InputCourse::Ramp,
        reference,
        body: Body::default(),
        outside: Outside::default(),
        temperature: heat::of_wall(wall.temperature),
        wear: Vec::new(),
    })
}

/// One plane.
fn plane(case: &Case, index: usize, wall: &Wall) -> Result<Boundary, Mistake> {
    let place = |key: &str| format!("walls[{index}].{key}");
    let normal = finite(place("normal"), wall.normal)?;
    let length = normal.iter().map(|component| component * component).sum::<f64>().sqrt();
    if length == 0.0 || !length.is_finite() {
        return Err(Mistake::new(place("normal"), format!("expected a vector with a direction, found {normal:?}")));
    }
    let on_axis = match &wall.axis {
        Some(Axis::Name(axis)) => ["x", "y", "z"].iter().position(|name| name == axis),
        _ => None,
    };
    let point = match (wall.point, on_axis, wall.position) {
        (Some(point), _, _) => point,
        (None, Some(axis), Some(position)) => {
            let mut point = [0.0; 3];
            point[axis] = position;
            point
        }
        _ => {
            return Err(Mistake::new(
                place("point"),
                "expected a point on the plane, or axis and position, found \
                                                      nothing",
            ));
        }
    };
    let point = finite(place("point"), point)?;
    Ok(Boundary {
        name: format!("wall{index}"),
        shape: Shape::of(Plane {
            material: material(place("type"), wall.material, case)?,
            point,
            normal: normal.map(|component| component / length),
        }),
        axes: [const { AxisMotion::Fixed }; 6],
        moves_with: None,
        nodes: NodeMotion::Rigid,
        input: InputCourse::Ramp,
        reference: point,
        body: Body::default(),
        outside: Outside::default(),
        temperature: heat::of_wall(wall.temperature),
        wear: Vec::new(),
    })
}

/// Indices into the scene's particles, ascending.
pub(super) fn members(place: &str, ids: &[u32], index_of: &BTreeMap<u32, u32>) -> Result<Vec<u32>, Mistake> {
    let index = |id: &u32| {
        let found = index_of.get(id).copied();
        found
            .ok_or_else(|| Mistake::new(format!("{place}.ids"), format!("expected a particle of the case, found {id}")))
    };
    let mut all: Vec<u32> = ids.iter().map(index).collect::<Result<_, Mistake>>()?;
    all.sort_unstable();
    all.dedup();
    Ok(all)
}

/// Constant forces.
fn forces(case: &Case, index_of: &BTreeMap<u32, u32>) -> Result<Vec<AppliedForce>, Mistake> {
    let one = |(index, force): (usize, &super::case::ExternalForce)| {
        let place = format!("external_forces[{index}]");
        Ok(AppliedForce {
            name: format!("force{index}"),
            members: members(&place, &force.ids, index_of)?,
            force: finite(format!("{place}.force"), force.force)?,
        })
    };
    case.external_forces.iter().enumerate().map(one).collect()
}

/// Cundall damping of each particle.
fn damping(case: &Case, particles: &[Particle]) -> Result<Vec<Damping>, Mistake> {
    let Some(damping) = &case.global_damping else { return Ok(Vec::new()) };
    if damping.kind != "cundall" {
        return Err(Mistake::new("global_damping.type", format!("expected cundall, found \"{}\"", damping.kind)));
    }
    let factors = particles.iter().map(|particle| scale(damping, particle)).collect::<Result<Vec<f64>, Mistake>>()?;
    let of = |key: &str, fraction: f64| match NonNegative::new(fraction) {
        Some(fraction) => Ok(factors.iter().map(|factor| fraction.get() * factor).collect()),
        None => Err(Mistake::new(format!("global_damping.{key}"), format!("expected 0 or above, found {fraction}"))),
    };
    let gravity_damped = match damping.gravity_damped {
        Some(damped) => damped,
        None if case.gravity == [0.0; 3] => false,
        None => {
            return Err(Mistake::new(
                "global_damping.gravity_damped",
                "expected true or false beside gravity, found \
                                                                      nothing",
            ));
        }
    };
    Ok(vec![Damping {
        newcomers: [0.0; 2],
        name: "damping".into(),
        linear: of("gamma_l", damping.gamma_l)?,
        angular: of("gamma_a", damping.gamma_a)?,
        gravity_damped,
        applied_forces_damped: damping.external_forces_damped.unwrap_or(false),
    }])
}

/// The factor on the damping of one particle.
fn scale(damping: &GlobalDamping, particle: &Particle) -> Result<f64, Mistake> {
    let Some(Scale { kind, values, divisor }) = &damping.scale else { return Ok(1.0) };
    match (kind.as_str(), divisor) {
        ("type", _) => Ok(values.get(&(particle.material.index() + 1).to_string()).copied().unwrap_or(1.0)),
        ("variable", Some(divisor)) if *divisor != 0.0 => Ok(particle.radius / divisor),
        ("variable", _) => {
            Err(Mistake::new("global_damping.scale.divisor", "absent or 0; the radius is divided by it"))
        }
        _ => Err(Mistake::new("global_damping.scale.kind", format!("expected type or variable, found \"{kind}\""))),
    }
}
