//! `cograin verify`

use super::{Ending, say};
use clap::Args;
use cograin::bond::keys::FormulationChoice;
use cograin_verify as verify;
use rayon::prelude::*;
use std::path::PathBuf;

/// `cograin verify`
#[derive(Args)]
pub(super) struct VerifyArguments {
    /// Cases, or folders of cases
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    /// Largest relative error, unless the case is more sensitive
    #[arg(long, value_name = "ERROR", default_value_t = verify::Options::default().tolerance)]
    tolerance: f64,
    /// Folder that gets the trajectories
    #[arg(long, value_name = "OUT")]
    write: Option<PathBuf>,
    /// Run cases of bonds from their start, instead of from each sample to the next
    #[arg(long)]
    free: bool,
    /// Formulation of bonds; all except engine_exact run from the start of a case
    #[arg(long, value_name = "NAME", default_value = "engine_exact", value_parser = formulation)]
    formulation: FormulationChoice,
}

/// A formulation by its name.
fn formulation(name: &str) -> Result<FormulationChoice, String> {
    let names = || FormulationChoice::ALL.iter().map(|choice| choice.name()).collect::<Vec<_>>().join(", ");
    FormulationChoice::named(name).ok_or_else(|| format!("expected one of {}, found {name}", names()))
}

/// `cograin verify`
pub(super) fn replay(arguments: &VerifyArguments) -> Result<(), Ending> {
    let options = verify::Options {
        tolerance: arguments.tolerance,
        write: arguments.write.clone(),
        free: arguments.free,
        formulation: arguments.formulation,
    };
    let cases = verify::find(&arguments.folders).map_err(Ending::refused)?;
    let reports: Vec<_> = cases.par_iter().with_max_len(1).map(|case| verify::replay(case, &options)).collect();
    let mut failed = 0;
    for report in reports {
        let report = report.map_err(Ending::refused)?;
        failed += usize::from(!report.passed());
        say(report)?;
    }
    if failed > 0 { Err(Ending::failed(format_args!("{failed} of {} cases failed", cases.len()))) } else { Ok(()) }
}
