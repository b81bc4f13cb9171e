//! Every function that FMI 2.0 asks of a unit for co-simulation has the parameters and the result that `fmi-sys` declares, made from the
//! standard's own headers.

use fmi::fmi2::binding::{Fmi2Binding, fmi2CallbackFunctions};
use std::any::type_name;
use std::collections::BTreeMap;
use std::ffi::c_char;
use std::fs;
use std::path::Path;

/// An integer of 32 bits: enumerations of C are unsigned for `fmi-sys`, and are passed in the same way.
const INTEGER: &str = "int";

/// A type of C as `fmi-sys` writes it, for one of ours as it is written.
fn c_type(ours: &str) -> String {
    if let Some((kind, pointed)) =
        ["*const ", "*mut "].into_iter().find_map(|kind| Some((kind, ours.strip_prefix(kind)?)))
    {
        return format!("{kind}{}", c_type(pointed));
    }
    let named = match ours.rsplit("::").next().unwrap_or(ours) {
        "Component" | "StateHandle" => "*mut core::ffi::c_void",
        "Reference" | "Boolean" | "c_int" | "Status" => INTEGER,
        "Text" => return c_type("*const c_char"),
        "c_char" => type_name::<c_char>(),
        "Callbacks" => type_name::<fmi2CallbackFunctions>(),
        "f64" | "usize" => ours,
        _ => panic!("{ours} is no type that is known here"),
    };
    named.to_owned()
}

/// The signature of each exported function of the unit: its parameters and its result.
fn ours() -> BTreeMap<String, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fmu/src");
    let mut found = BTreeMap::new();
    for name in ["lib.rs", "v2/mod.rs", "v2/values.rs"] {
        let path = folder.join(name);
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        for rest in text.split("#[unsafe(no_mangle)]").skip(1) {
            let (_, rest) = rest.split_once(" fn ").expect("a function follows");
            if !rest.starts_with("fmi2") {
                continue;
            }
            let (head, _) = rest.split_once('{').expect("a function has a body");
            let (name, rest) = head.split_once('(').expect("a function has parameters");
            let (parameters, result) = rest.rsplit_once(')').expect("a function has parameters");
            let parameters: Vec<String> = parameters
                .split(',')
                .filter(|parameter| !parameter.trim().is_empty())
                .map(|parameter| c_type(parameter.split_once(": ").expect("a parameter has a type").1.trim()))
                .collect();
            let result = result.trim().strip_prefix("-> ").map(|result| format!(" -> {}", c_type(result)));
            found.insert(name.to_owned(), format!("fn({}){}", parameters.join(", "), result.unwrap_or_default()));
        }
    }
    found
}

/// The signature of a function of `fmi-sys`, which holds the function or why it was not found.
fn theirs<F, E>(_: impl Fn(&Fmi2Binding) -> &Result<F, E>) -> String {
    let name = type_name::<F>();
    name[name.find("fn(").expect("it is a function")..].replace("u32", INTEGER).replace("i32", INTEGER)
}

/// Names and signatures of functions of `fmi-sys`.
macro_rules! declared {
    ($($name:ident)*) => { BTreeMap::from([$((stringify!($name).to_owned(), theirs(|binding| &binding.$name))),*]) };
}

#[test]
fn every_function_of_the_unit_has_the_signature_of_the_standard() {
    let theirs = declared!(
        fmi2GetTypesPlatform fmi2GetVersion fmi2SetDebugLogging fmi2Instantiate fmi2FreeInstance fmi2SetupExperiment
        fmi2EnterInitializationMode fmi2ExitInitializationMode fmi2Terminate fmi2Reset fmi2GetReal fmi2GetInteger fmi2GetBoolean
        fmi2GetString fmi2SetReal fmi2SetInteger fmi2SetBoolean fmi2SetString fmi2GetFMUstate fmi2SetFMUstate fmi2FreeFMUstate
        fmi2SerializedFMUstateSize fmi2SerializeFMUstate fmi2DeSerializeFMUstate fmi2GetDirectionalDerivative
        fmi2SetRealInputDerivatives fmi2GetRealOutputDerivatives fmi2DoStep fmi2CancelStep fmi2GetStatus fmi2GetRealStatus
        fmi2GetIntegerStatus fmi2GetBooleanStatus fmi2GetStringStatus
    );
    assert_eq!(theirs.len(), 34);
    assert_eq!(ours(), theirs);
}
