//! State as bytes: versioned, checksummed, tied to its scene.

use super::State;
use xxhash_rust::xxh3::xxh3_64;

/// What every snapshot starts with.
const MAGIC: &[u8; 8] = b"cograin\0";

/// Version of the layout; a change of any field of the state raises it.
const VERSION: u32 = 3;

/// Length of what stands before the payload: magic, version, scene fingerprint, checksum.
const HEADER: usize = 8 + 4 + 8 + 8;

/// Why bytes are not a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SnapshotError {
    /// Another kind of file.
    #[error("not a cograin state: the first bytes are other than \"cograin\"")]
    Foreign,
    /// Another layout.
    #[error("state of layout version {found}; this program reads version {expected}")]
    Version {
        /// Version in the bytes.
        found: u32,
        /// Version of this program.
        expected: u32,
    },
    /// Another scene.
    #[error("state of another scene: fingerprint {found:016x} found, {expected:016x} is right")]
    Scene {
        /// Fingerprint in the bytes.
        found: u64,
        /// Fingerprint of the scene.
        expected: u64,
    },
    /// Changed or cut.
    #[error("damaged state: the checksum does not fit")]
    Damaged,
}

impl State {
    /// The state as bytes that [`State::from_bytes`] takes back bit for bit.
    pub fn to_bytes(&self, scene_fingerprint: u64) -> Vec<u8> {
        let payload = postcard::to_stdvec(self).expect("a state holds nothing that postcard cannot write");
        let mut bytes = Vec::with_capacity(HEADER + payload.len());
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&scene_fingerprint.to_le_bytes());
        bytes.extend_from_slice(&xxh3_64(&payload).to_le_bytes());
        bytes.extend_from_slice(&payload);
        bytes
    }

    /// Reads what [`State::to_bytes`] wrote for the same scene.
    pub fn from_bytes(bytes: &[u8], scene_fingerprint: u64) -> Result<Self, SnapshotError> {
        let number = |from: usize| {
            bytes.get(from..from + 8).map(|part| u64::from_le_bytes(part.try_into().expect("eight bytes")))
        };
        if bytes.get(..8) != Some(MAGIC) {
            return Err(SnapshotError::Foreign);
        }
        let version = bytes.get(8..12).ok_or(SnapshotError::Damaged)?;
        let version = u32::from_le_bytes(version.try_into().expect("four bytes"));
        if version != VERSION {
            return Err(SnapshotError::Version { found: version, expected: VERSION });
        }
        let scene = number(12).ok_or(SnapshotError::Damaged)?;
        if scene != scene_fingerprint {
            return Err(SnapshotError::Scene { found: scene, expected: scene_fingerprint });
        }
        let checksum = number(20).ok_or(SnapshotError::Damaged)?;
        let payload = bytes.get(HEADER..).ok_or(SnapshotError::Damaged)?;
        if xxh3_64(payload) != checksum {
            return Err(SnapshotError::Damaged);
        }
        postcard::from_bytes(payload).map_err(|_| SnapshotError::Damaged)
    }

    /// A number that differs when any bit of the state differs.
    pub fn fingerprint(&self) -> u64 {
        xxh3_64(&postcard::to_stdvec(self).expect("a state holds nothing that postcard cannot write"))
    }
}
