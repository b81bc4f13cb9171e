//! Registers of every width, and one number at a time, do the same: arithmetic to the last bit, and moves of rows.
//!
//! One at a time is what processors without such registers work with; no scene can ask for it on the others.

use cograin::lanes::{Kernel, Lane, Width, run};
use cograin::number::Number;
use cograin::state::Row;

/// Numbers of every kind: signs, zeros, the smallest, the largest, none.
const NUMBERS: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.1,
    -3.7e5,
    2.5e-7,
    1.0 / 3.0,
    5e-324,
    -2.2e-308,
    1.7e308,
    -1.7e308,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    7.0e-17,
];

/// Bits of a number; all that are none count as one.
fn bits(number: f64) -> u64 {
    if number.is_nan() { f64::NAN.to_bits() } else { number.to_bits() }
}

/// Every operation on two numbers.
fn operations<N: Number>(a: N, b: N) -> [N; 13] {
    let (above, below) = (a.greater(b), b.greater(a));
    let one = |mask| N::select(mask, N::splat(1.0), N::splat(-0.0));
    [
        a + b,
        a - b,
        a * b,
        a / b,
        -a,
        a.sqrt(),
        a.abs(),
        a.max(b),
        a.min(b),
        N::select(above, a, b),
        one(N::both(above, below)),
        one(N::either(above, below)),
        one(N::both(above, N::zero().greater(b))),
    ]
}

/// Does every operation on every two numbers, and every move, in one width.
struct Try;

impl Kernel for Try {
    #[inline(always)]
    fn run<N: Lane>(self) {
        arithmetic::<N>();
        rows::<N>();
        indices::<N>();
    }
}

/// The numbers of a register.
#[inline(always)]
fn spread<N: Lane>(register: N) -> Vec<f64> {
    let mut numbers = vec![0.0; N::WIDTH];
    // SAFETY: as many places as numbers.
    unsafe { register.store(numbers.as_mut_ptr()) };
    numbers
}

/// Arithmetic against that of single numbers.
#[inline(always)]
fn arithmetic<N: Lane>() {
    for turn in 0..NUMBERS.len() {
        for start in (0..NUMBERS.len()).step_by(N::WIDTH) {
            let pairs: Vec<[f64; 2]> =
                (start..start + N::WIDTH).map(|n| [NUMBERS[n % 16], NUMBERS[(n + turn) % 16]]).collect();
            let [a, b] = [0, 1].map(|which| {
                let column: Vec<f64> = pairs.iter().map(|pair| pair[which]).collect();
                // SAFETY: as many numbers as the register has.
                unsafe { N::load(column.as_ptr()) }
            });
            for (what, together) in operations(a, b).into_iter().enumerate() {
                for (together, [a, b]) in spread(together).into_iter().zip(&pairs) {
                    let alone = operations(*a, *b)[what];
                    assert_eq!(
                        bits(together),
                        bits(alone),
                        "operation {what} of {a:e} and {b:e}: {together:e}, {alone:e}"
                    );
                }
            }
            let expected = pairs.iter().enumerate().fold(0, |bits, (lane, [a, b])| bits | u32::from(a > b) << lane);
            assert_eq!((N::bits(a.greater(b)), N::any(a.greater(b))), (expected, expected != 0));
        }
    }
}

/// Rows that are read, transposed, and written back elsewhere.
#[inline(always)]
fn rows<N: Lane>() {
    let rows: Vec<Row> = (0..40).map(|n| [0, 1, 2, 3].map(|k| f64::from(10 * n + k))).collect();
    let index: Vec<u32> = [3, 39, 0, 17, 4, 5, 31, 8].into_iter().take(N::WIDTH).collect();
    // SAFETY: the index names rows that are there.
    let columns = unsafe { N::load_rows(rows.as_ptr(), index.as_ptr()) };
    for (k, column) in columns.into_iter().enumerate() {
        let expected: Vec<f64> = index.iter().map(|&at| rows[at as usize][k]).collect();
        assert_eq!(spread(column), expected);
        // SAFETY: rows are four numbers, and the index names rows that are there.
        let gathered = unsafe { N::gather(rows.as_ptr().cast::<f64>().add(k), index.as_ptr(), 4) };
        assert_eq!(spread(gathered), expected);
    }
    let mut written = vec![[-1.0; 4]; 40];
    // SAFETY: as above.
    unsafe { N::store_rows(columns, written.as_mut_ptr(), index.as_ptr()) };
    for (at, row) in written.iter().enumerate() {
        let there = index.contains(&(at as u32));
        assert_eq!(*row, if there { rows[at] } else { [-1.0; 4] });
    }
    let mut block = vec![[-1.0; 4]; N::WIDTH + 1];
    // SAFETY: one row more than are written.
    unsafe { N::store_block(columns, block.as_mut_ptr()) };
    let expected: Vec<Row> = index.iter().map(|&at| rows[at as usize]).chain([[-1.0; 4]]).collect();
    assert_eq!(block, expected);
}

/// Indices picked by every mask.
#[inline(always)]
fn indices<N: Lane>() {
    let from: Vec<u32> = (0..N::WIDTH as u32).map(|n| 7 * n + 3).collect();
    for bits in 0..1_u32 << N::WIDTH {
        let picked: Vec<u32> = (0..N::WIDTH as u32).filter(|lane| bits >> lane & 1 == 1).collect();
        let (mut compacted, mut compressed) = ([0; 16], [0; 16]);
        // SAFETY: places enough for a whole register.
        let count = unsafe {
            N::compact(from.as_ptr(), bits, compacted.as_mut_ptr());
            N::compress(bits, 100, compressed.as_mut_ptr())
        };
        assert_eq!(count, picked.len());
        let expected: Vec<u32> = picked.iter().map(|&lane| from[lane as usize]).collect();
        assert_eq!(&compacted[..count], expected);
        let expected: Vec<u32> = picked.iter().map(|lane| 100 + lane).collect();
        assert_eq!(&compressed[..count], expected);
    }
}

#[test]
fn registers_of_every_width_do_what_one_number_at_a_time_does() {
    Try.run::<f64>();
    for width in Width::ALL.into_iter().filter(|width| width.offered()) {
        run(width, Try);
    }
}
