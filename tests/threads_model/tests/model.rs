//! Each model, as a test.

use cograin_threads_model as model;

#[test]
fn every_piece_is_done_once_and_seen() {
    model::every_piece_is_done_once_and_seen();
}

#[test]
fn an_odd_slab_sees_what_its_neighbours_did() {
    model::an_odd_slab_sees_what_its_neighbours_did();
}

#[test]
fn a_helper_is_dismissed() {
    model::a_helper_is_dismissed();
}
