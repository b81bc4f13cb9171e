//! What the protocol of the threads is written against: here the standard library, in `tests/threads_model` a model checker.

pub(super) use std::hint::spin_loop;
pub(super) use std::sync::Mutex;
pub(super) use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, AtomicUsize, fence};
pub(super) use std::thread::{Thread, current, park, yield_now};

/// How often a helper looks for work before it sleeps: some 50 µs.
pub(super) const LOOKS: u32 = 1500;

/// How often a thread that has finished looks whether the others have, before it yields the processor.
pub(super) const PATIENCE: u32 = 3000;

/// A value that the protocol guards.
pub(super) struct UnsafeCell<T>(std::cell::UnsafeCell<T>);

impl<T> UnsafeCell<T> {
    /// With this value.
    pub(super) fn new(value: T) -> Self {
        Self(std::cell::UnsafeCell::new(value))
    }

    /// Looks at it.
    pub(super) fn with<R>(&self, look: impl FnOnce(*const T) -> R) -> R {
        look(self.0.get())
    }

    /// Changes it.
    pub(super) fn with_mut<R>(&self, change: impl FnOnce(*mut T) -> R) -> R {
        change(self.0.get())
    }
}
