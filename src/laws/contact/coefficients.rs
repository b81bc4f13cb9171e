//! The numbers of a sub-model, as fields and as a row of plain numbers.

use crate::base::number::Number;

/// The numbers a sub-model needs in its loop, one set for each pair of materials.
pub trait Coefficients: Copy + Send + Sync + 'static {
    /// The same set with a lane vector for each number.
    type Lanes<N: Number>: Copy;
    /// How many numbers there are.
    const COUNT: usize;
    /// Writes the numbers, in the order of declaration.
    fn write(&self, row: &mut Vec<f64>);
    /// Takes them back.
    fn read(row: &[f64]) -> Self;
    /// The lane form of a row of [`Coefficients::COUNT`] numbers.
    fn lanes<N: Number>(row: &[N]) -> Self::Lanes<N>;
}

/// Declares the coefficients of a sub-model: a struct of [`Number`]s that implements [`Coefficients`].
#[macro_export]
macro_rules! coefficients {
    ($(#[$doc:meta])* $visibility:vis struct $name:ident { $($(#[$field_doc:meta])* $field:ident,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        $visibility struct $name<N = f64> {
            $($(#[$field_doc])* $visibility $field: N,)*
            /// Makes a struct without coefficients generic all the same.
            #[doc(hidden)]
            $visibility marker: std::marker::PhantomData<N>,
        }

        impl $name {
            /// The coefficients with these values, in the order of the fields.
            #[allow(clippy::new_without_default, reason = "a sub-model without coefficients has no default meaning")]
            #[allow(clippy::too_many_arguments, reason = "one for each coefficient")]
            $visibility fn new($($field: f64),*) -> Self {
                Self { $($field,)* marker: std::marker::PhantomData }
            }
        }

        impl $crate::contact::Coefficients for $name {
            type Lanes<N: $crate::number::Number> = $name<N>;
            const COUNT: usize = <[&str]>::len(&[$(stringify!($field)),*]);
            fn write(&self, _row: &mut Vec<f64>) {
                $(_row.push(self.$field);)*
            }
            fn read(row: &[f64]) -> Self {
                Self::lanes(row)
            }
            #[inline(always)]
            fn lanes<N: $crate::number::Number>(row: &[N]) -> $name<N> {
                let mut _row = row.iter();
                $(let $field = *_row.next().expect("a row has as many numbers as the sub-model");)*
                $name { $($field,)* marker: std::marker::PhantomData }
            }
        }
    };
}
pub(crate) use coefficients;
