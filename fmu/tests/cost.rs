//! What a call costs beside the time steps: memory is asked for in the first step alone, unless lists grow.

use super::host::{Host, Unpacked, source};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// The system's allocator, counting what each thread asks for.
struct Counting;

thread_local! {
    /// How often this thread asked for memory.
    static ASKED: Cell<u64> = const { Cell::new(0) };
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

// SAFETY: everything is the system's.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ASKED.set(ASKED.get() + 1);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn realloc(&self, start: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ASKED.set(ASKED.get() + 1);
        // SAFETY: the caller's promise.
        unsafe { System.realloc(start, layout, size) }
    }

    unsafe fn dealloc(&self, start: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(start, layout) }
    }
}

#[test]
fn a_step_asks_for_no_memory_after_the_first() {
    let source = source();
    let unit = Unpacked::of(&source, "cost");
    let host = Host::started(&unit);
    assert!(host.get("energy.elastic") > 0.0, "something touches");
    let length = 1.0e-5;
    // lists are made a few times, and the state is kept anew
    let mut point = 0;
    let mut go = |count: u32| {
        for _ in 0..count {
            let end = point + 1;
            host.set("floor.displacement.z", 1.0e-9 * f64::from(end));
            assert_eq!(host.step(f64::from(point) * length, length), crate::types::Status::Ok, "{}", host.said());
            point = end;
        }
    };
    go(300);
    let mut asking = 0;
    for _ in 0..200 {
        let before = ASKED.get();
        go(1);
        asking += u32::from(ASKED.get() > before);
    }
    // in these steps the lists were made anew
    assert!(asking <= 3, "{asking} of 200 steps asked for memory");
}
