//! Conductances of contacts and bonds.

use super::flows::Flows;
use crate::base::number::Vector;
use crate::base::threads::Context;
use crate::engine::contacts::SurfaceTouch;
use crate::engine::state::contacts::{BONDED, TOUCHING};
use crate::engine::state::{ContactList, Row, State};
use crate::laws::contact::heat::Spot;
use crate::laws::contact::{Adhesion, HeatModel, MaterialPair, NormalModel};
use crate::scene::Scene;
use std::f64::consts::PI;

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
        let row = |entry: usize| {
            let (a, b) = (&scene.materials[entry / materials], &scene.materials[entry % materials]);
            let pair = MaterialPair { a, b, properties: &scene.pairs[entry] };
            // What nothing meets may lack properties.
            let row = contact.between[entry].then(|| model.between(&pair).ok()).flatten();
            row.unwrap_or_else(|| vec![0.0; model.count()])
        };
        let rows = (0..materials * materials).flat_map(row).collect();
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

    /// Lets heat flow between the particles that touch, slab by slab in the order of the list.
    pub(super) fn between_particles(&self, list: &ContactList, state: &State, flows: &mut Flows, context: &Context) {
        let (position, material) = (&state.particles.position, &state.particles.material);
        let flows = flows.slabs();
        context.slabs(list.slabs.len().saturating_sub(1), |slab| {
            for entry in list.slabs[slab] as usize..list.slabs[slab + 1] as usize {
                // What a bond suppresses touches all the same.
                if list.flags[entry] & (TOUCHING | BONDED) == 0 {
                    continue;
                }
                let (i, j) = (list.first[entry] as usize, list.second[entry] as usize);
                let pair = material[i] as usize * self.materials + material[j] as usize;
                if let Some(conductance) = self.of_spheres(state, pair, position[i], position[j]) {
                    // SAFETY: a list holds slots of particles, and slabs worked on at the same time do not share any.
                    unsafe { flows.between(i, j, conductance) };
                }
            }
        });
    }

    /// Lets heat flow between a particle and a boundary.
    pub(super) fn at_boundary(&self, scene: &Scene, touch: &SurfaceTouch, state: &State, flows: &mut Flows) {
        let &SurfaceTouch { slot, boundary, overlap, weight, .. } = touch;
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
        flows.at_boundary(slot, boundary, weight * conductance);
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

    /// Lets heat flow along the living bonds of the law of this place.
    pub(super) fn conduct(&self, (scene, place): (&Scene, usize), state: &State, flows: &mut Flows) {
        let (list, position) = (&state.bonds[place], &state.particles.position);
        let conductance = |radius: f64, length: f64| self.per_length * (radius * radius) / length;
        for (entry, &first) in list.first.iter().enumerate() {
            let from = position[first as usize];
            let Some(&second) = list.second.get(entry) else {
                let Some(plane) = scene.bonds[place].plane else { continue };
                let shift = Vector::from(state.boundaries[plane.index()].displacement);
                let length = (Vector::from(from) - Vector::from(list.foot[entry]) - shift).length();
                if scene.boundaries[plane.index()].temperature.at_start().is_some() {
                    flows.at_boundary(first, plane.0, conductance(from[3], length));
                }
                continue;
            };
            let to = position[second as usize];
            let length = (Vector::from(from) - Vector::from(to)).length();
            flows.between(first, second, conductance(from[3].min(to[3]), length));
        }
    }
}
