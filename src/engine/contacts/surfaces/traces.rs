//! What contacts leave on a surface: wear, losses, and impacts that ended.
//!
//! A particle may touch several features of a surface at once, and roll from one to the next: that is one impact, which ends when it
//! touches none any more. What is remembered of it stands with the first of its contacts that counts.

use super::features::MovingSurface;
use super::history::PreviousContacts;
use super::sphere::ParticleLoads;
use super::{AtSurface, Load, Touched};
use crate::base::number::Vector;
use crate::engine::contacts::batches::{Batches, Bodies, Entries, Followed, Trace};
use crate::engine::state::{ImpactRecord, Row, State};
use crate::engine::traces::{Ended, Left, Share, TracedScene};
use crate::laws::wear::{Rubbing, Touch, WearModel};
use crate::scene::{Boundary, Scene};

/// Follows the contacts of a surface.
pub(super) struct SurfaceFollower {
    /// Its boundary.
    boundary: u32,
    /// What wears it.
    wear: Vec<WearModel>,
    /// What is told.
    scene: TracedScene,
}

/// What the contacts of a piece of the particles do to a surface.
#[derive(Clone, Debug, Default)]
pub(super) struct TraceRoom {
    /// Contact by contact.
    pub(super) followed: Followed,
    /// What they leave behind.
    left: Left,
}

/// What particles touch of a surface of features, each a column.
pub(super) struct TouchedFeatures<'a> {
    /// The surface, where it stands.
    pub(super) at: &'a MovingSurface<'a>,
    /// The particle of each contact (slot).
    pub(super) particle: &'a [u32],
    /// Its feature.
    pub(super) feature: &'a [u32],
    /// Normal and distance of its foot \[m\].
    pub(super) foot: &'a [Row],
    /// How often it counts; empty where each counts once.
    pub(super) weight: &'a [[f64; 3]],
    /// The particles.
    pub(super) particles: ParticleLoads<'a>,
}

impl TouchedFeatures<'_> {
    /// How often a contact counts.
    fn weight(&self, contact: usize) -> f64 {
        self.weight.get(contact).map_or(1.0, |[weight, ..]| *weight)
    }
}

/// Impacts as the rows of a list remember them, of which this is the first.
fn remembered(rows: &[Row], place: Option<usize>) -> ImpactRecord {
    place.map_or_else(ImpactRecord::default, |place| ImpactRecord::of_rows([rows[place], rows[place + 1]]))
}

/// Lets rows remember an impact.
fn remember(rows: &mut [Row], place: Option<usize>, record: ImpactRecord) {
    if let Some(place) = place {
        rows[place..place + 2].copy_from_slice(&record.to_rows());
    }
}

impl SurfaceFollower {
    /// Of a boundary of a scene; none where nothing is asked of its contacts.
    pub(super) fn of(scene: &Scene, boundary: &Boundary) -> Option<Self> {
        let index = scene.boundaries.iter().position(|other| other.name == boundary.name)?;
        let asks = scene.output.impacts.is_some() || !boundary.wear.is_empty();
        asks.then(|| Self { boundary: index as u32, wear: boundary.wear.clone(), scene: TracedScene::of(scene) })
    }

    /// Books what a piece of the particles left behind.
    pub(super) fn book(&self, room: &TraceRoom, state: &mut State) {
        room.left.book(&self.scene, state);
    }

    /// The volume that a contact wears off in a time step of this length \[s\], which may begin in it \[m³\].
    fn worn(&self, trace: &Trace, touches_first: bool, step: f64) -> f64 {
        let [normal, tangential] = trace.speed;
        let (mass, normal_speed) = (trace.mass, normal.max(0.0));
        let touch = touches_first.then_some(Touch { mass, normal_speed, tangential_speed: tangential });
        let rubbing = Rubbing { force: trace.force, sliding: tangential * step, touch };
        self.wear.iter().map(|model| model.volume(&rubbing)).sum()
    }

    /// An impact with a particle (slot) that ended.
    fn ended(&self, first: u32, record: ImpactRecord) -> Ended {
        Ended { first, second: None, between: self.boundary, record }
    }
}

impl AtSurface {
    /// What the contacts of a piece of the list of a plane leave behind.
    pub(super) fn trace_plane<B: Bodies<Sum = Load>>(&self, batches: &Batches<B>, room: &mut TraceRoom) {
        let (Some(follower), TraceRoom { followed, left }) = (&self.follower, room) else { return };
        left.clear();
        let (place, boundary) = (self.law.law.history_places().impact, follower.boundary);
        for trace in &followed.touching {
            // SAFETY: the entry belongs to this piece of the list.
            let rows = unsafe { batches.entries.history(trace.entry as usize) };
            let mut record = remembered(rows, place);
            let touches_first = record.go_on(batches.step, trace.force, trace.speed, trace.lost);
            remember(rows, place, record);
            let wear = follower.worn(trace, touches_first, batches.step);
            left.shares.push(Share { boundary, facet: 0, wear, lost: trace.lost });
        }
        for parted in &followed.parted {
            let mut record = ImpactRecord::of_rows(parted.rows);
            if record.begun {
                (0..2).for_each(|part| record.lost[part] += parted.lost[part]);
                left.ended.push(follower.ended(parted.first, record));
                left.shares.push(Share { boundary, facet: 0, wear: 0.0, lost: parted.lost });
            }
        }
    }

    /// What the contacts of a piece of the particles with features leave behind, in a time step of this length \[s\]: what was remembered
    /// before it, and where it stands now.
    pub(super) fn trace_features(
        &self,
        touched: &TouchedFeatures,
        (past, entries): (&PreviousContacts, Entries),
        step: f64,
        room: &mut TraceRoom,
    ) {
        let (Some(follower), TraceRoom { followed, left }) = (&self.follower, room) else { return };
        left.clear();
        // Where bonds suppress contacts, those of each manner come one after the other.
        followed.touching.sort_unstable_by_key(|trace| trace.entry);
        let place = self.law.law.history_places().impact;
        let (mut before, mut traces) = (0, &followed.touching[..]);
        let mut first = 0;
        while let Some(&slot) = touched.particle.get(first) {
            let end = first + touched.particle[first..].iter().take_while(|&&other| other == slot).count();
            let entries_before = past.of(slot, before);
            self.end_features(past, before..entries_before.start, left);
            before = entries_before.end;
            let of_particle = traces.iter().take_while(|trace| (trace.entry as usize) < end).count();
            let (mine, rest) = traces.split_at(of_particle);
            traces = rest;
            let mut record = remembered_of(past, entries_before, place);
            let is_new = self.go_on(&mut record, mine, step);
            // SAFETY: the entries are those of this piece, and nobody else looks at them.
            let rows = |contact: usize| unsafe { entries.history(contact) };
            (first..end).for_each(|contact| remember(rows(contact), place, ImpactRecord::default()));
            if let Some(keeper) = (first..end).find(|&contact| touched.weight(contact) > 0.0) {
                remember(rows(keeper), place, record);
            }
            let deepest = is_new.then(|| strongest(mine)).flatten();
            for trace in mine {
                let wear = follower.worn(trace, deepest == Some(trace.entry), step);
                self.share_out(touched, trace, wear, left);
            }
            first = end;
        }
        self.end_features(past, before..past.particle.len(), left);
    }

    /// Lets an impact go on with what the contacts of its particle do. Returns whether it begins.
    fn go_on(&self, record: &mut ImpactRecord, contacts: &[Trace], step: f64) -> bool {
        let Some(strongest) = strongest(contacts).and_then(|entry| contacts.iter().find(|it| it.entry == entry)) else {
            return false;
        };
        let force = contacts.iter().map(|trace| trace.force).sum();
        let lost = [0, 1].map(|part: usize| contacts.iter().map(|trace| trace.lost[part]).sum());
        record.go_on(step, force, strongest.speed, lost)
    }

    /// Gives what a contact left to the facets where it is.
    fn share_out(&self, touched: &TouchedFeatures, trace: &Trace, wear: f64, left: &mut Left) {
        let Some(follower) = &self.follower else { return };
        let (contact, boundary) = (trace.entry as usize, follower.boundary);
        let [x, y, z, distance] = touched.foot[contact];
        let centre = Vector::from(touched.particles.position[touched.particle[contact] as usize]);
        let foot = touched.at.frame().inside(centre - Vector::new(x, y, z) * distance);
        let share = &mut |facet: usize, share: f64| {
            let (facet, lost) = (facet as u32, trace.lost.map(|energy| energy * share));
            left.shares.push(Share { boundary, facet, wear: wear * share, lost });
        };
        match (touched.at.deformed(), &self.touched) {
            (Some(mesh), _) => mesh.share_out(touched.feature[contact], foot, share),
            (None, Touched::Features(shape)) => shape.share_out(touched.feature[contact], foot, share),
            _ => share(0, 1.0),
        }
    }

    /// Ends impacts of particles that touch no feature any more, at these entries of before.
    fn end_features(&self, past: &PreviousContacts, entries: std::ops::Range<usize>, left: &mut Left) {
        let (Some(follower), Some(_)) = (&self.follower, follows(self)) else { return };
        for entry in entries {
            let record = remembered_of(past, entry..entry + 1, self.law.law.history_places().impact);
            if record.begun {
                left.ended.push(follower.ended(past.particle[entry], record));
            }
        }
    }

    /// Ends the impacts of particles (slots) that go.
    pub(super) fn end_impacts(&self, state: &mut State, goes: &[bool]) {
        let (Some(follower), Some(place)) = (&self.follower, follows(self)) else { return };
        let (mut left, list) = (Left::default(), self.list(state));
        for (entry, &slot) in list.particle.iter().enumerate().filter(|(_, slot)| goes[**slot as usize]) {
            let record = remembered(list.history.get(entry), Some(place));
            if record.begun {
                left.ended.push(follower.ended(slot, record));
            }
        }
        left.book(&follower.scene, state);
    }
}

/// Where the contacts of a surface remember impacts, if they do.
fn follows(surface: &AtSurface) -> Option<usize> {
    surface.law.law.history_places().impact
}

/// The impact that some entries of before remember: one of them does.
fn remembered_of(past: &PreviousContacts, entries: std::ops::Range<usize>, place: Option<usize>) -> ImpactRecord {
    let Some(place) = place else { return ImpactRecord::default() };
    let of = |entry: usize| ImpactRecord::of_rows([past.row(entry, place), past.row(entry, place + 1)]);
    entries.map(of).find(|record| record.begun).unwrap_or_default()
}

/// The entry of the contact that presses most.
fn strongest(contacts: &[Trace]) -> Option<u32> {
    let more = |one: &Trace, other: &Trace| other.force > one.force;
    let found = contacts.iter().reduce(|one, other| if more(one, other) { other } else { one });
    found.map(|trace| trace.entry)
}
