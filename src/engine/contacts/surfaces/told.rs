//! What the pass of surfaces tells: how stiff contacts are, which there are, what energy they hold.

use super::{AtSurface, SurfacePass};
use crate::base::threads::Context;
use crate::engine::contacts::ahead::{Frame, Link, Meeting, SearchLimits};
use crate::engine::contacts::coefficients::MaterialRow;
use crate::engine::contacts::encounters::{self, Encounters};
use crate::engine::contacts::listed;
use crate::engine::contacts::pass::{Stiffness, SurfaceTouch, Telling};
use crate::engine::contacts::records::ContactRecord;
use crate::engine::state::State;
use crate::scene::Scene;

impl Stiffness for SurfacePass {
    fn stiffness(&self, state: &State, ahead: &SearchLimits, context: &Context, tell: &mut dyn FnMut(Link)) {
        for surface in &self.surfaces {
            match surface.plane_list(state) {
                Some(list) => listed::stiffness(&list, state, ahead, context, tell),
                None => surface.stiffness_at_features(state, ahead, tell),
            }
        }
    }

    fn impacts(&self, state: &State, meeting: &Meeting, tell: &mut dyn FnMut(Option<u32>, [Frame; 2])) {
        let (first, None) = meeting.materials else { return };
        for surface in &self.surfaces {
            let found = surface.table.impact(&surface.law.law, [first, surface.material], meeting);
            found.into_iter().for_each(|parts| tell(Some(surface.list(state).boundary), parts));
        }
    }

    fn rows(&self, scene: &Scene, tell: &mut dyn FnMut(MaterialRow)) {
        let present = scene.present();
        for surface in &self.surfaces {
            for material in (0..present.len()).filter(|&material| present[material]) {
                let materials = [material as u32, surface.material];
                let row = surface.table.material_row(surface.law_index, &surface.law.law, materials);
                row.into_iter().for_each(&mut *tell);
            }
        }
    }

    fn encounters(&self, state: &State, found: &mut Encounters) {
        for surface in &self.surfaces {
            match surface.plane_list(state) {
                Some(list) => encounters::of_list(&list, state, found),
                None => surface.encounters_at_features(state, found),
            }
        }
    }
}

impl Telling for SurfacePass {
    fn contacts(&self, state: &State, step: f64, tell: &mut dyn FnMut(ContactRecord)) {
        for surface in &self.surfaces {
            match surface.plane_list(state) {
                Some(list) => listed::records(&list, state, step, tell),
                None => surface.records_at_features(state, step, tell),
            }
        }
    }

    fn touched(&self, (state, flags): (&State, u8), tell: &mut dyn FnMut(SurfaceTouch)) {
        for surface in &self.surfaces {
            let (boundary, law) = (surface.list(state).boundary, surface.law_index);
            match surface.plane_list(state) {
                Some(list) => listed::touched(&list, (state, flags), &mut |slot, overlap| {
                    tell(SurfaceTouch { slot, boundary, law, overlap, weight: 1.0, nodes: &[] });
                }),
                None => surface.touched_at_features((state, flags), |slot, overlap, weight, nodes| {
                    tell(SurfaceTouch { slot, boundary, law, overlap, weight, nodes });
                }),
            }
        }
    }

    fn near_switch(&self, state: &State, step: f64, margin: f64) -> u64 {
        let lists = self.surfaces.iter().filter_map(|surface| surface.plane_list(state));
        lists.map(|list| listed::near_switch(&list, state, step, margin)).sum()
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        let energy = |surface: &AtSurface| match surface.plane_list(state) {
            Some(list) => listed::elastic_energy(&list, state),
            None => surface.energy_at_features(state),
        };
        self.surfaces.iter().map(energy).sum()
    }

    fn held_energy(&self, state: &State) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for surface in &self.surfaces {
            let held = match surface.plane_list(state) {
                Some(list) => listed::held_energy(&list, state),
                None => surface.held_at_features(state),
            };
            sum.iter_mut().zip(held).for_each(|(sum, part)| *sum += part);
        }
        sum
    }

    fn largest_overlap(&self, state: &State) -> f64 {
        let at_features = self.surfaces.iter().filter(|surface| surface.has_features());
        at_features.map(|surface| surface.largest_overlap(state)).fold(0.0, f64::max)
    }
}
