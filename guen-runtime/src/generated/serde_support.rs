//! Records in files: serde for the structs of a generated system, as a macro that generated code calls always and that
//! expands to nothing without the feature `serde`: only this crate knows whether the feature is on.

/// Implements serde's `Serialize` and `Deserialize` for a record of reals, as a struct of its fields.
///
/// `serde_record!(Type, "Type", count, [names], to_array, from_array)`: the names in order, and the way from and to an
/// array. Every field has to be there when it is read, each once, and no other. Without the feature `serde` it expands to
/// nothing. Works without a prelude and from any crate name. A record that has its names as `NAMES` and converts from and to
/// an array is `serde_record!(Type, "Type", count)`. With `derived` and a list of which fields are
/// [`Derived`](crate::Derived) behind the names the arrays are of options: such a field may be missing, and follows then.
///
/// ```
/// #[derive(Debug, PartialEq, Clone, Copy)]
/// struct Point<R> { x: R, y: R }
/// guen_runtime::serde_record!(Point, "Point", 2, ["x", "y"], |p| [p.x, p.y], |[x, y]| Point { x, y });
/// ```
#[cfg(feature = "serde")]
#[macro_export]
macro_rules! serde_record {
    ($Type:ident, $name:literal, $n:literal) => {
        $crate::serde_record!(
            $Type,
            $name,
            $n,
            $Type::<f64>::NAMES,
            |record| ::core::convert::From::from(*record),
            ::core::convert::From::from
        );
    };
    ($Type:ident, $name:literal, $n:literal, $names:expr, derived $derived:expr, $to:expr, $from:expr) => {
        impl<R: $crate::serde::Serialize + ::core::marker::Copy> $crate::serde::Serialize for $Type<R> {
            fn serialize<GuenSerializer: $crate::serde::Serializer>(
                &self,
                serializer: GuenSerializer,
            ) -> ::core::result::Result<GuenSerializer::Ok, GuenSerializer::Error> {
                let to: fn(&$Type<R>) -> [::core::option::Option<R>; $n] = $to;
                $crate::serialize_derived(serializer, $name, &$names, &$derived, &to(self))
            }
        }

        impl<'de, R: $crate::serde::Deserialize<'de>> $crate::serde::Deserialize<'de> for $Type<R> {
            fn deserialize<GuenDeserializer: $crate::serde::Deserializer<'de>>(
                deserializer: GuenDeserializer,
            ) -> ::core::result::Result<Self, GuenDeserializer::Error> {
                const NAMES: [&'static str; $n] = $names;
                const DERIVED: [bool; $n] = $derived;
                let from: fn([::core::option::Option<R>; $n]) -> ::core::option::Option<$Type<R>> = $from;
                $crate::deserialize_derived(deserializer, $name, &NAMES, &DERIVED, from)
            }
        }
    };
    ($Type:ident, $name:literal, $n:literal, $names:expr, $to:expr, $from:expr) => {
        impl<R: $crate::serde::Serialize + ::core::marker::Copy> $crate::serde::Serialize for $Type<R> {
            fn serialize<GuenSerializer: $crate::serde::Serializer>(
                &self,
                serializer: GuenSerializer,
            ) -> ::core::result::Result<GuenSerializer::Ok, GuenSerializer::Error> {
                let to: fn(&$Type<R>) -> [R; $n] = $to;
                $crate::serialize_record(serializer, $name, &$names, &to(self))
            }
        }

        impl<'de, R: $crate::serde::Deserialize<'de>> $crate::serde::Deserialize<'de> for $Type<R> {
            fn deserialize<GuenDeserializer: $crate::serde::Deserializer<'de>>(
                deserializer: GuenDeserializer,
            ) -> ::core::result::Result<Self, GuenDeserializer::Error> {
                const NAMES: [&'static str; $n] = $names;
                let from: fn([R; $n]) -> $Type<R> = $from;
                let values =
                    $crate::deserialize_record::<GuenDeserializer, R, $n>(deserializer, $name, &NAMES)?;
                ::core::result::Result::Ok(from(values))
            }
        }
    };
}

/// Expands to nothing: the feature `serde`, with which it implements serde's traits for a record, is off.
#[cfg(not(feature = "serde"))]
#[macro_export]
macro_rules! serde_record {
    ($Type:ident, $name:literal, $n:literal) => {};
    // An expression may begin with this word: where both could follow, the macro is ambiguous.
    ($Type:ident, $name:literal, $n:literal, $names:expr, derived $derived:expr, $to:expr, $from:expr) => {};
    ($Type:ident, $name:literal, $n:literal, $names:expr, $to:expr, $from:expr) => {};
}

#[cfg(feature = "serde")]
pub use with_serde::{deserialize_derived, deserialize_record, serialize_derived, serialize_record};

#[cfg(feature = "serde")]
mod with_serde {
    use core::fmt;
    use core::marker::PhantomData;

    use serde::de::{Deserialize, DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
    use serde::ser::{Serialize, SerializeStruct, Serializer};

    /// Writes a record as a struct; [`serde_record!`](crate::serde_record) calls it.
    ///
    /// # Errors
    ///
    /// Those of the serializer.
    #[doc(hidden)]
    pub fn serialize_record<S: Serializer, R: Serialize>(
        serializer: S,
        name: &'static str,
        names: &[&'static str],
        values: &[R],
    ) -> Result<S::Ok, S::Error> {
        let mut record = serializer.serialize_struct(name, names.len())?;
        for (name, value) in names.iter().zip(values) {
            record.serialize_field(name, value)?;
        }
        record.end()
    }

    /// Writes a record in which some fields may follow others; [`serde_record!`](crate::serde_record) calls it.
    ///
    /// # Errors
    ///
    /// Those of the serializer.
    #[doc(hidden)]
    pub fn serialize_derived<S: Serializer, R: Serialize>(
        serializer: S,
        name: &'static str,
        names: &[&'static str],
        derived: &[bool],
        values: &[Option<R>],
    ) -> Result<S::Ok, S::Error> {
        let mut record = serializer.serialize_struct(name, names.len())?;
        for ((name, derived), value) in names.iter().zip(derived).zip(values) {
            match value {
                Some(given) if !derived => record.serialize_field(name, given)?,
                _ => record.serialize_field(name, value)?,
            }
        }
        record.end()
    }

    /// Reads a record; [`serde_record!`](crate::serde_record) calls it.
    ///
    /// # Errors
    ///
    /// Those of the deserializer; a field that is missing, unknown or there twice.
    #[doc(hidden)]
    pub fn deserialize_record<'de, D: Deserializer<'de>, R: Deserialize<'de>, const N: usize>(
        deserializer: D,
        name: &'static str,
        names: &'static [&'static str],
    ) -> Result<[R; N], D::Error> {
        let fields = Fields { name, names, derived: &Fields::<R, N>::NONE, real: PhantomData };
        let mut values = deserializer.deserialize_struct(name, names, fields)?.into_iter().flatten();
        // No field may be missing, so that each has a value here.
        Ok([(); N].map(|()| values.next().expect("every field is there")))
    }

    /// Reads a record in which some fields may be missing; [`serde_record!`](crate::serde_record) calls it.
    ///
    /// # Errors
    ///
    /// Those of the deserializer; a field that is missing and follows no other, is unknown or there twice.
    #[doc(hidden)]
    pub fn deserialize_derived<'de, D: Deserializer<'de>, R: Deserialize<'de>, T, const N: usize>(
        deserializer: D,
        name: &'static str,
        names: &'static [&'static str],
        derived: &'static [bool; N],
        from: fn([Option<R>; N]) -> Option<T>,
    ) -> Result<T, D::Error> {
        let fields = Fields { name, names, derived, real: PhantomData };
        let values = deserializer.deserialize_struct(name, names, fields)?;
        from(values).ok_or_else(|| D::Error::custom("a field is missing"))
    }

    struct Fields<R, const N: usize> {
        name: &'static str,
        names: &'static [&'static str],
        /// Tells for each constant whether it may be missing.
        derived: &'static [bool; N],
        real: PhantomData<R>,
    }

    impl<R, const N: usize> Fields<R, N> {
        /// No field may be missing.
        const NONE: [bool; N] = [false; N];

        /// The values, or the name of the first that is missing.
        fn all<E: Error>(&self, values: [Option<R>; N]) -> Result<[Option<R>; N], E> {
            match (0..N).find(|k| values[*k].is_none() && !self.derived[*k]) {
                Some(missing) => Err(E::missing_field(self.names[missing])),
                None => Ok(values),
            }
        }
    }

    impl<'de, R: Deserialize<'de>, const N: usize> Visitor<'de> for Fields<R, N> {
        type Value = [Option<R>; N];

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "the {N} fields of `{}`", self.name)
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Self::Value, A::Error> {
            let mut values = [const { None }; N];
            for (k, value) in values.iter_mut().enumerate() {
                let missing = |visitor: &Self| A::Error::invalid_length(k, visitor);
                *value = if self.derived[k] {
                    sequence.next_element()?.ok_or_else(|| missing(&self))?
                } else {
                    Some(sequence.next_element()?.ok_or_else(|| missing(&self))?)
                };
            }
            self.all(values)
        }

        fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let mut values: [Option<R>; N] = [const { None }; N];
            let mut seen = [false; N];
            while let Some(place) = map.next_key_seed(FieldName(self.names))? {
                if seen[place] {
                    return Err(A::Error::duplicate_field(self.names[place]));
                }
                seen[place] = true;
                values[place] = if self.derived[place] { map.next_value()? } else { Some(map.next_value()?) };
            }
            self.all(values)
        }
    }

    /// A name among those of the fields, as its place.
    struct FieldName(&'static [&'static str]);

    impl<'de> DeserializeSeed<'de> for FieldName {
        type Value = usize;

        fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<usize, D::Error> {
            deserializer.deserialize_identifier(self)
        }
    }

    impl Visitor<'_> for FieldName {
        type Value = usize;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("the name of a field")
        }

        fn visit_u64<E: Error>(self, place: u64) -> Result<usize, E> {
            let known = usize::try_from(place).ok().filter(|place| *place < self.0.len());
            known.ok_or_else(|| E::invalid_value(serde::de::Unexpected::Unsigned(place), &self))
        }

        fn visit_str<E: Error>(self, name: &str) -> Result<usize, E> {
            let place = self.0.iter().position(|known| *known == name);
            place.ok_or_else(|| E::unknown_field(name, self.0))
        }
    }
}
