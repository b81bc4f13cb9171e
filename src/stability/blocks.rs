//! The bound body by body, for contacts without bonds.
//!
//! The scheme is stable while 4 M − 2 Δt C − Δt² K is positive definite. An interaction's share between two bodies is
//! bounded by what each would feel alone, |a − b|² ≤ (1 + t) |a|² + (1 + 1/t) |b|² for any t > 0, so the whole is bounded by
//! the largest root μ = 2/Δt of the bodies' own 6 × 6 blocks: μ² = λ_max(D(K) + μ D(C)). Which t is best is found by sweeps
//! that lay load from bodies with a large root on neighbours with a small one (Collatz and Wielandt); whatever they find
//! is a bound. Contacts that stick are not frustrated, so the bound comes near the truth.

use super::network::{Element, Group, Network, UNMOVED};

/// Lower triangle of a symmetric 6 × 6 matrix, row by row, scaled by mass and moment of inertia.
type Triangle = [f32; 21];

/// What rounding in single precision may take from the bound, with room.
const ROUNDING: f64 = 1e-5;

/// Most sweeps over the bodies that limit the step.
const SWEEPS: usize = 30;

/// Sweeps in which the bound may stand still: the largest of many roots often waits for its neighbours.
const PATIENCE: usize = 4;

/// Gain of the bound in so many sweeps below which the sweeps end.
const GAIN: f64 = 2e-3;

/// Parts of the first bound above which bodies are swept, one after the other until a lower one gains nothing.
const LEVELS: [f64; 4] = [0.92, 0.84, 0.74, 0.6];

/// Gain of the bound by a level below which no further level follows.
const LEVEL_GAIN: f64 = 4e-3;

/// Largest and least share ratio t.
const MOST_UNEVEN: f64 = 1e6;

/// Iterations that find the root of a block from below.
const ITERATIONS: usize = 8;

/// What a trial root grows by until it is above the root.
const TRIAL: f64 = 1.002;

/// Where iterations begin: across no direction that a block is likely to single out.
const ASKEW: [f64; 6] = [0.5, 0.4, 0.35, 0.45, 0.3, 0.4];

/// Own blocks of all bodies.
struct Blocks<'a> {
    /// The network.
    network: &'a Network<'a>,
    /// D(K) of each body \[1/s²\].
    stiffness: Vec<Triangle>,
    /// D(C) of each body \[1/s\]; empty where nothing is damped.
    damping: Vec<Triangle>,
    /// y of each body: a body with less of it bears more of what it shares with another.
    weights: Vec<f32>,
    /// The root about which stiffness and damping are weighed for the shares \[1/s\]. It stays: bodies that are not swept
    /// are relieved only while shares change by weights alone.
    shared_at: f64,
}

/// The largest root μ = 2/Δt \[1/s\], from the safe side, and the body that has it. `guess` is about what it will be, or 0.
pub(super) fn largest_root(network: &Network, guess: f64) -> (f64, Option<usize>) {
    let (root, mover) = swept(network, guess);
    (root * (1.0 + ROUNDING), mover)
}

/// The motion that the bound comes from: of this body alone, about, scaled as the network is.
pub(super) fn critical_motion(network: &Network, root: f64, mover: Option<usize>) -> Vec<[f64; 6]> {
    /// Iterations after which it stands out.
    const ITERATIONS: usize = 60;
    let mut motion = vec![[0.0; 6]; network.movers()];
    if let Some(mover) = mover {
        let mut blocks = Blocks::of(network, root);
        blocks.add(0..network.elements.len(), |other| other == mover);
        motion[mover] = ASKEW;
        blocks.estimate(mover, &mut motion[mover], root, ITERATIONS);
    }
    motion
}

/// The largest root \[1/s\] when load has been shared as well as sweeps find, and the body that has it.
fn swept(network: &Network, guess: f64) -> (f64, Option<usize>) {
    let movers = network.movers();
    let mut blocks = Blocks::of(network, guess);
    let all = 0..network.elements.len();
    if network.is_damped() && guess <= 0.0 {
        blocks.add(all.clone(), |_| true);
        blocks.shared_at = blocks.largest(0..movers, 0.0).0;
        blocks.clear(0..movers);
    }
    blocks.add(all, |_| true);
    let first = blocks.largest(0..movers, 0.0);
    let mut best = first;
    for level in LEVELS {
        if level * first.0 >= best.0 {
            continue;
        }
        let before = best.0;
        best = blocks.refine(level * first.0, best);
        // Bodies below a level bear nothing of what those above it could hand on: what they hold up, a lower one finds.
        if best.0 > level * first.0 && best.0 > (1.0 - LEVEL_GAIN) * before {
            break;
        }
    }
    best
}

impl<'a> Blocks<'a> {
    /// Empty ones, whose shares are weighed at this root \[1/s\].
    fn of(network: &'a Network<'a>, shared_at: f64) -> Self {
        let movers = network.movers();
        Self {
            network,
            stiffness: vec![[0.0; 21]; movers],
            damping: vec![[0.0; 21]; if network.is_damped() { movers } else { 0 }],
            weights: vec![1.0; movers],
            shared_at,
        }
    }
}

impl Blocks<'_> {
    /// Empties the blocks of these bodies.
    fn clear(&mut self, movers: impl Iterator<Item = usize>) {
        for mover in movers {
            self.stiffness[mover] = [0.0; 21];
            if let Some(block) = self.damping.get_mut(mover) {
                *block = [0.0; 21];
            }
        }
    }

    /// Adds these elements to the blocks of the bodies that are chosen.
    fn add(&mut self, elements: impl Iterator<Item = usize>, chosen: impl Fn(usize) -> bool) {
        for place in elements {
            let [Some((first, a)), second] = [0, 1].map(|end| self.end(place, end)) else { continue };
            let Some((second, b)) = second else {
                if chosen(first) {
                    self.add_end(first, place, 0, 1.0);
                }
                continue;
            };
            let weight = |mover: usize| f64::from(self.weights[mover]);
            let ratio = (b / a).sqrt() * weight(second) / weight(first);
            // It is not a number where neither end can move.
            let share = if ratio.is_nan() { 1.0 } else { ratio.clamp(1.0 / MOST_UNEVEN, MOST_UNEVEN) };
            if chosen(first) {
                self.add_end(first, place, 0, 1.0 + share);
            }
            if chosen(second) {
                self.add_end(second, place, 1, 1.0 + 1.0 / share);
            }
        }
    }

    /// The body at one end of an element and the trace of what it would feel alone.
    fn end(&self, place: usize, end: usize) -> Option<(usize, f64)> {
        let element = &self.network.elements[place];
        let slot = element.slots[end];
        if slot == UNMOVED {
            return None;
        }
        let mover = self.network.mover(slot)?;
        let [along, across, twisting, bending] = self.network.parts(place, self.shared_at);
        let arm = f64::from(element.arms[end]);
        let trace = match self.group(mover) {
            None => {
                let [v, w] = self.network.roots[mover];
                let turning = 2.0 * (arm * arm * across + bending) + twisting;
                v * v * (along + 2.0 * across) + w * w * turning
            }
            Some(group) => {
                let arm = self.network.arm(element, end, group);
                let square = |from: usize, to: usize| (from..to).map(|k| row_square(&group.root[k])).sum::<f64>();
                (along + 2.0 * across) * square(0, 3)
                    + ((along + across) * arm.dot(arm) + 2.0 * bending + twisting) * square(3, 6)
            }
        };
        Some((mover, trace))
    }

    /// The group behind a place, if it is one.
    fn group(&self, mover: usize) -> Option<&Group> {
        self.network.groups.get(mover.checked_sub(self.network.roots.len())?)?.as_ref()
    }

    /// Adds one end of an element to the block of its body.
    fn add_end(&mut self, mover: usize, place: usize, end: usize, share: f64) {
        let network = self.network;
        let element = &network.elements[place];
        let (stiffness, damping) = (network.stiffness.of(place), network.damping.of(place));
        let damped = damping != [0.0; 4];
        match mover.checked_sub(network.roots.len()) {
            None => {
                let place = Place::of(element, end, network.roots[mover], share);
                place.add(&mut self.stiffness[mover], stiffness);
                if damped {
                    place.add(&mut self.damping[mover], damping);
                }
            }
            Some(group) => {
                let Some(group) = &network.groups[group] else { return };
                let arm = network.arm(element, end, group).to_array();
                add_group(&mut self.stiffness[mover], element.normal, arm, stiffness, group, share);
                if damped {
                    add_group(&mut self.damping[mover], element.normal, arm, damping, group, share);
                }
            }
        }
    }

    /// D(K) + μ D(C) of a body.
    fn combined(&self, mover: usize, root: f64) -> [f64; 21] {
        let mut sum = self.stiffness[mover].map(f64::from);
        if let Some(damping) = self.damping.get(mover) {
            for (sum, part) in sum.iter_mut().zip(damping) {
                *sum += root * f64::from(*part);
            }
        }
        sum
    }

    /// Whether the root of a body is below this one: whether μ² − D(K) − μ D(C) is positive definite.
    fn is_below(&self, mover: usize, root: f64) -> bool {
        let square = root * root;
        let combined = self.combined(mover, root);
        // No eigenvalue is above the norm of all entries: most bodies need no more.
        if squares(&combined) < square * square {
            return true;
        }
        let mut rest = combined.map(|part| -part);
        for k in 0..6 {
            rest[diagonal(k)] += square;
        }
        is_positive(&mut rest)
    }

    /// About the root of a body, from below: that of the motion that iteration comes to.
    fn estimate(&self, mover: usize, vector: &mut [f64; 6], guess: f64, iterations: usize) -> f64 {
        let mut root = guess;
        for _ in 0..iterations {
            let block = self.combined(mover, root);
            let next = times(&block, vector);
            let length = next.iter().map(|part| part * part).sum::<f64>().sqrt();
            if length <= 0.0 {
                return 0.0;
            }
            *vector = next.map(|part| part / length);
            root = self.root_of_motion(mover, vector);
        }
        root
    }

    /// The root of one motion of a body.
    fn root_of_motion(&self, mover: usize, vector: &[f64; 6]) -> f64 {
        let form = |block: &Triangle| {
            let image = times(&block.map(f64::from), vector);
            image.iter().zip(vector).map(|(a, b)| a * b).sum::<f64>()
        };
        let (k, c) = (form(&self.stiffness[mover]), self.damping.get(mover).map_or(0.0, form));
        0.5 * (c + (c * c + 4.0 * k).max(0.0).sqrt())
    }

    /// The largest root of these bodies that is above `floor`, from the safe side, and the body that has it.
    fn largest(&self, movers: impl Iterator<Item = usize>, floor: f64) -> (f64, Option<usize>) {
        let (mut most, mut at) = (floor, None);
        for mover in movers {
            let empty =
                self.stiffness[mover] == [0.0; 21] && self.damping.get(mover).is_none_or(|block| *block == [0.0; 21]);
            if empty || (most > 0.0 && self.is_below(mover, most)) {
                continue;
            }
            let mut vector = ASKEW;
            most = self.estimate(mover, &mut vector, most, ITERATIONS).max(most) * TRIAL;
            // A block that holds no number has no root; the trial then ends at infinity.
            let mut growth = TRIAL;
            while most.is_finite() && !self.is_below(mover, most) {
                most *= growth;
                growth *= TRIAL;
            }
            at = Some(mover);
        }
        (most, at)
    }

    /// Sweeps over the bodies whose root is above `floor` and their neighbours. The others stay below it: they are only
    /// relieved. Returns the largest root and its body, or `floor` and the body that was.
    fn refine(&mut self, floor: f64, best: (f64, Option<usize>)) -> (f64, Option<usize>) {
        let network = self.network;
        let hot: Vec<bool> = (0..network.movers()).map(|mover| !self.is_below(mover, floor)).collect();
        let mut swept = hot.clone();
        let ends = |element: &Element| element.slots.map(|slot| network.mover(slot));
        for element in &network.elements {
            if let [Some(a), Some(b)] = ends(element) {
                swept[a] |= hot[b];
                swept[b] |= hot[a];
            }
        }
        let touches = |element: &Element| ends(element).iter().flatten().any(|&mover| swept[mover]);
        let elements: Vec<u32> =
            (0..network.elements.len() as u32).filter(|&place| touches(&network.elements[place as usize])).collect();
        let active: Vec<usize> = (0..network.movers()).filter(|&mover| swept[mover]).collect();
        let mut vectors = vec![ASKEW; active.len()];
        let mut roots = vec![best.0; active.len()];
        let (mut least, mut history) = (best, [f64::INFINITY; PATIENCE]);
        for sweep in 0..SWEEPS {
            for ((&mover, vector), root) in active.iter().zip(&mut vectors).zip(&mut roots) {
                let iterations = if sweep == 0 { ITERATIONS } else { 2 };
                *root = self.estimate(mover, vector, *root, iterations);
            }
            let top = self.largest(active.iter().copied(), floor);
            if top.0 < least.0 {
                least = (top.0, top.1.or(least.1));
            }
            let before = std::mem::replace(&mut history[sweep % PATIENCE], least.0);
            if top.0 <= floor || least.0 > (1.0 - GAIN) * before || sweep + 1 == SWEEPS {
                break;
            }
            for (&mover, root) in active.iter().zip(&roots) {
                let ratio = (root / top.0).clamp(0.3, 1.0);
                let (fourth, eighth) = (ratio.sqrt().sqrt(), ratio.sqrt().sqrt().sqrt());
                let weight = f64::from(self.weights[mover]) * ratio * fourth * eighth;
                self.weights[mover] = weight.max(1e-9) as f32;
            }
            self.clear(active.iter().copied());
            self.add(elements.iter().map(|&place| place as usize), |mover| swept[mover]);
        }
        least
    }
}

/// Where the diagonal entry of a row stands in a triangle.
const fn diagonal(row: usize) -> usize {
    row * (row + 3) / 2
}

/// How a particle stands to an element: what its springs and its dashpots are weighed with.
struct Place {
    /// Unit normal.
    normal: [f64; 3],
    /// n nᵀ, its lower triangle row by row.
    products: [f64; 6],
    /// What a stiffness gives to shifts, to turns by its arm, between the two and to turns by itself.
    weights: [f64; 4],
}

impl Place {
    /// Of the particle at one end of an element, which bears this share of it.
    #[inline(always)]
    fn of(element: &Element, end: usize, [v, w]: [f64; 2], share: f64) -> Self {
        let normal = element.normal.map(f64::from);
        let [x, y, z] = normal;
        let arm = f64::from(element.arms[end]);
        let (shift, mixed, turn) = (share * v * v, share * v * w * arm, share * w * w);
        let products = [x * x, y * x, y * y, z * x, z * y, z * z];
        Self { normal, products, weights: [shift, turn * arm * arm, mixed, turn] }
    }

    /// Adds what the particle feels of the element alone. The arm lies along the normal n, so that with I the unit matrix, k
    /// along and q across the normal and s the arm, the blocks are q I + (k − q) n nᵀ, s q [n]× and s² q (I − n nᵀ) beside
    /// torsion and bending.
    #[inline(always)]
    fn add(&self, block: &mut Triangle, parts: [f32; 4]) {
        let [along, across, twisting, bending] = parts.map(f64::from);
        let ([x, y, z], products, [shifting, armed, between, turning]) = (self.normal, self.products, self.weights);
        let (shift, shift_more) = (shifting * across, shifting * (along - across));
        let turn = armed * across + turning * bending;
        let turn_more = turning * twisting - turn;
        let mixed = between * across;
        let mut add = |place: usize, part: f64| block[place] += part as f32;
        add(0, shift + shift_more * products[0]);
        add(1, shift_more * products[1]);
        add(2, shift + shift_more * products[2]);
        add(3, shift_more * products[3]);
        add(4, shift_more * products[4]);
        add(5, shift + shift_more * products[5]);
        add(7, -mixed * z);
        add(8, mixed * y);
        add(9, turn + turn_more * products[0]);
        add(10, mixed * z);
        add(12, -mixed * x);
        add(13, turn_more * products[1]);
        add(14, turn + turn_more * products[2]);
        add(15, -mixed * y);
        add(16, mixed * x);
        add(18, turn_more * products[3]);
        add(19, turn_more * products[4]);
        add(20, turn + turn_more * products[5]);
    }
}

/// Adds what a group feels of an element alone, whose arm has any direction.
fn add_group(block: &mut Triangle, normal: [f32; 3], arm: [f64; 3], parts: [f32; 4], group: &Group, share: f64) {
    let [along, across, twisting, bending] = parts.map(|part| share * f64::from(part));
    let n = normal.map(f64::from);
    // The point of action moves with v + w × arm: what unit freedoms give along three axes.
    let a = arm;
    let turned = [[0.0, a[2], -a[1]], [-a[2], 0.0, a[0]], [a[1], -a[0], 0.0]];
    // Motions of the point and turns of the body that the scaled freedoms make.
    let freedom = |k: usize| {
        let unscaled: [f64; 6] = std::array::from_fn(|row| group.root[row][k]);
        let point: [f64; 3] = std::array::from_fn(|axis| {
            unscaled[axis] + (0..3).map(|turn| turned[axis][turn] * unscaled[3 + turn]).sum::<f64>()
        });
        (point, [unscaled[3], unscaled[4], unscaled[5]])
    };
    let freedoms: [_; 6] = std::array::from_fn(freedom);
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    for row in 0..6 {
        for column in 0..=row {
            let ((p, u), (q, w)) = (&freedoms[row], &freedoms[column]);
            let shift = across * dot(p, q) + (along - across) * dot(p, &n) * dot(q, &n);
            let turn = bending * dot(u, w) + (twisting - bending) * dot(u, &n) * dot(w, &n);
            block[row * (row + 1) / 2 + column] += (shift + turn) as f32;
        }
    }
}

/// Sum of the squares of all entries of a symmetric matrix, given by its triangle.
fn squares(triangle: &[f64; 21]) -> f64 {
    let all: f64 = triangle.iter().map(|part| part * part).sum();
    let on_diagonal: f64 = (0..6).map(|k| triangle[diagonal(k)] * triangle[diagonal(k)]).sum();
    2.0 * all - on_diagonal
}

/// Sum of the squares of a row.
fn row_square(row: &[f64; 6]) -> f64 {
    row.iter().map(|part| part * part).sum()
}

/// The product of a matrix, given by its triangle, with a vector.
fn times(triangle: &[f64; 21], vector: &[f64; 6]) -> [f64; 6] {
    let mut image = [0.0; 6];
    let mut place = 0;
    for a in 0..6 {
        for b in 0..a {
            image[a] += triangle[place] * vector[b];
            image[b] += triangle[place] * vector[a];
            place += 1;
        }
        image[a] += triangle[place] * vector[a];
        place += 1;
    }
    image
}

/// Whether a symmetric matrix is positive definite (L D Lᵀ, in place).
fn is_positive(matrix: &mut [f64; 21]) -> bool {
    for k in 0..6 {
        let pivot = matrix[diagonal(k)];
        if pivot <= 0.0 || pivot.is_nan() {
            return false;
        }
        let per_pivot = 1.0 / pivot;
        for a in k + 1..6 {
            let factor = matrix[a * (a + 1) / 2 + k] * per_pivot;
            for b in k + 1..=a {
                matrix[a * (a + 1) / 2 + b] -= factor * matrix[b * (b + 1) / 2 + k];
            }
        }
    }
    true
}
