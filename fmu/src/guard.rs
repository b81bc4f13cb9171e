//! Between C and the instance: null, wrong calls and panics become a status.

use crate::calls::Call;
use crate::instance::Instance;
use crate::logger::Logger;
use crate::refusal::Refusal;
use crate::types::{Component, Status, Text};
use std::any::Any;
use std::collections::BTreeMap;
use std::ffi::CStr;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, Once, PoisonError, RwLock, TryLockError};

/// An instance and where it reports to.
pub(crate) struct Guarded {
    /// The instance. One call at a time: a host's logger may try to call back, or two threads.
    pub(crate) instance: Mutex<Instance>,
    /// Its logger.
    pub(crate) logger: Logger,
}

/// All instances, by the numbers that hosts know them by. Those of freed and foreign ones are not in it.
static INSTANCES: RwLock<BTreeMap<usize, Arc<Guarded>>> = RwLock::new(BTreeMap::new());

/// A number by which a host knows an instance or a state: none is given out twice, not even after it was freed,
/// and other libraries in the process, those of other units included, give out others.
pub(crate) fn fresh_address() -> usize {
    /// Counts from its own address, which no other library has.
    static COUNT: AtomicUsize = AtomicUsize::new(1);
    (&raw const COUNT).addr().wrapping_add(COUNT.fetch_add(1, Ordering::Relaxed))
}

/// Enters an instance; yields what the host is to know it by.
pub(crate) fn enter(guarded: Guarded) -> Component {
    let address = fresh_address();
    INSTANCES.write().unwrap_or_else(PoisonError::into_inner).insert(address, Arc::new(guarded));
    std::ptr::without_provenance_mut(address)
}

/// Removes and drops an instance, which ends its threads.
pub(crate) fn leave(component: Component) {
    let guarded = INSTANCES.write().unwrap_or_else(PoisonError::into_inner).remove(&component.addr());
    // a host must not see a panic, and there is nobody left to tell
    let _ = catch_unwind(AssertUnwindSafe(|| drop(guarded)));
}

/// Runs a function on an instance. Whatever goes wrong is reported to the host's logger.
pub(crate) fn call(
    component: Component,
    call: &Call,
    action: impl FnOnce(&mut Instance, &Logger) -> Result<(), Refusal>,
) -> Status {
    let found = INSTANCES.read().unwrap_or_else(PoisonError::into_inner).get(&component.addr()).map(Arc::clone);
    let Some(guarded) = found else { return Status::Error };
    match run(&guarded, call, action) {
        Ok(()) => Status::Ok,
        Err(refusal) => {
            guarded.logger.refused(call.name, &refusal);
            refusal.status()
        }
    }
}

/// Runs a function on an instance, if it may be called now.
fn run(
    guarded: &Guarded,
    call: &Call,
    action: impl FnOnce(&mut Instance, &Logger) -> Result<(), Refusal>,
) -> Result<(), Refusal> {
    let mut instance = match guarded.instance.try_lock() {
        Ok(instance) => instance,
        Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
        Err(TryLockError::WouldBlock) => return Err(Refusal::Busy),
    };
    let phase = instance.phase();
    if !call.allowed.contains(&phase) {
        return Err(Refusal::Phase { phase, allowed: call.allowed });
    }
    catch_unwind(AssertUnwindSafe(|| action(&mut instance, &guarded.logger))).unwrap_or_else(|panic| {
        instance.break_down();
        Err(Refusal::Panic { message: message_of(panic.as_ref()) })
    })
}

/// What a panic says.
pub(crate) fn message_of(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".to_owned())
}

/// Keeps panics from the host's terminal: they reach its logger. This library has a standard library of its
/// own, so no panic of the host or of another unit is silenced.
pub(crate) fn silence_panics() {
    /// Hooks are set for good.
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        if cfg!(not(test)) {
            std::panic::set_hook(Box::new(|_| ()));
        }
    });
}

/// The elements of a C array, which may be null if there are none.
///
/// # Safety
/// `length` elements must stand at `pointer` if it is not null, and nobody may write them during `'a`.
pub(crate) unsafe fn slice<'a, T>(
    argument: &'static str,
    pointer: *const T,
    length: usize,
) -> Result<&'a [T], Refusal> {
    fits::<T>(argument, pointer.is_null(), length)?;
    // SAFETY: as the caller promises; the size was checked above.
    Ok(if length == 0 { &[] } else { unsafe { std::slice::from_raw_parts(pointer, length) } })
}

/// The elements of a C array to be written, which may be null if there are none.
///
/// # Safety
/// `length` elements must stand at `pointer` if it is not null, and nobody else may use them during `'a`.
pub(crate) unsafe fn slice_mut<'a, T>(
    argument: &'static str,
    pointer: *mut T,
    length: usize,
) -> Result<&'a mut [T], Refusal> {
    fits::<T>(argument, pointer.is_null(), length)?;
    // SAFETY: as the caller promises; the size was checked above.
    Ok(if length == 0 { &mut [] } else { unsafe { std::slice::from_raw_parts_mut(pointer, length) } })
}

/// Whether an array can be.
fn fits<T>(argument: &'static str, is_null: bool, length: usize) -> Result<(), Refusal> {
    if length > 0 && is_null {
        return Err(Refusal::Null { argument });
    }
    if length > isize::MAX.unsigned_abs() / size_of::<T>().max(1) {
        return Err(Refusal::Length { argument, length });
    }
    Ok(())
}

/// What a pointer points to, to be written.
///
/// # Safety
/// A `T` must stand at `pointer` if it is not null, and nobody else may use it during `'a`.
pub(crate) unsafe fn target<'a, T>(argument: &'static str, pointer: *mut T) -> Result<&'a mut T, Refusal> {
    // SAFETY: as the caller promises.
    unsafe { pointer.as_mut() }.ok_or(Refusal::Null { argument })
}

/// A C string; none if it is null.
///
/// # Safety
/// A string that ends in a zero must stand at `text` if it is not null.
pub(crate) unsafe fn text(text: Text) -> Option<String> {
    // SAFETY: as the caller promises.
    (!text.is_null()).then(|| unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned())
}
