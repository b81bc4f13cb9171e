//! The product of a network of contacts between particles with a motion, in lanes and over the threads: no groups, nothing that
//! resists turning alone.
//!
//! Arms lie along the normal n. With k along and q across it, the relative velocity s at the contact gives the force
//! f = q s + (k − q) (n · s) n, whose couple about either centre is the arm's length times n × f = q n × s. What both give each body is
//! found contact by contact, in registers; then each body adds up what its own contacts give it, in their order.

use super::ends::Ends;
use super::network::{Network, UNMOVED};
use crate::base::lanes::{self, Kernel, Lane, Shared, columns, vector};
use crate::base::number::{Row, Vector, add};
use crate::base::threads::{CHUNK, Context};

/// Numbers of a contact: unit normal, arms from each centre to where the forces act \[m\], springs along and across the normal \[N/m\],
/// dashpots likewise \[kg/s\].
const NUMBERS: usize = 9;

/// Contacts in the widest register: columns are filled up to a multiple of it.
const WIDEST: usize = 8;

/// A network of contacts between particles.
pub(super) struct Plain {
    /// The bodies of each contact: places among those that interact. What does not move is the place behind them.
    bodies: [Vec<u32>; 2],
    /// The numbers of all contacts, each a column.
    numbers: [Vec<f64>; NUMBERS],
    /// What scales translations \[1/√kg\] and rotations \[1/√(kg m²)\] of each body.
    roots: Vec<[f64; 2]>,
    /// Scaled velocity of each body, and what scales it.
    shifts: Vec<Row>,
    /// Scaled angular velocity of each body, and what scales it.
    spins: Vec<Row>,
    /// Scaled acceleration and angular acceleration of each end of a contact: twice the contact, and 1 more for its second end.
    loads: Vec<[Row; 2]>,
}

impl Plain {
    /// That of a network with these bodies, whose elements have these ends; none where it has more than contacts of particles.
    pub(super) fn of(network: &Network, movers: &[u32], ends_of: &[[u32; 2]]) -> Option<Self> {
        if network.stiffness.resists_turning() || network.damping.resists_turning() {
            return None;
        }
        let roots: Vec<_> =
            movers.iter().map(|&mover| network.roots.get(mover as usize).copied()).collect::<Option<_>>()?;
        let (nobody, room) = (movers.len() as u32, ends_of.len().next_multiple_of(WIDEST));
        let mut bodies = [vec![nobody; room], vec![nobody; room]];
        let mut numbers = [const { Vec::new() }; NUMBERS];
        numbers.iter_mut().for_each(|column| column.resize(room, 0.0));
        for (place, (element, own)) in network.elements.iter().zip(ends_of).enumerate() {
            for (bodies, &body) in bodies.iter_mut().zip(own) {
                bodies[place] = if body == UNMOVED { nobody } else { body };
            }
            let ([x, y, z], [a, b]) = (element.normal.map(f64::from), element.arms.map(f64::from));
            let ([k, q, ..], [c, d, ..]) = (network.stiffness.of(place), network.damping.of(place));
            for (column, number) in numbers.iter_mut().zip([x, y, z, a, b, k, q, c, d]) {
                column[place] = number;
            }
        }
        let rows = || vec![[0.0; 4]; movers.len() + 1];
        let loads = vec![[[0.0; 4]; 2]; 2 * room];
        Some(Self { bodies, numbers, roots, shifts: rows(), spins: rows(), loads })
    }

    /// S(μ) of a motion.
    pub(super) fn multiply(
        &mut self,
        root: f64,
        (motion, image): (&[[f64; 6]], &mut [[f64; 6]]),
        ends: &Ends,
        context: &Context,
    ) {
        for (body, ([v, w], [a, b, c, d, e, f])) in self.roots.iter().zip(motion).enumerate() {
            (self.shifts[body], self.spins[body]) = ([*a, *b, *c, *v], [*d, *e, *f, *w]);
        }
        let mut loads = std::mem::take(&mut self.loads);
        let count = self.bodies[0].len();
        let places = Shared::new(&mut loads);
        context.each(count.div_ceil(CHUNK), |piece| {
            let (from, to) = (piece * CHUNK, ((piece + 1) * CHUNK).min(count));
            // SAFETY: pieces do not overlap.
            let loads = unsafe { places.part(2 * from, 2 * to) };
            lanes::run(context.width, Loads { plain: self, root, from, loads });
        });
        self.loads = loads;
        let count = image.len();
        let places = Shared::new(image);
        context.each(count.div_ceil(CHUNK), |piece| {
            let (from, to) = (piece * CHUNK, ((piece + 1) * CHUNK).min(count));
            // SAFETY: pieces do not overlap.
            let image = unsafe { places.part(from, to) };
            lanes::run(context.width, Sums { loads: &self.loads, ends, from, image });
        });
    }

    /// A column of the numbers, from this contact on.
    ///
    /// # Safety
    /// The contact is a multiple of the register's width, below the length of the columns.
    #[inline(always)]
    unsafe fn number<N: Lane>(&self, column: usize, at: usize) -> N {
        // SAFETY: the caller's promise; columns are filled up to a multiple of the widest register.
        unsafe { N::load(self.numbers[column].as_ptr().add(at)) }
    }

    /// How the bodies at this end of contacts move: velocity and angular velocity times the arm; what scales both; the arm \[m\].
    ///
    /// # Safety
    /// As for [`Plain::number`].
    #[inline(always)]
    unsafe fn moved<N: Lane>(&self, end: usize, at: usize) -> End<N> {
        // SAFETY: the caller's promise; bodies are places among the rows.
        unsafe {
            let bodies = self.bodies[end].as_ptr().add(at);
            let shift = N::load_rows(self.shifts.as_ptr(), bodies);
            let spin = N::load_rows(self.spins.as_ptr(), bodies);
            let arm: N = self.number(3 + end, at);
            ([vector(shift) * shift[3], vector(spin) * (spin[3] * arm)], [shift[3], spin[3]], arm)
        }
    }
}

/// The bodies at an end of contacts: their motion, what scales it, the arm \[m\].
type End<N> = ([Vector<N>; 2], [N; 2], N);

/// What the contacts of a piece give their ends.
struct Loads<'a, 'b> {
    /// The network.
    plain: &'a Plain,
    /// Root μ \[1/s\].
    root: f64,
    /// The first contact.
    from: usize,
    /// Where it goes: two for each contact.
    loads: &'b mut [[Row; 2]],
}

impl Kernel for Loads<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { plain, root, from, loads } = self;
        let root = N::splat(root);
        let mut place = 0;
        while 2 * place < loads.len() {
            let at = from + place;
            // SAFETY: pieces and columns are multiples of the widest register, and each contact has two loads.
            unsafe {
                let n = Vector::new(plain.number::<N>(0, at), plain.number(1, at), plain.number(2, at));
                let ([u, w], [shift, spin], arm) = plain.moved::<N>(0, at);
                let ([v, z], [other_shift, other_spin], other_arm) = plain.moved::<N>(1, at);
                let slip = (u - v) + (w - z).cross(n);
                let along = plain.number::<N>(5, at) + root * plain.number(7, at);
                let across = plain.number::<N>(6, at) + root * plain.number(8, at);
                let force = slip * across + n * ((along - across) * n.dot(slip));
                let couple = n.cross(force);
                let mut rows = [[[0.0; 4]; WIDEST]; 4];
                N::store_block(columns(force * shift), rows[0].as_mut_ptr());
                N::store_block(columns(couple * (spin * arm)), rows[1].as_mut_ptr());
                N::store_block(columns(force * -other_shift), rows[2].as_mut_ptr());
                N::store_block(columns(couple * (-other_spin * other_arm)), rows[3].as_mut_ptr());
                let mut lane = 0;
                while lane < N::WIDTH {
                    let ends = loads.as_mut_ptr().add(2 * (place + lane));
                    *ends = [rows[0][lane], rows[1][lane]];
                    *ends.add(1) = [rows[2][lane], rows[3][lane]];
                    lane += 1;
                }
            }
            place += N::WIDTH;
        }
    }
}

/// What a piece of the bodies feels.
struct Sums<'a, 'b> {
    /// What each end feels.
    loads: &'a [[Row; 2]],
    /// The ends of each body.
    ends: &'a Ends,
    /// The first body.
    from: usize,
    /// Where it goes.
    image: &'b mut [[f64; 6]],
}

impl Kernel for Sums<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { loads, ends, from, image } = self;
        let mut place = 0;
        while place < image.len() {
            let own = ends.of_body(from + place);
            let mut next = 0;
            let mut sums = [[0.0; 4]; 2];
            while next < own.len() {
                let load = &loads[own[next] as usize];
                add(&mut sums[0], &load[0]);
                add(&mut sums[1], &load[1]);
                next += 1;
            }
            let [[a, b, c, _], [d, e, f, _]] = sums;
            image[place] = [a, b, c, d, e, f];
            place += 1;
        }
    }
}
