//! The library that a unit carries: where it is looked for, and whether it is the right one.

use super::functions::FUNCTIONS;
use crate::interface::Standard;
use object::read::NameOrOrdinal;
use object::read::macho::{FatArch, MachOFatFile32, MachOFatFile64};
use object::{Architecture, BinaryFormat, FileFlags, FileKind, Object, ObjectKind};
use std::collections::{BTreeMap, BTreeSet};
use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Names the library's file where no path is given.
pub const ENVIRONMENT_VARIABLE: &str = "COGRAIN_FMU_LIBRARY";

/// Name of the library with the sub-models of the program.
pub const STANDARD_LIBRARY: &str = "cograin_fmu";

/// Text that stands in a library of units that was built from these sources, and in no other.
pub const LIBRARY_MARK: &str =
    concat!("cograin FMI 2.0 library, version ", env!("CARGO_PKG_VERSION"), ", build ", env!("COGRAIN_BUILD"), ";");

/// How marks begin, those of other versions, too.
const MARK_BEGINS: &str = "cograin FMI 2.0 library, ";

/// A mark is no longer.
const LONGEST_MARK: usize = 120;

/// What a mark, whole or after its begin, says of the program.
fn built_by(mark: &str) -> &str {
    mark.trim_start_matches(MARK_BEGINS).trim_end_matches(';')
}

/// Why there is no library to package.
#[derive(Debug, thiserror::Error)]
pub enum LibraryError {
    /// It was found nowhere.
    #[error(
        "the unit's library was not found; looked at {}; build it with `cargo build --release`, or name it (--library, or the environment variable {ENVIRONMENT_VARIABLE})",
        list(looked_at)
    )]
    NotFound {
        /// Where it was looked for.
        looked_at: Vec<PathBuf>,
    },
    /// It cannot be read.
    #[error("{}: {cause}; name the unit's library", path.display())]
    Read {
        /// Its path.
        path: PathBuf,
        /// What the system said.
        cause: io::Error,
    },
    /// It is another kind of file.
    #[error("{}: expected a shared library (ELF, PE or Mach-O), found {found}", path.display())]
    Kind {
        /// Its path.
        path: PathBuf,
        /// What it is.
        found: String,
    },
    /// It is another library.
    #[error("{}: expected a library of cograin's units, found one without the mark \"{LIBRARY_MARK}\"", path.display())]
    Foreign {
        /// Its path.
        path: PathBuf,
    },
    /// It was built from other sources.
    #[error(
        "{}: expected the library of this program, {}, found that of {found}; build both from the same sources",
        path.display(),
        built_by(LIBRARY_MARK)
    )]
    Other {
        /// Its path.
        path: PathBuf,
        /// The version and the build that its mark tells.
        found: String,
    },
    /// It lacks a function.
    #[error("{}: expected the functions of FMI 2.0 and 3.0, found none called {missing}", path.display())]
    Function {
        /// Its path.
        path: PathBuf,
        /// The first one that is missing.
        missing: &'static str,
    },
    /// FMI has no name for its system.
    #[error("{}: expected a library for Linux, Windows or macOS on a processor that FMI has a name for, found one for {found}", path.display())]
    Platform {
        /// Its path.
        path: PathBuf,
        /// The system and processor.
        found: String,
    },
    /// Two of them would stand in one place.
    #[error("expected one library for {folder}, found {} and {}", paths[0].display(), paths[1].display())]
    Twice {
        /// The place.
        folder: String,
        /// The two libraries.
        paths: [PathBuf; 2],
    },
}

/// Paths, one after the other.
fn list(paths: &[PathBuf]) -> String {
    paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}

/// How FMI names a kind of machine.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Platform {
    /// Folder of the library in a unit of FMI 2.0.
    folder: String,
    /// The same in one of FMI 3.0.
    tuple: String,
    /// End of the library's name.
    pub(super) suffix: &'static str,
}

impl Platform {
    /// Folder of the library in a unit.
    pub(super) fn folder(&self, standard: Standard) -> &str {
        match standard {
            Standard::Fmi2 => &self.folder,
            Standard::Fmi3 => &self.tuple,
        }
    }
}

/// A library that a unit carries.
#[derive(Debug)]
pub(super) struct Library {
    /// The kind of machine that finds it in its folder.
    pub(super) platform: Platform,
    /// Its bytes.
    pub(super) bytes: Vec<u8>,
}

impl Library {
    /// The libraries at these paths, in the order of their folders, if all are libraries of units for different machines.
    pub(super) fn read_all(paths: &[PathBuf]) -> Result<Vec<Self>, LibraryError> {
        let mut found: BTreeMap<Platform, (&PathBuf, Vec<u8>)> = BTreeMap::new();
        for path in paths {
            let (platforms, bytes) = Self::read(path)?;
            for platform in platforms {
                let folder = platform.folder.clone();
                if let Some((other, _)) = found.insert(platform, (path, bytes.clone())) {
                    return Err(LibraryError::Twice { folder, paths: [other.clone(), path.clone()] });
                }
            }
        }
        Ok(found.into_iter().map(|(platform, (_, bytes))| Self { platform, bytes }).collect())
    }

    /// The file at a path, if it is a library of units, and the machines that it is for: several where it holds code for several
    /// processors, as those of a Mac.
    fn read(path: &Path) -> Result<(BTreeSet<Platform>, Vec<u8>), LibraryError> {
        let path_of = || path.to_owned();
        let bytes = fs::read(path).map_err(|cause| LibraryError::Read { path: path_of(), cause })?;
        let images = Image::all_of(&bytes).map_err(|found| LibraryError::Kind { path: path_of(), found })?;
        let mut platforms = BTreeSet::new();
        for image in &images {
            let marks: Vec<&[u8]> = image.marks().collect();
            if !marks.iter().any(|mark| mark.starts_with(LIBRARY_MARK.as_bytes())) {
                // Of the library's own texts that begin likewise the mark tells most.
                return Err(match marks.into_iter().filter_map(told).max_by_key(|found| found.len()) {
                    Some(found) => LibraryError::Other { path: path_of(), found: found.to_owned() },
                    None => LibraryError::Foreign { path: path_of() },
                });
            }
            platforms.insert(image.platform().map_err(|found| LibraryError::Platform { path: path_of(), found })?);
            let functions = image.functions().map_err(|found| LibraryError::Kind { path: path_of(), found })?;
            if let Some(missing) = FUNCTIONS.concat().into_iter().find(|name| !functions.contains(name.as_bytes())) {
                return Err(LibraryError::Function { path: path_of(), missing });
            }
        }
        Ok((platforms, bytes))
    }
}

/// Machine code for one processor.
struct Image<'a> {
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
    fn all_of(bytes: &'a [u8]) -> Result<Vec<Self>, String> {
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

    /// The machines that it is for, or their name if FMI has none for them. FMI 2.0 has names of its own for x86 and, since 2.0.4,
    /// takes those of FMI 3.0 for other processors.
    fn platform(&self) -> Result<Platform, String> {
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

/// Finds the libraries: at the paths given, one for each platform, else where [`ENVIRONMENT_VARIABLE`] says, else beside the running
/// program, in the folder above it, or in `../lib/cograin`; there it has the name that the crate has which makes it.
pub fn find_libraries(name: &str, given: &[PathBuf]) -> Result<Vec<PathBuf>, LibraryError> {
    if let Some(missing) = given.iter().find(|path| !path.is_file()) {
        return Err(LibraryError::NotFound { looked_at: vec![missing.clone()] });
    }
    if !given.is_empty() {
        return Ok(given.to_vec());
    }
    let named = env::var_os(ENVIRONMENT_VARIABLE).map(|path| vec![PathBuf::from(path)]);
    let looked_at = named.unwrap_or_else(|| beside(name, env::current_exe().ok()));
    match looked_at.iter().find(|path| path.is_file()) {
        Some(path) => Ok(vec![path.clone()]),
        None => Err(LibraryError::NotFound { looked_at }),
    }
}

/// Where the library of this name may stand when the program stands at `program`.
fn beside(name: &str, program: Option<PathBuf>) -> Vec<PathBuf> {
    let name = format!("{}{name}{}", env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
    // programs of tests stand one folder below the library
    let folders = program.into_iter().flat_map(|program| {
        let folder = program.parent().map(Path::to_owned);
        let above = folder.as_deref().and_then(Path::parent).map(Path::to_owned);
        let installed = above.as_ref().map(|above| above.join("lib").join("cograin"));
        [folder, above, installed]
    });
    folders.flatten().map(|folder| folder.join(&name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::export::sample_library::{self as sample, Sample};
    use crate::output::scratch::Scratch;

    /// The name by which the library at a path of this test is refused, or the folders that it gets.
    fn verdict(name: &str, bytes: &[u8]) -> Result<String, String> {
        let folder = Scratch::new();
        let path = folder.join(name);
        fs::write(&path, bytes).unwrap();
        let folders = |platforms: BTreeSet<Platform>| platforms.into_iter().map(|it| it.folder).collect::<Vec<_>>();
        let read = Library::read(&path);
        read.map(|(platforms, _)| folders(platforms).join(" ")).map_err(|error| error.to_string())
    }

    #[test]
    fn a_library_that_is_nowhere_is_reported_with_every_place() {
        let missing = PathBuf::from("no/such/library.so");
        let message = find_libraries(STANDARD_LIBRARY, &[missing]).unwrap_err().to_string();
        assert!(message.contains("no/such/library.so"), "{message}");
        assert!(message.contains("cargo build --release"), "{message}");
    }

    #[test]
    fn the_library_is_looked_for_beside_above_and_in_lib() {
        let name = format!("{}cograin_fmu{}", env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
        let expected = ["/usr/bin", "/usr", "/usr/lib/cograin"].map(|folder| Path::new(folder).join(&name));
        assert_eq!(beside(STANDARD_LIBRARY, Some("/usr/bin/cograin".into())), expected);
    }

    #[test]
    fn every_system_that_fmi_names_gets_its_folder() {
        for (made, folder) in [
            (Sample::LINUX, "linux64"),
            (Sample { bits: 32, ..Sample::LINUX }, "linux32"),
            (Sample::WINDOWS, "win64"),
            (Sample { bits: 32, ..Sample::WINDOWS }, "win32"),
            (Sample::MACOS, "darwin64"),
            (Sample { arm: true, ..Sample::LINUX }, "aarch64-linux"),
            (Sample { arm: true, bits: 32, ..Sample::LINUX }, "aarch32-linux"),
            (Sample { arm: true, ..Sample::WINDOWS }, "aarch64-windows"),
            (Sample { arm: true, ..Sample::MACOS }, "aarch64-darwin"),
        ] {
            assert_eq!(verdict(folder, &made.bytes()).as_deref(), Ok(folder));
        }
        let both = [Sample { arm: true, ..Sample::MACOS }, Sample::MACOS];
        let folders = verdict("universal", &sample::universal(&both));
        assert_eq!(folders.as_deref(), Ok("aarch64-darwin darwin64"), "one file for both processors of a Mac");
        let half = [both[0], Sample { without: "fmi2DoStep", ..both[1] }];
        assert!(verdict("half", &sample::universal(&half)).unwrap_err().ends_with("found none called fmi2DoStep"));
    }

    #[test]
    fn other_machines_are_named() {
        let message = verdict("system", &Sample { system: 9, ..Sample::LINUX }.bytes()).unwrap_err();
        assert!(message.ends_with("found one for another system on x86_64"), "{message}");
        let mut mips = Sample::LINUX.bytes();
        // The number of the processor stands at byte 18 of an ELF header; 8 is MIPS.
        mips[18] = 8;
        let message = verdict("processor", &mips).unwrap_err();
        assert!(message.ends_with("found one for Linux on mips64"), "{message}");
    }

    #[test]
    fn what_is_no_library_of_units_is_refused_by_what_it_is() {
        let refused = |bytes: &[u8]| verdict("kind", bytes).unwrap_err();
        assert!(refused(b"a text").ends_with("found another file"));
        assert!(refused(b"").ends_with("found another file"));
        assert!(refused(&Sample { shared: false, ..Sample::LINUX }.bytes()).ends_with("found a program"));
        let no_mark = Sample { mark: "", ..Sample::WINDOWS }.bytes();
        assert!(refused(&no_mark).contains("found one without the mark"));
        for made in [Sample::LINUX, Sample::WINDOWS, Sample::MACOS] {
            let other = Sample { mark: "cograin FMI 2.0 library, version 0.0.9;", ..made };
            let message = refused(&other.bytes());
            assert!(message.contains("found that of version 0.0.9; build both"), "{message}");
            let older = LIBRARY_MARK.replace(env!("COGRAIN_BUILD"), "0123456789abcdef");
            let message = refused(&[Sample { mark: "", ..made }.bytes(), older.into_bytes()].concat());
            assert!(
                message.contains(concat!(env!("CARGO_PKG_VERSION"), ", build 0123456789abcdef; build")),
                "{message}"
            );
            // Text that only begins like a mark hides none.
            let before = [Sample { mark: "cograin FMI 2.0 library, ", ..made }.bytes(), LIBRARY_MARK.into()].concat();
            assert!(verdict("before", &before).is_ok());
        }
        let mixed = [Sample { arm: true, ..Sample::MACOS }, Sample { mark: "", ..Sample::MACOS }];
        assert!(refused(&sample::universal(&mixed)).contains("without the mark"), "each part has its own");
        for made in [Sample::LINUX, Sample::WINDOWS, Sample::MACOS] {
            let message = refused(&Sample { without: "fmi2DoStep", ..made }.bytes());
            assert!(message.ends_with("found none called fmi2DoStep"), "{message}");
            // Whatever is cut off is missed and never read beyond. The mark takes the place of its last letters.
            let whole = Sample { mark: "", ..made }.bytes();
            for length in (0..whole.len() - 128).step_by(7) {
                assert!(verdict("cut", &[&whole[..length], LIBRARY_MARK.as_bytes()].concat()).is_err(), "{length}");
            }
        }
    }

    #[test]
    fn two_libraries_for_one_platform_are_refused_with_both_names() {
        let folder = Scratch::new();
        let paths = ["one", "two"].map(|name| folder.join(name));
        for path in &paths {
            fs::write(path, Sample::LINUX.bytes()).unwrap();
        }
        let message = Library::read_all(&paths).unwrap_err().to_string();
        for path in &paths {
            assert!(message.contains(&path.display().to_string()), "{message}");
        }
        assert!(message.starts_with("expected one library for linux64, found "), "{message}");
    }
}
