//! The library that a unit carries: where it is looked for, and whether it is the right one.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Names the library's file where no path is given.
pub const ENVIRONMENT_VARIABLE: &str = "COGRAIN_FMU_LIBRARY";

/// Name of the library with the sub-models of the program.
pub const STANDARD_LIBRARY: &str = "cograin_fmu";

/// Text that stands in the library of this version and in no other.
pub const LIBRARY_MARK: &str = concat!("cograin FMI 2.0 library, version ", env!("CARGO_PKG_VERSION"), ";");

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
    /// It is another file.
    #[error("{}: not the unit's library of this version; \"{LIBRARY_MARK}\" does not stand in it", path.display())]
    Foreign {
        /// Its path.
        path: PathBuf,
    },
    /// FMI 2.0 has no name for this system.
    #[error("expected linux, windows or macos on x86_64, which FMI 2.0 knows, found {system} on {processor}")]
    Platform {
        /// The operating system.
        system: &'static str,
        /// The processor.
        processor: &'static str,
    },
}

/// Paths, one after the other.
fn list(paths: &[PathBuf]) -> String {
    paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}

/// How FMI 2.0 names a kind of machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Platform {
    /// Folder of the library in the unit.
    pub(super) folder: &'static str,
    /// End of the library's name.
    pub(super) suffix: &'static str,
}

impl Platform {
    /// The machine that this program was built for.
    pub(super) fn of_this_program() -> Result<Self, LibraryError> {
        let (system, processor) = (env::consts::OS, env::consts::ARCH);
        let folder = match (system, processor) {
            ("linux", "x86_64") => "linux64",
            ("windows", "x86_64") => "win64",
            ("macos", "x86_64") => "darwin64",
            _ => return Err(LibraryError::Platform { system, processor }),
        };
        Ok(Self { folder, suffix: env::consts::DLL_SUFFIX })
    }
}

/// Finds the library: at the path given, else where [`ENVIRONMENT_VARIABLE`] says, else beside the running
/// program, in the folder above it, or in `../lib/cograin`; there it has the name that the crate has which makes it.
pub fn find_library(name: &str, given: Option<&Path>) -> Result<PathBuf, LibraryError> {
    let named = given.map(Path::to_owned).or_else(|| env::var_os(ENVIRONMENT_VARIABLE).map(PathBuf::from));
    let looked_at = named.map_or_else(|| beside(name, env::current_exe().ok()), |path| vec![path]);
    match looked_at.iter().find(|path| path.is_file()) {
        Some(path) => Ok(path.clone()),
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

/// The bytes of the library, if it is one.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, LibraryError> {
    let bytes = fs::read(path).map_err(|cause| LibraryError::Read { path: path.to_owned(), cause })?;
    let mark = LIBRARY_MARK.as_bytes();
    if bytes.windows(mark.len()).any(|window| window == mark) {
        Ok(bytes)
    } else {
        Err(LibraryError::Foreign { path: path.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_library_that_is_nowhere_is_reported_with_every_place() {
        let missing = Path::new("no/such/library.so");
        let message = find_library(STANDARD_LIBRARY, Some(missing)).unwrap_err().to_string();
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
    fn a_file_that_is_no_library_is_refused() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
        assert!(matches!(read(path), Err(LibraryError::Foreign { .. })));
    }
}
