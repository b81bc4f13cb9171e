//! What a scene writes of a model, a rule: keys whose type the row of the model alone knows.

use crate::base::document::{Document, Faults};
use serde::de::DeserializeOwned;
use std::any::Any;
use std::fmt;
use std::sync::{Mutex, PoisonError};

/// What a scene writes under the name of a model or of a rule.
pub trait ModelKeys: Copy + fmt::Debug + PartialEq + Send + Sync + DeserializeOwned + 'static {}

impl<T: Copy + fmt::Debug + PartialEq + Send + Sync + DeserializeOwned + 'static> ModelKeys for T {}

/// Keys of any type.
pub(super) trait AnyKeys: Any + fmt::Debug + Send + Sync {}

impl<T: Any + fmt::Debug + Send + Sync> AnyKeys for T {}

/// Keys that live as long as the program.
pub(super) type Kept = &'static dyn AnyKeys;

/// Keeps keys. The same keys are kept once, so that reading scenes again and again keeps no more.
pub(super) fn keep<K: ModelKeys>(keys: K) -> Kept {
    static ALL: Mutex<Vec<Kept>> = Mutex::new(Vec::new());
    let mut all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
    let same = all.iter().find(|kept| of_kind::<K>(**kept) == Some(&keys));
    if let Some(kept) = same {
        return *kept;
    }
    let kept: Kept = Box::leak(Box::new(keys));
    all.push(kept);
    kept
}

/// The keys, if they are of this type.
pub(super) fn of_kind<K: 'static>(keys: Kept) -> Option<&'static K> {
    let any: &'static dyn Any = keys;
    any.downcast_ref()
}

/// The keys of the model whose row asks.
pub(super) fn own<K: 'static>(keys: Kept) -> &'static K {
    of_kind(keys).expect("a model is made with its own keys")
}

/// Reads keys below a table, and keeps them.
pub(super) fn read<K: ModelKeys>(document: &Document, table: &str, name: &str, faults: &mut Faults) -> Option<Kept> {
    document.read_key::<K>(table, name, faults).map(keep)
}
