//! Modes of an expansion, with named fields.

/// The states of a contact as an enumeration, the first one first.
#[doc(hidden)]
#[macro_export]
macro_rules! contact_states {
    ($docs:literal $Name:ident $First:ident $($State:ident)*) => {
        #[doc = $docs]
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq, ::core::cmp::Eq,
            ::core::hash::Hash
        )]
        #[allow(missing_docs, reason = "the states are words of the language")]
        pub enum $Name {
            $First,
            $($State,)*
        }

        impl ::core::convert::From<$crate::hybrid::ElementState> for $Name {
            fn from(state: $crate::hybrid::ElementState) -> Self {
                match state {
                    $($crate::hybrid::ElementState::$State => $Name::$State,)*
                    _ => $Name::$First,
                }
            }
        }

        impl ::core::convert::From<$Name> for $crate::hybrid::ElementState {
            fn from(state: $Name) -> Self {
                match state {
                    $Name::$First => $crate::hybrid::ElementState::$First,
                    $($Name::$State => $crate::hybrid::ElementState::$State,)*
                }
            }
        }

        impl ::core::fmt::Display for $Name {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                f.write_str($crate::hybrid::ElementState::from(*self).word())
            }
        }
    };
}

/// `Mode`: the number of contacts, the fields, the names of the contacts, the way to the state of each, and the fields from states.
#[doc(hidden)]
#[macro_export]
macro_rules! contact_mode {
    (
        $count:literal { $($(#[$($doc:tt)*])* pub $field:ident: $State:ty,)* } [$($name:literal)*]
        |$mode:ident| [$($state:expr),*] { $($literal:tt)* }
    ) => {
        /// A mode: the state of every contact.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq, ::core::cmp::Eq,
            ::core::hash::Hash
        )]
        pub struct Mode {
            $($(#[$($doc)*])* pub $field: $State,)*
        }

        impl ::core::convert::From<$crate::hybrid::Mode<$count>> for Mode {
            #[allow(unused_variables, reason = "a system with switches alone has one mode")]
            fn from($mode: $crate::hybrid::Mode<$count>) -> Self {
                Mode { $($literal)* }
            }
        }

        impl ::core::convert::From<Mode> for $crate::hybrid::Mode<$count> {
            #[allow(unused_variables, reason = "a system with switches alone has one mode")]
            fn from($mode: Mode) -> Self {
                $crate::hybrid::Mode([$(::core::convert::From::from($state)),*])
            }
        }

        impl ::core::fmt::Display for Mode {
            #[allow(unused_variables, unused_mut, unused_assignments, reason = "a system with switches alone has one mode")]
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                let ($mode, mut before) = (self, "");
                $(
                    ::core::write!(f, "{before}{} {}", $name, $state)?;
                    before = ", ";
                )*
                ::core::result::Result::Ok(())
            }
        }
    };
}

/// The `Mode` of an instance, with its fields.
#[doc(hidden)]
#[macro_export]
macro_rules! instance_mode {
    ($($(#[$($doc:tt)*])* pub $field:ident: $State:ty,)*) => {
        /// The states of the contacts of the instance.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq, ::core::cmp::Eq,
            ::core::hash::Hash
        )]
        pub struct Mode {
            $($(#[$($doc)*])* pub $field: $State,)*
        }
    };
}
