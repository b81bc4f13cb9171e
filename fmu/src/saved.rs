//! Saved states of an instance, and their bytes.

use crate::calls::Phase;
use crate::instance::GivenParameters;
use crate::types::Status;
use cograin::state::State;
use cograin::state::snapshot::SnapshotError;
use xxhash_rust::xxh3::xxh3_64;

/// Everything of an instance that changes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Saved {
    /// Of the simulation.
    pub(crate) state: State,
    /// What else there is.
    pub(crate) course: Course,
    /// The parameters that the simulation was made with.
    pub(crate) given: GivenParameters,
}

/// What changes beside the simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Course {
    /// Where the instance stands.
    pub(crate) phase: Phase,
    /// Whether the boundaries stand where the start values of the inputs say.
    pub(crate) placed: bool,
    /// How the last communication step ended.
    pub(crate) last_step: Status,
    /// The host's time less the simulation's \[s\].
    pub(crate) origin: f64,
    /// Where the experiment ends, if anywhere \[s\].
    pub(crate) stop: Option<f64>,
}

/// What the bytes start with.
const MAGIC: &[u8; 8] = b"cogunit\0";
/// Version of the layout.
const VERSION: u32 = 3;
/// Length of what stands before the state: magic, version, length, checksum, three bytes, origin, stop, length of the GUID.
const HEADER: usize = CHECKED + 3 + 8 + 8 + 4;
/// Where the part begins that the checksum covers.
pub(crate) const CHECKED: usize = 8 + 4 + 8 + 8;

/// Why bytes are not a state of this unit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum BlobError {
    /// Another kind of data.
    #[error("expected the bytes of a serialised state, found no state of a cograin unit")]
    Foreign,
    /// Another layout.
    #[error("state of layout version {found}; this unit reads version {VERSION}")]
    Version {
        /// Version in the bytes.
        found: u32,
    },
    /// Another unit.
    #[error("state of the unit with GUID {found}; this is {expected}")]
    Unit {
        /// GUID in the bytes.
        found: String,
        /// GUID of this unit.
        expected: String,
    },
    /// Changed or cut.
    #[error("damaged state: its length or checksum does not fit")]
    Damaged,
    /// The simulation's part does not fit.
    #[error(transparent)]
    State(#[from] SnapshotError),
}

impl Saved {
    /// The state as bytes.
    pub(crate) fn to_bytes(&self, identity: &str, scene_fingerprint: u64) -> Vec<u8> {
        let state = self.state.to_bytes(scene_fingerprint);
        let mut bytes = Vec::with_capacity(HEADER + identity.len() + state.len());
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&[0; 16]);
        bytes.push(self.course.phase as u8);
        bytes.push(u8::from(self.course.placed));
        bytes.push(self.course.last_step as u8);
        bytes.extend_from_slice(&self.course.origin.to_le_bytes());
        bytes.extend_from_slice(&self.course.stop.unwrap_or(f64::INFINITY).to_le_bytes());
        // a GUID is some 36 bytes
        bytes.extend_from_slice(&u32::try_from(identity.len()).unwrap_or(u32::MAX).to_le_bytes());
        bytes.extend_from_slice(identity.as_bytes());
        bytes.extend_from_slice(&(self.given.len() as u64).to_le_bytes());
        for (&index, value) in &self.given {
            bytes.extend_from_slice(&(index as u64).to_le_bytes());
            bytes.extend_from_slice(&value.to_le_bytes());
        }
        bytes.extend_from_slice(&state);
        let length = (bytes.len() as u64).to_le_bytes();
        bytes[CHECKED - 16..CHECKED - 8].copy_from_slice(&length);
        let checksum = xxh3_64(&bytes[CHECKED..]).to_le_bytes();
        bytes[CHECKED - 8..CHECKED].copy_from_slice(&checksum);
        bytes
    }

    /// Whether bytes that begin so can be as many as these: an array is copied only then.
    pub(crate) fn check_length(head: &[u8], length: usize) -> Result<(), BlobError> {
        let mut reader = Reader { bytes: head };
        if reader.take::<8>() != Ok(*MAGIC) {
            return Err(BlobError::Foreign);
        }
        let version = u32::from_le_bytes(reader.take()?);
        if version != VERSION {
            return Err(BlobError::Version { found: version });
        }
        if u64::from_le_bytes(reader.take()?) == length as u64 { Ok(()) } else { Err(BlobError::Damaged) }
    }

    /// Reads what [`Saved::to_bytes`] wrote for the same unit.
    pub(crate) fn from_bytes(bytes: &[u8], identity: &str, scene_fingerprint: u64) -> Result<Self, BlobError> {
        Self::check_length(bytes, bytes.len())?;
        let mut reader = Reader { bytes: bytes.get(CHECKED - 8..).ok_or(BlobError::Damaged)? };
        let checksum = u64::from_le_bytes(reader.take()?);
        if xxh3_64(reader.bytes) != checksum {
            return Err(BlobError::Damaged);
        }
        let [phase, placed, last_step] = reader.take()?;
        let origin = f64::from_le_bytes(reader.take()?);
        let stop = f64::from_le_bytes(reader.take()?);
        let length = u32::from_le_bytes(reader.take()?) as usize;
        let found = reader.bytes.get(..length).ok_or(BlobError::Damaged)?;
        if found != identity.as_bytes() {
            let found = String::from_utf8_lossy(found).into_owned();
            return Err(BlobError::Unit { found, expected: identity.to_owned() });
        }
        if !origin.is_finite() || stop.is_nan() || stop == f64::NEG_INFINITY || placed > 1 {
            return Err(BlobError::Damaged);
        }
        let course = Course {
            phase: phase_of(phase)?,
            placed: placed != 0,
            last_step: status_of(last_step)?,
            origin,
            stop: stop.is_finite().then_some(stop),
        };
        reader.bytes = &reader.bytes[length..];
        let mut given = GivenParameters::new();
        for _ in 0..u64::from_le_bytes(reader.take()?) {
            given.insert(u64::from_le_bytes(reader.take()?) as usize, f64::from_le_bytes(reader.take()?));
        }
        Ok(Self { state: State::from_bytes(reader.bytes, scene_fingerprint)?, course, given })
    }
}

/// Bytes that are read from the front.
struct Reader<'a> {
    /// What is left.
    bytes: &'a [u8],
}

impl Reader<'_> {
    /// The next bytes.
    fn take<const N: usize>(&mut self) -> Result<[u8; N], BlobError> {
        let (taken, rest) = self.bytes.split_first_chunk().ok_or(BlobError::Damaged)?;
        self.bytes = rest;
        Ok(*taken)
    }
}

/// The phase that a byte stands for; a broken instance cannot be saved.
fn phase_of(byte: u8) -> Result<Phase, BlobError> {
    [Phase::Instantiated, Phase::Initialization, Phase::Ready, Phase::Discarded, Phase::Terminated]
        .into_iter()
        .find(|phase| *phase as u8 == byte)
        .ok_or(BlobError::Damaged)
}

/// The status that a byte stands for.
fn status_of(byte: u8) -> Result<Status, BlobError> {
    [Status::Ok, Status::Warning, Status::Discard, Status::Error]
        .into_iter()
        .find(|status| *status as u8 == byte)
        .ok_or(BlobError::Damaged)
}
