//! The library of units with the sub-models of the program.

cograin_unit::unit!(cograin::scene::Models::standard());
