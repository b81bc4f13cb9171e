//! How contacts between particles change with a few inputs: the law over numbers with slopes, on a register's worth of touching
//! entries of a batch at a time. The values that come of it are those of the law, to the bit, so the law is not evaluated beside.

use super::contacts::{ContactPass, Pairs};
use crate::batches::{Along, Batch, Batches, ContactGeometry, Entries, Left, SpherePair};
use crate::coefficients::in_lanes;
use crate::contact::{Acting, Contact, Evaluated, Law, MOST_HISTORY, Needs, Reaction};
use crate::dual::{Dual, Slopes};
use crate::lanes::{Kernel, Lane, Places, Shared, lanes_of};
use crate::number::{Number, Vector};
use crate::state::contacts::TOUCHING;
use crate::state::{Row, State};
use crate::tangent::{Alone, FollowPass, InLanes, Inputs, ListSlopes, Moving, Tangent};
use crate::tangent::{rows_at, slopes_of, spread, with_slopes};
use std::sync::{Mutex, PoisonError};

/// A pass over contacts that turn their bodies, or do not: of these nothing is looked at but the force.
pub(super) struct Touching<P, const TURNING: bool>(pub(super) P);

/// Room for what contacts remember.
pub(super) type Remembered<I, N> = [[InLanes<I, N>; 4]; MOST_HISTORY];

/// What contacts do, with slopes: of laws that turn their bodies, or do not.
#[inline(always)]
fn react_by<I: Inputs, N: Lane, const TURNING: bool>(
    law: &Law,
    acting: &Acting<InLanes<I, N>>,
    row: &[I::Values<N>],
    contact: &mut Contact<InLanes<I, N>>,
    rows: &mut [[InLanes<I, N>; 4]],
    step: InLanes<I, N>,
) -> Reaction<InLanes<I, N>> {
    if TURNING {
        return law.react_by(acting, row, contact, rows, step);
    }
    let (_, normal) = law.press(acting, row, contact, rows, step);
    let (force, zero) = (contact.normal * normal.force, I::Values::<N>::zero());
    Reaction { force, couple: Vector::zero(), rolling: Vector::zero(), sliding: zero.greater(zero) }
}

/// The same; slopes of what they remember, at these places of the list, go on. `rows` is room for that.
#[inline(always)]
pub(super) fn react<I: Inputs, N: Lane, const TURNING: bool>(
    (law, acting, row): (&Law, &Acting<InLanes<I, N>>, &[I::Values<N>]),
    contact: &mut Contact<InLanes<I, N>>,
    (history, slopes, entries): (&[Vec<Row>], &mut ListSlopes<I>, &Places),
    (rows, step): (&mut Remembered<I, N>, InLanes<I, N>),
) -> Reaction<InLanes<I, N>> {
    let rows = &mut rows[..law.history().len()];
    for (row, (values, slopes)) in rows.iter_mut().zip(history.iter().zip(&slopes.rows)) {
        *row = rows_at::<I, N>(values, slopes, entries);
    }
    let reaction = react_by::<I, N, TURNING>(law, acting, row, contact, rows, step);
    for (slopes, row) in slopes.rows.iter_mut().zip(rows) {
        I::put::<N>(slopes_of::<I, N>(*row), slopes, entries);
    }
    reaction
}

/// Contacts with what their law looks at, and no slopes of what follows from radii and masses, which do not change: of the rest
/// nothing is computed. `values` are those of the same contacts. The area of the section is left to be found, where it is needed.
#[inline(always)]
pub(super) fn needed<I: Inputs, N: Lane, const TURNING: bool>(
    geometry: ContactGeometry<InLanes<I, N>>,
    values: &Contact<I::Values<N>>,
    needs: Needs,
) -> ContactGeometry<InLanes<I, N>> {
    let contact = geometry.contact;
    let contact = Contact {
        radius: Dual::constant(values.radius),
        mass: Dual::constant(values.mass),
        section_area: Dual::zero(),
        section_radius: Dual::constant(values.section_radius),
        slip: kept(TURNING && (needs.torque || needs.carry), contact.slip),
        relative_spin: kept(TURNING && needs.spin, contact.relative_spin),
        spin_sum: kept(TURNING && (needs.spin_sum || needs.carry), contact.spin_sum),
        turning: kept(TURNING && needs.carry, contact.turning),
        per_reach: Dual::constant(values.per_reach),
        rolling_inertia: Dual::constant(values.rolling_inertia),
        ..contact
    };
    ContactGeometry { contact, ..geometry }
}

/// A vector, where it is needed.
#[inline(always)]
fn kept<N: Number>(needed: bool, vector: Vector<N>) -> Vector<N> {
    if needed { vector } else { Vector::zero() }
}

/// Nothing is remembered of contacts whose bodies are apart: those of the entries whose bit is set.
#[inline(always)]
pub(super) fn part<I: Inputs>(slopes: &mut ListSlopes<I>, entries: &Places, mut apart: u32) {
    while apart != 0 {
        let entry = entries.at(apart.trailing_zeros() as usize);
        for rows in &mut slopes.rows {
            rows[entry] = I::NONE;
        }
        apart &= apart - 1;
    }
}

/// The materials of some particles.
#[inline(always)]
pub(super) fn materials(material: &[u32], slots: &Places) -> [u32; 8] {
    let mut found = [0; 8];
    for (lane, found) in found.iter_mut().enumerate() {
        *found = material[slots.at(lane)];
    }
    found
}

/// The numbers that a list keeps of the pairs, where it does.
#[inline(always)]
pub(super) fn constants<N: Lane>(kept: &[f64], entries: &Places) -> N {
    if kept.is_empty() { N::zero() } else { lanes_of(|lane| kept[entries.at(lane)]) }
}

/// How far beyond touch the contacts hold their bodies together \[m\], if the law does.
#[inline(always)]
pub(super) fn beyond<N: Lane>(law: &Law, flags: &[u8], kept: &[f64], entries: &Places) -> Option<N> {
    let reach = |entry: usize| if flags[entry] & TOUCHING != 0 { kept[entry] } else { 0.0 };
    if law.holds_beyond_touch() { Some(lanes_of(|lane| reach(entries.at(lane)))) } else { None }
}

/// Contacts between particles whose slopes are followed.
pub(super) struct Followed<'a, I: Inputs> {
    /// The pass.
    pass: &'a ContactPass,
    /// How the particles move.
    moving: Moving<'a>,
    /// Their materials.
    material: &'a [u32],
    /// What is followed; slabs wait for each other.
    tangents: Mutex<&'a mut [Tangent<I>]>,
    /// Whether nothing is.
    none: bool,
    /// The time step, or time itself.
    step: Alone<I>,
    /// Whether the list is looked at alone.
    looks: bool,
}

impl<'a, I: Inputs> Followed<'a, I> {
    /// Those of a pass, over a time step.
    pub(super) fn of(
        pass: &'a ContactPass,
        moving: Moving<'a>,
        material: &'a [u32],
        tangents: &'a mut [Tangent<I>],
        step: Alone<I>,
    ) -> Self {
        for tangent in &mut *tangents {
            let slopes = &mut tangent.contacts[pass.index];
            slopes.set_odd(pass.law.law.history().iter().map(|row| row.odd));
            slopes.go_on();
        }
        Self { pass, moving, material, none: tangents.is_empty(), tangents: Mutex::new(tangents), step, looks: false }
    }

    /// Whether nothing is followed.
    pub(super) fn is_none(&self) -> bool {
        self.none
    }
}

impl<I: Inputs> Along for Followed<'_, I> {
    fn follow(&self, batch: &mut Batch) -> Left {
        let mut tangents = self.tangents.lock().unwrap_or_else(PoisonError::into_inner);
        let reaches = |tangent: &Tangent<I>| batch.slots().iter().any(|slots| tangent.particles.reaches(slots));
        let Some(last) = tangents.iter().rposition(reaches) else {
            return if self.looks { Left::Nothing } else { Left::All };
        };
        // The last one evaluates the law, too: history goes on then.
        let writes = !self.looks && !self.pass.law.law.is_booked();
        for (place, tangent) in tangents[..=last].iter_mut().enumerate() {
            let (width, writes) = (tangent.width, writes && place == last);
            if self.pass.law.needs.torque {
                I::run(width, Follow::<I, true> { contacts: self, tangent, batch, writes });
            } else {
                I::run(width, Follow::<I, false> { contacts: self, tangent, batch, writes });
            }
        }
        match (self.looks, writes) {
            (true, _) => Left::Nothing,
            (false, true) => Left::Spreading,
            (false, false) => Left::All,
        }
    }
}

/// Contacts of a batch with the slopes by an input. TURNING: they turn their bodies; otherwise nothing is looked at but the force.
struct Follow<'a, 'b, 'c, I: Inputs, const TURNING: bool> {
    /// The contacts.
    contacts: &'a Followed<'c, I>,
    /// What is followed.
    tangent: &'a mut Tangent<I>,
    /// The batch.
    batch: &'a mut Batch<'b>,
    /// Whether the law is evaluated.
    writes: bool,
}

impl<I: Inputs, const TURNING: bool> Kernel for Follow<'_, '_, '_, I, TURNING> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { contacts: Followed { pass, moving, material, step, .. }, tangent, batch, writes } = self;
        let (law, needs) = (&pass.law.law, pass.law.needs);
        let (moved, slopes) = (&mut tangent.particles, &mut tangent.contacts[pass.index]);
        let (step, remembered) = (spread::<I, N>(*step), law.history().len());
        let uniform = pass.table.uniform().map(in_lanes::<I::Values<N>>);
        let acting = Evaluated::acting(law);
        let mut rows = [[Dual::zero(); 4]; MOST_HISTORY];
        for at in (0..batch.count()).step_by(I::Values::<N>::WIDTH) {
            let [i, j, entries] = batch.places::<I::Values<N>>(at);
            let count = usize::min(batch.count() - at, I::Values::<N>::WIDTH);
            let reached = moved.reached(i.first(count)) | moved.reached(j.first(count));
            if reached == 0 && !writes {
                continue;
            }
            let found = batch.found::<I::Values<N>>(at);
            let spheres = moved.pair(found, &i, &j);
            let velocities = moved.velocities::<N>(moving, &i, &j);
            let mut spins = [[Dual::zero(); 4]; 2];
            if TURNING {
                spins = [moved.spins(moving, &i), moved.spins(moving, &j)];
            }
            let constant = batch.constants::<I::Values<N>>(at);
            let spheres = SpherePair::from_found(spheres);
            let geometry = spheres.meet(velocities, spins, Dual::constant(constant));
            let [velocity_i, velocity_j] = velocities;
            let known = [Dual::values_of(velocity_i), Dual::values_of(velocity_j)];
            let values = SpherePair::from_found(found).meet(known, [[Number::zero(); 4]; 2], constant).contact;
            let mut geometry = needed::<I, N, TURNING>(geometry, &values, needs);
            if needs.section {
                geometry.contact.section_area = spheres.section(spheres.roots(), geometry.contact.overlap);
            }
            let gathered;
            let row = match &uniform {
                Some(row) => row,
                None => {
                    gathered = pass.table.lanes(materials(material, &i), materials(material, &j));
                    &gathered
                }
            };
            for (place, row) in rows[..remembered].iter_mut().enumerate() {
                let slopes = slopes.begin::<N>(place, &entries, count);
                *row = with_slopes::<I, N>(batch.remembered(place, at), slopes);
            }
            let reaction =
                react_by::<I, N, TURNING>(law, &acting, row, &mut geometry.contact, &mut rows[..remembered], step);
            if writes {
                for (place, row) in rows[..remembered].iter().enumerate() {
                    batch.remember(place, at, Dual::values_of(*row));
                }
                let arms = [geometry.first_arm.value, geometry.second_arm.value];
                batch.put(at, &values_of(&reaction), arms, needs);
            }
            if reached == 0 {
                continue;
            }
            for (place, row) in rows[..remembered].iter().enumerate() {
                slopes.put::<N>(place, &entries, slopes_of::<I, N>(*row));
            }
            let Reaction { force, couple, rolling, .. } = reaction;
            moved.press_pairs([&i, &j], (count, reached), force);
            if TURNING {
                let on_i = -(couple * geometry.first_arm) - rolling;
                moved.twist_pairs([&i, &j], count, [on_i, rolling - couple * geometry.second_arm]);
            }
        }
    }
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

impl<I: Inputs> FollowPass<I> for ContactPass {
    /// Looks at the contacts alone, in a copy of the list.
    fn add_slopes(&self, state: &State, tangent: &mut Tangent<I>, step: Alone<I>) {
        let (particles, mut list, width) = (&state.particles, state.contacts[self.index].clone(), tangent.width);
        let moving = Moving::of(&particles.position, &particles.velocity, &particles.angular_velocity);
        let tangents = std::slice::from_mut(tangent);
        let followed = Followed { looks: true, ..Followed::of(self, moving, &particles.material, tangents, step) };
        let batches = Batches {
            bodies: Pairs::<false> {
                first: &list.first,
                second: &list.second,
                position: &particles.position,
                velocity: &particles.velocity,
                angular_velocity: &particles.angular_velocity,
                material: &particles.material,
                force: Shared::new(&mut []),
                torque: Shared::new(&mut []),
            },
            entries: Entries::of(&mut list.flags, &mut list.history, &mut list.pair_constant),
            law: &self.law,
            table: &self.table,
            uniform: self.table.uniform(),
            step: 0.0,
            width,
            along: Some(&followed),
        };
        batches.run(0, list.first.len(), 0..0);
    }
}
