//! Which function may be called when: those of FMI 2.0, and the words for those of FMI 3.0.

/// Where an instance stands between making and freeing it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    /// Made, or reset.
    Instantiated,
    /// Between entering and leaving the initialisation mode.
    Initialization,
    /// Ready for a communication step.
    Ready,
    /// The last communication step failed; the state is that of its beginning.
    Discarded,
    /// Terminated.
    Terminated,
    /// Something broke inside.
    Broken,
}

impl std::fmt::Display for Phase {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(match self {
            Self::Instantiated => "before the initialisation mode",
            Self::Initialization => "in the initialisation mode",
            Self::Ready => "between communication steps",
            Self::Discarded => "after a discarded communication step",
            Self::Terminated => "after the end of the simulation",
            Self::Broken => "after an internal error",
        })
    }
}

use Phase::{Broken, Discarded, Initialization, Instantiated, Ready, Terminated};

/// A function of the standard and when it may be called.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Call {
    /// Its name.
    pub(crate) name: &'static str,
    /// When it may be called.
    pub(crate) allowed: &'static [Phase],
}

/// Declares the table: function, and when it may be called.
macro_rules! calls {
    ($($constant:ident $name:literal: $($phase:ident)+;)+) => {
        $(#[doc = concat!("`", $name, "`")] pub(crate) const $constant: $crate::calls::Call = $crate::calls::Call { name: $name, allowed: &[$($crate::calls::Phase::$phase),+] };)+
    };
}

pub(crate) use calls;

/// What may be called at any time.
pub(crate) const ALWAYS: &[Phase] = &[Instantiated, Initialization, Ready, Discarded, Terminated, Broken];

calls! {
    SET_DEBUG_LOGGING "fmi2SetDebugLogging": Instantiated Initialization Ready Discarded Terminated Broken;
    SETUP_EXPERIMENT "fmi2SetupExperiment": Instantiated;
    ENTER_INITIALIZATION_MODE "fmi2EnterInitializationMode": Instantiated;
    EXIT_INITIALIZATION_MODE "fmi2ExitInitializationMode": Initialization;
    TERMINATE "fmi2Terminate": Ready Discarded;
    RESET "fmi2Reset": Instantiated Initialization Ready Discarded Terminated Broken;
    GET_REAL "fmi2GetReal": Initialization Ready Discarded Terminated;
    GET_INTEGER "fmi2GetInteger": Initialization Ready Discarded Terminated;
    GET_BOOLEAN "fmi2GetBoolean": Initialization Ready Discarded Terminated;
    GET_STRING "fmi2GetString": Initialization Ready Discarded Terminated;
    SET_REAL "fmi2SetReal": Instantiated Initialization Ready Discarded;
    SET_INTEGER "fmi2SetInteger": Instantiated Initialization Ready Discarded;
    SET_BOOLEAN "fmi2SetBoolean": Instantiated Initialization Ready Discarded;
    SET_STRING "fmi2SetString": Instantiated Initialization Ready Discarded;
    GET_STATE "fmi2GetFMUstate": Instantiated Initialization Ready Discarded Terminated;
    SET_STATE "fmi2SetFMUstate": Instantiated Initialization Ready Discarded Terminated;
    FREE_STATE "fmi2FreeFMUstate": Instantiated Initialization Ready Discarded Terminated Broken;
    SERIALIZED_SIZE "fmi2SerializedFMUstateSize": Instantiated Initialization Ready Discarded Terminated;
    SERIALIZE "fmi2SerializeFMUstate": Instantiated Initialization Ready Discarded Terminated;
    DESERIALIZE "fmi2DeSerializeFMUstate": Instantiated Initialization Ready Discarded Terminated;
    GET_DIRECTIONAL_DERIVATIVE "fmi2GetDirectionalDerivative": Initialization Ready Discarded Terminated;
    SET_INPUT_DERIVATIVES "fmi2SetRealInputDerivatives": Instantiated Initialization Ready Discarded;
    GET_OUTPUT_DERIVATIVES "fmi2GetRealOutputDerivatives": Ready Discarded Terminated;
    DO_STEP "fmi2DoStep": Ready Discarded;
    CANCEL_STEP "fmi2CancelStep": Ready Discarded;
    GET_STATUS "fmi2GetStatus": Ready Discarded Terminated;
    GET_REAL_STATUS "fmi2GetRealStatus": Ready Discarded Terminated;
    GET_INTEGER_STATUS "fmi2GetIntegerStatus": Ready Discarded Terminated;
    GET_BOOLEAN_STATUS "fmi2GetBooleanStatus": Ready Discarded Terminated;
    GET_STRING_STATUS "fmi2GetStringStatus": Ready Discarded Terminated;
}
