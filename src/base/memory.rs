//! How much memory there is, where large arrays begin in it, and what of it will be needed soon.
//!
//! An allocator gives large arrays whole pages, so all of them begin at the same place of a page. A loop that goes
//! through several of them side by side then reads from places that differ from those it has just written to in the
//! page alone, and processors, which compare the lowest twelve bits first, hold such reads back until the write is
//! through (4K aliasing: Intel 64 and IA-32 Architectures Optimization Reference Manual, "Memory Disambiguation").
//! Here each begins some lines of the cache further into its page than the one before.

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Arrays from this size on are placed \[bytes\].
const LARGE: usize = 1 << 16;

/// Size of a page, and of what processors compare \[bytes\].
const PAGE: usize = 1 << 12;

/// Size of a line of the cache \[bytes\].
const LINE: usize = 1 << 6;

/// Lines between the beginnings of two arrays that follow each other: ten in a row are at least five lines apart.
const STRIDE: usize = 13;

/// Beginnings there are. With [`STRIDE`] it has no common divisor.
const BEGINNINGS: usize = 60;

/// Room in front of an array for where its memory begins.
const NOTE: usize = size_of::<*mut u8>();

/// The system's allocator with large arrays beginning at different places of a page. Programs choose it with
/// `#[global_allocator]`; results do not depend on it. Where the system has no memory left it ends the program in words and with
/// status 1, instead of by a signal.
pub struct Staggered;

/// Large arrays that were given out.
static GIVEN: AtomicUsize = AtomicUsize::new(0);

/// The layout of the memory that holds a large array.
fn around(array: Layout) -> Option<Layout> {
    let size = array.size().checked_add(2 * PAGE)?;
    Layout::from_size_align(size, align_of::<*mut u8>()).ok()
}

/// Whether an array is placed; one of extraordinary alignment is not.
fn is_large(array: Layout) -> bool {
    array.size() >= LARGE && array.align() <= LINE
}

/// The memory that the system gave; where it has none left the program ends.
fn given(start: *mut u8, memory: Layout) -> *mut u8 {
    if start.is_null() { end_without(memory) } else { start }
}

/// Ends the program in words and with status 1, as other work that failed. Files are whole at any time.
#[cold]
fn end_without(memory: Layout) -> ! {
    /// Whether the words are being said: saying them must not ask for memory again and again.
    static SAID: AtomicBool = AtomicBool::new(false);
    if !SAID.swap(true, Ordering::Relaxed) {
        let megabytes = memory.size() as f64 / 1e6;
        let _ = writeln!(
            io::stderr(),
            "expected {megabytes:.3} MB more of memory, found none free in the machine or within the limit of this process; the \
             files written so far are whole"
        );
    }
    std::process::exit(1)
}

/// Places an array in its memory, and notes where that begins.
///
/// # Safety
/// `start` is memory of the layout [`around`] the array.
unsafe fn place(start: *mut u8) -> *mut u8 {
    let lines = GIVEN.fetch_add(1, Ordering::Relaxed) * STRIDE % BEGINNINGS;
    // The next page begins at most one page further on, and never less than `NOTE` after the start with a line more.
    let ahead = PAGE - start.addr() % PAGE + LINE + LINE * lines;
    // SAFETY: less than two pages further on: a page, and at most 60 lines of the 64 of another. The note stands in
    // front, within the memory, since a line is longer; it is aligned as a line is.
    unsafe {
        let array = start.add(ahead);
        array.sub(NOTE).cast::<*mut u8>().write(start);
        array
    }
}

// SAFETY: memory is the system's; an array lies inside what was asked for around it, aligned to a line of the cache, and
// the same test tells when it is given back.
unsafe impl GlobalAlloc for Staggered {
    unsafe fn alloc(&self, array: Layout) -> *mut u8 {
        match around(array).filter(|_| is_large(array)) {
            // SAFETY: the size is not zero.
            Some(memory) => unsafe { place(given(System.alloc(memory), memory)) },
            // SAFETY: the caller's promise.
            None => given(unsafe { System.alloc(array) }, array),
        }
    }

    unsafe fn alloc_zeroed(&self, array: Layout) -> *mut u8 {
        match around(array).filter(|_| is_large(array)) {
            // SAFETY: the size is not zero. The note stands in front of the array.
            Some(memory) => unsafe { place(given(System.alloc_zeroed(memory), memory)) },
            // SAFETY: the caller's promise.
            None => given(unsafe { System.alloc_zeroed(array) }, array),
        }
    }

    unsafe fn dealloc(&self, start: *mut u8, array: Layout) {
        match around(array).filter(|_| is_large(array)) {
            // SAFETY: `place` wrote the note in front of it.
            Some(memory) => unsafe { System.dealloc(start.sub(NOTE).cast::<*mut u8>().read(), memory) },
            // SAFETY: the caller's promise.
            None => unsafe { System.dealloc(start, array) },
        }
    }
}

/// Memory that this process may still ask for \[bytes\], where the system tells: what is free, less where a limit of the
/// process or of its group is nearer.
pub fn available() -> Option<u64> {
    /// Bytes in the unit of these files.
    const KIBIBYTE: u64 = 1024;
    let field = |file: &str, name: &str| {
        let text = std::fs::read_to_string(file).ok()?;
        let rest = text.lines().find_map(|line| line.strip_prefix(name))?.to_owned();
        rest.split_whitespace().next()?.parse::<u64>().ok()
    };
    let whole = |file: &str| std::fs::read_to_string(file).ok()?.trim().parse::<u64>().ok();
    let free = field("/proc/meminfo", "MemAvailable:").map(|free| free * KIBIBYTE);
    let own = field("/proc/self/limits", "Max address space")
        .map(|limit| limit.saturating_sub(field("/proc/self/status", "VmSize:").unwrap_or(0) * KIBIBYTE));
    let group = whole("/sys/fs/cgroup/memory.max")
        .map(|limit| limit.saturating_sub(whole("/sys/fs/cgroup/memory.current").unwrap_or(0)));
    [free, own, group].into_iter().flatten().min()
}

/// Memory that a sphere of a scene takes until it runs, with a few contacts: measured with a lattice of 4 million \[bytes\].
pub(crate) const SPHERE: u64 = 600;

/// What is right instead of something that needs this much \[bytes\]; nothing where there is room for it.
pub(crate) fn lacking(needed: u64) -> Option<String> {
    let free = available().filter(|free| needed > *free)?;
    Some(format!("what fits into the {:.2} GB of memory that are free", free as f64 / 1e9))
}

/// Tells the processor, if it can be told, that an address will be needed soon.
#[inline(always)]
pub fn prefetch<T>(_place: *const T) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a prefetch of any place does no harm.
    unsafe {
        std::arch::x86_64::_mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(_place.cast());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::{Mutex, PoisonError};

    /// Where an array begins depends on how many were given out before: one test after the other.
    static ALONE: Mutex<()> = Mutex::new(());

    /// Asks for arrays of these sizes, writes them full, and hands out where they begin.
    fn beginnings(sizes: &[usize]) -> Vec<usize> {
        let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let arrays: Vec<_> = sizes
            .iter()
            .map(|&size| {
                let layout = Layout::from_size_align(size, 32).unwrap();
                // SAFETY: sizes are not zero.
                (layout, unsafe { Staggered.alloc(layout) })
            })
            .collect();
        for (number, (layout, start)) in arrays.iter().enumerate() {
            // SAFETY: so much was given.
            unsafe { start.write_bytes(number as u8, layout.size()) };
        }
        for (number, (layout, start)) in arrays.iter().enumerate() {
            // SAFETY: it was written.
            let bytes = unsafe { std::slice::from_raw_parts(*start, layout.size()) };
            assert!(bytes.iter().all(|&byte| byte == number as u8), "array {number} is its own");
        }
        for &(layout, start) in &arrays {
            // SAFETY: given by the same allocator with this layout.
            unsafe { Staggered.dealloc(start, layout) };
        }
        arrays.iter().map(|(_, start)| start.addr()).collect()
    }

    #[test]
    fn large_arrays_begin_at_different_lines_of_a_page() {
        // Other tests run meanwhile with the system's allocator: nobody else counts.
        let starts = beginnings(&[640_000; 8]);
        for (one, start) in starts.iter().enumerate() {
            assert_eq!(start % LINE, 0);
            for other in &starts[..one] {
                let apart = (start % PAGE).abs_diff(other % PAGE);
                assert!(apart.min(PAGE - apart) >= 4 * LINE, "{start:x} and {other:x}");
            }
        }
    }

    #[test]
    fn arrays_of_every_size_are_whole() {
        beginnings(&[1, 100, LARGE - 1, LARGE, LARGE + 1, 1_000_003]);
    }

    #[test]
    fn arrays_grow_and_keep_what_they_hold() {
        let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let layout = Layout::from_size_align(LARGE, 8).unwrap();
        // SAFETY: the size is not zero, and layouts go with their arrays.
        unsafe {
            let start = Staggered.alloc_zeroed(layout);
            assert!(std::slice::from_raw_parts(start, LARGE).iter().all(|&byte| byte == 0));
            start.write_bytes(7, LARGE);
            let grown = Staggered.realloc(start, layout, 3 * LARGE);
            assert!(std::slice::from_raw_parts(grown, LARGE).iter().all(|&byte| byte == 7));
            let grown_layout = Layout::from_size_align(3 * LARGE, 8).unwrap();
            let small = Staggered.realloc(grown, grown_layout, 10);
            assert!(std::slice::from_raw_parts(small, 10).iter().all(|&byte| byte == 7));
            Staggered.dealloc(small, Layout::from_size_align(10, 8).unwrap());
        }
    }
}
