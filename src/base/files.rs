//! Files that are read as a whole.

use crate::base::memory;
use std::fs;
use std::io::{Error, ErrorKind, Result};
use std::path::Path;

/// The bytes of a file that there is memory for. Folders are refused, and devices and pipes, which may have no end.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    let about = fs::metadata(path)?;
    if about.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if !about.is_file() {
        return Err(Error::other("expected a file, found a device or a pipe"));
    }
    let length = about.len();
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
