//! Records with arrays in files: serde for structs whose values stand in fields, arrays and structs.

/// The content of a field of a generated struct.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One value.
    Value,
    /// An array of so many entries.
    Array(usize, &'static Shape),
    /// A struct with its fields.
    Struct(&'static [(&'static str, Shape)]),
}

impl Shape {
    /// The number of values.
    ///
    /// ```
    /// use guen_runtime::Shape;
    /// assert_eq!(Shape::Array(3, &Shape::Array(2, &Shape::Value)).values(), 6);
    /// assert_eq!(Shape::Struct(&[("x", Shape::Value), ("q", Shape::Array(4, &Shape::Value))]).values(), 5);
    /// ```
    pub const fn values(&self) -> usize {
        match self {
            Shape::Value => 1,
            Shape::Array(count, entry) => *count * entry.values(),
            Shape::Struct(fields) => {
                let (mut sum, mut field) = (0, 0);
                while field < fields.len() {
                    sum += fields[field].1.values();
                    field += 1;
                }
                sum
            }
        }
    }
}

/// Implements serde's `Serialize` and `Deserialize` for a record whose values stand in arrays and structs, as
/// [`serde_record!`](crate::serde_record) does for a record of reals.
///
/// `serde_structured!(Type, "Type", count, [names of the fields], shapes, derived, to_array, from_array)`: the arrays are of options
/// in the order of the fields; a value that is derived may be `null`, and follows then. Without the feature `serde` it expands to
/// nothing.
#[cfg(feature = "serde")]
#[doc(hidden)]
#[macro_export]
macro_rules! serde_structured {
    ($Type:ident, $name:literal, $n:literal, $names:expr, $shapes:expr, $derived:expr, $to:expr, $from:expr) => {
        impl<R: $crate::serde::Serialize + ::core::marker::Copy> $crate::serde::Serialize for $Type<R> {
            fn serialize<GuenSerializer: $crate::serde::Serializer>(
                &self,
                serializer: GuenSerializer,
            ) -> ::core::result::Result<GuenSerializer::Ok, GuenSerializer::Error> {
                let to: fn(&$Type<R>) -> [::core::option::Option<R>; $n] = $to;
                $crate::serialize_structured(serializer, $name, $shapes, &$derived, &to(self))
            }
        }

        impl<'de, R: $crate::serde::Deserialize<'de> + ::core::marker::Copy> $crate::serde::Deserialize<'de>
            for $Type<R>
        {
            fn deserialize<GuenDeserializer: $crate::serde::Deserializer<'de>>(
                deserializer: GuenDeserializer,
            ) -> ::core::result::Result<Self, GuenDeserializer::Error> {
                const DERIVED: [bool; $n] = $derived;
                let from: fn([::core::option::Option<R>; $n]) -> ::core::option::Option<$Type<R>> = $from;
                $crate::deserialize_structured(deserializer, $name, &$names, $shapes, &DERIVED, from)
            }
        }
    };
}

/// Expands to nothing: the feature `serde` is off.
#[cfg(not(feature = "serde"))]
#[doc(hidden)]
#[macro_export]
macro_rules! serde_structured {
    ($($anything:tt)*) => {};
}

#[cfg(feature = "serde")]
pub use with_serde::{deserialize_structured, serialize_structured};

#[cfg(feature = "serde")]
mod with_serde {
    use core::fmt;
    use core::marker::PhantomData;

    use serde::de::{Deserialize, DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
    use serde::ser::{Serialize, SerializeStruct, SerializeTuple, Serializer};

    use super::Shape;

    /// Writes a record; [`serde_structured!`](crate::serde_structured) calls it.
    ///
    /// # Errors
    ///
    /// Those of the serializer.
    #[doc(hidden)]
    pub fn serialize_structured<S: Serializer, R: Serialize>(
        serializer: S,
        name: &'static str,
        fields: &'static [(&'static str, Shape)],
        derived: &[bool],
        values: &[Option<R>],
    ) -> Result<S::Ok, S::Error> {
        let mut record = serializer.serialize_struct(name, fields.len())?;
        let mut before = 0;
        for (name, shape) in fields {
            let own = before..before + shape.values();
            before = own.end;
            let part = Part { shape, derived: &derived[own.clone()], values: &values[own] };
            record.serialize_field(name, &part)?;
        }
        record.end()
    }

    /// A part of the values with its shape.
    struct Part<'a, R> {
        shape: &'static Shape,
        derived: &'a [bool],
        values: &'a [Option<R>],
    }

    impl<R: Serialize> Serialize for Part<'_, R> {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            match self.shape {
                Shape::Value => match &self.values[0] {
                    Some(value) if !self.derived[0] => value.serialize(serializer),
                    value => value.serialize(serializer),
                },
                Shape::Array(count, entry) => {
                    let size = entry.values();
                    let mut tuple = serializer.serialize_tuple(*count)?;
                    for k in 0..*count {
                        let own = k * size..(k + 1) * size;
                        let (derived, values) = (&self.derived[own.clone()], &self.values[own]);
                        tuple.serialize_element(&Part { shape: entry, derived, values })?;
                    }
                    tuple.end()
                }
                Shape::Struct(fields) => {
                    serialize_structured(serializer, "", fields, self.derived, self.values)
                }
            }
        }
    }

    /// Reads a record; [`serde_structured!`](crate::serde_structured) calls it.
    ///
    /// # Errors
    ///
    /// Those of the deserializer; a field that is missing and follows no other, is unknown or there twice.
    #[doc(hidden)]
    pub fn deserialize_structured<'de, D: Deserializer<'de>, R: Deserialize<'de>, T, const N: usize>(
        deserializer: D,
        name: &'static str,
        names: &'static [&'static str],
        fields: &'static [(&'static str, Shape)],
        derived: &'static [bool; N],
        from: fn([Option<R>; N]) -> Option<T>,
    ) -> Result<T, D::Error> {
        let mut values = [const { None }; N];
        let fields = Fields { name, fields, derived, values: &mut values, real: PhantomData };
        deserializer.deserialize_struct(name, names, fields)?;
        from(values).ok_or_else(|| D::Error::custom("a field is missing"))
    }

    /// The fields of a struct, whose values are read into a list.
    struct Fields<'a, R> {
        name: &'static str,
        fields: &'static [(&'static str, Shape)],
        derived: &'static [bool],
        values: &'a mut [Option<R>],
        real: PhantomData<R>,
    }

    impl<R> Fields<'_, R> {
        /// The values of a field.
        fn part(&mut self, field: usize) -> Reader<'_, R> {
            let before: usize = self.fields[..field].iter().map(|(_, shape)| shape.values()).sum();
            let shape = &self.fields[field].1;
            let own = before..before + shape.values();
            Reader { shape, derived: &self.derived[own.clone()], values: &mut self.values[own] }
        }

        /// Whether a value of a field has been read.
        fn is_read(&mut self, field: usize) -> bool {
            self.part(field).values.iter().any(Option::is_some)
        }

        /// Whether a field may be missing: every value in it follows others.
        fn may_be_missing(&self, field: usize) -> bool {
            let before: usize = self.fields[..field].iter().map(|(_, shape)| shape.values()).sum();
            self.derived[before..before + self.fields[field].1.values()].iter().all(|derived| *derived)
        }
    }

    impl<'de, R: Deserialize<'de>> Visitor<'de> for Fields<'_, R> {
        type Value = ();

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "the {} fields of `{}`", self.fields.len(), self.name)
        }

        fn visit_seq<A: SeqAccess<'de>>(mut self, mut sequence: A) -> Result<(), A::Error> {
            for field in 0..self.fields.len() {
                if sequence.next_element_seed(self.part(field))?.is_none() {
                    return Err(A::Error::invalid_length(field, &self));
                }
            }
            Ok(())
        }

        fn visit_map<A: MapAccess<'de>>(mut self, mut map: A) -> Result<(), A::Error> {
            while let Some(field) = map.next_key_seed(FieldName(self.fields))? {
                if self.is_read(field) {
                    return Err(A::Error::duplicate_field(self.fields[field].0));
                }
                map.next_value_seed(self.part(field))?;
            }
            match (0..self.fields.len()).find(|field| !self.is_read(*field) && !self.may_be_missing(*field)) {
                Some(missing) => Err(A::Error::missing_field(self.fields[missing].0)),
                None => Ok(()),
            }
        }
    }

    /// A part of the values that is read.
    struct Reader<'a, R> {
        shape: &'static Shape,
        derived: &'static [bool],
        values: &'a mut [Option<R>],
    }

    impl<'de, R: Deserialize<'de>> DeserializeSeed<'de> for Reader<'_, R> {
        type Value = ();

        fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
            match self.shape {
                Shape::Value => {
                    self.values[0] = match self.derived[0] {
                        true => Option::deserialize(deserializer)?,
                        false => Some(R::deserialize(deserializer)?),
                    };
                    Ok(())
                }
                Shape::Array(count, _) => deserializer.deserialize_tuple(*count, Entries(self)),
                Shape::Struct(fields) => {
                    let Reader { derived, values, .. } = self;
                    let fields = Fields { name: "", fields, derived, values, real: PhantomData };
                    deserializer.deserialize_struct("", &[], fields)
                }
            }
        }
    }

    /// The entries of an array.
    struct Entries<'a, R>(Reader<'a, R>);

    impl<'de, R: Deserialize<'de>> Visitor<'de> for Entries<'_, R> {
        type Value = ();

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            match self.0.shape {
                Shape::Array(count, _) => write!(f, "an array of {count} entries"),
                _ => f.write_str("an array"),
            }
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<(), A::Error> {
            let Shape::Array(count, entry) = self.0.shape else { return Ok(()) };
            let size = entry.values();
            for k in 0..*count {
                let own = k * size..(k + 1) * size;
                let (derived, values) = (&self.0.derived[own.clone()], &mut self.0.values[own]);
                if sequence.next_element_seed(Reader { shape: entry, derived, values })?.is_none() {
                    return Err(A::Error::invalid_length(k, &self));
                }
            }
            Ok(())
        }
    }

    /// A name among those of the fields, as its place.
    struct FieldName(&'static [(&'static str, Shape)]);

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
            let place = self.0.iter().position(|(known, _)| *known == name);
            place.ok_or_else(|| E::custom(format_args!("unknown field `{name}`")))
        }
    }
}
