//! States that are saved, restored and turned into bytes.

use super::{Instance, SavedState, StartedSimulation};
use crate::calls::Phase;
use crate::guard;
use crate::host_memory::Target;
use crate::refusal::Refusal;
use crate::saved::{BlobError, Saved};

impl Instance {
    /// `fmi2GetFMUstate`: over the state at `address`, or anew if that is 0. Yields the address.
    pub(crate) fn save(&mut self, address: usize) -> Result<usize, Refusal> {
        if address != 0 && !self.kept.contains_key(&address) {
            return Err(Refusal::Handle);
        }
        self.make()?;
        let (state, given) = (self.simulation.state().clone(), self.made_with.clone());
        let saved = Saved { state, course: self.course, given };
        Ok(self.keep(saved, address))
    }

    /// Keeps a state at `address`, or at a new one if this unit has none there. Yields the address.
    fn keep(&mut self, saved: Saved, address: usize) -> usize {
        if let Some(kept) = self.kept.get_mut(&address) {
            *kept = SavedState { saved, bytes: None };
            return address;
        }
        let address = guard::fresh_address();
        self.kept.insert(address, SavedState { saved, bytes: None });
        address
    }

    /// `fmi2SetFMUstate`
    pub(crate) fn restore(&mut self, address: usize) -> Result<(), Refusal> {
        let SavedState { saved, .. } = self.kept.get(&address).ok_or(Refusal::Handle)?;
        let other = if saved.given == self.made_with { None } else { Some(self.made_with_those_of(saved)?) };
        let course = saved.course;
        // Kept states are those of this instance, or were checked as they came in; a simulation made anew has not seen them yet.
        if let Some(begun) = other {
            begun.simulation.check(&saved.state).map_err(|fault| BlobError::State(fault.into()))?;
            self.given.clone_from(&begun.given);
            self.take(begun);
        }
        self.given.clone_from(&self.made_with);
        self.changed();
        self.simulation.return_to(&self.kept[&address].saved.state);
        self.course = course;
        match course.phase {
            Phase::Ready | Phase::Discarded => self.frames.go_back(&self.simulation, self.start_time(), self.time()),
            Phase::Instantiated | Phase::Initialization => self.frames.undo(),
            Phase::Terminated | Phase::Broken => {}
        }
        Ok(())
    }

    /// `fmi2FreeFMUstate`; freeing nothing is fine.
    pub(crate) fn forget(&mut self, address: usize) -> Result<(), Refusal> {
        if address == 0 {
            return Ok(());
        }
        self.kept.remove(&address).map(drop).ok_or(Refusal::Handle)
    }

    /// Bytes of a saved state.
    fn bytes(&mut self, address: usize) -> Result<&mut Option<Vec<u8>>, Refusal> {
        let kept = self.kept.get_mut(&address).ok_or(Refusal::Handle)?;
        if kept.bytes.is_none() {
            kept.bytes = Some(kept.saved.to_bytes(&self.unit.identity, self.unit.scene.fingerprint));
        }
        Ok(&mut kept.bytes)
    }

    /// `fmi2SerializedFMUstateSize`
    pub(crate) fn serialized_size(&mut self, address: usize) -> Result<usize, Refusal> {
        Ok(self.bytes(address)?.as_ref().map_or(0, Vec::len))
    }

    /// `fmi2SerializeFMUstate`: a large buffer is filled to the number of bytes there are.
    pub(crate) fn serialize(&mut self, address: usize, buffer: &Target<u8>) -> Result<(), Refusal> {
        let given = buffer.len();
        let kept = self.bytes(address)?;
        let needed = kept.as_ref().map_or(0, Vec::len);
        if given < needed {
            return Err(Refusal::Size { given, needed });
        }
        // the bytes are as large as the state; they are made again if they are asked for again
        buffer.put_all(&kept.take().unwrap_or_default());
        Ok(())
    }

    /// `fmi2DeSerializeFMUstate`: over the state at `address`, or anew. Yields the address.
    pub(crate) fn deserialize(&mut self, bytes: &[u8], address: usize) -> Result<usize, Refusal> {
        if address != 0 && !self.kept.contains_key(&address) {
            return Err(Refusal::Handle);
        }
        let saved = Saved::from_bytes(bytes, &self.unit.identity, self.unit.scene.fingerprint)?;
        for (&index, &value) in &saved.given {
            self.unit.interface.check(index, value)?;
        }
        let other = if saved.given == self.made_with { None } else { Some(self.made_with_those_of(&saved)?) };
        let simulation = other.as_ref().map_or(&self.simulation, |begun| &begun.simulation);
        simulation.check(&saved.state).map_err(|fault| BlobError::State(fault.into()))?;
        Ok(self.keep(saved, address))
    }

    /// A simulation with the parameters of a saved state.
    fn made_with_those_of(&self, saved: &Saved) -> Result<StartedSimulation, Refusal> {
        self.unit.begin(saved.given.clone()).map_err(|error| Refusal::Parameters { error: error.to_string() })
    }
}
