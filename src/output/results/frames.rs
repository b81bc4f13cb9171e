//! The files of a frame: particles by ascending id, the contacts between them, their bonds, the boundaries, the cell, the clumps, then
//! the grids.

use super::boundaries::boundaries;
use super::image;
use super::job::Job;
use super::vtk::{EncodeError, Kind, PointCloud, Values};
use crate::base::geometry::{Lattice, Quaternion};
use crate::engine::bodies::loads::{force_on, mass_of};
use crate::engine::simulation::{BondRecord, ContactRecord, number};
use crate::engine::state::{CellState, Clumps, Particles};
use crate::scene::{Grid, ParticleShape, Scene};

/// The files of a frame as bytes, in the order of their kinds; none for other jobs.
pub(crate) fn files(scene: &Scene, mut job: Job) -> impl Iterator<Item = Result<Vec<u8>, EncodeError>> {
    let fields = if let Job::Frame { grids, .. } = &mut job { std::mem::take(grids) } else { Vec::new() };
    let compressed = scene.output.compressed;
    let images = grids(scene).zip(fields).map(move |(grid, fields)| image::encode(&grid.shape, fields, compressed));
    let clouds = clouds(scene, job).into_iter().flatten();
    clouds.map(move |cloud| cloud.encode(compressed)).chain(images)
}

/// The grids that frames show.
pub(crate) fn grids(scene: &Scene) -> impl Iterator<Item = &Grid> {
    scene.grids.iter().filter(|grid| !grid.outputs.is_empty())
}

/// The clouds of a frame, in the order of their kinds; none for other jobs.
fn clouds(scene: &Scene, job: Job) -> [Option<PointCloud>; 6] {
    let Job::Frame {
        particles: bodies,
        contacts: touching,
        bonds: living,
        boundaries: moved,
        traces: left,
        cell: lies,
        clumps: rigid,
        ..
    } = job
    else {
        return [const { None }; 6];
    };
    let loads = || (touching.as_deref().unwrap_or_default(), living.as_deref().unwrap_or_default());
    [
        Some(particles(scene, (&bodies, rigid.as_deref()), lies.as_deref())),
        touching.as_ref().filter(|_| scene.output.contacts).map(|touching| contacts(scene, &bodies, touching)),
        living.as_ref().map(|living| bonds(scene, &bodies, living)),
        moved.map(|(moved, nodes)| boundaries(scene, &bodies, (&moved, &nodes), loads(), left.as_deref())),
        lies.as_deref().map(cell),
        rigid.as_deref().map(|rigid| clumps(scene, (&bodies, rigid), lies.as_deref())),
    ]
}

/// All particles, in the order of the scene whatever their order in memory, those that came later behind them.
pub(crate) fn particles(
    scene: &Scene,
    (particles, clumps): (&Particles, Option<&Clumps>),
    cell: Option<&CellState>,
) -> PointCloud {
    let none = Clumps::default();
    let rigid = clumps.unwrap_or(&none);
    let slots = || particles.slots();
    let [points, unwrapped] = places(scene, particles, cell);
    let three = |rows: &[[f64; 4]]| slots().flat_map(|slot| rows[slot].into_iter().take(3)).collect::<Vec<_>>();
    let fourth = |rows: &[[f64; 4]]| slots().map(|slot| rows[slot][3]).collect::<Vec<_>>();
    let (groups, owner) = (scene.boundaries.len() as i64, |slot: usize| i64::from(particles.owner[slot]) - 1);
    let damage = (!particles.bonds.is_empty()).then(|| ("damage", Values::Scalars(particles.damage())));
    let fields = vec![
        ("radius", Values::Scalars(fourth(&particles.position))),
        ("id", Values::Integers(slots().map(|slot| i64::from(number(scene, particles, particles.id[slot]))).collect())),
        ("material", Values::Integers(slots().map(|slot| i64::from(particles.material[slot])).collect())),
        ("velocity", Values::Vectors(three(&particles.velocity))),
        ("angular_velocity", Values::Vectors(three(&particles.angular_velocity))),
        ("force", Values::Vectors(slots().flat_map(|slot| force_on(scene, particles, slot)).collect())),
        ("torque", Values::Vectors(three(&particles.torque))),
        ("mass", Values::Scalars(slots().map(|slot| mass_of(scene, (particles, rigid), slot)).collect())),
        (
            "group",
            Values::Integers(
                slots().map(|slot| owner(slot).min(groups)).map(|it| if it < groups { it } else { -1 }).collect(),
            ),
        ),
    ];
    let of_clump = |slot: usize| {
        let clump = usize::try_from(owner(slot) - groups).ok().and_then(|clump| rigid.number.get(clump));
        clump.map_or(-1, |&number| i64::from(number))
    };
    let clumps = clumps.map(|_| ("clump", Values::Integers(slots().map(of_clump).collect())));
    let of_set = |slot: usize| scene.particles.get(particles.id[slot] as usize).map_or(-1, |own| i64::from(own.set.0));
    let sets = (scene.sets.len() > 1).then(|| ("set", Values::Integers(slots().map(of_set).collect())));
    let orientation = (!particles.orientation.is_empty()).then(|| {
        let rows = slots().flat_map(|slot| particles.orientation[slot]).collect();
        ("orientation", Values::Quaternions(rows))
    });
    // A reader must know that masses are not those of spheres.
    let discs = scene.particles.iter().any(|particle| particle.shape == ParticleShape::Disc);
    let density = |slot: usize| particles.velocity[slot][3] / ParticleShape::Disc.volume(particles.position[slot][3]);
    let density = discs.then(|| ("density", Values::Scalars(slots().map(density).collect())));
    let declared = scene.columns.iter().zip(&particles.declared);
    let declared = declared
        .map(|(start, values)| (start.column.name, Values::Scalars(slots().map(|slot| values[slot]).collect())));
    PointCloud {
        points,
        cell: around(scene, cell),
        fields: fields
            .into_iter()
            .chain(density)
            .chain(declared)
            .chain(cell.map(|_| ("unwrapped", Values::Vectors(unwrapped))))
            .chain(sets)
            .chain(clumps)
            .chain(orientation)
            .chain(damage)
            .collect(),
        ..PointCloud::default()
    }
}

/// Where the particles are, brought back into the cell if there is one, and where they would be without \[m\].
fn places(scene: &Scene, particles: &Particles, cell: Option<&CellState>) -> [Vec<f64>; 2] {
    let lattice = cell.zip(scene.cell.as_ref()).map(|(lies, cell)| Lattice { edges: lies.edges, ..cell.lattice });
    let mut all = [Vec::new(), Vec::new()];
    for slot in particles.slots() {
        let [x, y, z, _] = particles.position[slot];
        let mut both = [[x, y, z]; 2];
        if let (Some(lattice), Some(cell)) = (&lattice, cell) {
            let away = cell.edges_away[particles.id[slot] as usize];
            let (out, back) = (lattice.displacement(away), lattice.displacement(lattice.edges_away([x, y, z])));
            for axis in 0..3 {
                both[0][axis] -= back[axis];
                both[1][axis] += out[axis];
            }
        }
        all.iter_mut().zip(both).for_each(|(all, place)| all.extend(place));
    }
    all
}

/// The cell as rows: its corner, its edges \[m\], and 1 for each along which it repeats; empty where there is none.
fn around(scene: &Scene, cell: Option<&CellState>) -> Vec<[f64; 3]> {
    let rows = cell.zip(scene.cell.as_ref()).map(|(lies, cell)| {
        let [a, b, c] = lies.edges;
        [lies.origin, a, b, c, cell.lattice.periodic.map(|repeats| f64::from(u8::from(repeats)))]
    });
    rows.map_or_else(Vec::new, Vec::from)
}

/// The clumps: mass centres, and how their own frames are turned.
fn clumps(scene: &Scene, (particles, clumps): (&Particles, &Clumps), cell: Option<&CellState>) -> PointCloud {
    let three = |rows: &[[f64; 4]]| rows.iter().flat_map(|[x, y, z, _]| [*x, *y, *z]).collect::<Vec<_>>();
    let turned = |(row, shape): (&[f64; 4], &u32)| {
        let axes = Quaternion::from_row(scene.clump_shapes[*shape as usize].axes);
        (Quaternion::from_row(*row) * axes.conjugate()).to_row()
    };
    let numbers = |numbers: &[u32]| Values::Integers(numbers.iter().map(|&number| i64::from(number)).collect());
    let unwrapped = cell.map(|cell| {
        let place = |clump: usize| {
            let shift = cell.displacement(clumps.spheres_of(clump)[0]);
            [0, 1, 2].map(|axis| clumps.position[clump][axis] + shift[axis])
        };
        ("unwrapped", Values::Vectors((0..clumps.len()).flat_map(place).collect()))
    });
    let material = |clump: usize| {
        let sphere = clumps.spheres_of(clump)[0];
        i64::from(particles.material[particles.slot[sphere as usize] as usize])
    };
    let fields = vec![
        ("clump", numbers(&clumps.number)),
        ("material", Values::Integers((0..clumps.len()).map(material).collect())),
        ("shape", numbers(&clumps.shape)),
        ("scale", Values::Scalars(clumps.scale.clone())),
        ("mass", Values::Scalars(clumps.velocity.iter().map(|row| row[3]).collect())),
        ("orientation", Values::Quaternions(clumps.orientation.iter().zip(&clumps.shape).flat_map(turned).collect())),
        ("velocity", Values::Vectors(three(&clumps.velocity))),
        ("angular_velocity", Values::Vectors(three(&clumps.angular_velocity))),
        ("force", Values::Vectors(three(&clumps.force))),
        ("moment", Values::Vectors(three(&clumps.moment))),
    ];
    let shared = scene.columns.iter().zip(&particles.declared).filter(|(start, _)| start.column.shared.is_some());
    let shared = shared.map(|(start, values)| {
        let value = |clump: usize| values[particles.slot[clumps.spheres_of(clump)[0] as usize] as usize];
        (start.column.name, Values::Scalars((0..clumps.len()).map(value).collect()))
    });
    let fields = fields.into_iter().chain(shared).chain(unwrapped).collect();
    PointCloud { points: three(&clumps.position), cell: around(scene, cell), fields, ..PointCloud::default() }
}

/// The edges of the cell as lines.
fn cell(cell: &CellState) -> PointCloud {
    let corner = |number: usize| {
        let along = |edge: usize, axis: usize| if number >> edge & 1 == 1 { cell.edges[edge][axis] } else { 0.0 };
        [0, 1, 2].map(|axis| cell.origin[axis] + along(0, axis) + along(1, axis) + along(2, axis))
    };
    let lines =
        (0..8).flat_map(|from| (0..3).map(move |edge| [from, from | 1 << edge]).filter(|[from, to]| from != to));
    let points = lines.flatten().flat_map(corner).collect();
    PointCloud { points, kind: Kind::Lines, ..PointCloud::default() }
}

/// A point for each contact: where it is, its forces on the first body, and the two bodies.
///
/// A wall has no id: `id2` is then −1, and `boundary` is its place in the scene; between particles `boundary` is −1.
pub(crate) fn contacts(scene: &Scene, particles: &Particles, contacts: &[ContactRecord]) -> PointCloud {
    let id = |particle: u32| i64::from(number(scene, particles, particle));
    let vectors = |of: fn(&ContactRecord) -> [f64; 3]| Values::Vectors(contacts.iter().flat_map(of).collect());
    let scalars = |of: fn(&ContactRecord) -> f64| Values::Scalars(contacts.iter().map(of).collect());
    let integers = |of: &dyn Fn(&ContactRecord) -> i64| Values::Integers(contacts.iter().map(of).collect());
    PointCloud {
        points: contacts.iter().flat_map(|contact| contact.point).collect(),
        fields: vec![
            ("id1", integers(&|contact| id(contact.first))),
            ("id2", integers(&|contact| contact.second.map_or(-1, id))),
            ("boundary", integers(&|contact| contact.boundary.map_or(-1, i64::from))),
            ("normal", vectors(|contact| contact.normal)),
            ("overlap", scalars(|contact| contact.overlap)),
            ("normal_force", scalars(|contact| contact.normal_force)),
            ("tangential_force", vectors(|contact| contact.tangential_force)),
            ("sliding", Values::Bytes(contacts.iter().map(|contact| u8::from(contact.sliding)).collect())),
        ],
        ..PointCloud::default()
    }
}

/// A line for each bond, from body i to body j or to its foot on the plane: what it carries. The ids of the bodies are
/// those of the points; a foot has −1, and `boundary` is then the place of the plane in the scene (otherwise −1).
pub(crate) fn bonds(scene: &Scene, particles: &Particles, bonds: &[BondRecord]) -> PointCloud {
    let id = |particle: u32| i64::from(number(scene, particles, particle));
    let ids = bonds.iter().flat_map(|bond| [id(bond.first), bond.second.map_or(-1, id)]).collect();
    let plane = |bond: &BondRecord| {
        let plane = scene.bonds.get(bond.law as usize).and_then(|law| law.plane);
        plane.map_or(-1, |plane| i64::from(plane.0))
    };
    let vectors = |of: fn(&BondRecord) -> [f64; 3]| Values::Vectors(bonds.iter().flat_map(of).collect());
    let scalars = |of: fn(&BondRecord) -> f64| Values::Scalars(bonds.iter().map(of).collect());
    PointCloud {
        points: bonds.iter().flat_map(|bond| [bond.position, bond.other]).flatten().collect(),
        cell: Vec::new(),
        kind: Kind::Lines,
        fields: vec![("id", Values::Integers(ids))],
        cell_fields: vec![
            ("law", Values::Integers(bonds.iter().map(|bond| i64::from(bond.law)).collect())),
            ("boundary", Values::Integers(bonds.iter().map(plane).collect())),
            ("normal_force", scalars(|bond| bond.carried.normal)),
            ("shear_force", vectors(|bond| bond.carried.shear)),
            ("torsion", scalars(|bond| bond.carried.torsion)),
            ("bending", vectors(|bond| bond.carried.bending)),
            ("normal_stress", scalars(|bond| bond.carried.normal_stress)),
            ("shear_stress", scalars(|bond| bond.carried.shear_stress)),
            ("energy", scalars(|bond| bond.carried.energy)),
            ("dissipated", scalars(|bond| bond.dissipated)),
        ],
    }
}
