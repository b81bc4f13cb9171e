//! Slopes of contacts, batch by batch of the time step: the law over numbers with slopes, on a register's worth of touching entries at a
//! time. The values that come beside them are those of the law, to the bit, so the law is not evaluated beside.

use crate::batches::{Along, Batch, BatchLaw, Buffer, ContactGeometry, FOUND, Left};
use crate::coefficients::{CoefficientTable, in_lanes};
use crate::contact::{Acting, Contact, Evaluated, Law, MOST_HISTORY, Needs, Reaction};
use crate::dual::{Dual, Slopes};
use crate::lanes::{self, Kernel, Lane, Places, columns, rows_from};
use crate::number::{Number, Vector};
use crate::tangent::{ListSlopes, Tangent, slopes_of, spread, with_slopes};
use std::sync::{Mutex, PoisonError};

/// A register's worth of contacts.
pub(super) struct Register<N> {
    /// Their bodies (slots), first and second ones; where the second body is always the same, anything.
    pub(super) slots: [Places; 2],
    /// How many of them count.
    pub(super) count: usize,
    /// What was found of their places.
    pub(super) found: [N; FOUND],
    /// What takes long, found from that.
    pub(super) roots: [N; 2],
    /// Pair constants.
    pub(super) constant: N,
}

/// The bodies of the contacts of a list, as slopes see them.
pub(super) trait Sides: Send + Sync {
    /// Whether the second body is a boundary: its moment has the arm of the particle, whatever the law.
    const AT_BOUNDARY: bool;

    /// The slopes of what the list remembers.
    fn list<'a>(&self, tangent: &'a mut Tangent) -> &'a mut ListSlopes;

    /// Whether an input has reached any contact of a batch.
    fn reaches(&self, tangent: &Tangent, buffer: &Buffer) -> bool;

    /// Which of the first so many contacts an input has reached, a bit for each.
    fn reached(&self, tangent: &Tangent, slots: &[Places; 2], count: usize) -> u32;

    /// Computes ahead what takes the processor long and follows from the places alone.
    fn roots<N: Lane>(&self, found: &[N; FOUND]) -> [N; 2];

    /// Geometry and relative motion. Of the area of the section the slopes are there if the law needs them.
    fn meet<N: Lane, const TURNING: bool>(
        &self,
        tangent: &Tangent,
        contacts: &Register<N>,
        needs: Needs,
    ) -> ContactGeometry<Dual<N>>;

    /// The materials of both bodies.
    fn materials(&self, slots: &[Places; 2]) -> [[u32; 8]; 2];

    /// Adds the slopes of what the law does to the bodies of those contacts that count; those whose bit is set are reached then.
    fn load<N: Lane, const TURNING: bool>(
        &self,
        tangent: &mut Tangent,
        contacts: (&Register<N>, u32),
        geometry: &ContactGeometry<Dual<N>>,
        reaction: &Reaction<Dual<N>>,
    );
}

/// A list of contacts whose slopes are followed.
pub(super) struct Followed<'a, 'b, S> {
    /// Their bodies.
    pub(super) sides: S,
    /// Their law.
    pub(super) law: &'a BatchLaw,
    /// Its coefficients.
    pub(super) table: &'a CoefficientTable,
    /// The coefficients of all entries, if they are the same.
    pub(super) uniform: Option<&'a [f64]>,
    /// What is followed; pieces of the list wait for each other.
    pub(super) tangents: &'a Mutex<&'b mut [Tangent]>,
    /// The time step, or time itself.
    pub(super) step: Dual,
    /// Whether the list is looked at alone.
    pub(super) looks: bool,
}

impl<S: Sides> Along for Followed<'_, '_, S> {
    fn follow(&self, batch: &mut Batch) -> Left {
        let mut tangents = self.tangents.lock().unwrap_or_else(PoisonError::into_inner);
        if !batch.buffer.parted.is_empty() {
            tangents.iter_mut().for_each(|tangent| self.sides.list(tangent).end(&batch.buffer.parted));
            batch.buffer.parted.clear();
        }
        let Some(last) = tangents.iter().rposition(|tangent| self.sides.reaches(tangent, batch.buffer)) else {
            return if self.looks { Left::Nothing } else { Left::All };
        };
        // The last input evaluates the law, too: history goes on then.
        let writes = !self.looks && !self.law.law.is_booked();
        let (width, tangents) = (tangents[last].width, &mut tangents[..=last]);
        if self.law.needs.torque {
            lanes::run_seldom(width, Follow::<S, true> { contacts: self, tangents, batch, writes });
        } else {
            lanes::run_seldom(width, Follow::<S, false> { contacts: self, tangents, batch, writes });
        }
        match (self.looks, writes) {
            (true, _) => Left::Nothing,
            (false, true) => Left::Spreading,
            (false, false) => Left::All,
        }
    }
}

/// Contacts of a batch with the slopes by some inputs, one after another. TURNING: they turn their bodies; otherwise nothing is looked at but the force.
struct Follow<'a, 'b, 'c, 'd, S, const TURNING: bool> {
    /// The contacts.
    contacts: &'a Followed<'c, 'd, S>,
    /// What is followed.
    tangents: &'a mut [Tangent],
    /// The batch.
    batch: &'a mut Batch<'b>,
    /// Whether the law is evaluated, with the last input.
    writes: bool,
}

impl<S: Sides, const TURNING: bool> Kernel for Follow<'_, '_, '_, '_, S, TURNING> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { contacts: Followed { sides, law, table, uniform, step, .. }, tangents, batch, writes } = self;
        let (law, needs, last) = (&law.law, law.needs, tangents.len() - 1);
        let (step, remembered) = (spread::<N>(*step), law.history().len());
        let uniform = uniform.map(in_lanes::<N>);
        let acting = Evaluated::acting(law);
        let (mut values, mut rows) = ([[N::zero(); 4]; MOST_HISTORY], [[Dual::zero(); 4]; MOST_HISTORY]);
        // What the law looks at stays where it is from one register to the next: slopes that are none are written once.
        let mut contact = Contact::zero();
        let mut roots = sides.roots(&batch.found::<N>(0));
        for at in (0..batch.buffer.ready).step_by(N::WIDTH) {
            let here = roots;
            roots = sides.roots(&batch.found::<N>(at + N::WIDTH));
            let Buffer { first, second, entry, ready, .. } = &*batch.buffer;
            let (slots, entries) =
                ([Places::from::<N>(first, at), Places::from::<N>(second, at)], Places::from::<N>(entry, at));
            let (count, found, constant) =
                (usize::min(ready - at, N::WIDTH), batch.found::<N>(at), batch.constants::<N>(at));
            let contacts = Register { slots, count, found, roots: here, constant };
            let gathered;
            let row = match &uniform {
                Some(row) => row,
                None => {
                    let [first, second] = sides.materials(&contacts.slots);
                    gathered = table.lanes(first, second);
                    &gathered
                }
            };
            for (place, row) in values[..remembered].iter_mut().enumerate() {
                *row = batch.remembered(place, at);
            }
            for (place, tangent) in tangents.iter_mut().enumerate() {
                let (writes, reached) = (writes && place == last, sides.reached(tangent, &contacts.slots, count));
                if reached == 0 && !writes {
                    continue;
                }
                let mut geometry = sides.meet::<N, TURNING>(tangent, &contacts, needs);
                if S::AT_BOUNDARY && TURNING && law.undeformed_arms() {
                    geometry.first_arm = geometry.contact.radius;
                }
                fill::<N, TURNING>(&mut contact, &geometry.contact, needs);
                let list = sides.list(tangent);
                for (place, (row, values)) in rows[..remembered].iter_mut().zip(&values).enumerate() {
                    *row = with_slopes::<N>(*values, list.read::<N>(place, &entries));
                }
                let reaction = react::<N, TURNING>(law, &acting, row, &mut contact, &mut rows[..remembered], step);
                if writes {
                    for (place, row) in rows[..remembered].iter().enumerate() {
                        batch.remember(place, at, Dual::values_of(*row));
                    }
                    let arms = [geometry.first_arm.value, geometry.second_arm.value];
                    put::<S, N>(batch, at, &values_of(&reaction), (arms, needs));
                }
                if reached == 0 {
                    continue;
                }
                for (place, row) in rows[..remembered].iter().enumerate() {
                    list.put::<N>(place, &entries, slopes_of::<N>(*row));
                }
                sides.load::<N, TURNING>(tangent, (&contacts, reached), &geometry, &reaction);
            }
        }
    }
}

/// What contacts do, with slopes: of laws that turn their bodies, or do not.
#[inline(always)]
fn react<N: Lane, const TURNING: bool>(
    law: &Law,
    acting: &Acting<Dual<N>>,
    row: &[N],
    contact: &mut Contact<Dual<N>>,
    rows: &mut [[Dual<N>; 4]],
    step: Dual<N>,
) -> Reaction<Dual<N>> {
    if TURNING {
        return law.react_by(acting, row, contact, rows, step);
    }
    let (_, weight) = law.carry(contact, rows, step);
    let normal = law.press(acting, row, contact, rows, (step, weight));
    let (force, zero) = (contact.normal * normal.force, N::zero());
    Reaction { force, couple: Vector::zero(), rolling: Vector::zero(), sliding: zero.greater(zero) }
}

/// Writes what the law looks at of contacts. What follows from radii and masses does not change: of it the values are written alone.
#[inline(always)]
fn fill<N: Lane, const TURNING: bool>(contact: &mut Contact<Dual<N>>, found: &Contact<Dual<N>>, needs: Needs) {
    contact.overlap = found.overlap;
    contact.normal = found.normal;
    contact.normal_velocity = found.normal_velocity;
    contact.radius.value = found.radius.value;
    contact.mass.value = found.mass.value;
    contact.pair_constant.value = found.pair_constant.value;
    if needs.section {
        contact.section_area = found.section_area;
        contact.section_radius.value = found.section_radius.value;
    }
    if needs.bodies {
        contact.per_reach.value = found.per_reach.value;
        contact.rolling_inertia.value = found.rolling_inertia.value;
    }
    if TURNING || needs.carry {
        contact.slip = found.slip;
    }
    if TURNING && needs.spin {
        contact.relative_spin = found.relative_spin;
    }
    if TURNING && (needs.spin_sum || needs.carry) {
        contact.spin_sum = found.spin_sum;
        contact.turning = found.turning;
    }
    if needs.carry {
        contact.per_distance = found.per_distance;
    }
}

/// Writes what the law does to a register's worth of contacts, and the arms of the bodies \[m\]; the last contact of the batch is repeated.
#[inline(always)]
fn put<S: Sides, N: Lane>(batch: &mut Batch, at: usize, reaction: &Reaction<N>, (arms, needs): ([N; 2], Needs)) {
    rows_from(columns(reaction.force), &mut batch.buffer.force, at);
    if S::AT_BOUNDARY || needs.torque {
        batch.buffer.put_arms(at, arms);
    }
    if !needs.torque {
        return;
    }
    rows_from(columns(reaction.couple), &mut batch.buffer.couple, at);
    if needs.spin {
        rows_from(columns(reaction.rolling), &mut batch.buffer.rolling, at);
    }
    batch.slide(at, N::bits(reaction.sliding));
}

/// The values of what a law does.
#[inline(always)]
fn values_of<V: Number, S: Slopes<V>>(reaction: &Reaction<Dual<V, S>>) -> Reaction<V> {
    let Reaction { force, couple, rolling, sliding } = *reaction;
    Reaction {
        force: Vector::new(force.x.value, force.y.value, force.z.value),
        couple: Vector::new(couple.x.value, couple.y.value, couple.z.value),
        rolling: Vector::new(rolling.x.value, rolling.y.value, rolling.z.value),
        sliding,
    }
}
