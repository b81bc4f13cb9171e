//! Batches against one contact at a time: the same bits in every lane width, whether sub-models work one after another
//! or as one.

use super::law::BatchLaw;
use super::{ContactGeometry, Entries, EntryEvaluation};
use crate::base::lanes::Width;
use crate::base::number::{Row, Vector};
use crate::engine::contacts::coefficients::CoefficientTable;
use crate::engine::state::History;
use crate::engine::state::contacts::{SLIDING, TOUCHING};
use crate::laws::contact::batch::{Buffer, SpherePair, Stage};
use crate::laws::contact::fixtures::{corners, every_law, properties, with_pair};
use crate::laws::contact::{Contact, Law, LawChoice, Needs, Offset};
use std::f64::consts::PI;

/// Contacts in a batch: more than a register holds, and no whole number of registers.
const COUNT: usize = 11;

/// What is to be remembered of an entry before.
fn before(entry: usize, row: usize) -> Row {
    [0.125, 0.5 * entry as f64, 0.25 * row as f64, 0.0625]
}

/// Contacts to try a law on; of one whose cohesion model acts beyond touch, two are apart.
fn contacts(law: &BatchLaw) -> Vec<Contact> {
    let mut contacts = corners();
    if law.law.parts() {
        contacts[1].overlap = -1.0 / 32768.0;
        contacts[3].overlap = -1.0 / 65536.0;
    }
    contacts
}

/// Forces, couples, torques, flags and history of a batch, and behind them what it lost.
fn batch(
    law: &BatchLaw,
    rows: &[f64],
    uniform: bool,
    width: Width,
    manner: Option<EntryEvaluation>,
) -> Vec<(Vec<Row>, u8)> {
    let table = CoefficientTable::of_rows([rows, rows].concat().repeat(2), 2);
    let mut buffer = Buffer::new();
    let all = Needs { torque: true, spin: true, section: true, bodies: true, spin_sum: true, carry: true };
    for entry in 0..COUNT {
        let geometry = ContactGeometry { contact: contacts(law)[entry % 5], first_arm: 0.5, second_arm: 0.25 };
        // SAFETY: the buffer has room for more.
        unsafe { buffer.put::<f64, true>(entry, &geometry, all) };
        // Entries stand in the list in another order.
        buffer.entry[entry] = ((entry * 3) % COUNT) as u32;
        buffer.row[entry] = (entry % 4) as u32;
    }
    for place in COUNT..COUNT + 8 {
        let geometry = ContactGeometry { contact: contacts(law)[(COUNT - 1) % 5], first_arm: 0.5, second_arm: 0.25 };
        // SAFETY: as above.
        unsafe { buffer.put::<f64, true>(place, &geometry, all) };
        buffer.entry[place] = buffer.entry[COUNT - 1];
        buffer.row[place] = buffer.row[COUNT - 1];
    }
    let kept = law.law.history().len() + usize::from(manner.is_some());
    buffer.history = buffer.entry.map(|entry| entry * kept as u32);
    buffer.ready = COUNT;
    let mut constants = (0..COUNT).map(|entry| contacts(law)[place_of(entry) % 5].pair_constant).collect::<Vec<f64>>();
    let mut flags = vec![TOUCHING; COUNT];
    let mut history = History::of(kept, 0);
    (0..COUNT).for_each(|entry| history.push((0..kept).map(|row| before(entry, row))));
    let entries = Entries::of(&mut flags, kept, history.all_mut(), &mut constants);
    let (places, own) = (law.law.places(), law.law.history_places());
    let uniform = uniform.then_some(rows);
    let offset = law.law.history().len();
    let mut stage = Stage {
        entries: &entries,
        table: table.rows(),
        uniform,
        places,
        history: own,
        offset,
        step: 0.5,
        touches: !law.law.pulls_beyond_touch(),
        onset: law.law.onset(),
        weights: None,
        booked: &law.booked,
        buffer: &mut buffer,
    };
    let (needs, runs) = law.runs(manner);
    runs.iter().for_each(|run| run(width, &mut stage));
    let mut found = Vec::new();
    for place in 0..COUNT {
        let entry = (place * 3) % COUNT;
        let mut rows = vec![buffer.force[place]];
        if law.needs.torque {
            rows.push(buffer.couple[place]);
        }
        if needs.spin {
            rows.push(buffer.rolling[place]);
        }
        rows.extend(history.get(entry));
        found.push((rows, flags[entry]));
    }
    if law.law.is_booked() {
        found.push((buffer.losses.columns.as_flattened().as_chunks().0.to_vec(), 0));
    }
    found
}

/// Where an entry of the list stands in the batch.
fn place_of(entry: usize) -> usize {
    (0..COUNT).find(|place| (place * 3) % COUNT == entry).expect("every entry has a place")
}

/// The same, contact by contact.
fn one_by_one(law: &BatchLaw, rows: &[f64]) -> Vec<(Vec<Row>, u8)> {
    let of = |vector: Vector| vector.row_with(0.0);
    let one = |place: usize| {
        let entry = (place * 3) % COUNT;
        let mut history: Vec<Row> = (0..law.law.history().len()).map(|row| before(entry, row)).collect();
        let reaction = law.law.react(rows, &mut contacts(law)[place % 5], &mut history, 0.5);
        let mut found = vec![of(reaction.force)];
        if law.needs.torque {
            found.push(of(reaction.couple));
        }
        if law.needs.spin {
            found.push(of(reaction.rolling));
        }
        found.extend(history);
        (found, if reaction.sliding { TOUCHING | SLIDING } else { TOUCHING })
    };
    (0..COUNT).map(one).collect()
}

/// A contact at an overlap of the offset alone: two spheres by their arms, or one at a wall.
fn at_offset(contact: &Contact, offset: f64) -> Contact {
    let half = 0.5 * contact.overlap;
    let area = if contact.radius > 0.75 * contact.section_radius {
        PI * offset * (contact.radius + contact.radius - offset)
    } else {
        SpherePair::section_area([0.5 + half, 0.25 + half], offset)
    };
    Contact { overlap: offset, section_area: area, ..*contact }
}

/// The same, contact by contact, while a bond suppresses them or when it is gone.
fn suppressed_one_by_one(law: &BatchLaw, rows: &[f64], bonded: bool) -> Vec<(Vec<Row>, u8)> {
    let of = |vector: Vector| vector.row_with(0.0);
    let one = |place: usize| {
        let (entry, contact) = ((place * 3) % COUNT, corners()[place % 5]);
        let mut history: Vec<Row> = (0..law.law.history().len()).map(|row| before(entry, row)).collect();
        let offset = before(entry, history.len())[3].min(contact.overlap);
        let pressing = contact.overlap - offset;
        let beyond = Offset { pressing, acts: !bonded, contact: at_offset(&contact, offset) };
        let reaction = law.law.react_beyond(rows, &contact, &beyond, &mut history, 0.5);
        let mut found = vec![of(reaction.force)];
        if law.needs.torque {
            found.push(of(reaction.couple));
        }
        if law.needs.spin && !bonded {
            found.push(of(reaction.rolling));
        }
        found.extend(history);
        found.push(reaction.force.row_with(if bonded { contact.overlap } else { offset }));
        (found, if reaction.sliding { TOUCHING | SLIDING } else { TOUCHING })
    };
    (0..COUNT).map(one).collect()
}

/// Bits of what was found.
fn bits(found: &[(Vec<Row>, u8)]) -> Vec<u64> {
    let of = |(rows, flags): &(Vec<Row>, u8)| {
        let numbers = rows.as_flattened().iter().map(|number| number.to_bits());
        numbers.chain([u64::from(*flags)]).collect::<Vec<u64>>()
    };
    found.iter().flat_map(of).collect()
}

#[test]
fn every_law_has_the_bits_of_one_contact_in_every_lane_width_sub_model_by_sub_model_and_whole() {
    let (mut whole, mut tried) = (0, 0);
    for choice in every_law() {
        let law = Law::of(&choice).recorded();
        let rows = with_pair(&properties(), |pair| choice.coefficients(pair)).expect("all properties are there");
        let laws = [BatchLaw::of(law.clone()), BatchLaw::sub_models(law)];
        whole += usize::from(laws[0].is_fused());
        let expected = one_by_one(&laws[0], &rows);
        for width in Width::ALL.into_iter().filter(|width| width.offered()) {
            for (law, uniform) in laws.iter().flat_map(|law| [(law, true), (law, false)]) {
                let found = batch(law, &rows, uniform, width, None);
                assert_eq!(bits(&found), bits(&expected), "{choice:?}, {width:?}\n{found:?}\n{expected:?}");
                tried += 1;
            }
        }
    }
    // Forms that several models share count once for each of them.
    assert!(whole >= 6 && tried >= 90 * 4, "{whole} laws are compiled whole, {tried} batches");
}

#[test]
fn what_a_batch_loses_has_the_same_bits_in_every_lane_width_sub_model_by_sub_model_and_whole() {
    let mut whole = 0;
    for choice in every_law() {
        let law = Law::of(&choice).recorded().booked();
        let rows = with_pair(&properties(), |pair| choice.coefficients(pair)).expect("all properties are there");
        let laws = [BatchLaw::sub_models(law.clone()), BatchLaw::of(law)];
        whole += usize::from(laws[1].is_fused());
        let expected = batch(&laws[0], &rows, true, Width::Least, None);
        let lost = &expected.last().expect("a batch has losses").0;
        assert!(lost.as_flattened().iter().any(|energy| *energy != 0.0), "{choice:?} loses nothing: {lost:?}");
        for width in Width::ALL.into_iter().filter(|width| width.offered()) {
            for (law, uniform) in laws.iter().flat_map(|law| [(law, true), (law, false)]) {
                let found = batch(law, &rows, uniform, width, None);
                assert_eq!(bits(&found), bits(&expected), "{choice:?}, {width:?}\n{found:?}\n{expected:?}");
            }
        }
    }
    assert!(whole >= 6, "{whole} laws are compiled whole");
}

#[test]
fn suppressed_contacts_have_the_bits_of_one_contact_in_every_lane_width() {
    let mut tried = 0;
    for choice in every_law().into_iter().filter(|choice| Law::of(choice).takes_offset()) {
        let rows = with_pair(&properties(), |pair| choice.coefficients(pair)).expect("all properties are there");
        let law = BatchLaw::of(Law::of(&choice).recorded());
        for (manner, bonded) in [(EntryEvaluation::Bonded, true), (EntryEvaluation::Released, false)] {
            let expected = suppressed_one_by_one(&law, &rows, bonded);
            for width in Width::ALL.into_iter().filter(|width| width.offered()) {
                let found = batch(&law, &rows, tried % 2 == 0, width, Some(manner));
                assert_eq!(bits(&found), bits(&expected), "{choice:?}, {manner:?}, {width:?}\n{found:?}\n{expected:?}");
                tried += 1;
            }
        }
    }
    assert!(tried >= 100, "{tried} batches");
}

#[test]
fn a_law_that_is_not_compiled_whole_is_done_by_its_sub_models() {
    let of = |choice: &LawChoice| {
        let law = Law::of(choice);
        (BatchLaw::of(law.clone()).is_fused(), BatchLaw::sub_models(law).is_fused())
    };
    let found: Vec<(bool, bool)> = every_law().iter().map(of).collect();
    assert!(found.contains(&(false, false)) && found.contains(&(true, false)) && !found.contains(&(true, true)));
}
