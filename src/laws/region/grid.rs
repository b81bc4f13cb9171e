//! A box that is divided evenly into cells.

use super::cuboid::Cuboid;
use super::sphere::{beyond, in_box};
use crate::base::number::Vector;

/// Corners of cells of which what is beyond them is kept without asking for memory: a sphere over four cells along each axis.
const FEW: usize = 125;

/// Cells with their weights: never below 0, 1 in sum. A cell may stand there more than once.
pub type Weights = [(usize, f64); 8];

/// A box that is divided evenly into cells, which are counted along x first, then y, then z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Lower and upper corner \[m\].
    pub corners: [[f64; 3]; 2],
    /// How many cells stand along each axis.
    pub counts: [u32; 3],
    /// Whether space repeats from the upper face to the lower one, along each axis: the last cell then has the first as its neighbour.
    pub repeats: [bool; 3],
}

impl Grid {
    /// How many cells it has.
    pub fn cells(&self) -> usize {
        self.counts.iter().map(|&count| count as usize).product()
    }

    /// Whether each face between cells lies above the one before it, which rounding may hide of very many cells.
    pub fn is_divided(&self) -> bool {
        (0..3)
            .all(|axis| (0..self.counts[axis] as usize).all(|cell| self.plane(axis, cell) < self.plane(axis, cell + 1)))
    }

    /// Edges of a cell \[m\].
    pub fn edges(&self) -> [f64; 3] {
        let [lower, upper] = self.corners;
        [0, 1, 2].map(|axis| (upper[axis] - lower[axis]) / f64::from(self.counts[axis]))
    }

    /// Volume of a cell \[m³\].
    pub fn cell_volume(&self) -> f64 {
        self.edges().into_iter().product()
    }

    /// Centre of a cell \[m\].
    pub fn centre(&self, cell: usize) -> [f64; 3] {
        let [lower, upper] = self.box_of(self.place(cell)).corners;
        [0, 1, 2].map(|axis| lower[axis] + 0.5 * (upper[axis] - lower[axis]))
    }

    /// The cell that a point is in. The lower faces of a cell are in it, the upper ones are not.
    pub fn cell_of(&self, point: Vector) -> Option<usize> {
        let point = point.to_array();
        Cuboid { corners: self.corners }
            .holds(point.into())
            .then(|| self.number([0, 1, 2].map(|axis| self.along(axis, point[axis]))))
    }

    /// Hands out each cell that has a part of a sphere, with the volume of the part \[m³\]. In sum the parts are the part of the sphere in
    /// the box, to rounding of the sphere's volume.
    pub fn parts_of_sphere(&self, centre: Vector, radius: f64, mut hand: impl FnMut(usize, f64)) {
        let centre = centre.to_array();
        let Some([low, high]) = self.met([0, 1, 2].map(|axis| [centre[axis] - radius, centre[axis] + radius])) else {
            return;
        };
        let plane = |axis: usize, number: usize| (self.plane(axis, number) - centre[axis]) / radius;
        let width = [0, 1, 2].map(|axis| high[axis] - low[axis] + 2);
        // What is beyond a corner serves the eight cells around it.
        let (count, mut few, mut many) = (width.iter().product(), [0.0; FEW], Vec::new());
        let beyond_of = if count > FEW {
            many.resize(count, 0.0);
            &mut many[..]
        } else {
            &mut few[..count]
        };
        let place = |[i, j, k]: [usize; 3]| ((k - low[2]) * width[1] + j - low[1]) * width[0] + i - low[0];
        each_of([low, high.map(|last| last + 1)], |corner| {
            beyond_of[place(corner)] = beyond([0, 1, 2].map(|axis| plane(axis, corner[axis])));
        });
        each_of([low, high], |cell| {
            let upper = cell.map(|along| along + 1);
            let corners = [cell, upper].map(|corner| [0, 1, 2].map(|axis| plane(axis, corner[axis])));
            let of_corner = |number: usize| beyond_of[place([0, 1, 2].map(|axis| cell[axis] + (number >> axis & 1)))];
            let part = in_box(corners, (radius, self.box_of(cell).volume()), of_corner);
            if part > 0.0 {
                hand(self.number(cell), part);
            }
        });
    }

    /// Hands out each cell that has a part of the line between two points \[m\], with the part over the length of the line.
    pub fn parts_of_line(&self, from: Vector, to: Vector, mut hand: impl FnMut(usize, f64)) {
        let ends = [from.to_array(), to.to_array()];
        let Some(cells) = self.met([0, 1, 2].map(|axis| {
            let [one, other] = ends.map(|end| end[axis]);
            [one.min(other), one.max(other)]
        })) else {
            return;
        };
        each_of(cells, |cell| {
            let share = self.box_of(cell).share_of_line(from, to);
            if share > 0.0 {
                hand(self.number(cell), share);
            }
        });
    }

    /// Its cells as a lattice of their centres.
    pub fn centres(&self) -> Centres {
        let ([lower, upper], counts) = (self.corners, self.counts.map(|count| count as usize));
        Centres {
            corners: self.corners,
            per_length: [0, 1, 2].map(|axis| counts[axis] as f64 / (upper[axis] - lower[axis])),
            counts,
            repeats: self.repeats,
        }
    }

    /// The cells between whose centres a point \[m\] lies ([`Centres::weights`]).
    pub fn weights(&self, point: Vector) -> Weights {
        self.centres().weights(point)
    }

    /// Number of the cell at a place along each axis.
    fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.counts[1] as usize + j) * self.counts[0] as usize + i
    }

    /// Place of a cell along each axis.
    pub(super) fn place(&self, cell: usize) -> [usize; 3] {
        let [nx, ny, _] = self.counts.map(|count| count as usize);
        [cell % nx, cell / nx % ny, cell / (nx * ny)]
    }

    /// The box of a cell.
    pub(super) fn box_of(&self, cell: [usize; 3]) -> Cuboid {
        let corner = |upper: usize| [0, 1, 2].map(|axis| self.plane(axis, cell[axis] + upper));
        Cuboid { corners: [corner(0), corner(1)] }
    }

    /// Where a plane between cells is along an axis, from 0 \[m\].
    fn plane(&self, axis: usize, number: usize) -> f64 {
        let ([lower, upper], count) = (self.corners.map(|corner| corner[axis]), self.counts[axis] as usize);
        if number == count { upper } else { lower + (upper - lower) * (number as f64 / count as f64) }
    }

    /// The cell along an axis that a place is in; for one outside the outermost cell.
    fn along(&self, axis: usize, at: f64) -> usize {
        let last = self.counts[axis] as usize - 1;
        let mut cell = (((at - self.corners[0][axis]) / self.edges()[axis]) as usize).min(last);
        // The quotient may be rounded across a plane.
        while cell > 0 && self.plane(axis, cell) > at {
            cell -= 1;
        }
        while cell < last && self.plane(axis, cell + 1) <= at {
            cell += 1;
        }
        cell
    }

    /// The first and the last cell along each axis that meet what reaches from here to there; none where it is outside.
    fn met(&self, extent: [[f64; 2]; 3]) -> Option<[[usize; 3]; 2]> {
        let [lower, upper] = self.corners;
        let outside = |axis: usize| extent[axis][1] < lower[axis] || extent[axis][0] > upper[axis];
        (!(0..3).any(outside)).then(|| [0, 1].map(|end| [0, 1, 2].map(|axis| self.along(axis, extent[axis][end]))))
    }
}

/// The centres of the cells of a grid, between which fields are linear: what many points ask for.
#[derive(Clone, Copy, Debug)]
pub struct Centres {
    /// Lower and upper corner of the box \[m\].
    corners: [[f64; 3]; 2],
    /// Cells for each length along each axis \[1/m\].
    per_length: [f64; 3],
    /// How many cells stand along each axis.
    counts: [usize; 3],
    /// Whether space repeats along each axis.
    repeats: [bool; 3],
}

impl Centres {
    /// Whether a point is in the box, which goes on where space repeats.
    #[inline(always)]
    pub fn holds(&self, point: Vector) -> bool {
        let ([lower, upper], point) = (self.corners, point.to_array());
        (0..3).all(|axis| self.repeats[axis] || (lower[axis]..upper[axis]).contains(&point[axis]))
    }

    /// The cells between whose centres a point \[m\] lies, with weights linear along each axis. Fields that are linear in space come out
    /// as they are between the outermost centres. Beyond these the value of the outermost cell holds, or, where space repeats, that
    /// between the last cell and the first.
    #[inline(always)]
    pub fn weights(&self, point: Vector) -> Weights {
        let point = point.to_array();
        let [nx, ny, _] = self.counts;
        let strides = [1, nx, nx * ny];
        let along = |axis: usize| {
            let ([first, second], share) = self.along(axis, point[axis]);
            [(first * strides[axis], 1.0 - share), (second * strides[axis], share)]
        };
        let (along_x, along_y, along_z) = (along(0), along(1), along(2));
        // Loops, as closures over arrays are called and not inlined here.
        let mut weights = [(0, 0.0); 8];
        let mut place = 0;
        for (k, z) in along_z {
            for (j, y) in along_y {
                let (row, share) = (j + k, y * z);
                for (i, x) in along_x {
                    weights[place] = (i + row, x * share);
                    place += 1;
                }
            }
        }
        weights
    }

    /// What makes the derivatives along x, y and z \[1/m\] of the field between these cells: 0 in sum, and 0 along an axis where the value of
    /// the outermost cell holds.
    pub fn slopes(&self, point: Vector) -> [Weights; 3] {
        let point = point.to_array();
        let [nx, ny, _] = self.counts;
        let strides = [1, nx, nx * ny];
        let cells = [0, 1, 2].map(|axis| self.along(axis, point[axis]));
        let slope = |axis: usize| {
            let place = (point[axis] - self.corners[0][axis]) * self.per_length[axis] - 0.5;
            let is_between = self.repeats[axis] || (0.0..(self.counts[axis] - 1) as f64).contains(&place);
            if is_between { self.per_length[axis] } else { 0.0 }
        };
        [0, 1, 2].map(|along: usize| {
            let mut weights = [(0, 1.0); 8];
            for (place, (cell, weight)) in weights.iter_mut().enumerate() {
                for axis in 0..3 {
                    let ([first, second], share) = cells[axis];
                    let is_second = place >> axis & 1 == 1;
                    *cell += strides[axis] * if is_second { second } else { first };
                    let [before, behind] =
                        if axis == along { [-slope(axis), slope(axis)] } else { [1.0 - share, share] };
                    *weight *= if is_second { behind } else { before };
                }
            }
            weights
        })
    }

    /// The two cells along an axis between whose centres a place \[m\] lies, and the weight of the second.
    #[inline(always)]
    fn along(&self, axis: usize, place: f64) -> ([usize; 2], f64) {
        let count = self.counts[axis];
        let place = (place - self.corners[0][axis]) * self.per_length[axis] - 0.5;
        if self.repeats[axis] {
            let (whole, all) = (place.floor(), count as f64);
            let first = (whole - all * (whole / all).floor()) as usize % count;
            return ([first, (first + 1) % count], place - whole);
        }
        let place = place.clamp(0.0, (count - 1) as f64);
        let first = (place as usize).min(count.saturating_sub(2));
        ([first, (first + 1).min(count - 1)], place - first as f64)
    }
}

/// Hands out the places from the first to the last along each axis, along x first.
fn each_of([first, last]: [[usize; 3]; 2], mut hand: impl FnMut([usize; 3])) {
    for k in first[2]..=last[2] {
        for j in first[1]..=last[1] {
            for i in first[0]..=last[0] {
                hand([i, j, k]);
            }
        }
    }
}
