//! Which function of FMI 3.0 may be called when.

use crate::calls::calls;

calls! {
    SET_DEBUG_LOGGING "fmi3SetDebugLogging": Instantiated Initialization Ready Discarded Terminated Broken;
    ENTER_INITIALIZATION_MODE "fmi3EnterInitializationMode": Instantiated;
    EXIT_INITIALIZATION_MODE "fmi3ExitInitializationMode": Initialization;
    TERMINATE "fmi3Terminate": Ready Discarded;
    RESET "fmi3Reset": Instantiated Initialization Ready Discarded Terminated Broken;
    GET_FLOAT64 "fmi3GetFloat64": Instantiated Initialization Ready Discarded Terminated;
    GET_INT32 "fmi3GetInt32": Instantiated Initialization Ready Discarded Terminated;
    GET_STRING "fmi3GetString": Instantiated Initialization Ready Discarded Terminated;
    SET_FLOAT64 "fmi3SetFloat64": Instantiated Initialization Ready Discarded;
    SET_INT32 "fmi3SetInt32": Instantiated Initialization Ready Discarded;
    SET_STRING "fmi3SetString": Instantiated Initialization Ready Discarded;
    GET_STATE "fmi3GetFMUState": Instantiated Initialization Ready Discarded Terminated;
    SET_STATE "fmi3SetFMUState": Instantiated Initialization Ready Discarded Terminated;
    FREE_STATE "fmi3FreeFMUState": Instantiated Initialization Ready Discarded Terminated Broken;
    SERIALIZED_SIZE "fmi3SerializedFMUStateSize": Instantiated Initialization Ready Discarded Terminated;
    SERIALIZE "fmi3SerializeFMUState": Instantiated Initialization Ready Discarded Terminated;
    DESERIALIZE "fmi3DeserializeFMUState": Instantiated Initialization Ready Discarded Terminated;
    GET_DIRECTIONAL_DERIVATIVE "fmi3GetDirectionalDerivative": Initialization Ready Discarded Terminated;
    GET_OUTPUT_DERIVATIVES "fmi3GetOutputDerivatives": Ready Discarded Terminated;
    DO_STEP "fmi3DoStep": Ready Discarded;
}
