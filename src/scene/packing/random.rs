//! Spheres at random places of a region, none overlapping another.

use super::dense::dense;
use super::generator::generator;
use super::keys::PackingTable;
use super::radii::Draw;
use super::region::Region;
use super::{PackingProgress, Sphere, too_many};
use crate::base::document::Mistake;
use crate::base::geometry::Lattice;
use rand_chacha::ChaCha8Rng;

/// Places tried for one sphere before the region counts as full.
const TRIES: usize = 5000;

/// The spheres that are in already and are at most twice as large as one another.
struct Class {
    /// Radius of the largest of the class \[m\].
    largest: f64,
    /// Width of a cell, at least the diameter of the largest \[m\].
    width: f64,
    /// Cells along each axis.
    counts: [usize; 3],
    /// Spheres in each cell.
    cells: Vec<Vec<Sphere>>,
}

impl Class {
    /// An empty class of spheres up to this radius.
    fn new(largest: f64, size: [f64; 3], spheres: usize) -> Self {
        // More cells than spheres gain nothing.
        let most = 8.0 * spheres as f64 + 64.0;
        let cells = |width: f64| size.map(|length| (length / width).ceil().max(1.0));
        let mut width = 2.0 * largest;
        while cells(width).iter().product::<f64>() > most {
            width *= 2.0;
        }
        let counts = cells(width).map(|count| count as usize);
        Self { largest, width, counts, cells: vec![Vec::new(); counts.iter().product()] }
    }

    /// The cell of a place, along each axis.
    fn cell(&self, place: [f64; 3]) -> [usize; 3] {
        std::array::from_fn(|axis| ((place[axis] / self.width) as usize).min(self.counts[axis] - 1))
    }

    /// The place of a cell in the list.
    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.counts[1] + j) * self.counts[0] + i
    }

    /// Whether a sphere overlaps none of the class.
    fn has_room(&self, (place, radius): Sphere) -> bool {
        let [i, j, k] = self.cell(place);
        let around = |middle: usize, axis: usize| middle.saturating_sub(1)..=(middle + 1).min(self.counts[axis] - 1);
        around(k, 2).all(|k| {
            around(j, 1).all(|j| {
                around(i, 0).all(|i| {
                    self.cells[self.index([i, j, k])].iter().all(|(other, size)| {
                        let squared: f64 =
                            (0..3).map(|axis| (place[axis] - other[axis]) * (place[axis] - other[axis])).sum();
                        squared >= (radius + size) * (radius + size)
                    })
                })
            })
        })
    }
}

/// The spheres of a packing, in a scene that may have a cell. Otherwise the key that is wrong.
pub(crate) fn packing(
    table: &PackingTable,
    cell: Option<Lattice>,
    (seed, set): (u64, &str),
    tell: &mut dyn FnMut(PackingProgress),
) -> Result<Vec<Sphere>, (&'static str, Mistake)> {
    let region = Region::named(table, cell)?;
    let mut random = generator(seed, set);
    let mut radii = Draw::of(table, &mut random)?;
    match (table.count, table.solid_fraction) {
        (Some(count), None) => {
            let count = count.get() as usize;
            let mut tell = |placed| tell(PackingProgress::Placing { set, placed, count });
            scattered(&region, count, &mut radii, &mut random, &mut tell)
        }
        (None, Some(fraction)) => {
            let mut tell = |rounds, overlap| tell(PackingProgress::Pushing { set, rounds, overlap });
            dense(&region, fraction.get(), &mut radii, &mut random, &mut tell)
        }
        _ => {
            let found = if table.count.is_some() { "both" } else { "neither" }.to_owned();
            let expected = "one of count and solid_fraction".to_owned();
            Err(("packing", Mistake::Unexpected { found, expected }))
        }
    }
}

/// Places spheres, each at the first random place where it finds room, the largest first.
fn scattered(
    region: &Region,
    count: usize,
    radii: &mut Draw,
    random: &mut ChaCha8Rng,
    tell: &mut dyn FnMut(usize),
) -> Result<Vec<Sphere>, (&'static str, Mistake)> {
    if let Some(expected) = too_many(count as f64) {
        let found = format!("{count}");
        return Err(("packing.count", Mistake::Unexpected { found, expected }));
    }
    let size = region.size();
    let radii: Vec<f64> = (0..count).map(|_| radii.next(random)).collect();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|a, b| radii[*b].total_cmp(&radii[*a]));
    let mut spheres = vec![([0.0; 3], 0.0); count];
    let mut classes: Vec<Class> = Vec::new();
    let mut volume = 0.0;
    for (reached, index) in order.into_iter().enumerate() {
        let radius = radii[index];
        if classes.last().is_none_or(|class| 2.0 * radius < class.largest) {
            classes.push(Class::new(radius, size, count));
        }
        let Some(place) = room(radius, region, &classes, random) else {
            let fraction = volume / region.volume();
            return Err(("packing.count", Mistake::RegionFull { reached, count, fraction }));
        };
        if let Some(class) = classes.last_mut() {
            let cell = class.index(class.cell(place));
            class.cells[cell].push((place, radius));
        }
        volume += 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
        spheres[index] = (region.in_scene(place), radius);
        tell(reached + 1);
    }
    Ok(spheres)
}

/// A place, in coordinates of the region, where the sphere overlaps no other.
fn room(radius: f64, region: &Region, classes: &[Class], random: &mut ChaCha8Rng) -> Option<[f64; 3]> {
    if region.width() < 2.0 * radius {
        return None;
    }
    let depth = radius + classes.first().map_or(radius, |class| class.largest);
    let has_room = |place: [f64; 3]| classes.iter().all(|class| class.has_room((place, radius)));
    (0..TRIES)
        .map(|_| region.anywhere(radius, random))
        .find(|place| region.holds(*place, radius) && region.everywhere(*place, depth, has_room))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::quantity::Corners;
    use crate::base::quantity::Positive;
    use crate::scene::packing::keys::Radii;
    use std::num::NonZeroU32;

    /// A packing of a cube of edge 1.
    fn cube(count: u32, radii: [f64; 2]) -> PackingTable {
        let [least, most] = radii.map(|radius| Positive::new(radius).unwrap().get());
        PackingTable {
            r#box: Some(Corners([[-1.0; 3], [0.0; 3]])),
            cylinder: None,
            count: NonZeroU32::new(count),
            solid_fraction: None,
            radius: Some(Radii([least, most])),
            sizes: None,
        }
    }

    #[test]
    fn spheres_of_wide_sizes_stay_apart_and_inside() {
        let spheres = packing(&cube(500, [0.005, 0.06]), None, (1, "a"), &mut |_| {}).unwrap();
        for (index, (p, r)) in spheres.iter().enumerate() {
            assert!(p.iter().all(|x| x - r >= -1.0 - 1e-15 && x + r <= 1e-15), "{p:?}");
            for (q, s) in &spheres[..index] {
                let squared: f64 = (0..3).map(|axis| (p[axis] - q[axis]) * (p[axis] - q[axis])).sum();
                assert!(squared.sqrt() - (r + s) > -1e-14, "{p:?} {q:?}");
            }
        }
    }

    #[test]
    fn the_same_seed_and_set_give_the_same_packing_and_others_another() {
        let of = |seed, set| packing(&cube(50, [0.02, 0.03]), None, (seed, set), &mut |_| {}).unwrap();
        assert_eq!(of(1, "a"), of(1, "a"));
        assert_ne!(of(1, "a"), of(2, "a"));
        assert_ne!(of(1, "a"), of(1, "b"));
    }

    #[test]
    fn a_full_box_says_how_many_it_took() {
        let (key, mistake) = packing(&cube(10_000, [0.1, 0.1]), None, (1, "a"), &mut |_| {}).unwrap_err();
        assert_eq!(key, "packing.count");
        let Mistake::RegionFull { reached, count, fraction } = mistake else { panic!("{mistake}") };
        assert_eq!(count, 10_000);
        assert!((0.2..0.4).contains(&fraction) && (50..100).contains(&reached), "{reached} {fraction}");
    }
}
