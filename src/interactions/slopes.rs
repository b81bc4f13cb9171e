//! How contacts between particles change with a few inputs: the law over numbers with slopes, on a register's worth of touching
//! entries of the list at a time.

use super::contacts::ContactPass;
use crate::batches::{ContactGeometry, SpherePair};
use crate::coefficients::in_lanes;
use crate::contact::{Contact, Law, MOST_HISTORY, Needs, Reaction};
use crate::dual::Dual;
use crate::lanes::{Kernel, Lane, Places, columns_at, lanes_of};
use crate::number::{Number, Vector};
use crate::state::contacts::TOUCHING;
use crate::state::{Particles, Row, State};
use crate::tangent::{AddSlopes, Alone, FollowPass, Group, InLanes, Inputs, ListSlopes, Tangent, Waiting};
use crate::tangent::{rows_at, slopes_of, spread};

/// A pass over contacts that turn their bodies, or do not: of these nothing is looked at but the force.
pub(super) struct Touching<P, const TURNING: bool>(pub(super) P);

/// Room for what contacts remember.
pub(super) type Remembered<I, N> = [[InLanes<I, N>; 4]; MOST_HISTORY];

/// What contacts do, with slopes; those of what they remember, at these places of the list, go on. `rows` is room for that.
#[inline(always)]
pub(super) fn react<I: Inputs, N: Lane, const TURNING: bool>(
    law: &Law,
    row: &[I::Values<N>],
    contact: &mut Contact<InLanes<I, N>>,
    (history, slopes, entries): (&[Vec<Row>], &mut ListSlopes<I>, (&Places, usize)),
    (rows, step): (&mut Remembered<I, N>, InLanes<I, N>),
) -> Reaction<InLanes<I, N>> {
    let (entries, count) = entries;
    let rows = &mut rows[..law.history().len()];
    for (row, (values, slopes)) in rows.iter_mut().zip(history.iter().zip(&slopes.rows)) {
        *row = rows_at::<I, N>(values, slopes, entries);
    }
    let reaction = if TURNING {
        law.react(row, contact, rows, step)
    } else {
        let (_, normal) = law.press(row, contact, rows, step);
        let (force, zero) = (contact.normal * normal.force, I::Values::<N>::zero());
        Reaction { force, couple: Vector::zero(), rolling: Vector::zero(), sliding: zero.greater(zero) }
    };
    for (slopes, row) in slopes.rows.iter_mut().zip(rows) {
        I::put::<N>(slopes_of::<I, N>(*row), slopes, entries.first(count));
    }
    reaction
}

/// Contacts with what their law looks at, and no slopes of what follows from radii and masses, which do not change: of the rest
/// nothing is computed. `values` are those of the same contacts.
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
        section_area: if needs.section { contact.section_area } else { Dual::zero() },
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
pub(super) fn materials(particles: &Particles, slots: &Places) -> [u32; 8] {
    let mut found = [0; 8];
    for (lane, found) in found.iter_mut().enumerate() {
        *found = particles.material[slots.at(lane)];
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

impl<I: Inputs> FollowPass<I> for ContactPass {
    fn add_slopes(&self, state: &State, tangent: &mut Tangent<I>, step: Alone<I>) {
        tangent.contacts[self.index].set_odd(self.law.law.history().iter().map(|row| row.odd));
        if self.law.needs.torque {
            I::run(tangent.width, AddSlopes { pass: Touching::<_, true>(self), state, tangent, step });
        } else {
            I::run(tangent.width, AddSlopes { pass: Touching::<_, false>(self), state, tangent, step });
        }
    }
}

impl<const TURNING: bool, I: Inputs> Kernel for AddSlopes<'_, Touching<&ContactPass, TURNING>, I> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { pass: Touching(pass), state, tangent, step } = self;
        let (list, particles, law) = (&state.contacts[pass.index], &state.particles, &pass.law.law);
        let (moved, slopes) = (&mut tangent.particles, &mut tangent.contacts[pass.index]);
        let step = spread::<I, N>(step);
        let uniform = pass.table.uniform().map(in_lanes::<I::Values<N>>);
        let mut waiting = Waiting::of([&list.first, &list.second]);
        let mut rows = [[Dual::zero(); 4]; MOST_HISTORY];
        while let Some(mut group) = waiting.look::<I::Values<N>>() {
            let Group { entries, bodies: [i, j], count } = group;
            let wanted = moved.reached(i.first(count)) | moved.reached(j.first(count));
            let mut touching = 0;
            if wanted != 0 {
                let place = &particles.position;
                let pair = SpherePair::<I::Values<N>>::of([columns_at(place, &i), columns_at(place, &j)]);
                let beyond = beyond(law, &list.flags, &list.pair_constant, &entries);
                touching = wanted & I::Values::<N>::bits(pair.overlap(beyond));
                part(slopes, &entries, wanted & !touching);
            }
            if I::Values::<N>::WIDTH > 1 {
                waiting.wait(&group, touching);
                let Some(filled) = waiting.take::<I::Values<N>>() else { continue };
                group = filled;
            } else if touching == 0 {
                continue;
            }
            let Group { entries, bodies: [i, j], count } = group;
            let ([p, v], [q, u]) = (moved.bodies::<N>(particles, &i), moved.bodies::<N>(particles, &j));
            let mut spins = [[Dual::zero(); 4]; 2];
            if TURNING {
                spins = [moved.spins(particles, &i), moved.spins(particles, &j)];
            }
            let constant = constants::<I::Values<N>>(&list.pair_constant, &entries);
            let geometry = SpherePair::of([p, q]).meet([v, u], spins, Dual::constant(constant));
            let pair = SpherePair::of([Dual::values_of(p), Dual::values_of(q)]);
            let velocities = [Dual::values_of(v), Dual::values_of(u)];
            let values = pair.meet(velocities, [[Number::zero(); 4]; 2], constant).contact;
            let mut geometry = needed::<I, N, TURNING>(geometry, &values, pass.law.needs);
            let gathered;
            let row = match &uniform {
                Some(row) => row,
                None => {
                    gathered = pass.table.lanes(materials(particles, &i), materials(particles, &j));
                    &gathered
                }
            };
            let remembered = (&*list.history, &mut *slopes, (&entries, count));
            let Reaction { force, couple, rolling, .. } =
                react::<I, N, TURNING>(law, row, &mut geometry.contact, remembered, (&mut rows, step));
            let slots = [i.first(count), j.first(count)];
            moved.press_pairs(slots, force);
            if TURNING {
                moved.twist_pairs(
                    slots,
                    [-(couple * geometry.first_arm) - rolling, rolling - couple * geometry.second_arm],
                );
            }
        }
    }
}
