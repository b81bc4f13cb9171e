//! On intervals and columns of what is written.

use crate::interface::{Interface, MOST_COLUMNS};
use crate::scene::{Scene, Step};

/// Remarks on intervals that end behind the run, or are not a whole number of given steps.
pub(super) fn intervals(scene: &Scene) -> Vec<String> {
    let output = &scene.output;
    let named = [
        ("history_interval", output.history_interval),
        ("frame_interval", output.frame_interval),
        ("checkpoint_interval", output.checkpoint_interval),
    ];
    let mut remarks = Vec::new();
    for (key, interval) in named.into_iter().filter_map(|(key, interval)| Some((key, interval?))) {
        if let Some(end) = scene.run.end.filter(|end| interval > *end) {
            remarks.push(format!("[output] {key}: {interval:e} s is longer than the run, which ends at {end:e} s"));
        } else if let Step::Given(step) = scene.run.step
            && ((interval / step).round() * step - interval).abs() > 1e-6 * step
        {
            remarks.push(format!(
                "[output] {key}: {interval:e} s is not a whole number of steps of {step:e} s; they are shortened to fit"
            ));
        }
    }
    remarks
}

/// On columns of `history.csv` that are left out because there would be very many.
pub(super) fn columns(scene: &Scene) -> Option<String> {
    let interface = Interface::of(scene);
    let all = interface.outputs().filter(|(_, variable)| variable.element().is_none()).count();
    (scene.output.columns.is_none() && all > MOST_COLUMNS).then(|| {
        format!(
            "[output] columns: history.csv has {} of {all} outputs, without those of groups of particles; columns names those that you \
             want, [\"*\"] all of them",
            interface.recorded().count()
        )
    })
}
