//! Images of the particles of a periodic cell.
//!
//! A pair across a face is a particle and the image of another. Images are rows among the particles, so lists, passes and bonds do
//! not know them; no force moves them, and their loads are added to their particles. Of each two opposite displacements there are
//! images of one, so a pair is there once; a particle may touch an image of itself, or several of another.
//!
//! Images are made anew with the lists. What is kept of a pair goes by the two particles and by how many edges one is away from
//! the other, which no way of writing the same pair changes.

use crate::base::geometry::Lattice;
use crate::base::geometry::lattice::{brought_back, counted_anew, is_behind};
use crate::engine::state::cell::CellState;
use crate::engine::state::particles::each_column;
use crate::engine::state::{IMAGE, Particles, Row, State};
use crate::scene::{Bond, Scene, Shape};
use std::collections::BTreeMap;

/// What is rounded must not leave an image out.
const HAIR: f64 = 1.0 + 1e-9;

/// Makes images.
#[derive(Clone, Debug)]
pub(crate) struct Images {
    /// The cell at time 0.
    lattice: Lattice,
    /// Radius of the largest particle \[m\].
    largest: f64,
    /// The largest distance of centres that are to be bonded \[m\].
    bonded: f64,
    /// How far the centre of a sphere may stand outside of the cell, in which the mass centre of its clump is \[m\].
    outside: f64,
}

/// A particle and how its images are displaced.
type Image = (u32, [i64; 3]);

impl Images {
    /// Those of a scene, where it has a cell.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let lattice = scene.cell.as_ref()?.lattice;
        let distance = |bond: &Bond| {
            let listed = bond.pairs.iter().map(|pair| {
                let [a, b] = pair.map(|index| scene.particles[index as usize].position);
                lattice.distance(a, b)
            });
            listed.fold(bond.create_distance().unwrap_or(0.0), f64::max)
        };
        Some(Self {
            lattice,
            largest: scene.radii().fold(0.0, f64::max),
            bonded: scene.bonds.iter().map(distance).fold(0.0, f64::max),
            outside: scene.widest_clump(),
        })
    }

    /// Whether the cell repeats along an edge.
    pub(crate) fn repeats(&self, edge: usize) -> bool {
        self.lattice.periodic[edge]
    }

    /// The cell as it is now.
    pub(crate) fn lattice(&self, cell: &CellState) -> Lattice {
        Lattice { edges: cell.edges, ..self.lattice }
    }

    /// Brings particles back into the cell and makes the images within the reach of pairs: gaps up to `skin` \[m\], and bonds. Lists
    /// refer to the new rows afterwards, and to the copies of these surfaces that stand where they were touched.
    pub(crate) fn renew(&self, state: &mut State, shapes: &[&Shape], skin: f64) {
        let Some(mut cell) = state.cell.take() else { return };
        self.straighten(&mut cell);
        let lattice = self.lattice(&cell);
        let before = whereabouts(&cell, &state.particles);
        let lists = Lists::of(state, &before);
        let before_by_index = cell.edges_away.clone();
        let row = self.bring_back(&mut cell, state, &lattice);
        let mut images = self.near(state, &lattice, skin);
        images.extend(lists.wanted(&cell, &row));
        images.sort_unstable();
        images.dedup();
        put_images(&mut cell, state, images);
        lists.rewrite(state, &cell, &row);
        self.follow_surfaces(state, (&cell, &before_by_index), shapes);
        place(&lattice, &cell, &mut state.particles);
        state.cell = Some(cell);
    }

    /// Brings surfaces back by whole edges, and contacts to the copies that stand where their particles are now, which were away by
    /// so many edges.
    fn follow_surfaces(&self, state: &mut State, (cell, away): (&CellState, &[[i64; 3]]), shapes: &[&Shape]) {
        let lattice = self.lattice(cell);
        let State { boundaries, walls, particles, .. } = state;
        let mut went = vec![[0; 3]; boundaries.len()];
        for ((moved, shape), went) in boundaries.iter_mut().zip(shapes).zip(&mut went) {
            if shape.features().is_some() {
                let edges = lattice.whole_edges(moved.displacement);
                *went = less(edges, lattice.whole_edges(moved.brought_back));
                moved.brought_back = lattice.displacement(edges);
            }
        }
        for list in walls {
            let boundary = list.boundary as usize;
            let Some(features) = shapes[boundary].features() else { continue };
            for (slot, feature) in list.particle.iter().zip(&mut list.feature) {
                let id = particles.id[*slot as usize] as usize;
                let by = less(went[boundary], less(cell.edges_away[id], away[id]));
                if by != [0; 3] {
                    *feature = features.beside(*feature, by).unwrap_or(*feature);
                }
            }
        }
    }

    /// Takes leaning edges back by whole ones.
    fn straighten(&self, cell: &mut CellState) {
        let times = self.lattice(cell).leaning();
        if times == [0; 3] {
            return;
        }
        cell.edges = brought_back(cell.edges, times);
        cell.reference = brought_back(cell.reference, times);
        for edges in cell.edges_away.iter_mut().chain(&mut cell.displaced) {
            *edges = counted_anew(*edges, times);
        }
    }

    /// Brings particles back into the cell and takes the old images away. Returns the new row of each particle's index.
    fn bring_back(&self, cell: &mut CellState, state: &mut State, lattice: &Lattice) -> Vec<u32> {
        let particles = &mut state.particles;
        let stays: Vec<bool> = particles.owner.iter().map(|&owner| owner != IMAGE).collect();
        particles.keep_rows(|slot| stays[slot]);
        let mut row = vec![0; particles.slot.len()];
        let mut bring = |(id, place): (u32, &mut Row), away: [i64; 3]| {
            let shift = lattice.displacement(away);
            for axis in 0..3 {
                place[axis] -= shift[axis];
                cell.edges_away[id as usize][axis] += away[axis];
            }
        };
        let away_of = |[x, y, z, _]: Row| Some(lattice.edges_away([x, y, z])).filter(|away| *away != [0; 3]);
        for (slot, (&id, place)) in particles.id.iter().zip(&mut particles.position).enumerate() {
            row[id as usize] = slot as u32;
            let is_loose = particles.owner[slot] as usize <= state.boundaries.len();
            if let Some(away) = away_of(*place).filter(|_| is_loose) {
                bring((id, place), away);
            }
        }
        // A clump is brought back as a whole, by its mass centre: spheres of one stay beside each other.
        for clump in 0..state.clumps.len() {
            let Some(away) = away_of(state.clumps.position[clump]) else { continue };
            for &sphere in state.clumps.spheres_of(clump) {
                bring((sphere, &mut particles.position[row[sphere as usize] as usize]), away);
            }
            let shift = lattice.displacement(away);
            (0..3).for_each(|axis| state.clumps.position[clump][axis] -= shift[axis]);
        }
        row
    }

    /// Images that may be met by pairs with a gap up to `skin` \[m\] or that are to be bonded, of all particles by their row.
    fn near(&self, state: &State, lattice: &Lattice, skin: f64) -> Vec<Image> {
        let mut images = Vec::new();
        for (slot, &[x, y, z, radius]) in state.particles.position.iter().enumerate() {
            let depth = (radius + self.largest).max(self.bonded) + skin + self.outside;
            lattice.images([x, y, z], depth * HAIR, &mut |shift| images.push((slot as u32, shift)));
        }
        images
    }
}

/// By how many edges what stands in each slot is away from where its particle has come to without being brought back.
pub(crate) fn whereabouts(cell: &CellState, particles: &Particles) -> Vec<[i64; 3]> {
    let mut away: Vec<[i64; 3]> = particles.id.iter().map(|&id| cell.edges_away[id as usize]).collect();
    for (&image, shift) in cell.images.iter().zip(&cell.displaced) {
        away[image as usize] = less(away[image as usize], *shift);
    }
    away
}

/// The difference of two counts.
fn less(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [0, 1, 2].map(|edge| a[edge].saturating_sub(b[edge]))
}

/// Two particles by their indices, and by how many edges what is met of the first is further away than of the second.
#[derive(Clone, Copy)]
struct Pair {
    /// Indices.
    ids: [u32; 2],
    /// Edges.
    apart: [i64; 3],
}

impl Pair {
    /// Which image meets which particle: the place of the image among the two, its particle's row and its displacement; none where no
    /// image is needed.
    fn image(&self, cell: &CellState, row: &[u32]) -> Option<(usize, Image)> {
        let [i, j] = self.ids;
        let away = |id: u32| cell.edges_away[id as usize];
        let shift = [0, 1, 2].map(|edge| away(j)[edge] - away(i)[edge] + self.apart[edge]);
        match shift {
            [0, 0, 0] => None,
            shift if is_behind(shift) => Some((1, (row[j as usize], shift))),
            shift => Some((0, (row[i as usize], shift.map(|count| -count)))),
        }
    }
}

/// Where the particles of pairs stand, images among them; those that are missing are made.
pub(crate) struct ImageSlots {
    /// Slot of each image.
    slots: BTreeMap<Image, u32>,
    /// Images to be made.
    missing: Vec<Image>,
    /// The slot of the next one.
    next: u32,
}

impl ImageSlots {
    /// Those of a state.
    pub(crate) fn of(state: &State) -> Self {
        let cell = state.cell.iter();
        let images = cell.flat_map(|cell| cell.images.iter().zip(cell.originals.iter().zip(&cell.displaced)));
        Self {
            slots: images.map(|(&image, (&original, &shift))| ((original, shift), image)).collect(),
            missing: Vec::new(),
            next: state.particles.len() as u32,
        }
    }

    /// The slots of two particles (their indices here, their slots there) that are to each other as they were in another state, whose
    /// slots are away by so many edges.
    pub(crate) fn pair(&mut self, state: &State, ids: [u32; 2], there: [u32; 2], away: &[[i64; 3]]) -> [u32; 2] {
        let slot = &state.particles.slot;
        let mut slots = ids.map(|id| slot[id as usize]);
        let Some(cell) = &state.cell else { return slots };
        let pair = Pair { ids, apart: less(away[there[0] as usize], away[there[1] as usize]) };
        if let Some((place, image)) = pair.image(cell, slot) {
            slots[place] = *self.slots.entry(image).or_insert_with(|| {
                self.missing.push(image);
                self.next += 1;
                self.next - 1
            });
        }
        slots
    }

    /// Makes what is missing. The lists are made anew afterwards.
    pub(crate) fn make(self, state: &mut State) {
        let Some(cell) = &mut state.cell else { return };
        let first = state.particles.len() as u32;
        cell.images.extend((0..self.missing.len() as u32).map(|place| first + place));
        cell.originals.extend(self.missing.iter().map(|(original, _)| *original));
        cell.displaced.extend(self.missing.iter().map(|(_, shift)| *shift));
        let originals: Vec<u32> = self.missing.iter().map(|(original, _)| *original).collect();
        state.particles.add_images(&originals);
    }
}

/// Takes over a cell as it has come to in another state, whose particles are these here (their rows, which are their indices). Returns
/// the row here of what stands in each slot there, images among them.
pub(crate) fn take_over(state: &mut State, reached: &State, here: impl Fn(u32) -> Option<u32>) -> Vec<Option<u32>> {
    let mut rows: Vec<Option<u32>> = reached.particles.id.iter().map(|&id| here(id)).collect();
    let (Some(cell), Some(other)) = (&mut state.cell, &reached.cell) else { return rows };
    (cell.reference, cell.edges, cell.strain) = (other.reference, other.edges, other.strain);
    for (there, away) in other.edges_away.iter().enumerate() {
        if let Some(here) = here(there as u32) {
            cell.edges_away[here as usize] = *away;
        }
    }
    let mut next = state.particles.len() as u32;
    for ((&image, &original), &shift) in other.images.iter().zip(&other.originals).zip(&other.displaced) {
        // An image of a particle that is not here has no row.
        rows[image as usize] = None;
        let Some(original) = rows[original as usize] else { continue };
        rows[image as usize] = Some(next);
        cell.images.push(next);
        cell.originals.push(original);
        cell.displaced.push(shift);
        next += 1;
    }
    state.particles.add_images(&cell.originals);
    rows
}

/// The pairs of the lists, by particles.
struct Lists {
    /// Of each contact law: entries with something to keep.
    contacts: Vec<Vec<(u32, Pair)>>,
    /// Of each bond law.
    bonds: Vec<Vec<Pair>>,
    /// Of each list at a surface: indices of particles.
    walls: Vec<Vec<u32>>,
}

impl Lists {
    /// Reads the lists of a state whose slots are away by so many edges.
    fn of(state: &State, away: &[[i64; 3]]) -> Self {
        let id = &state.particles.id;
        let pair = |a: u32, b: u32| {
            let [a, b] = [a as usize, b as usize];
            Pair { ids: [id[a], id[b]], apart: less(away[a], away[b]) }
        };
        let contacts = state.contacts.iter().map(|list| {
            let kept = list.flags.iter().enumerate().filter(|(_, flags)| **flags != 0);
            kept.map(|(entry, _)| (entry as u32, pair(list.first[entry], list.second[entry]))).collect()
        });
        let bonds =
            state.bonds.iter().map(|list| list.first.iter().zip(&list.second).map(|(&a, &b)| pair(a, b)).collect());
        let walls = state.walls.iter().map(|list| list.particle.iter().map(|&slot| id[slot as usize]).collect());
        Self { contacts: contacts.collect(), bonds: bonds.collect(), walls: walls.collect() }
    }

    /// Images that bonds need.
    fn wanted(&self, cell: &CellState, row: &[u32]) -> Vec<Image> {
        let bonds = self.bonds.iter().flatten();
        bonds.filter_map(|pair| pair.image(cell, row)).map(|(_, image)| image).collect()
    }

    /// Writes the new rows into the lists. Contacts whose image is not there any more are out of reach.
    fn rewrite(&self, state: &mut State, cell: &CellState, row: &[u32]) {
        let own = (state.particles.len() - cell.originals.len()) as u32;
        let slots = |pair: &Pair| {
            let mut slots = pair.ids.map(|id| row[id as usize]);
            if let Some((place, image)) = pair.image(cell, row) {
                slots[place] = own + find(cell, image)?;
            }
            Some(slots)
        };
        for (list, pairs) in state.contacts.iter_mut().zip(&self.contacts) {
            for (entry, pair) in pairs {
                let entry = *entry as usize;
                match slots(pair) {
                    Some([first, second]) => (list.first[entry], list.second[entry]) = (first, second),
                    None => list.flags[entry] = 0,
                }
            }
        }
        for (list, pairs) in state.bonds.iter_mut().zip(&self.bonds) {
            for (bond, pair) in pairs.iter().enumerate() {
                if let Some([first, second]) = slots(pair) {
                    (list.first[bond], list.second[bond]) = (first, second);
                }
            }
        }
        for (list, ids) in state.walls.iter_mut().zip(&self.walls) {
            for (slot, id) in list.particle.iter_mut().zip(ids) {
                *slot = row[*id as usize];
            }
        }
    }
}

/// The place of an image among all, which are sorted.
fn find(cell: &CellState, image: Image) -> Option<u32> {
    let (mut from, mut to) = (0, cell.originals.len());
    while from < to {
        let middle = from.midpoint(to);
        match (cell.originals[middle], cell.displaced[middle]).cmp(&image) {
            std::cmp::Ordering::Equal => return Some(middle as u32),
            std::cmp::Ordering::Less => from = middle + 1,
            std::cmp::Ordering::Greater => to = middle,
        }
    }
    None
}

/// Adds rows for these images, sorted, behind the particles.
fn put_images(cell: &mut CellState, state: &mut State, images: Vec<Image>) {
    let own = state.particles.len() as u32;
    cell.images.clear();
    cell.images.extend((0..images.len() as u32).map(|place| own + place));
    cell.originals.clear();
    cell.originals.extend(images.iter().map(|(original, _)| *original));
    cell.displaced.clear();
    cell.displaced.extend(images.iter().map(|(_, shift)| *shift));
    state.particles.add_images(&cell.originals);
}

/// Follows the images into a new order of the particles.
pub(crate) fn follow(state: &mut State, new_slot: &[u32]) {
    let Some(cell) = &mut state.cell else { return };
    for slot in cell.images.iter_mut().chain(&mut cell.originals) {
        *slot = new_slot[*slot as usize];
    }
}

/// Puts the images where they belong, moving as their particles do relative to the streaming motion.
pub(crate) fn place(lattice: &Lattice, cell: &CellState, particles: &mut Particles) {
    let pairs =
        || cell.images.iter().zip(&cell.originals).map(|(&image, &original)| (image as usize, original as usize));
    each_column!(&mut *particles, |_name, images, column| if images == OfImages::Followed && !column.is_empty() {
        pairs().for_each(|(image, original)| column[image] = column[original]);
    });
    for (&image, &shift) in cell.images.iter().zip(&cell.displaced) {
        let displacement = lattice.displacement(shift);
        for (part, by) in particles.position[image as usize].iter_mut().zip(displacement) {
            *part += by;
        }
    }
}

/// Adds the loads of images to their particles, and takes them from the images. Returns the sum over images of force times
/// displacement, rows are components of the force \[J\].
pub(crate) fn gather(lattice: &Lattice, cell: &CellState, particles: &mut Particles) -> [[f64; 3]; 3] {
    let Particles { force, torque, .. } = particles;
    let mut sum = [[0.0; 3]; 3];
    for ((&image, &original), &shift) in cell.images.iter().zip(&cell.originals).zip(&cell.displaced) {
        let (image, original) = (image as usize, original as usize);
        let (load, displacement) = (force[image], lattice.displacement(shift));
        for (row, part) in sum.iter_mut().zip(load) {
            for (entry, along) in row.iter_mut().zip(displacement) {
                *entry += part * along;
            }
        }
        for loads in [&mut *force, &mut *torque] {
            let load = std::mem::take(&mut loads[image]);
            for axis in 0..3 {
                loads[original][axis] += load[axis];
            }
        }
    }
    sum
}
