//! Copies into memory that is already there.

/// Writes `Clone` for a struct: `clone_from` uses the memory of every list again, which the derived one does not. A field
/// that is not named does not compile.
macro_rules! clone_in_place {
    ($type:ident { $($field:ident),* $(,)? }) => {
        impl Clone for $type {
            fn clone(&self) -> Self {
                Self { $($field: self.$field.clone()),* }
            }

            fn clone_from(&mut self, other: &Self) {
                $(self.$field.clone_from(&other.$field);)*
            }
        }
    };
}

pub(super) use clone_in_place;
