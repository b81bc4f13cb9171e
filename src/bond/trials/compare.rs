//! A run beside a stored trajectory: restored from its samples, compared with them.

use super::replay::{Run, largest};
use super::stored::Case;
use crate::number::Vector;

impl Run {
    /// Takes bodies and bonds (of `engine_exact`) from a stored sample.
    pub(super) fn restore(&mut self, case: &Case, sample: usize) {
        let count = self.bodies.len();
        let rows = &case.samples.rows[sample * count..(sample + 1) * count];
        for (body, row) in rows.iter().enumerate() {
            let part = |first: &str| case.samples.vector(row, first);
            self.bodies[body].position = part("x");
            self.bodies[body].velocity = part("vx");
            self.bodies[body].spin = part("omegax");
            self.loads[body] = [part("fx"), part("tx")];
        }
        for link in &mut self.links {
            let stored = bond_row(case, rows[0][0], [self.ids[link.i], link.j.map_or(0, |j| self.ids[j])]);
            link.rows = stored.filter(|(_, _, living)| *living).map(|(row, sign, _)| {
                let table = case.bonds.as_ref().unwrap();
                let part = |first: &str| (table.vector(row, first) * sign).to_array();
                let row = |[x, y, z]: [f64; 3], last: f64| [x, y, z, last];
                let reference = stored.unwrap().0[table.column("d0")];
                [row(part("ftx"), reference), row(part("tnx"), 0.0), row(part("ttx"), 0.0)]
            });
        }
    }

    /// Deviations from a stored sample: x, v, ω, f, t, bond force; each absolute. And whether the living bonds agree.
    pub(super) fn compare(&self, case: &Case, sample: usize) -> ([f64; 6], bool) {
        let count = self.bodies.len();
        let rows = &case.samples.rows[sample * count..(sample + 1) * count];
        let mut worst = [0.0_f64; 6];
        for ((body, load), row) in self.bodies.iter().zip(&self.loads).zip(rows) {
            let ours = [body.position, body.velocity, body.spin, load[0], load[1]];
            for (index, (ours, first)) in ours.into_iter().zip(["x", "vx", "omegax", "fx", "tx"]).enumerate() {
                worst[index] = worst[index].max(largest(ours - case.samples.vector(row, first)));
            }
        }
        let mut same = true;
        if let Some(table) = &case.bonds {
            for link in &self.links {
                let stored = bond_row(case, rows[0][0], [self.ids[link.i], link.j.map_or(0, |j| self.ids[j])]);
                same &= link.rows.is_some() == stored.is_some_and(|(_, _, living)| living);
                let force = stored.map_or(Vector::zero(), |(row, sign, _)| table.vector(row, "fx") * sign);
                worst[5] = worst[5].max(largest(link.force - force));
            }
        }
        (worst, same)
    }
}

/// The row of two ids at a step, the sign for the order of the ids, and whether the bond lives.
fn bond_row(case: &Case, step: f64, ids: [i64; 2]) -> Option<(&Vec<f64>, f64, bool)> {
    let table = case.bonds.as_ref()?;
    let (one, two, living) = (table.column("id1"), table.column("id2"), table.column("bonded"));
    table.rows.iter().filter(|row| row[0] == step).find_map(|row| {
        let found = [row[one] as i64, row[two] as i64];
        let sign = if found == ids {
            1.0
        } else if found == [ids[1], ids[0]] {
            -1.0
        } else {
            return None;
        };
        Some((row, sign, row[living] > 0.5))
    })
}
