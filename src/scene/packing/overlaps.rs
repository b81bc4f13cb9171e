//! Which spheres overlap, found in time proportional to their number.

/// One size class of spheres, sorted by cell; a cell is as wide as the largest sphere of the class.
struct Level {
    /// Width of a cell \[m\], at least the largest diameter of the class.
    width: f64,
    /// Cell and sphere, ascending.
    entries: Vec<(u64, u32)>,
}

/// Bits of a cell's number along one axis.
const BITS: u32 = 21;

/// Cells kept free at each end of an axis, so that neighbouring rows never wrap around.
const MARGIN: u64 = 2;

/// How much wider than the largest sphere a cell is, so that rounding never puts a touching pair two cells apart.
const SLACK: f64 = 1.0 + 1e-9;

/// Calls `found` for each two spheres whose surfaces overlap, with the overlap \[m\].
///
/// Spheres are classed by size, each class twice as large as the one before; small ones are looked for
/// among larger ones, so that wide size ratios do not crowd the cells.
pub(crate) fn for_each_overlap(spheres: &[([f64; 3], f64)], mut found: impl FnMut(u32, u32, f64)) {
    let Some(smallest) = spheres.iter().map(|(_, radius)| *radius).reduce(f64::min) else { return };
    let lower = spheres
        .iter()
        .fold([f64::INFINITY; 3], |lower, (position, _)| std::array::from_fn(|axis| lower[axis].min(position[axis])));
    let extent = spheres.iter().fold(0.0_f64, |extent, (position, _)| {
        (0..3).fold(extent, |extent, axis| extent.max(position[axis] - lower[axis]))
    });
    let cells = (1_u64 << (BITS - 1)) as f64;
    let classes: Vec<usize> = spheres.iter().map(|(_, radius)| class(*radius, smallest)).collect();
    let mut largest = vec![0.0_f64; 1 + classes.iter().copied().max().unwrap_or(0)];
    for ((_, radius), class) in spheres.iter().zip(&classes) {
        largest[*class] = largest[*class].max(*radius);
    }
    let width = |radius: f64| (2.0 * SLACK * radius).max(extent / cells);
    let mut levels: Vec<Level> =
        largest.into_iter().map(|radius| Level { width: width(radius), entries: Vec::new() }).collect();
    for ((index, (position, _)), class) in (0..).zip(spheres).zip(&classes) {
        let level = &mut levels[*class];
        level.entries.push((cell(position, &lower, level.width), index));
    }
    let mut test = |a: u32, b: u32| {
        let ((p, r), (q, s)) = (&spheres[a as usize], &spheres[b as usize]);
        let squared: f64 = (0..3).map(|axis| (p[axis] - q[axis]) * (p[axis] - q[axis])).sum();
        if squared < (r + s) * (r + s) {
            found(a, b, r + s - squared.sqrt());
        }
    };
    for level in &mut levels {
        level.entries.sort_unstable();
        within(&level.entries, &mut test);
    }
    for (index, (position, _)) in (0..).zip(spheres) {
        for level in levels[classes[index as usize] + 1..].iter().filter(|level| !level.entries.is_empty()) {
            around(level, cell(position, &lower, level.width), &mut |other| test(index, other));
        }
    }
}

/// The size class: 0 up to twice the smallest radius, 1 up to four times it, and so on.
fn class(radius: f64, smallest: f64) -> usize {
    let (mut class, mut bound) = (0, 2.0 * smallest);
    while radius > bound && class < 60 {
        class += 1;
        bound *= 2.0;
    }
    class
}

/// The number of the cell of a point; cells that follow one another along x have consecutive numbers.
fn cell(position: &[f64; 3], lower: &[f64; 3], width: f64) -> u64 {
    let along = |axis: usize| ((position[axis] - lower[axis]) / width) as u64 + MARGIN;
    along(0) | along(1) << BITS | along(2) << (2 * BITS)
}

/// Calls `test` once for each two entries in the same or neighbouring cells.
fn within(entries: &[(u64, u32)], test: &mut impl FnMut(u32, u32)) {
    // The rows of three cells that lie before a cell; each entry meets those before it.
    let (y, z) = (1 << BITS, 1 << (2 * BITS));
    let rows = [z + y, z, z - y, y].map(|back: u64| back);
    let mut starts = [0_usize; 4];
    for (place, (cell, index)) in entries.iter().enumerate() {
        for (other_cell, other) in entries[..place].iter().rev() {
            if other_cell + 1 < *cell {
                break;
            }
            test(*other, *index);
        }
        for (back, start) in rows.iter().zip(&mut starts) {
            let middle = cell - back;
            while entries[*start].0 + 1 < middle {
                *start += 1;
            }
            for (_, other) in entries[*start..].iter().take_while(|(cell, _)| *cell <= middle + 1) {
                test(*other, *index);
            }
        }
    }
}

/// Calls `test` for each entry in a cell or its 26 neighbours.
fn around(level: &Level, cell: u64, test: &mut impl FnMut(u32)) {
    for z in 0..3 {
        for y in 0..3 {
            let middle = cell + (z << (2 * BITS)) + (y << BITS) - (1 << (2 * BITS)) - (1 << BITS);
            let start = level.entries.partition_point(|(cell, _)| *cell + 1 < middle);
            for (_, other) in level.entries[start..].iter().take_while(|(cell, _)| *cell <= middle + 1) {
                test(*other);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::for_each_overlap;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    /// A number from 0 to 1.
    fn uniform(random: &mut ChaCha8Rng) -> f64 {
        (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    #[test]
    fn finds_what_comparing_all_with_all_finds_whatever_the_sizes() {
        for ratio in [1.0, 3.0, 40.0] {
            let mut random = ChaCha8Rng::seed_from_u64(7);
            let spheres: Vec<([f64; 3], f64)> = (0..600)
                .map(|_| {
                    let position = [0; 3].map(|_| 0.4 * (uniform(&mut random) - 0.5));
                    let share = uniform(&mut random);
                    (position, 0.01 + 0.01 * (ratio - 1.0) * share * share * share * share)
                })
                .collect();
            let mut expected = Vec::new();
            for i in 0..spheres.len() as u32 {
                for j in i + 1..spheres.len() as u32 {
                    let ((p, r), (q, s)) = (spheres[i as usize], spheres[j as usize]);
                    let squared: f64 = (0..3).map(|axis| (p[axis] - q[axis]) * (p[axis] - q[axis])).sum();
                    if squared < (r + s) * (r + s) {
                        expected.push((i, j));
                    }
                }
            }
            let mut found = Vec::new();
            for_each_overlap(&spheres, |i, j, _| found.push((i.min(j), i.max(j))));
            found.sort_unstable();
            assert!(expected.len() > 20, "only {} pairs to find", expected.len());
            assert_eq!(found, expected, "size ratio {ratio}");
        }
    }
}
