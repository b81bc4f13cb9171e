//! The list of living bonds: its order, what is in it, and what leaves it.

use crate::base::number::Vector;
use crate::engine::state::{BondList, State};
use std::cmp::Ordering;

/// Whether these two particles (slots) have a bond in this list, which is ascending by the slots of its bonds.
pub(crate) fn is_bonded(list: &BondList, a: u32, b: u32) -> bool {
    let wanted = (a.min(b), a.max(b));
    let (mut from, mut to) = (0, list.first.len());
    while from < to {
        let middle = from.midpoint(to);
        let (i, j) = (list.first[middle], list.second[middle]);
        match (i.min(j), i.max(j)).cmp(&wanted) {
            Ordering::Equal => return true,
            Ordering::Less => from = middle + 1,
            Ordering::Greater => to = middle,
        }
    }
    false
}

/// Takes bonds out of a list, keeping the order of the others.
pub(crate) fn remove(list: &mut BondList, gone: impl Iterator<Item = u32>) {
    let mut dead = vec![false; list.first.len()];
    for bond in gone {
        dead[bond as usize] = true;
    }
    let mut slabs = vec![0_u32; list.slabs.len()];
    for slab in 1..list.slabs.len() {
        let (from, to) = (list.slabs[slab - 1] as usize, list.slabs[slab] as usize);
        let living = dead[from..to].iter().filter(|dead| !**dead).count() as u32;
        slabs[slab] = slabs[slab - 1] + living;
    }
    list.slabs = slabs;
    for slots in [&mut list.first, &mut list.second] {
        keep(slots, &dead);
    }
    for column in list.rows.iter_mut().chain(&mut list.damping).chain([&mut list.foot]) {
        keep(column, &dead);
    }
    keep(&mut list.lost, &dead);
}

/// Keeps the entries of living bonds, in their order.
fn keep<T>(entries: &mut Vec<T>, dead: &[bool]) {
    let mut dead = dead.iter();
    entries.retain(|_| !dead.next().copied().unwrap_or(false));
}

/// Brings the bonds of a list into the order of newly sorted particles.
pub(crate) fn sort(list: &mut BondList, new_slot: &[u32], slabs: &[u32]) {
    let at_plane = list.second.is_empty();
    for slot in list.first.iter_mut().chain(&mut list.second) {
        *slot = new_slot[*slot as usize];
    }
    let mut order: Vec<u32> = (0..list.first.len() as u32).collect();
    let key = |&bond: &u32| {
        let i = list.first[bond as usize];
        let j = list.second.get(bond as usize).copied().unwrap_or(i);
        (i.min(j), i.max(j))
    };
    order.sort_unstable_by_key(key);
    let leading: Vec<u32> = order.iter().map(|bond| key(bond).0).collect();
    list.slabs = if at_plane { &[][..] } else { slabs }
        .iter()
        .map(|&slot| leading.partition_point(|&first| first < slot) as u32)
        .collect();
    list.first = order.iter().map(|&bond| list.first[bond as usize]).collect();
    list.second = order.iter().filter_map(|&bond| list.second.get(bond as usize).copied()).collect();
    let columns = list.rows.iter_mut().chain(&mut list.damping).chain([&mut list.foot]);
    for column in columns.filter(|column| !column.is_empty()) {
        *column = order.iter().map(|&bond| column[bond as usize]).collect();
    }
    if !list.lost.is_empty() {
        list.lost = order.iter().map(|&bond| list.lost[bond as usize]).collect();
    }
}

/// Length of the longest bond \[m\].
pub(crate) fn longest(state: &State) -> f64 {
    let position = &state.particles.position;
    let bonds = state.bonds.iter().flat_map(|list| list.first.iter().zip(&list.second));
    let squares = bonds.map(|(&i, &j)| {
        let apart = Vector::from(position[i as usize]) - Vector::from(position[j as usize]);
        apart.dot(apart)
    });
    squares.fold(0.0, f64::max).sqrt()
}
