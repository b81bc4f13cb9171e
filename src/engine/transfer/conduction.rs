//! Conductances of contacts and bonds.

use crate::base::number::Vector;
use crate::engine::contacts::SurfaceTouch;
use crate::engine::state::{ContactList, Row, State};
use crate::laws::contact::heat::Spot;
use crate::laws::contact::{Adhesion, HeatModel, NormalModel};
use crate::laws::surface::NodeWeights;
use crate::scene::Scene;
use std::f64::consts::PI;

/// Who is told what conducts.
pub(super) trait Conductances {
    /// Two particles (slots) conduct \[W/K\].
    fn between(&mut self, first: u32, second: u32, conductance: f64);

    /// A particle (slot) and a boundary conduct \[W/K\], where nodes have temperatures by these around the foot.
    fn at_boundary(&mut self, slot: u32, boundary: u32, nodes: &[NodeWeights], conductance: f64);
}

/// What a contact law conducts.
pub(super) struct Conduction {
    /// Which law.
    law: usize,
    /// Its heat model.
    model: HeatModel,
    /// Its normal model, which knows the contact radius.
    normal: NormalModel,
    /// Coefficients of the heat model for each two materials.
    rows: Vec<f64>,
    /// How many materials there are.
    materials: usize,
    /// Whether bodies that have touched conduct as long as they hold together.
    beyond_touch: bool,
}

impl Conduction {
    /// That of a contact law of this index, if it conducts.
    pub(super) fn of(scene: &Scene, law: usize) -> Option<Self> {
        let contact = &scene.contacts[law];
        let (model, materials) = (contact.heat?, scene.materials.len());
        let rows = contact.heat_rows(scene).concat();
        let normal = contact.choice.normal;
        let beyond_touch = normal.row().does.adhesion() == Adhesion::BeyondTouch;
        Some(Self { law, model, normal, rows, materials, beyond_touch })
    }

    /// The coefficients of the normal model for two materials, as they are now.
    #[inline(always)]
    fn normal_row<'a>(&self, state: &'a State, entry: usize) -> &'a [f64] {
        let all = &state.coefficients[self.law];
        let count = all.len() / (self.materials * self.materials);
        &all[entry * count..(entry + 1) * count]
    }

    /// The coefficients of the heat model for two materials.
    #[inline(always)]
    fn row(&self, entry: usize) -> &[f64] {
        let count = self.model.count();
        &self.rows[entry * count..(entry + 1) * count]
    }

    /// Conductance of two spheres \[W/K\]; none where they do not touch.
    #[inline(always)]
    fn of_spheres(&self, state: &State, entry: usize, first: Row, second: Row) -> Option<f64> {
        let (r, s) = (first[3], second[3]);
        let overlap = r + s - (Vector::from(first) - Vector::from(second)).length();
        if overlap <= 0.0 && !self.beyond_touch {
            return None;
        }
        let radius = (self.normal.row().does.contact_radius)(self.normal_row(state, entry), overlap, r * s / (r + s));
        let spot = Spot::of_spheres([r, s], overlap, radius);
        Some((self.model.row().does.conductance)(self.row(entry), &spot))
    }

    /// Tells what the particles conduct that touch, where their entry has one of these flags.
    pub(super) fn tell(&self, (list, flags): (&ContactList, u8), state: &State, hear: &mut impl Conductances) {
        let (position, material) = (&state.particles.position, &state.particles.material);
        for entry in (0..list.first.len()).filter(|&entry| list.flags[entry] & flags != 0) {
            let (first, second) = (list.first[entry], list.second[entry]);
            let (i, j) = (first as usize, second as usize);
            let pair = material[i] as usize * self.materials + material[j] as usize;
            if let Some(conductance) = self.of_spheres(state, pair, position[i], position[j]) {
                hear.between(first, second, conductance);
            }
        }
    }

    /// Tells what a particle and a boundary conduct.
    pub(super) fn at_boundary(&self, scene: &Scene, touch: &SurfaceTouch, state: &State, hear: &mut impl Conductances) {
        let &SurfaceTouch { slot, boundary, overlap, weight, nodes, .. } = touch;
        let Some(wall) = scene.boundaries[boundary as usize].shape.material() else { return };
        let (radius, material) =
            (state.particles.position[slot as usize][3], state.particles.material[slot as usize] as usize);
        if overlap <= 0.0 && !self.beyond_touch {
            return;
        }
        let entry = material * self.materials + wall.index();
        let contact_radius = (self.normal.row().does.contact_radius)(self.normal_row(state, entry), overlap, radius);
        let spot = Spot::at_wall(radius, overlap, contact_radius);
        let conductance = (self.model.row().does.conductance)(self.row(entry), &spot);
        hear.at_boundary(slot, boundary, nodes, weight * conductance);
    }
}

/// What the bonds of a law conduct: cylinders of this conductivity from centre to centre.
pub(super) struct BondConduction {
    /// Conductivity times π times the square of the radius multiplier \[W/(m K)\].
    per_length: f64,
}

impl BondConduction {
    /// That of a bond law of this index, if it conducts.
    pub(super) fn of(scene: &Scene, bond: usize) -> Option<Self> {
        let keys = &scene.bonds[bond].keys;
        let multiplier = keys.radius_multiplier.map_or(1.0, |it| it.get());
        keys.conductivity.map(|conductivity| Self { per_length: conductivity.get() * PI * (multiplier * multiplier) })
    }

    /// Tells what the living bonds of the law of this place conduct.
    pub(super) fn tell(&self, (scene, place): (&Scene, usize), state: &State, hear: &mut impl Conductances) {
        let (list, position) = (&state.bonds[place], &state.particles.position);
        let conductance = |radius: f64, length: f64| self.per_length * (radius * radius) / length;
        for (entry, &first) in list.first.iter().enumerate() {
            let from = position[first as usize];
            let Some(&second) = list.second.get(entry) else {
                let Some(plane) = scene.bonds[place].plane else { continue };
                let shift = Vector::from(state.boundaries[plane.index()].displacement);
                let length = (Vector::from(from) - Vector::from(list.foot[entry]) - shift).length();
                if scene.boundaries[plane.index()].temperature.at_start().is_some() {
                    hear.at_boundary(first, plane.0, &[], conductance(from[3], length));
                }
                continue;
            };
            let to = position[second as usize];
            let length = (Vector::from(from) - Vector::from(to)).length();
            hear.between(first, second, conductance(from[3].min(to[3]), length));
        }
    }
}
