//! From the `file:` URI of the resources to a path.

use std::ffi::OsString;
use std::path::PathBuf;

/// Why a location is not a path.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum LocationError {
    /// Another scheme.
    #[error("fmuResourceLocation: expected a file: URI, as file:///path/to/resources, found {uri:?}")]
    Scheme {
        /// What was given.
        uri: String,
    },
    /// Another machine.
    #[error("fmuResourceLocation: expected a path on this machine, found {uri:?} on the machine {host:?}")]
    Host {
        /// What was given.
        uri: String,
        /// The machine.
        host: String,
    },
    /// A broken escape.
    #[error(
        "fmuResourceLocation: expected two hexadecimal digits after each percent sign, found {uri:?}; write %25 \
             for the sign itself"
    )]
    Escape {
        /// What was given.
        uri: String,
    },
}

/// The path that a `file:` URI means: `file:///…`, `file:/…` or `file://localhost/…`.
pub(crate) fn path_of(uri: &str) -> Result<PathBuf, LocationError> {
    let foreign = || LocationError::Scheme { uri: uri.to_owned() };
    let (scheme, rest) = uri.split_once(':').ok_or_else(foreign)?;
    if !scheme.eq_ignore_ascii_case("file") {
        return Err(foreign());
    }
    let path = match rest.strip_prefix("//") {
        Some(rest) => {
            let (host, path) = rest.split_at(rest.find('/').ok_or_else(foreign)?);
            if !host.is_empty() && !host.eq_ignore_ascii_case("localhost") {
                return Err(LocationError::Host { uri: uri.to_owned(), host: host.to_owned() });
            }
            path
        }
        None if rest.starts_with('/') => rest,
        None => return Err(foreign()),
    };
    let bytes = decoded(path.as_bytes()).ok_or_else(|| LocationError::Escape { uri: uri.to_owned() })?;
    Ok(PathBuf::from(native(bytes)))
}

/// The bytes with their escapes resolved.
fn decoded(mut text: &[u8]) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len());
    while let Some((&first, rest)) = text.split_first() {
        text = rest;
        if first == b'%' {
            let (digits, rest) = text.split_first_chunk::<2>()?;
            let digit = |digit: u8| char::from(digit).to_digit(16);
            bytes.push(u8::try_from(digit(digits[0])? * 16 + digit(digits[1])?).ok()?);
            text = rest;
        } else {
            bytes.push(first);
        }
    }
    Some(bytes)
}

/// Bytes as a path of this system.
#[cfg(unix)]
fn native(bytes: Vec<u8>) -> OsString {
    std::os::unix::ffi::OsStringExt::from_vec(bytes)
}

/// Bytes as a path of this system: `/C:/folder` means `C:/folder`.
#[cfg(not(unix))]
fn native(bytes: Vec<u8>) -> OsString {
    let text = String::from_utf8_lossy(&bytes).into_owned();
    match text.strip_prefix('/') {
        Some(rest) if rest.as_bytes().get(1) == Some(&b':') => rest.to_owned().into(),
        _ => text.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_forms_of_a_file_uri_mean_the_same_path() {
        for uri in ["file:///tmp/unit/resources", "file:/tmp/unit/resources", "FILE://localhost/tmp/unit/resources"] {
            assert_eq!(path_of(uri), Ok(PathBuf::from("/tmp/unit/resources")), "{uri}");
        }
    }

    #[test]
    fn escapes_are_resolved_and_other_letters_are_left() {
        assert_eq!(path_of("file:///a%20b/%23%25/%C3%BC/ü/"), Ok(PathBuf::from("/a b/#%/ü/ü/")));
    }

    #[test]
    fn other_schemes_machines_and_broken_escapes_are_refused() {
        assert!(matches!(path_of("/tmp/resources"), Err(LocationError::Scheme { .. })));
        assert!(matches!(path_of("http://host/resources"), Err(LocationError::Scheme { .. })));
        assert!(matches!(path_of("file:resources"), Err(LocationError::Scheme { .. })));
        assert!(matches!(path_of("file://elsewhere/resources"), Err(LocationError::Host { .. })));
        assert!(matches!(path_of("file:///a%2"), Err(LocationError::Escape { .. })));
        assert!(matches!(path_of("file:///a%zz"), Err(LocationError::Escape { .. })));
    }
}
