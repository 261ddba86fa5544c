//! Values that stand for a missing one: fill values such as -9999, and everything outside a range.
//! It decides on single values as they are written in the file, before any unit; what is suspicious is said by the audit.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use std::borrow::Cow;

/// Relative difference below which a value is a fill value: files round 9.969209968386869e36 as they like.
const SAME_FILL: f64 = 1e-4;

/// Sizes of values that programs write for a missing one: nines, powers of ten, the ends of short integers, and netCDF's fill values.
const USUAL_FILLS: [f64; 15] = [
    999.0,
    9999.0,
    99_999.0,
    999_999.0,
    9_999_999.0,
    32_767.0,
    32_768.0,
    2_147_483_647.0,
    2_147_483_648.0,
    999.9,
    999.99,
    1e20,
    1e30,
    1e35,
    9.969_209_968_386_869e36,
];

/// Whether a value as written is one of those that programs write for a missing one.
pub fn usual_fill(value: f64) -> bool {
    USUAL_FILLS.iter().any(|fill| (value.abs() - fill).abs() <= SAME_FILL * fill)
}

/// Which values of a column, in its own unit, are taken for missing: `blank = -9999`, `blank = [-9999, 1e20]`, or
/// `blank = { equal = [-9999], outside = [-40, 40] }`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Blank {
    /// Values that are fill values.
    pub equal: Vec<f64>,
    /// Smallest and largest value that is not blanked.
    pub outside: Option<[f64; 2]>,
}

impl Blank {
    /// Whether a value is taken for missing.
    pub fn takes(&self, value: f64) -> bool {
        let fill = |f: &f64| value == *f || (value - f).abs() <= SAME_FILL * f.abs();
        self.equal.iter().any(fill) || self.outside.is_some_and(|[low, high]| value < low || value > high)
    }
}

/// Values that stand for a missing one: a value, a list of values, or this table.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct BlankTable {
    /// Fill values.
    #[serde(default)]
    equal: Vec<f64>,
    /// Smallest and largest value that is kept.
    outside: Option<[f64; 2]>,
}

impl JsonSchema for Blank {
    fn schema_name() -> Cow<'static, str> {
        "Blank".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let table = BlankTable::json_schema(generator);
        let list = Vec::<f64>::json_schema(generator);
        json_schema!({ "anyOf": [{ "type": "number" }, list, table] })
    }
}

impl<'de> Deserialize<'de> for Blank {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Any;
        impl<'de> serde::de::Visitor<'de> for Any {
            type Value = Blank;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a value, a list of values, or a table with `equal` or `outside`")
            }
            fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Blank, E> {
                checked(Blank { equal: vec![value], outside: None })
            }
            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<Blank, E> {
                self.visit_f64(value as f64)
            }
            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<Blank, E> {
                self.visit_f64(value as f64)
            }
            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut seq: A) -> Result<Blank, A::Error> {
                let mut equal = Vec::new();
                while let Some(value) = seq.next_element()? {
                    equal.push(value);
                }
                checked(Blank { equal, outside: None })
            }
            fn visit_map<M: serde::de::MapAccess<'de>>(self, map: M) -> Result<Blank, M::Error> {
                let t = BlankTable::deserialize(serde::de::value::MapAccessDeserializer::new(map))?;
                checked(Blank { equal: t.equal, outside: t.outside })
            }
        }
        deserializer.deserialize_any(Any)
    }
}

/// A rule whose numbers can be used.
fn checked<E: serde::de::Error>(blank: Blank) -> Result<Blank, E> {
    if blank.equal.iter().chain(blank.outside.iter().flatten()).any(|v| !v.is_finite()) {
        return Err(E::custom("values of `blank` must be finite; NaN and inf are taken for missing anyway"));
    }
    if blank.outside.is_some_and(|[low, high]| low >= high) {
        return Err(E::custom("`outside` of `blank` is [smallest, largest] value to keep, the first below the second"));
    }
    Ok(blank)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fill_values_and_values_outside_a_range_are_missing() {
        let blank = Blank { equal: vec![-9999.0, 9.969_209_968e36], outside: Some([-40.0, 40.0]) };
        for (value, missing) in [(-9999.0, true), (9.96921e36, true), (41.0, true), (-40.0, false), (0.0, false)] {
            assert_eq!(blank.takes(value), missing, "{value}");
        }
        assert!(!Blank { equal: vec![0.0], outside: None }.takes(1e-9));
    }
}
