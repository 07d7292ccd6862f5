//! Numbers that come back from a file as they went, to the bit.
//!
//! Formats for people have no infinities and no NaN, so these are texts there: `"inf"`, `"-inf"`, `"NaN"`, and
//! `"NaN:fff8000000000001"` for a NaN with another sign or payload. All other numbers are the format's own; serde's JSON
//! reads them exactly with its feature `float_roundtrip`, which the feature `serde` of this crate turns on.

use std::fmt;

use serde::de::{Deserialize, Deserializer, Error, Visitor};
use serde::ser::{Serialize, Serializer};

/// A number as a file has it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exact(pub f64);

/// Writes a number; for fields: `#[serde(with = "crate::exact")]`.
pub(crate) fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if value.is_finite() || !serializer.is_human_readable() {
        return serializer.serialize_f64(*value);
    }
    let (bits, usual) = (value.to_bits(), f64::NAN.to_bits());
    if value.is_nan() && bits != usual {
        return serializer.collect_str(&format_args!("NaN:{bits:016x}"));
    }
    // `inf`, `-inf` and `NaN`.
    serializer.collect_str(value)
}

/// Reads a number that [`serialize`] wrote.
pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    if deserializer.is_human_readable() {
        deserializer.deserialize_any(Number)
    } else {
        deserializer.deserialize_f64(Number)
    }
}

struct Number;

impl Visitor<'_> for Number {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, \"inf\", \"-inf\" or \"NaN\"")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<f64, E> {
        Ok(value)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<f64, E> {
        let number = value as f64;
        // `u64::MAX` and its like round to a power of two beyond all of them.
        let same = number < u64::MAX as f64 && number as u64 == value;
        if same { Ok(number) } else { Err(E::custom(format!("{value} has more digits than a double"))) }
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<f64, E> {
        let size = self.visit_u64(value.unsigned_abs())?;
        Ok(if value < 0 { -size } else { size })
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<f64, E> {
        let number = match text {
            "inf" => Some(f64::INFINITY),
            "-inf" => Some(f64::NEG_INFINITY),
            "NaN" => Some(f64::NAN),
            _ => text
                .strip_prefix("NaN:")
                .and_then(|digits| u64::from_str_radix(digits, 16).ok())
                .map(f64::from_bits)
                .filter(|number| number.is_nan()),
        };
        number.ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(text), &self))
    }
}

impl Serialize for Exact {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serialize(&self.0, serializer)
    }
}

impl<'de> Deserialize<'de> for Exact {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserialize(deserializer).map(Self)
    }
}

/// Serialises fields with a number that may be missing: `#[serde(with = "crate::exact::option")]`.
#[cfg(feature = "study")]
pub(crate) mod option {
    use super::{Deserialize, Deserializer, Exact, Serialize, Serializer};

    pub(crate) fn serialize<S: Serializer>(value: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        value.map(Exact).serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
        Ok(Option::<Exact>::deserialize(deserializer)?.map(|Exact(value)| value))
    }
}

#[cfg(test)]
mod tests {
    use super::Exact;

    fn there_and_back(value: f64) -> f64 {
        let text = serde_json::to_string(&Exact(value)).unwrap();
        let Exact(back) = serde_json::from_str(&text).unwrap();
        back
    }

    #[test]
    fn every_double_comes_back() {
        let special = [
            0.0,
            -0.0,
            5e-324,
            f64::MIN_POSITIVE,
            f64::MAX,
            f64::MIN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
            -f64::NAN,
            f64::from_bits(0x7ff0_0000_0000_0001),
            f64::from_bits(u64::MAX),
            1e16,
            9_007_199_254_740_993.0,
        ];
        for value in special {
            assert_eq!(there_and_back(value).to_bits(), value.to_bits(), "{value:?}");
        }
        // Any bits at all, always the same: the generator of splitmix64.
        let mut state = 1_u64;
        let mut off = 0;
        for _ in 0..200_000 {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut bits = state;
            bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            bits ^= bits >> 31;
            off += u32::from(there_and_back(f64::from_bits(bits)).to_bits() != bits);
        }
        assert_eq!(off, 0);
    }

    #[test]
    fn what_is_no_double_is_refused() {
        for (text, number) in [("3", 3.0), ("-3", -3.0), ("9007199254740992", 9_007_199_254_740_992.0)] {
            assert_eq!(serde_json::from_str::<Exact>(text).unwrap().0, number);
        }
        for text in [
            "null",
            "true",
            "\"\"",
            "\"1.5\"",
            "\"nan\"",
            "\"NaN:0\"",
            "\"NaN:7ff0000000000000\"",
            "\"NaN:x\"",
            "9007199254740993",
            "18446744073709551615",
            "-9223372036854775807",
        ] {
            assert!(serde_json::from_str::<Exact>(text).is_err(), "{text}");
        }
    }
}
