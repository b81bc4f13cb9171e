//! Mistakes in what is asked of contacts, in words.

use super::{FLOOR, GRAINS};
use crate::support::read;

/// Fails unless a scene is refused in words with this part.
#[track_caller]
fn refused(more: &str, part: &str) {
    let text = format!(
        "{GRAINS}[particles.all]\nmaterial = \"stone\"\nlist = [{{ position = [0, 0, 2e-3], radius = 1e-3 }}]\n{FLOOR}{more}"
    );
    let found = read(&text).err().unwrap_or_else(|| panic!("accepted:\n{text}"));
    assert!(found.contains(part), "{found}");
}

#[test]
fn an_unknown_model_is_answered_with_the_nearest_name() {
    refused("[boundary.floor.wear.archad]\ncoefficient = 1e-12\n", "archard");
    refused("[boundary.floor.wear.archard]\ncoeficient = 1e-12\n", "coefficient");
    refused("[boundary.floor.wear.finnie]\nflow_stres = 1e9\n", "flow_stress");
    refused("[output]\nimpacts = { histograms = {} }\n", "histogram");
    refused("[output]\nimpacts = { histogram = { bins = 3 } }\n", "bins_per_decade");
}

#[test]
fn values_that_mean_nothing_are_refused() {
    refused("[boundary.floor.wear.archard]\ncoefficient = -1e-12\n", "expected a number above 0");
    refused("[boundary.floor.wear.archard]\n", "coefficient");
    refused("[boundary.floor.wear]\n", "a table [boundary.floor.wear.<model>]");
    refused("[output]\nimpacts = { histogram = { bins_per_decade = 0 } }\n", "bins_per_decade");
    refused("[output]\nimpacts = true\n", "impacts");
}

#[test]
fn a_group_of_particles_has_no_surface_to_wear() {
    let group = "[boundary.hand]\nparticles = { set = \"all\" }\n[boundary.hand.wear.archard]\ncoefficient = 1e-12\n";
    refused(group, "expected wear of a surface");
}
