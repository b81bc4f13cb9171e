//! How contacts between particles change with a few inputs: the law over numbers with slopes.

use super::contacts::ContactPass;
use crate::batches::{ContactGeometry, SpherePair};
use crate::contact::{Contact, Law, MOST_HISTORY, Needs, Reaction};
use crate::dual::Dual;
use crate::lanes::{Kernel, Lane, run};
use crate::number::{Number, Vector};
use crate::state::contacts::TOUCHING;
use crate::state::{Row, State};
use crate::tangent::{AddSlopes, ListSlopes, NONE, Tangent};

/// A pass over contacts that turn their bodies, or do not: of these nothing is looked at but the force.
pub(super) struct Touching<P, const TURNING: bool>(pub(super) P);

/// What a contact does, with slopes; those of what it remembers go on. `rows` is room for that.
#[inline(always)]
pub(super) fn react<N: Lane, const TURNING: bool>(
    law: &Law,
    row: &[f64],
    contact: &mut Contact<Dual<N>>,
    (history, slopes, entry): (&[Vec<Row>], &mut ListSlopes, usize),
    (rows, step): (&mut [[Dual<N>; 4]; MOST_HISTORY], Dual<N>),
) -> Reaction<Dual<N>> {
    let rows = &mut rows[..law.history().len()];
    for (row, (values, slopes)) in rows.iter_mut().zip(history.iter().zip(&slopes.rows)) {
        *row = Dual::row(values[entry], &slopes[entry]);
    }
    let reaction = if TURNING {
        law.react(row, contact, rows, step)
    } else {
        let (_, normal) = law.press(row, contact, rows, step);
        let force = contact.normal * normal.force;
        Reaction { force, couple: Vector::zero(), rolling: Vector::zero(), sliding: false }
    };
    for (slopes, row) in slopes.rows.iter_mut().zip(rows) {
        slopes[entry] = Dual::slopes_of(*row);
    }
    reaction
}

/// A contact with what its law looks at, and no slopes of what follows from radii and masses, which do not change: of the rest
/// nothing is computed. `values` are those of the same contact.
#[inline(always)]
pub(super) fn needed<N: Lane, const TURNING: bool>(
    geometry: ContactGeometry<Dual<N>>,
    values: &Contact,
    needs: Needs,
) -> ContactGeometry<Dual<N>> {
    let contact = geometry.contact;
    let vector = |needed: bool, vector: Vector<Dual<N>>| if TURNING && needed { vector } else { Vector::zero() };
    let contact = Contact {
        radius: Dual::splat(values.radius),
        mass: Dual::splat(values.mass),
        section_area: if needs.section { contact.section_area } else { Dual::zero() },
        section_radius: Dual::splat(values.section_radius),
        slip: vector(needs.torque || needs.carry, contact.slip),
        relative_spin: vector(needs.spin, contact.relative_spin),
        spin_sum: vector(needs.spin_sum || needs.carry, contact.spin_sum),
        turning: vector(needs.carry, contact.turning),
        per_reach: Dual::splat(values.per_reach),
        rolling_inertia: Dual::splat(values.rolling_inertia),
        ..contact
    };
    ContactGeometry { contact, ..geometry }
}

/// Nothing is remembered of a contact whose bodies are apart.
pub(super) fn part(slopes: &mut ListSlopes, entry: usize) {
    for rows in &mut slopes.rows {
        rows[entry] = NONE;
    }
}

/// How far beyond touch a contact holds its bodies together \[m\], if it may.
pub(super) fn beyond(law: &Law, flags: u8, constant: f64) -> Option<f64> {
    (law.holds_beyond_touch() && flags & TOUCHING != 0).then_some(constant)
}

impl ContactPass {
    /// Adds the slopes of its forces to those of the particles.
    pub(super) fn add_contact_slopes(&self, state: &State, tangent: &mut Tangent, step: Dual) {
        tangent.contacts[self.index].set_odd(self.law.law.history().iter().map(|row| row.odd));
        if self.law.needs.torque {
            run(tangent.width, AddSlopes { pass: Touching::<_, true>(self), state, tangent, step });
        } else {
            run(tangent.width, AddSlopes { pass: Touching::<_, false>(self), state, tangent, step });
        }
    }
}

impl<const TURNING: bool> Kernel for AddSlopes<'_, Touching<&ContactPass, TURNING>> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { pass: Touching(pass), state, tangent, step } = self;
        let (list, particles, law) = (&state.contacts[pass.index], &state.particles, &pass.law.law);
        let (moved, slopes) = (&mut tangent.particles, &mut tangent.contacts[pass.index]);
        let (step, mut rows) = (Dual::<N>::new(step.value, &step.slopes), [[Dual::zero(); 4]; MOST_HISTORY]);
        for (entry, (&i, &j)) in list.first.iter().zip(&list.second).enumerate() {
            let (i, j) = (i as usize, j as usize);
            if !moved.reached[i] && !moved.reached[j] {
                continue;
            }
            let constant = list.pair_constant.get(entry).copied().unwrap_or(0.0);
            let near = SpherePair::of([particles.position[i], particles.position[j]]);
            if !near.overlap(beyond(law, list.flags[entry], constant)) {
                part(slopes, entry);
                continue;
            }
            let ([p, v], [q, u]) = (moved.body::<N>(particles, i), moved.body::<N>(particles, j));
            let spins = [i, j].map(|slot| if TURNING { moved.spin(particles, slot) } else { [Dual::zero(); 4] });
            let geometry = SpherePair::of([p, q]).meet([v, u], spins, Dual::splat(constant));
            let values = near.meet([particles.velocity[i], particles.velocity[j]], [[0.0; 4]; 2], constant).contact;
            let ContactGeometry { mut contact, first_arm, second_arm } =
                needed::<N, TURNING>(geometry, &values, pass.law.needs);
            let row = pass.table.row(particles.material[i], particles.material[j]);
            let Reaction { force, couple, rolling, .. } =
                react::<N, TURNING>(law, row, &mut contact, (&list.history, slopes, entry), (&mut rows, step));
            if TURNING {
                moved.load(i, force, -(couple * first_arm) - rolling);
                moved.load(j, -force, rolling - couple * second_arm);
            } else {
                moved.press(i, force);
                moved.press(j, -force);
            }
        }
    }
}
