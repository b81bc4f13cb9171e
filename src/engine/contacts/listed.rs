//! Contacts of a list where their bodies are now: told in one way, whatever the bodies are.

use super::ahead::{Kind, Link, SearchLimits};
use super::records::{self, ContactRecord, Motion};
use crate::base::number::Vector;
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::contacts::{BONDED, RELEASED, SILENT, SLIDING, TOUCHING, is_told};
use crate::engine::state::{History, Row, State};
use crate::laws::contact::{Contact, Law, Reaction};

/// What a list keeps of its contacts, each a column.
#[derive(Clone, Copy)]
pub(crate) struct ListColumns<'a> {
    /// Bits.
    pub flags: &'a [u8],
    /// What the law remembers, and offsets behind it.
    pub history: &'a History,
    /// Pair constants; empty where the law has none.
    pub pair_constant: &'a [f64],
}

impl ListColumns<'_> {
    /// The pair constant of an entry.
    pub(crate) fn constant(&self, entry: usize) -> f64 {
        self.pair_constant.get(entry).copied().unwrap_or(0.0)
    }

    /// How far apart bodies are to count as near, where a law may hold them together beyond touch \[m\].
    pub(crate) fn reach(&self, law: &Law, entry: usize, gap: f64) -> f64 {
        let holds = law.holds_beyond_touch() && self.flags[entry] & TOUCHING != 0;
        if holds { gap.max(self.constant(entry)) } else { gap }
    }
}

/// A contact at the present time.
pub(crate) struct CurrentContact<'a> {
    /// Geometry and relative motion.
    pub contact: Contact,
    /// Arms at the two bodies \[m\].
    pub arms: [f64; 2],
    /// Coefficients of its law.
    pub row: &'a [f64],
}

/// The bodies of a contact: a particle (slot), another one, or a boundary.
pub(crate) type Bodies = (u32, Option<u32>, Option<u32>);

/// A list of contacts of one law.
pub(crate) trait ContactEntries {
    /// The law.
    fn law(&self) -> &Law;

    /// What is kept of the contacts.
    fn kept<'a>(&self, state: &'a State) -> ListColumns<'a>;

    /// The bodies of an entry.
    fn bodies(&self, state: &State, entry: usize) -> Bodies;

    /// The contact of an entry, if the bodies touch, still hold together or are less than `gap` \[m\] apart: the overlap is
    /// then below 0.
    fn meet(&self, state: &State, entry: usize, gap: f64, motion: Motion) -> Option<CurrentContact<'_>>;

    /// The contact as deep as it may get, if it may.
    fn deepest(&self, state: &State, ahead: &SearchLimits, entry: usize, met: &CurrentContact) -> Option<Contact>;
}

/// Tells the stiffness of each contact at work or, where `ahead` looks further, as stiff as each may get. Contacts that a bond
/// suppresses, or has suppressed, count where they touch, as far as they act.
pub(crate) fn stiffness(
    list: &(impl ContactEntries + Sync),
    state: &State,
    ahead: &SearchLimits,
    context: &Context,
    tell: &mut dyn FnMut(Link),
) {
    let count = list.kept(state).flags.len();
    if context.threads.is_none() && context.watch.is_none() {
        return (0..count).filter_map(|entry| link(list, state, ahead, entry)).for_each(tell);
    }
    let piece = |piece: usize| {
        let entries = piece * CHUNK..((piece + 1) * CHUNK).min(count);
        entries.filter_map(|entry| link(list, state, ahead, entry)).collect::<Vec<_>>()
    };
    context.fold(count.div_ceil(CHUNK), piece, (), |(), links| links.into_iter().for_each(&mut *tell));
}

/// How stiff a contact may get, if it may touch.
fn link(list: &impl ContactEntries, state: &State, ahead: &SearchLimits, entry: usize) -> Option<Link> {
    let (law, flags) = (list.law(), list.kept(state).flags[entry]);
    let bonded = flags & BONDED != 0;
    if bonded && flags & SILENT != 0 {
        return None;
    }
    let gap = if flags & (BONDED | RELEASED) == 0 { ahead.margin.max(ahead.way) } else { 0.0 };
    let met = list.meet(state, entry, gap, Motion::Present)?;
    let touches = met.contact.overlap >= 0.0 || (law.holds_beyond_touch() && flags & TOUCHING != 0);
    let deep = list.deepest(state, ahead, entry, &met).or(touches.then_some(met.contact))?;
    let kind = if touches { Kind::Contact } else { Kind::ComingContact };
    let link = Link::of_contact(list.bodies(state, entry), (law, met.row), &deep, met.arms);
    Some(if bonded { link.without_normal() } else { Link { kind, ..link } })
}

/// Tells each contact at work as it was in the last evaluation, after a time step of this length \[s\].
pub(crate) fn records(list: &impl ContactEntries, state: &State, step: f64, tell: &mut dyn FnMut(ContactRecord)) {
    let (law, kept) = (list.law(), list.kept(state));
    for (entry, &flags) in kept.flags.iter().enumerate().filter(|(_, flags)| is_told(**flags)) {
        let Some(mut met) = list.meet(state, entry, f64::INFINITY, Motion::HalfStepBack(step)) else { continue };
        met.contact = records::seen(law, met.contact, kept.history, entry);
        let (reaction, sliding) = if flags & (BONDED | RELEASED) == 0 {
            records::react(law, met.row, &met.contact, kept.history, entry, flags)
        } else {
            remembered(kept.history, entry, flags)
        };
        let (first, second, boundary) = list.bodies(state, entry);
        let particles = &state.particles;
        let point = Vector::from(particles.position[first as usize]) - met.contact.normal * met.arms[0];
        let name = |slot: u32| particles.id[slot as usize];
        let ids = (name(first), second.map(name));
        tell(ContactRecord::new(ids, boundary, point, &met.contact, &reaction, sliding));
    }
}

/// Tells the first body and the overlap \[m\] of each entry that touches and has one of these flags.
pub(crate) fn touched(list: &impl ContactEntries, (state, flags): (&State, u8), tell: &mut dyn FnMut(u32, f64)) {
    for (entry, _) in list.kept(state).flags.iter().enumerate().filter(|(_, own)| **own & flags != 0) {
        if let Some(met) = list.meet(state, entry, 0.0, Motion::Present) {
            tell(list.bodies(state, entry).0, met.contact.overlap);
        }
    }
}

/// A change of the overlap, over itself, that a contact far from a switch does not feel.
pub(crate) const SLIGHT: f64 = 1e-4;

/// How many contacts are near a switch: they would begin or end to slide in a time step of this length \[s\] if their overlap were a
/// little larger or smaller, or their bodies touch or miss each other by less than `margin` \[m\].
pub(crate) fn near_switch(list: &impl ContactEntries, state: &State, step: f64, margin: f64) -> u64 {
    let (law, kept) = (list.law(), list.kept(state));
    let is_near = |entry: &usize| {
        let Some(CurrentContact { contact, row, .. }) = list.meet(state, *entry, margin, Motion::Present) else {
            return false;
        };
        let slides = |share: f64| {
            let mut contact = Contact { overlap: share * contact.overlap, ..contact };
            law.react(row, &mut contact, &mut records::history(kept.history, *entry), step).sliding
        };
        contact.overlap.abs() < margin || slides(1.0 - SLIGHT) != slides(1.0 + SLIGHT)
    };
    (0..kept.flags.len()).filter(is_near).count() as u64
}

/// What a suppressed contact did, as far as records tell it: the force that was kept, and whether friction slid.
fn remembered(history: &History, entry: usize, flags: u8) -> (Reaction, bool) {
    let force = history.get(entry).last().copied().unwrap_or_default();
    let sliding = flags & SLIDING != 0;
    (Reaction { force: force.into(), couple: Vector::zero(), rolling: Vector::zero(), sliding }, sliding)
}

/// Elastic energy of the contacts \[J\]: none of the normal force while a bond suppresses it.
pub(crate) fn elastic_energy(list: &impl ContactEntries, state: &State) -> f64 {
    energy(list, state, Law::elastic_energy)
}

/// Energy that a law's rolling springs and its sticky or plastic normal forces hold \[J\].
pub(crate) fn held_energy(list: &impl ContactEntries, state: &State) -> [f64; 3] {
    let (law, mut held) = (list.law(), [0.0; 3]);
    if law.has_rolling() {
        held[0] = energy(list, state, |law, row, contact, _, history| law.rolling_energy(row, contact, history));
    }
    if !law.presses() {
        held[if law.is_plastic() { 2 } else { 1 }] = energy(list, state, Law::normal_energy);
    }
    held
}

/// Sum of an energy of each contact, of its law, coefficients, geometry, offset and history \[J\].
fn energy(list: &impl ContactEntries, state: &State, of: impl Fn(&Law, &[f64], &Contact, f64, &[Row]) -> f64) -> f64 {
    let (law, kept) = (list.law(), list.kept(state));
    let told = kept.flags.iter().enumerate().filter(|(_, flags)| is_told(**flags));
    let energy = |(entry, &flags): (usize, &u8)| {
        let CurrentContact { contact, row, .. } = list.meet(state, entry, 0.0, Motion::Present)?;
        let offset = match flags {
            flags if flags & BONDED != 0 => contact.overlap,
            flags if flags & RELEASED != 0 => {
                kept.history.get(entry).last().map_or(0.0, |row| row[3]).min(contact.overlap)
            }
            _ => 0.0,
        };
        Some(of(law, row, &contact, offset, &records::history(kept.history, entry)))
    };
    told.filter_map(energy).sum()
}
