//! How contacts change with an input: the law over numbers with slopes, on a register's worth of touching entries at a time.

use crate::batches::ContactGeometry;
use crate::contact::{Acting, Contact, Law, MOST_HISTORY, Needs, Reaction};
use crate::dual::Dual;
use crate::lanes::{Lane, Places, lanes_of, put_at};
use crate::number::{Number, Vector};
use crate::state::Row;
use crate::state::contacts::TOUCHING;
use crate::tangent::{ListSlopes, rows_at, slopes_of};

/// A pass over contacts that turn their bodies, or do not: of these nothing is looked at but the force.
pub(super) struct Touching<P, const TURNING: bool>(pub(super) P);

/// Room for what contacts remember.
pub(super) type Remembered<N> = [[Dual<N>; 4]; MOST_HISTORY];

/// What contacts do, with slopes: of laws that turn their bodies, or do not.
#[inline(always)]
pub(super) fn react_by<N: Lane, const TURNING: bool>(
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
    let (_, normal) = law.press(acting, row, contact, rows, step);
    let (force, zero) = (contact.normal * normal.force, N::zero());
    Reaction { force, couple: Vector::zero(), rolling: Vector::zero(), sliding: zero.greater(zero) }
}

/// The same; slopes of what they remember, at these places of the list, go on. `rows` is room for that.
#[inline(always)]
pub(super) fn react<N: Lane, const TURNING: bool>(
    (law, acting, row): (&Law, &Acting<Dual<N>>, &[N]),
    contact: &mut Contact<Dual<N>>,
    (history, slopes, entries): (&[Vec<Row>], &mut ListSlopes, &Places),
    (rows, step): (&mut Remembered<N>, Dual<N>),
) -> Reaction<Dual<N>> {
    let rows = &mut rows[..law.history().len()];
    for (row, (values, slopes)) in rows.iter_mut().zip(history.iter().zip(&slopes.rows)) {
        *row = rows_at::<N>(values, slopes, entries);
    }
    let reaction = react_by::<N, TURNING>(law, acting, row, contact, rows, step);
    for (slopes, row) in slopes.rows.iter_mut().zip(rows) {
        put_at(slopes_of::<N>(*row), slopes, entries);
    }
    reaction
}

/// Contacts with what their law looks at, and no slopes of what follows from radii and masses, which do not change: of the rest
/// nothing is computed. `values` are those of the same contacts. The area of the section is left to be found, where it is needed.
#[inline(always)]
pub(super) fn needed<N: Lane, const TURNING: bool>(
    geometry: ContactGeometry<Dual<N>>,
    values: &Contact<N>,
    needs: Needs,
) -> ContactGeometry<Dual<N>> {
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
pub(super) fn part(slopes: &mut ListSlopes, entries: &Places, mut apart: u32) {
    while apart != 0 {
        let entry = entries.at(apart.trailing_zeros() as usize);
        for rows in &mut slopes.rows {
            rows[entry] = [0.0; 4];
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
