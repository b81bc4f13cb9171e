//! Between C and the instance: null, wrong calls and panics become a status.

use crate::calls::Call;
use crate::floating_point;
use crate::instance::{Instance, Request};
use crate::logger::Logger;
use crate::refusal::Refusal;
use crate::types::{Component, Status};
use cograin::scene::Models;
use std::any::Any;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, Once, PoisonError, TryLockError, TryLockResult};
use std::time::{Duration, Instant};

/// An instance and where it reports to.
pub(crate) struct Guarded {
    /// The instance. One call at a time: a host's logger may try to call back, or two threads.
    pub(crate) instance: Mutex<Instance>,
    /// Its logger.
    pub(crate) logger: Logger,
    /// Set to end the communication step under way.
    pub(crate) stop: Arc<AtomicBool>,
}

impl Guarded {
    /// An instance that reports to a logger.
    pub(crate) fn new(instance: Instance, logger: Logger) -> Self {
        let stop = instance.stop();
        Self { instance: Mutex::new(instance), logger, stop }
    }
}

/// All instances, by the numbers that hosts know them by. Those of freed and foreign ones are not in it.
static INSTANCES: Mutex<BTreeMap<usize, Arc<Guarded>>> = Mutex::new(BTreeMap::new());

/// How long the table of instances is waited for. It is held for a moment at a time, unless the process was forked in
/// just that moment: then no thread is left to give it back, and calls are refused.
const PATIENCE: Duration = Duration::from_secs(2);

/// Does something with the table of instances; `None` if it cannot be had.
fn with_instances<T>(action: impl FnOnce(&mut BTreeMap<usize, Arc<Guarded>>) -> T) -> Option<T> {
    let mut action = Some(action);
    let mut attempt = |table: TryLockResult<_>| {
        let mut table: std::sync::MutexGuard<'_, _> = match table {
            Ok(table) => table,
            Err(TryLockError::Poisoned(poisoned)) => PoisonError::into_inner(poisoned),
            Err(TryLockError::WouldBlock) => return None,
        };
        action.take().map(|action| action(&mut table))
    };
    let mut result = attempt(INSTANCES.try_lock());
    if result.is_none() {
        let begun = Instant::now();
        while result.is_none() && begun.elapsed() < PATIENCE {
            std::thread::yield_now();
            result = attempt(INSTANCES.try_lock());
        }
    }
    result
}

/// The instance that a host knows by this.
fn find(component: Component) -> Option<Arc<Guarded>> {
    with_instances(|instances| instances.get(&component.addr()).map(Arc::clone)).flatten()
}

/// A number by which a host knows an instance or a state: none is given out twice, not even after it was freed,
/// and other libraries in the process, those of other units included, give out others.
pub(crate) fn fresh_address() -> usize {
    /// Counts from its own address, which no other library has.
    static COUNT: AtomicUsize = AtomicUsize::new(1);
    (&raw const COUNT).addr().wrapping_add(COUNT.fetch_add(1, Ordering::Relaxed))
}

/// Enters an instance; yields what the host is to know it by, null if it cannot be entered.
fn enter(guarded: Guarded) -> Component {
    let address = fresh_address();
    match with_instances(|instances| instances.insert(address, Arc::new(guarded))) {
        Some(_) => std::ptr::without_provenance_mut(address),
        None => std::ptr::null_mut(),
    }
}

/// Makes an instance as the host asks for it by this function; null if there is none. The reason goes to the logger.
pub(crate) fn instantiate(function: &str, request: &Request, logger: Logger, models: fn() -> Models) -> Component {
    silence_panics();
    let made = || catch_unwind(AssertUnwindSafe(|| Instance::new(request, models())));
    match floating_point::standard(made) {
        Ok(Ok(instance)) => {
            logger.event(|| format!("{function}: {}", instance.about()));
            enter(Guarded::new(instance, logger))
        }
        Ok(Err(error)) => {
            logger.failed(function, &error.to_string());
            std::ptr::null_mut()
        }
        Err(panic) => {
            logger.failed(function, &format!("internal error: {}", message_of(panic.as_ref())));
            std::ptr::null_mut()
        }
    }
}

/// Removes and drops an instance, which ends its threads. A communication step under way on another thread ends after
/// its present time step.
pub(crate) fn leave(component: Component) {
    floating_point::standard(|| {
        let guarded = with_instances(|instances| instances.remove(&component.addr())).flatten();
        if let Some(guarded) = &guarded {
            guarded.stop.store(true, Ordering::Relaxed);
        }
        // a host must not see a panic, and there is nobody left to tell
        let _ = catch_unwind(AssertUnwindSafe(|| drop(guarded)));
    });
}

/// Ends the communication step under way on another thread; refused if there is no such step.
pub(crate) fn cancel(component: Component, function: &Call) -> Status {
    let Some(guarded) = find(component) else { return Status::Error };
    if matches!(guarded.instance.try_lock(), Err(TryLockError::WouldBlock)) {
        guarded.stop.store(true, Ordering::Relaxed);
        return Status::Ok;
    }
    call(component, function, |_, _| Err(Refusal::NothingToCancel))
}

/// Runs a function on an instance. Whatever goes wrong is reported to the host's logger.
pub(crate) fn call(
    component: Component,
    call: &Call,
    action: impl FnOnce(&mut Instance, &Logger) -> Result<(), Refusal>,
) -> Status {
    floating_point::standard(|| {
        let Some(guarded) = find(component) else { return Status::Error };
        let (result, warning) = run(&guarded, call, action);
        if let Some(warning) = &warning {
            guarded.logger.warned(call.name, warning);
        }
        match result {
            Ok(()) if warning.is_some() => Status::Warning,
            Ok(()) => Status::Ok,
            Err(refusal) => {
                guarded.logger.refused(call.name, &refusal);
                refusal.status()
            }
        }
    })
}

/// Runs a function on an instance, if it may be called now. Yields also what it left undone, in words.
fn run(
    guarded: &Guarded,
    call: &Call,
    action: impl FnOnce(&mut Instance, &Logger) -> Result<(), Refusal>,
) -> (Result<(), Refusal>, Option<String>) {
    let mut instance = match guarded.instance.try_lock() {
        Ok(instance) => instance,
        Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
        Err(TryLockError::WouldBlock) => return (Err(Refusal::Busy), None),
    };
    let phase = instance.phase();
    if !call.allowed.contains(&phase) {
        return (Err(Refusal::Phase { phase, allowed: call.allowed }), None);
    }
    let result = catch_unwind(AssertUnwindSafe(|| action(&mut instance, &guarded.logger))).unwrap_or_else(|panic| {
        instance.break_down();
        Err(Refusal::Panic { message: message_of(panic.as_ref()) })
    });
    (result, instance.take_warning())
}

/// What a panic says.
fn message_of(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".to_owned())
}

/// Keeps panics from the host's terminal: they reach its logger. This library has a standard library of its
/// own, so no panic of the host or of another unit is silenced.
fn silence_panics() {
    /// Hooks are set for good.
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        if cfg!(not(test)) {
            std::panic::set_hook(Box::new(|_| ()));
        }
    });
}
