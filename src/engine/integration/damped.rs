//! Who is damped, and by how much: of the scene's own particles, of those that come later, of surfaces.

use super::Fields;
use super::braking::{Damped, Damping};

impl Fields {
    /// Damps what the scene does not damp by this fraction of force and torque, gravity included.
    pub(crate) fn damp_rest(&mut self, fraction: f64, count: usize) {
        let rest = Damped { linear: fraction, angular: fraction, gravity: true, applied: true };
        self.damping.resize(count, Damped::default());
        self.damps = true;
        for damped in self.damping.iter_mut().chain([&mut self.newcomers, &mut self.surfaces]) {
            if damped.linear == 0.0 && damped.angular == 0.0 {
                *damped = rest;
            }
        }
    }

    /// Takes all damping away, until [`Fields::damp_as`] puts it back.
    pub(crate) fn without_damping(&mut self) -> Damping {
        let damps = std::mem::take(&mut self.damps);
        let others = [std::mem::take(&mut self.newcomers), std::mem::take(&mut self.surfaces)];
        Damping(std::mem::take(&mut self.damping), others, damps)
    }

    /// Damps as before.
    pub(crate) fn damp_as(&mut self, damping: Damping) {
        (self.damping, [self.newcomers, self.surfaces], self.damps) = (damping.0, damping.1, damping.2);
    }

    /// Damping of a particle by its index.
    #[inline]
    pub(super) fn damped(&self, id: u32) -> Damped {
        match self.damping.get(id as usize) {
            Some(damped) => *damped,
            None => self.newcomers,
        }
    }

    /// Whether any particle is damped.
    pub(crate) fn damps(&self) -> bool {
        self.damps
    }
}
