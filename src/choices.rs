//! From the name of a model in a scene to its type in the program.

/// Declares the list of models of one kind.
///
/// Yields an enum of the models' `Keys` as the scene writes them (`[contact.<law>.<kind>.<model>]`, the
/// model's file name being its name in the scene), a visitor trait, `visit`, which hands the type to the
/// visitor, and `NAMES`. A new model is one row.
macro_rules! choices {
    ($(#[$doc:meta])* $choice:ident of $kind:ident, taken by $visitor:ident: $($file:ident::$model:ident,)+) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, serde::Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum $choice {
            $(#[doc = concat!("`", stringify!($file), "`")] $model(<$file::$model as $kind>::Keys),)+
        }

        /// What to do with the model once its type is known.
        pub trait $visitor {
            /// The type of the result.
            type Output;
            /// Called once, with the type that the scene named.
            fn take<M: $kind>(self, keys: &M::Keys) -> Self::Output;
        }

        impl $choice {
            /// The models' names in a scene.
            pub const NAMES: &'static [&'static str] = &[$(stringify!($file)),+];

            /// What each model remembers of a contact, by its name.
            pub const MEMORIES: &'static [(&'static str, Option<super::HistoryRow>)] =
                &[$((stringify!($file), <$file::$model as $kind>::HISTORY)),+];

            /// The model's name in a scene.
            pub fn name(&self) -> &'static str {
                match self { $(Self::$model(_) => stringify!($file),)+ }
            }

            /// Goes from the name in the scene to the type in the program.
            pub fn visit<V: $visitor>(&self, visitor: V) -> V::Output {
                match self { $(Self::$model(keys) => visitor.take::<$file::$model>(keys),)+ }
            }
        }
    };
}
pub(crate) use choices;
