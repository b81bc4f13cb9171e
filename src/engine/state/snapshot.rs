//! The state as bytes, with a version, a checksum and the fingerprint of its scene.

use super::{State, StateFault};
use crate::laws::bond;
use crate::laws::contact;
use std::io::{self, Seek, SeekFrom, Write};
use std::sync::OnceLock;
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

/// The first bytes of every snapshot.
const MAGIC: &[u8; 8] = b"cograin\0";

/// Version of the header.
const VERSION: u32 = 7;

/// Length of the header: magic, version, schema, scene fingerprint, checksum.
const HEADER: usize = 8 + 4 + 8 + 8 + 8;

/// The structs and enumerations of the state as text (`build.rs`).
const SCHEMA: &str = include_str!(concat!(env!("OUT_DIR"), "/state_schema.txt"));

/// A number that differs when any field of the state differs in name, type or place, or a law of the program remembers
/// something else.
fn schema() -> u64 {
    /// It is the same for a whole process.
    static SCHEMA: OnceLock<u64> = OnceLock::new();
    *SCHEMA.get_or_init(|| xxh3_64(described().as_bytes()))
}

/// The fields of the state, and what laws of contacts and bonds keep in its rows, which are numbers alone.
fn described() -> String {
    SCHEMA.to_owned() + &contact::remembered() + &bond::remembered()
}

/// Why serialising a state into memory cannot fail.
const WRITABLE: &str = "a state holds nothing that postcard cannot write";

/// The header.
fn header(scene_fingerprint: u64, checksum: u64) -> [u8; HEADER] {
    let mut header = [0; HEADER];
    header[..8].copy_from_slice(MAGIC);
    header[8..12].copy_from_slice(&VERSION.to_le_bytes());
    header[12..20].copy_from_slice(&schema().to_le_bytes());
    header[20..28].copy_from_slice(&scene_fingerprint.to_le_bytes());
    header[28..].copy_from_slice(&checksum.to_le_bytes());
    header
}

/// Why bytes are not a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SnapshotError {
    /// Not a snapshot.
    #[error("not a cograin state: the first bytes are other than \"cograin\"")]
    Foreign,
    /// A header of another version.
    #[error("expected a state of layout version {expected}, found one of version {found}")]
    Version {
        /// Version in the bytes.
        found: u32,
        /// Version of this program.
        expected: u32,
    },
    /// Written by a program whose state has other fields.
    #[error(
        "expected the schema {expected:016x} of particles, contacts and bonds, found {found:016x}, that of another \
         build of this program"
    )]
    Schema {
        /// Schema in the bytes.
        found: u64,
        /// Schema of this program.
        expected: u64,
    },
    /// Undamaged, but not a state of this scene.
    #[error(transparent)]
    Fault(#[from] StateFault),
    /// A state of another scene.
    #[error("expected the fingerprint {expected:016x} of this scene, found {found:016x}, that of another scene")]
    Scene {
        /// Fingerprint in the bytes.
        found: u64,
        /// Fingerprint of the scene.
        expected: u64,
    },
    /// Damaged or cut short.
    #[error("damaged state: the checksum does not fit")]
    Damaged,
}

/// Where the bytes go: into memory, a file, or a checksum. One type for all three, so that the code that writes a state is
/// compiled once.
struct Flowing<'a>(&'a mut dyn Take);

/// Takes bytes.
trait Take {
    /// These ones.
    fn take(&mut self, bytes: &[u8]) -> io::Result<()>;
}

impl Take for Vec<u8> {
    fn take(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.extend_from_slice(bytes);
        Ok(())
    }
}

impl Take for Xxh3 {
    fn take(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.update(bytes);
        Ok(())
    }
}

/// A file, the checksum of the bytes written to it, and the first error.
struct Checked<'a> {
    /// The file.
    file: &'a mut dyn Write,
    /// Checksum so far.
    checksum: Xxh3,
    /// What went wrong.
    failed: Option<io::Error>,
}

impl Take for Checked<'_> {
    fn take(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.checksum.update(bytes);
        self.file.write_all(bytes).map_err(|error| {
            let kind = error.kind();
            self.failed = Some(error);
            kind.into()
        })
    }
}

impl postcard::ser_flavors::Flavor for Flowing<'_> {
    type Output = ();

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.try_extend(&[byte])
    }

    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        self.0.take(bytes).map_err(|_| postcard::Error::SerializeBufferFull)
    }

    fn finalize(self) -> postcard::Result<()> {
        Ok(())
    }
}

impl State {
    /// The state as bytes, from which [`State::from_bytes`] restores it bit for bit.
    pub fn to_bytes(&self, scene_fingerprint: u64) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.size());
        bytes.extend_from_slice(&header(scene_fingerprint, 0));
        postcard::serialize_with_flavor(self, Flowing(&mut bytes)).expect(WRITABLE);
        let checksum = xxh3_64(&bytes[HEADER..]);
        bytes[..HEADER].copy_from_slice(&header(scene_fingerprint, checksum));
        bytes
    }

    /// Writes the same bytes to a file, list by list: memory for all of them is not needed.
    pub fn write_to(&self, scene_fingerprint: u64, file: &mut (impl Write + Seek)) -> io::Result<()> {
        let begin = file.stream_position()?;
        file.write_all(&header(scene_fingerprint, 0))?;
        let mut checked = Checked { file: &mut *file, checksum: Xxh3::new(), failed: None };
        let written = postcard::serialize_with_flavor(self, Flowing(&mut checked));
        if let Some(error) = checked.failed {
            return Err(error);
        }
        written.expect(WRITABLE);
        let checksum = checked.checksum.digest();
        file.seek(SeekFrom::Start(begin))?;
        file.write_all(&header(scene_fingerprint, checksum))
    }

    /// Restores a state that [`State::to_bytes`] wrote for the same scene. Whether it fits the scene is checked by
    /// [`Simulation::resume`](crate::engine::simulation::Simulation::resume) and
    /// [`Simulation::check`](crate::engine::simulation::Simulation::check).
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
        let found = number(12).ok_or(SnapshotError::Damaged)?;
        if found != schema() {
            return Err(SnapshotError::Schema { found, expected: schema() });
        }
        let scene = number(20).ok_or(SnapshotError::Damaged)?;
        if scene != scene_fingerprint {
            return Err(SnapshotError::Scene { found: scene, expected: scene_fingerprint });
        }
        let checksum = number(28).ok_or(SnapshotError::Damaged)?;
        let payload = bytes.get(HEADER..).ok_or(SnapshotError::Damaged)?;
        if xxh3_64(payload) != checksum {
            return Err(SnapshotError::Damaged);
        }
        postcard::from_bytes(payload).map_err(|_| SnapshotError::Damaged)
    }

    /// A number that differs when any bit of the state differs.
    pub fn fingerprint(&self) -> u64 {
        let mut hash = Xxh3::new();
        postcard::serialize_with_flavor(self, Flowing(&mut hash)).expect(WRITABLE);
        hash.digest()
    }

    /// An estimate of the length of a snapshot, so that memory is requested once.
    fn size(&self) -> usize {
        let row = size_of::<super::Row>();
        let particles = self.particles.len() * (8 * row + 24 + 8 * self.particles.declared.len());
        let lists = self.contacts.iter().map(|list| list.first.len() * (list.history.rows() * row + 17));
        let planes = self.walls.iter().map(|list| list.particle.len() * (list.history.rows() * row + 17));
        let bonds = self.bonds.iter().map(|list| list.first.len() * (list.rows.len() * row + 8));
        let contacts = lists.chain(planes).sum::<usize>();
        4096 + 1024 * self.boundaries.len() + particles + contacts + bonds.sum::<usize>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_and_what_the_laws_remember_belong_to_the_schema() {
        let described = described();
        for part in [
            "pub struct State {\npub clock: Clock,\n",
            "pub position: Vec<Row>,\n#[serde(with = \"plain\")]\npub velocity: Vec<Row>,\n",
            "struct Losses",
            "enum Source {\n",
            "history: tangential spring [true, true, true, false]",
            "eepa: plastic overlap, overlap before [false, false, false, false]",
            "epsd2: rolling torque [true, true, true, false]",
            "incremental: shear force x y z, free length; bending torque x y z, torsion",
            "engine_exact: ",
            "finite_rotation: axis in the first body",
        ] {
            assert!(described.contains(part), "{part} is missing in:\n{described}");
        }
    }
}
