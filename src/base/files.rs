//! Files that are read: as a whole, or as far as one likes.

use crate::base::memory;
use std::fs::{self, File};
use std::io::{Error, ErrorKind, Result};
use std::path::Path;

/// The length of a file \[bytes\]. Folders are refused, and devices and pipes, which may have no end.
fn length(path: &Path) -> Result<u64> {
    let about = fs::metadata(path)?;
    if about.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if !about.is_file() {
        return Err(Error::other("expected a file, found a device or a pipe"));
    }
    Ok(about.len())
}

/// A file that is read as far as one likes.
pub(crate) fn open(path: &Path) -> Result<File> {
    length(path)?;
    File::open(path)
}

/// The bytes of a file that there is memory for.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    let length = length(path)?;
    if let Some(expected) = memory::lacking(length) {
        return Err(Error::other(format!("expected {expected}, found {:.2} GB", length as f64 / 1e9)));
    }
    fs::read(path)
}

#[cfg(all(test, unix))]
mod tests {
    use super::read;
    use std::path::Path;

    #[test]
    fn what_has_no_end_is_not_read() {
        let told = |path: &str| read(Path::new(path)).unwrap_err().to_string();
        assert_eq!(told("/dev/zero"), "expected a file, found a device or a pipe");
        assert_eq!(told("/"), "is a directory");
    }
}
