//! The library that a unit carries: where it is looked for, and whether it is the right one.

mod image;

pub use image::LIBRARY_MARK;
pub(super) use image::Platform;

use image::{Image, built_by};
use std::collections::{BTreeMap, BTreeSet};
use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Names the library's file where no path is given.
pub const ENVIRONMENT_VARIABLE: &str = "COGRAIN_FMU_LIBRARY";

/// Name of the library with the sub-models of the program.
pub const STANDARD_LIBRARY: &str = "cograin_fmu";

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
    /// None is for a platform that was asked for.
    #[error("expected a platform whose library is there ({}), found {wanted}", there.join(", "))]
    Wanted {
        /// What was asked for.
        wanted: String,
        /// The platforms whose libraries are there.
        there: Vec<String>,
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

/// Files of libraries, and the platforms among theirs for which a unit carries one.
#[derive(Clone, Debug)]
pub struct Libraries {
    /// The files.
    pub paths: Vec<PathBuf>,
    /// Names of platforms, as either edition of FMI has them; without any, all.
    pub platforms: Vec<String>,
}

impl Libraries {
    /// Whether a unit carries a library for this platform.
    fn takes(&self, platform: &Platform) -> bool {
        self.platforms.is_empty() || self.platforms.iter().any(|name| platform.is_named(name))
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
    /// The libraries that a unit carries, in the order of their folders, if all are libraries of units for different machines.
    pub(super) fn read_all(libraries: &Libraries) -> Result<Vec<Self>, LibraryError> {
        let mut found: BTreeMap<Platform, (&PathBuf, Vec<u8>)> = BTreeMap::new();
        let mut there = BTreeSet::new();
        for path in &libraries.paths {
            let bytes = fs::read(path).map_err(|cause| LibraryError::Read { path: path.clone(), cause })?;
            let platforms = Self::platforms(path, &bytes, libraries)?;
            there.extend(platforms.iter().cloned());
            for platform in platforms.into_iter().filter(|platform| libraries.takes(platform)) {
                let folder = platform.folder.clone();
                if let Some((other, _)) = found.insert(platform, (path, bytes.clone())) {
                    return Err(LibraryError::Twice { folder, paths: [other.clone(), path.clone()] });
                }
            }
        }
        if let Some(wanted) = libraries.platforms.iter().find(|name| !found.keys().any(|it| it.is_named(name))) {
            let there = there.into_iter().map(|platform| platform.folder).collect();
            return Err(LibraryError::Wanted { wanted: wanted.clone(), there });
        }
        Ok(found.into_iter().map(|(platform, (_, bytes))| Self { platform, bytes }).collect())
    }

    /// The machines that a file is for: several where it holds code for several processors, as those of a Mac. Those parts that the
    /// unit carries must be libraries of units.
    fn platforms(path: &Path, bytes: &[u8], wanted: &Libraries) -> Result<BTreeSet<Platform>, LibraryError> {
        let path_of = || path.to_owned();
        let images = Image::all_of(bytes).map_err(|found| LibraryError::Kind { path: path_of(), found })?;
        let mut platforms = BTreeSet::new();
        for image in &images {
            let platform = image.platform().map_err(|found| LibraryError::Platform { path: path_of(), found })?;
            if wanted.takes(&platform) {
                image.check(path)?;
            }
            platforms.insert(platform);
        }
        Ok(platforms)
    }
}

/// Finds the libraries: at the paths given, one for each platform, else where [`ENVIRONMENT_VARIABLE`] says, else beside the running
/// program, in the folder above it, or in `../lib/cograin`; there they have the name that the crate has which makes them. That last
/// folder and those in it may hold libraries for several platforms; all are found.
pub fn find_libraries(name: &str, given: &[PathBuf]) -> Result<Vec<PathBuf>, LibraryError> {
    if let Some(missing) = given.iter().find(|path| !path.is_file()) {
        return Err(LibraryError::NotFound { looked_at: vec![missing.clone()] });
    }
    if !given.is_empty() {
        return Ok(given.to_vec());
    }
    match env::var_os(ENVIRONMENT_VARIABLE).map(PathBuf::from) {
        Some(path) if path.is_file() => Ok(vec![path]),
        Some(path) => Err(LibraryError::NotFound { looked_at: vec![path] }),
        None => beside(name, env::current_exe().ok()),
    }
}

/// The libraries of this name for the program that stands at `program`.
fn beside(name: &str, program: Option<PathBuf>) -> Result<Vec<PathBuf>, LibraryError> {
    let own = format!("{}{name}{}", env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
    let folder = program.as_deref().and_then(Path::parent);
    // programs of tests stand one folder below the library
    let above = folder.and_then(Path::parent);
    let mut looked_at: Vec<PathBuf> = [folder, above].into_iter().flatten().map(|folder| folder.join(&own)).collect();
    if let Some(built) = looked_at.iter().find(|path| path.is_file()) {
        return Ok(vec![built.clone()]);
    }
    let installed = above.map(|above| above.join("lib").join("cograin"));
    let found = installed.as_deref().map_or_else(Vec::new, |folder| installed_in(folder, name));
    looked_at.extend(installed.map(|folder| folder.join(&own)));
    if found.is_empty() { Err(LibraryError::NotFound { looked_at }) } else { Ok(found) }
}

/// The libraries of this name in a folder and in those that stand in it, for any system.
fn installed_in(folder: &Path, name: &str) -> Vec<PathBuf> {
    let names = [format!("lib{name}.so"), format!("{name}.dll"), format!("lib{name}.dylib")];
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let folders = std::iter::once(folder.to_owned()).chain(entries.filter(|path| path.is_dir()));
    let mut found: Vec<PathBuf> = folders.flat_map(|folder| names.clone().map(|name| folder.join(name))).collect();
    found.retain(|path| path.is_file());
    found.sort();
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::export::sample_library::{self as sample, Sample};
    use crate::output::scratch::Scratch;

    /// The name by which the library at a path of this test is refused, or the folders that it gets.
    fn verdict(name: &str, bytes: &[u8]) -> Result<String, String> {
        let path = PathBuf::from(name);
        let folders = |platforms: BTreeSet<Platform>| platforms.into_iter().map(|it| it.folder).collect::<Vec<_>>();
        let all = Libraries { paths: Vec::new(), platforms: Vec::new() };
        let read = Library::platforms(&path, bytes, &all);
        read.map(|platforms| folders(platforms).join(" ")).map_err(|error| error.to_string())
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
        let expected = ["/no/bin", "/no", "/no/lib/cograin"].map(|folder| Path::new(folder).join(&name));
        match beside(STANDARD_LIBRARY, Some("/no/bin/cograin".into())) {
            Err(LibraryError::NotFound { looked_at }) => assert_eq!(looked_at, expected),
            other => panic!("expected no library, found {other:?}"),
        }
    }

    #[test]
    fn libraries_that_were_installed_are_found_for_every_platform_and_one_beside_the_program_stands_alone() {
        let folder = Scratch::new();
        let write = |path: &str, sample: Sample| {
            let path = folder.join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, sample.bytes()).unwrap();
            path
        };
        let linux = write("lib/cograin/x86_64-linux/libcograin_fmu.so", Sample::LINUX);
        let arm = write("lib/cograin/aarch64-linux/libcograin_fmu.so", Sample { arm: true, ..Sample::LINUX });
        let windows = write("lib/cograin/x86_64-windows/cograin_fmu.dll", Sample::WINDOWS);
        let mac = write("lib/cograin/libcograin_fmu.dylib", Sample::MACOS);
        write("lib/cograin/x86_64-windows/own_law.dll", Sample::WINDOWS);
        let found = || beside(STANDARD_LIBRARY, Some(folder.join("bin/cograin"))).unwrap();
        let folders = |platforms: &[&str]| {
            let platforms = platforms.iter().map(ToString::to_string).collect();
            let read = Library::read_all(&Libraries { paths: found(), platforms });
            read.map(|all| all.into_iter().map(|it| it.platform.folder).collect::<Vec<_>>().join(" "))
        };
        assert_eq!(found(), [arm, mac, linux, windows.clone()]);
        assert_eq!(folders(&[]).unwrap(), "aarch64-linux darwin64 linux64 win64");
        // Names of either edition.
        assert_eq!(folders(&["win64", "x86_64-linux"]).unwrap(), "linux64 win64");
        let message = folders(&["linux64", "win32"]).unwrap_err().to_string();
        assert!(message.ends_with("(aarch64-linux, darwin64, linux64, win64), found win32"), "{message}");
        // What is left out need not fit; what is packed must.
        fs::write(&windows, Sample { mark: "", ..Sample::WINDOWS }.bytes()).unwrap();
        assert_eq!(folders(&["linux64"]).unwrap(), "linux64");
        assert!(folders(&[]).unwrap_err().to_string().contains("without the mark"));
        let own = format!("{}cograin_fmu{}", env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
        assert_eq!(found().len(), 4);
        let built = write(&format!("bin/{own}"), Sample::LINUX);
        assert_eq!(found(), [built]);
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
        let both = Libraries { paths: paths.to_vec(), platforms: Vec::new() };
        let message = Library::read_all(&both).unwrap_err().to_string();
        for path in &paths {
            assert!(message.contains(&path.display().to_string()), "{message}");
        }
        assert!(message.starts_with("expected one library for linux64, found "), "{message}");
    }
}
