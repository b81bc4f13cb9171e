//! The functions of FMI for co-simulation, 2.0 and 3.0, over one instance: a host finds those of its edition of the standard.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]
#![allow(
    clippy::missing_safety_doc,
    reason = "the demands are those of FMI, stated once for all functions of an edition"
)]

mod calls;
mod floating_point;
mod frames;
mod guard;
mod host_memory;
mod instance;
mod location;
mod logger;
mod refusal;
mod saved;
mod shared;
pub mod types;
pub mod v2;
pub mod v3;

use cograin::export::LIBRARY_MARK;

/// Stands in every library of units from these sources: [`LIBRARY_MARK`].
pub const MARK: [u8; LIBRARY_MARK.len()] = {
    let mut bytes = [0; LIBRARY_MARK.len()];
    bytes.copy_from_slice(LIBRARY_MARK.as_bytes());
    bytes
};

/// Makes a crate the library of units: `unit!(models)`, with the [`Models`](cograin::scene::Models) that their scenes may name, once in
/// a crate of type `cdylib`. The other functions of FMI are those of this crate, which the library exports as well.
#[macro_export]
macro_rules! unit {
    ($models:expr) => {
        /// Tells `export` that this is the library of a unit.
        #[used]
        static COGRAIN_UNIT: [u8; $crate::MARK.len()] = $crate::MARK;

        /// `fmi2Instantiate`
        ///
        /// # Safety
        /// As FMI 2.0 demands.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn fmi2Instantiate(
            name: $crate::types::Text,
            kind: ::std::ffi::c_int,
            guid: $crate::types::Text,
            location: $crate::types::Text,
            functions: *const $crate::types::Callbacks,
            _visible: $crate::types::Boolean,
            logging: $crate::types::Boolean,
        ) -> $crate::types::Component {
            let arguments = $crate::v2::Arguments { name, kind, guid, location, functions, logging };
            // SAFETY: demands of FMI 2.0.
            unsafe { $crate::v2::instantiate(&arguments, || $models) }
        }

        /// `fmi3InstantiateCoSimulation`
        ///
        /// # Safety
        /// As FMI 3.0 demands.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
            name: $crate::types::Text,
            token: $crate::types::Text,
            resources: $crate::types::Text,
            _visible: $crate::v3::Boolean,
            logging: $crate::v3::Boolean,
            event_mode: $crate::v3::Boolean,
            _early_return: $crate::v3::Boolean,
            _intermediate: *const $crate::types::Reference,
            intermediates: usize,
            environment: $crate::types::Environment,
            logger: ::core::option::Option<$crate::v3::LogFunction>,
            _update: ::core::option::Option<$crate::v3::UpdateFunction>,
        ) -> $crate::types::Component {
            let arguments = $crate::v3::Arguments {
                name,
                token,
                resources,
                logging,
                event_mode,
                intermediates,
                environment,
                logger,
            };
            // SAFETY: demands of FMI 3.0.
            unsafe { $crate::v3::instantiate(&arguments, || $models) }
        }
    };
}

#[cfg(test)]
unit!(cograin::scene::Models::standard());

#[cfg(test)]
#[path = "../tests/calls.rs"]
mod tests;
