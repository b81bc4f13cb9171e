//! The zip file.

use super::resources::{Content, Resource};
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Cursor, Write};
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Writes the entries, in their order, beside `output` and then puts the whole file in its place.
pub(super) fn write(entries: &[Resource], output: &Path) -> io::Result<()> {
    /// Tells apart what one process writes at the same time.
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let mut name = OsString::from(".");
    name.push(output.file_name().ok_or_else(|| io::Error::other("not the path of a file"))?);
    name.push(format!(".{}.{}.part", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    let part = output.with_file_name(name);

    let done = write_to(entries, &part).and_then(|()| fs::rename(&part, output));
    if done.is_err() {
        // what went wrong first is the reason to report
        let _ = fs::remove_file(&part);
    }
    done
}

/// Writes the entries to a new file.
fn write_to(entries: &[Resource], path: &Path) -> io::Result<()> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::DEFAULT);
    // An archive that cannot be written tells so on the standard error when it is dropped, so it is made in memory.
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for entry in entries {
        let mode = if matches!(entry.content, Content::Program(_)) { 0o755 } else { 0o644 };
        archive.start_file(entry.path.as_str(), options.unix_permissions(mode))?;
        archive.write_all(entry.content.bytes())?;
    }
    let bytes = archive.finish()?.into_inner();
    let mut file = File::create_new(path)?;
    file.write_all(&bytes)?;
    file.sync_all()
}
