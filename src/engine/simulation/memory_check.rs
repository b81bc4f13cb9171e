//! Whether there is memory for what a scene asks for: found before it is asked for, since a system that has promised too
//! much ends the program.

use super::{RunError, Simulation};
use crate::base::geometry::Frame;
use crate::base::memory;
use crate::engine::neighbours::pair_estimate;

/// Bytes of a listed pair, without what is remembered of it: in the list, in the one it is made of, and where it is found.
const PAIR: f64 = 46.0;

/// Bytes of a row that is remembered of it, in the list and the one it is made of.
const ROW: f64 = 64.0;

/// Bytes of a bond, while its list is brought into order.
const BOND: f64 = 600.0;

/// Bytes of a part of a surface that is near a particle, in the list and the pieces it is made of.
const PART: f64 = 12.0;

/// Pairs of a list, and the rows that are remembered of them, are counted in 32 bits.
const MOST: f64 = u32::MAX as f64;

impl Simulation {
    /// Refuses lists that have no room.
    pub(super) fn check_memory(&self) -> Result<(), RunError> {
        let Some(free) = memory::available() else { return Ok(()) };
        let particles = &self.state.particles;
        let every = 0.5 * particles.len() as f64 * particles.len() as f64;
        let spheres = |skin: f64| move |one: f64, other: f64| one + other + skin;
        let kept = (0..self.scene.contacts.len()).map(|law| self.scene.kept_rows(law).len());
        let rows = kept.max().unwrap_or(0).max(1) as f64;
        let pair = PAIR + ROW * rows;
        let refuse = |(pairs, rows): (f64, f64), bytes: f64, why: String| {
            let (needed, few) = (pairs * bytes, pairs * rows <= MOST);
            if few && needed <= free as f64 { Ok(()) } else { Err(RunError::Memory { pairs, needed, free, why }) }
        };
        // Where even all pairs have room nothing needs to be counted.
        if every * pair > free as f64 && !self.scene.contacts.is_empty() {
            let skin = self.state.neighbours.skin;
            let pairs = pair_estimate::pairs(particles, spheres(skin));
            refuse((pairs, rows), pair, format!("near pairs with a [run] skin of {skin:e} m"))?;
        }
        for bond in &self.scene.bonds {
            let Some(distance) = bond.create_distance().filter(|_| every * BOND > free as f64) else { continue };
            let pairs = pair_estimate::pairs(particles, |_, _| distance);
            refuse((pairs, 1.0), BOND, format!("pairs with a [bond.{}] create_distance of {distance:e} m", bond.name))?;
        }
        let skin = self.state.neighbours.skin;
        for (boundary, stands) in self.scene.boundaries.iter().zip(&self.state.boundaries) {
            let features = boundary.shape.features().filter(|_| !self.scene.contacts.is_empty());
            let most = features.map_or(0, |features| features.counts()[0] * particles.len());
            let Some(features) = features.filter(|_| most as f64 * PART > free as f64) else { continue };
            let frame = Frame::of(boundary.reference.into(), stands.shift().into(), stands.orientation.0);
            let parts = pair_estimate::parts(particles, features, (&frame, skin));
            let why = format!("parts of [boundary.{}] near particles with a [run] skin of {skin:e} m", boundary.name);
            refuse((parts, 1.0), PART, why)?;
        }
        Ok(())
    }
}
