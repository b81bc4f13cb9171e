//! What the system tells a command: requests to end, and files that may not grow further.

use super::Ending;
use std::ffi::c_int;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Lets the first Ctrl-C, or another request to end, end the work in good order, and the second at once: all files are whole at any
/// time. A request that the caller has chosen to ignore, as `nohup` does, stays ignored.
pub(super) fn stop_at_interruption() -> Result<Arc<AtomicBool>, Ending> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in STOPPING {
        if is_ignored(signal) {
            continue;
        }
        signal_hook::flag::register_conditional_shutdown(signal, 1, Arc::clone(&stop)).map_err(Ending::failed)?;
        signal_hook::flag::register(signal, Arc::clone(&stop)).map_err(Ending::failed)?;
    }
    Ok(stop)
}

/// Lets the system tell by an error that a file may not grow further, instead of ending the program.
pub(super) fn tell_of_full_files() {
    // Where this cannot be had, the program ends as it did.
    #[cfg(unix)]
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
}

/// Requests to end.
#[cfg(unix)]
const STOPPING: [c_int; 3] = [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM, signal_hook::consts::SIGHUP];

/// Requests to end.
#[cfg(not(unix))]
const STOPPING: [c_int; 2] = [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM];

/// Whether the caller has chosen to ignore a signal, where the system tells.
fn is_ignored(signal: c_int) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}
