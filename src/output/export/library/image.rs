//! Machine code: which machine it is for, whether it is a library of units, and of which program.

use super::LibraryError;
use crate::interface::Standard;
use crate::output::export::functions::FUNCTIONS;
use object::read::NameOrOrdinal;
use object::read::macho::{FatArch, MachOFatFile32, MachOFatFile64};
use object::{Architecture, BinaryFormat, FileFlags, FileKind, Object, ObjectKind};
use std::collections::BTreeSet;
use std::path::Path;

/// Text that stands in a library of units that was built from these sources, and in no other.
pub const LIBRARY_MARK: &str =
    concat!("cograin FMI 2.0 library, version ", env!("CARGO_PKG_VERSION"), ", build ", env!("COGRAIN_BUILD"), ";");

/// How marks begin, those of other versions, too.
const MARK_BEGINS: &str = "cograin FMI 2.0 library, ";

/// A mark is no longer.
const LONGEST_MARK: usize = 120;

/// What a mark, whole or after its begin, says of the program.
pub(super) fn built_by(mark: &str) -> &str {
    mark.trim_start_matches(MARK_BEGINS).trim_end_matches(';')
}

/// How FMI names a kind of machine.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::output::export) struct Platform {
    /// Folder of the library in a unit of FMI 2.0.
    pub(super) folder: String,
    /// The same in one of FMI 3.0.
    tuple: String,
    /// End of the library's name.
    pub(in crate::output::export) suffix: &'static str,
}

impl Platform {
    /// Folder of the library in a unit.
    pub(in crate::output::export) fn folder(&self, standard: Standard) -> &str {
        match standard {
            Standard::Fmi2 => &self.folder,
            Standard::Fmi3 => &self.tuple,
        }
    }

    /// Whether an edition calls it so.
    pub(super) fn is_named(&self, name: &str) -> bool {
        [&self.folder, &self.tuple].into_iter().any(|own| own == name)
    }
}

/// Machine code for one processor.
pub(super) struct Image<'a> {
    /// The file, or that part of it.
    file: object::File<'a>,
    /// Its bytes.
    bytes: &'a [u8],
}

/// What a mark says of the program that it was built with, if it is one.
fn told(mark: &[u8]) -> Option<&str> {
    let end = mark.iter().take(LONGEST_MARK).position(|byte| *byte == b';')?;
    let text = std::str::from_utf8(&mark[..end]).ok().map(built_by)?;
    text.chars().all(|letter| letter.is_ascii_graphic() || letter == ' ').then_some(text)
}

impl<'a> Image<'a> {
    /// The shared library that the bytes are, for each of its processors, or what they are instead.
    pub(super) fn all_of(bytes: &'a [u8]) -> Result<Vec<Self>, String> {
        let parts = match FileKind::parse(bytes) {
            Err(_) => return Err("another file".to_owned()),
            Ok(FileKind::MachOFat32) => parts_of(MachOFatFile32::parse(bytes).map_err(damaged)?.arches(), bytes)?,
            Ok(FileKind::MachOFat64) => parts_of(MachOFatFile64::parse(bytes).map_err(damaged)?.arches(), bytes)?,
            Ok(_) => vec![bytes],
        };
        parts.into_iter().map(Self::of).collect()
    }

    /// The shared library for one processor.
    fn of(bytes: &'a [u8]) -> Result<Self, String> {
        let file = object::File::parse(bytes).map_err(damaged)?;
        match file.kind() {
            ObjectKind::Dynamic => Ok(Self { file, bytes }),
            ObjectKind::Executable => Err("a program".to_owned()),
            _ => Err("an object file".to_owned()),
        }
    }

    /// Its bytes from each place where a mark may begin.
    fn marks(&self) -> impl Iterator<Item = &'a [u8]> {
        let (bytes, begin) = (self.bytes, MARK_BEGINS.as_bytes());
        bytes.windows(begin.len()).enumerate().filter(move |(_, window)| *window == begin).map(|(at, _)| &bytes[at..])
    }

    /// Refuses a library that is not this program's, or lacks a function.
    pub(super) fn check(&self, path: &Path) -> Result<(), LibraryError> {
        let path_of = || path.to_owned();
        let marks: Vec<&[u8]> = self.marks().collect();
        if !marks.iter().any(|mark| mark.starts_with(LIBRARY_MARK.as_bytes())) {
            // Of the library's own texts that begin likewise the mark tells most.
            return Err(match marks.into_iter().filter_map(told).max_by_key(|found| found.len()) {
                Some(found) => LibraryError::Other { path: path_of(), found: found.to_owned() },
                None => LibraryError::Foreign { path: path_of() },
            });
        }
        let functions = self.functions().map_err(|found| LibraryError::Kind { path: path_of(), found })?;
        match FUNCTIONS.concat().into_iter().find(|name| !functions.contains(name.as_bytes())) {
            Some(missing) => Err(LibraryError::Function { path: path_of(), missing }),
            None => Ok(()),
        }
    }

    /// The machines that it is for, or their name if FMI has none for them. FMI 2.0 has names of its own for x86 and, since 2.0.4,
    /// takes those of FMI 3.0 for other processors.
    pub(super) fn platform(&self) -> Result<Platform, String> {
        /// Values of the ELF header's field for the system that Linux uses: none, and GNU.
        const LINUX: [u8; 2] = [0, 3];
        let (format, processor) = (self.file.format(), self.file.architecture());
        let linux = !matches!(self.file.flags(), FileFlags::Elf { os_abi, .. } if !LINUX.contains(&os_abi.0));
        let (system, name, short, suffix) = match format {
            BinaryFormat::Elf if linux => ("Linux", "linux", "linux", ".so"),
            BinaryFormat::Pe => ("Windows", "windows", "win", ".dll"),
            BinaryFormat::MachO => ("macOS", "darwin", "darwin", ".dylib"),
            _ => ("another system", "", "", ""),
        };
        let named = match processor {
            _ if name.is_empty() => None,
            Architecture::I386 => Some((format!("{short}32"), "x86")),
            Architecture::X86_64 => Some((format!("{short}64"), "x86_64")),
            Architecture::Arm => Some((format!("aarch32-{name}"), "aarch32")),
            Architecture::Aarch64 => Some((format!("aarch64-{name}"), "aarch64")),
            Architecture::Riscv32 => Some((format!("riscv32-{name}"), "riscv32")),
            Architecture::Riscv64 => Some((format!("riscv64-{name}"), "riscv64")),
            _ => None,
        };
        let machine = || format!("{system} on {}", format!("{processor:?}").to_lowercase());
        let (folder, processor) = named.ok_or_else(machine)?;
        Ok(Platform { folder, tuple: format!("{processor}-{name}"), suffix })
    }

    /// Names of the functions that it offers, as C has them.
    fn functions(&self) -> Result<BTreeSet<Vec<u8>>, String> {
        let underscore: &[u8] = if self.file.format() == BinaryFormat::MachO { b"_" } else { b"" };
        let mut names = BTreeSet::new();
        for export in self.file.exports().map_err(damaged)? {
            if let NameOrOrdinal::Name(name) = export.map_err(damaged)?.name() {
                names.extend(name.strip_prefix(underscore).map(<[u8]>::to_vec));
            }
        }
        Ok(names)
    }
}

/// Of a file for several processors the part for each.
fn parts_of<'a>(parts: &[impl FatArch], bytes: &'a [u8]) -> Result<Vec<&'a [u8]>, String> {
    let parts: Vec<_> = parts.iter().map(|part| part.data(bytes)).collect::<Result<_, _>>().map_err(damaged)?;
    if parts.is_empty() { Err("a damaged one: it has no part".to_owned()) } else { Ok(parts) }
}

/// What is said of a file that cannot be read to its end.
fn damaged(error: object::Error) -> String {
    format!("a damaged one: {error}")
}
