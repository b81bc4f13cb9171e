//! VTK files through vtkio: its panics print nothing here, and it gets no more memory than a file can fill.

mod packed_sizes;

use crate::memory;
use cograin_vtk::model::Vtk;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

thread_local! {
    /// Whether a panic of this thread is expected and caught.
    static EXPECTED: Cell<bool> = const { Cell::new(false) };
}

/// Memory that a byte of a file takes as it is read: the text, and the numbers in it, which grow from two bytes to eight.
const PARSED: u64 = 6;

/// Reads a VTK file, XML or legacy; otherwise what was found instead of a readable one.
pub(crate) fn read(bytes: &[u8]) -> Result<Vtk, String> {
    let unpacked = packed_sizes::stated(bytes)?;
    let needed = (PARSED * bytes.len() as u64).saturating_add(unpacked.saturating_mul(2));
    if let Some(right) = memory::lacking(needed) {
        return Err(format!("data that need about {:.2} GB of memory instead of {right}", needed as f64 / 1e9));
    }
    let found = match silently(|| cograin_vtk::read(bytes)) {
        Ok(Ok(file)) => return Ok(file),
        Ok(Err(_)) if holds(bytes, b"encoding=\"raw\"") => "raw appended data (encoding=\"raw\")",
        Ok(Err(_)) if holds(bytes, b"vtkLZMADataCompressor") => "data packed by lzma",
        Ok(Err(_)) => "a file that is no VTK file, or a damaged one",
        Err(Panicked) => "a file with damaged data arrays",
    };
    Err(found.to_owned())
}

/// The work panicked.
struct Panicked;

/// Does the work; a panic in it prints nothing. Panics of other threads are printed as ever.
fn silently<T>(work: impl FnOnce() -> T) -> Result<T, Panicked> {
    /// The hook that knows which panics are expected is set once and hands the others on.
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let otherwise = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if !EXPECTED.get() {
                otherwise(panic);
            }
        }));
    });
    EXPECTED.set(true);
    // Nothing of vtkio's state outlives the call.
    let done = catch_unwind(AssertUnwindSafe(work));
    EXPECTED.set(false);
    done.map_err(|_| Panicked)
}

/// Whether the file holds these bytes.
fn holds(bytes: &[u8], part: &[u8]) -> bool {
    bytes.windows(part.len()).any(|window| window == part)
}
