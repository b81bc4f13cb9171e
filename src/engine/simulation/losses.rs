//! The physical energy book, opened and read.

use super::Simulation;
use crate::engine::energy::losses::{self, StoredEnergy};
use crate::engine::state::Loss;

impl Simulation {
    /// Lets the book of losses begin at the present state, where the scene keeps one.
    pub(super) fn open_losses(&mut self) {
        if self.state.losses.is_none() {
            return;
        }
        let (kinetic, elastic, StoredEnergy(held)) = (self.kinetic_energy(), self.elastic_energy(), self.held());
        let potential = losses::potential(&self.state, &self.fields);
        if let Some(losses) = &mut self.state.losses {
            (losses.initial_kinetic, losses.initial_elastic) = (kinetic, elastic);
            (losses.initial_potential, losses.initial_held) = (potential, held);
        }
    }

    /// What causes of loss hold and may give back.
    pub(super) fn held(&self) -> StoredEnergy {
        let mut sum = [0.0; 3];
        for pass in &self.passes {
            sum.iter_mut().zip(pass.held_energy(&self.state)).for_each(|(sum, part)| *sum += part);
        }
        StoredEnergy(sum)
    }

    /// What each of [`Loss::ALL`] took since the book was opened \[J\]; `None` where the scene keeps no book of losses.
    pub fn losses(&self) -> Option<[f64; Loss::COUNT]> {
        let book = self.state.losses.as_ref()?;
        let held = self.held();
        Some(Loss::ALL.map(|loss| losses::lost(&self.state, book, &held, loss)))
    }

    /// Kinetic, elastic and potential energy and all losses since the book of losses was opened, less what boundaries, weight and
    /// applied forces gave \[J\]: the error of the time stepping. `None` where the scene keeps no book of losses.
    pub fn physical_residual(&self) -> Option<f64> {
        self.physical_residual_beside(self.kinetic_energy(), self.elastic_energy(), &self.losses()?)
    }

    /// The same, where kinetic and elastic energy and losses are known \[J\].
    pub fn physical_residual_beside(&self, kinetic: f64, elastic: f64, losses: &[f64; Loss::COUNT]) -> Option<f64> {
        let book = self.state.losses.as_ref()?;
        let potential = losses::potential(&self.state, &self.fields) - book.initial_potential;
        let given: f64 = self.state.works().sum();
        let grown = kinetic - book.initial_kinetic + elastic - book.initial_elastic + potential;
        Some(grown + losses.iter().sum::<f64>() - given - book.given_to_bodies - self.work_of_fluid())
    }

    /// Work of the fluid since the start \[J\].
    fn work_of_fluid(&self) -> f64 {
        self.state.fluid.as_ref().map_or(0.0, |fluid| fluid.work)
    }

    /// Energy that came out of nothing by the book of losses, and all that was turned over \[J\]: what nothing accounts for, and
    /// what dashpots gave instead of taking it. What a law gains by its equations is booked under its name, and is not meant.
    pub(super) fn gain_by_losses(&self) -> Option<[f64; 2]> {
        let (book, losses) = (self.state.losses.as_ref()?, self.losses()?);
        let (kinetic, elastic) = (self.kinetic_energy(), self.elastic_energy());
        let residual = self.physical_residual_beside(kinetic, elastic, &losses)?;
        let damping = [Loss::NormalDamping, Loss::TangentialDamping, Loss::BondDamping, Loss::GlobalDamping];
        let given: f64 = damping.into_iter().map(|loss| (-losses[loss as usize]).max(0.0)).sum();
        let potential = losses::potential(&self.state, &self.fields) - book.initial_potential;
        let works = self.state.works();
        let parts = [book.initial_kinetic, book.initial_elastic, potential, book.given_to_bodies, self.work_of_fluid()];
        let scale = parts.into_iter().chain(works).chain(losses).map(f64::abs).sum();
        Some([residual + given, scale])
    }
}
