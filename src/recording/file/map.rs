//! The column map: a small TOML file that says how a foreign layout becomes canonical channels.
//! It describes the file only; reading by it is `read.rs`, and what the channels mean is `channel.rs`.
//!
//! A channel without an entry in `[columns]` is found under its own name, so that an entry is needed only for what differs:
//!
//! ```toml
//! blank = [-9999, 9.96921e36]          # values of any column that stand for a missing one
//! wrap_repair = true                   # the heading was interpolated across north, through 180 degrees
//! leave_out = ["r"]                    # channels that are not to be read
//!
//! [columns]
//! delta = { sign = -1 }                # positive to port
//! n = { scale = 0.5, delay = 10.0 }    # \[s\] what the column shows happened 10 s earlier
//! r = { delay = { "day 2" = 4.0 } }    # ... in the runs of that session only
//! u = { blank = { outside = [-5, 25] } }
//! psi = { column = "gyro", unit = "deg", offset = 1.5 }
//! ```

use super::blank::Blank;
use crate::files::suggestion;
use crate::files::written::{Kind, Mistake, joined, line_at, read_text, read_toml};
use crate::recording::channel::{CHANNELS, Channel, ChannelInfo};
use crate::recording::driven::Driven;
use crate::recording::error::RecordingError;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// How the columns of a file become channels. The default is the canonical layout: one header line, commas, columns
/// named after the channels with the unit in brackets.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColumnMap {
    /// What separates fields.
    #[serde(default)]
    pub delimiter: Delimiter,
    /// What separates whole from fraction in a number.
    #[serde(default)]
    pub decimal: Decimal,
    /// Lines to skip before the header, or before the data where there is no header.
    #[serde(default)]
    pub skip_lines: usize,
    /// Whether a line of column names comes before the data.
    #[serde(default)]
    #[schemars(with = "bool")]
    pub header: Header,
    /// Axes in which the columns `u` and `v` (and `u_water`, `v_water`) are given.
    #[serde(default)]
    pub velocity_frame: VelocityFrame,
    /// Whether the columns `u` and `v` were made from a velocity over ground (SOG and COG, or north and east) and the recorded heading, so
    /// that an error of the heading turns them.
    #[serde(default)]
    pub velocity_by_heading: bool,
    /// What the columns `u` and `v` are relative to.
    #[serde(default)]
    pub speed: SpeedReference,
    /// Point of the ship whose position is recorded, metres `[forward, starboard]` of midship.
    #[serde(default)]
    pub reference_point: [f64; 2],
    /// Point whose velocity is recorded; the position's when not given.
    #[serde(default)]
    pub velocity_point: Option<[f64; 2]>,
    /// Time step \[s\] from which to rebuild a time column that is missing or rounded.
    #[serde(default)]
    pub dt: Option<f64>,
    /// Time \[s\] to subtract from every row.
    #[serde(default)]
    pub time_zero: f64,
    /// Channels to derive from others where they were not recorded: `u` and `v` from position and heading, `r` from heading.
    #[serde(default)]
    pub derive: Vec<Derived>,
    /// Length \[s\] of the local quadratic fit that derives them; nine rows when not given.
    #[serde(default)]
    pub derive_span: Option<f64>,
    /// Longest dropout \[s\] to bridge by straight lines; none when not given.
    #[serde(default)]
    pub bridge: Option<f64>,
    /// Values of any column that stand for a missing one.
    #[serde(default)]
    pub blank: Blank,
    /// Whether the heading was interpolated across north, through 180 degrees; such samples are put on the short way round.
    #[serde(default)]
    pub wrap_repair: bool,
    /// Channels that are not to be read, though the file has a column of their name.
    #[serde(default)]
    pub leave_out: Vec<String>,
    /// Column of each channel. A channel that is not in this table is found under its own name.
    #[serde(default)]
    pub columns: Option<BTreeMap<String, Column>>,
    /// What drives the craft, which every recording must have: propeller and rudder unless a ship file says otherwise.
    #[serde(skip)]
    pub driven: Driven,
    /// The file it was read from.
    #[serde(skip)]
    pub path: Option<PathBuf>,
    /// Line of each channel's entry in that file.
    #[serde(skip)]
    lines: BTreeMap<String, usize>,
}

/// What separates fields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Delimiter {
    /// `,`
    #[default]
    Comma,
    /// `;`
    Semicolon,
    /// The tabulator.
    Tab,
    /// Any run of blanks.
    Whitespace,
}

/// What separates whole from fraction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Decimal {
    /// `1.5`
    #[default]
    Point,
    /// `1,5`
    Comma,
}

/// Whether there is a line of names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "bool")]
pub struct Header(pub bool);

impl Default for Header {
    fn default() -> Self {
        Self(true)
    }
}

impl From<bool> for Header {
    fn from(present: bool) -> Self {
        Self(present)
    }
}

/// Axes of recorded velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum VelocityFrame {
    /// Forward and to starboard.
    #[default]
    Body,
    /// North and east, the axes of `x` and `y`.
    Earth,
}

/// What recorded velocities are relative to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum SpeedReference {
    /// The earth.
    #[default]
    #[serde(rename = "over ground")]
    OverGround,
    /// The water: `u`, `v` are then stored as `u_water`, `v_water`.
    #[serde(rename = "through water")]
    ThroughWater,
}

/// A channel that can be derived from others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Derived {
    /// Surge velocity over ground, from position and heading.
    U,
    /// Sway velocity over ground, from position and heading.
    V,
    /// Yaw rate, from heading.
    R,
}

/// Where a channel comes from: `psi = "psi_hat"`, or a table with the keys below.
///
/// The channel is `sign * scale * value + offset` in the column's unit, then converted to SI. Without `column`, `index` and `value`
/// it is the column of the channel's own name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Column {
    /// Name in the header, with or without the unit in brackets.
    pub name: Option<String>,
    /// Position in the row, counted from 1.
    pub index: Option<usize>,
    /// A constant, where there is no column.
    pub value: Option<f64>,
    /// Unit; the header's when not given.
    pub unit: Option<String>,
    /// Factor on the value.
    pub scale: Option<f64>,
    /// 1 or -1: the sense in which the column is positive (`-1` for a rudder positive to port).
    pub sign: Option<f64>,
    /// Added, in the column's unit.
    pub offset: Option<f64>,
    /// How late the column records what happened.
    pub delay: Option<Delay>,
    /// Values of the column, as written, that stand for a missing one.
    pub blank: Blank,
}

/// How late a column records what happened \[s\]; negative where it is early. At most an hour.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Delay {
    /// In every run.
    Always(f64),
    /// By session; 0 in sessions that are not listed.
    Sessions(BTreeMap<String, f64>),
}

/// Longest delay \[s\]: more is another run, or a unit that is not seconds.
const LONGEST_DELAY: f64 = 3600.0;

impl Delay {
    /// The delay in the runs of a session \[s\].
    pub fn within(&self, session: &str) -> f64 {
        match self {
            Self::Always(delay) => *delay,
            Self::Sessions(delays) => delays.get(session).copied().unwrap_or(0.0),
        }
    }

    fn possible(&self) -> bool {
        let one = |delay: &f64| delay.abs() <= LONGEST_DELAY;
        match self {
            Self::Always(delay) => one(delay),
            Self::Sessions(delays) => delays.values().all(one),
        }
    }
}

impl Column {
    /// Factor and offset in the column's unit.
    pub(crate) fn linear(&self) -> (f64, f64) {
        (self.sign.unwrap_or(1.0) * self.scale.unwrap_or(1.0), self.offset.unwrap_or(0.0))
    }

    /// The column as a person would name it.
    pub(crate) fn label(&self) -> String {
        match (&self.name, self.index) {
            (Some(name), _) => name.clone(),
            (None, Some(index)) => format!("number {index}"),
            (None, None) => "constant".to_owned(),
        }
    }
}

/// Where the channel comes from: `sign * scale * value + offset` in the column's unit. A text in place of the table is its `column`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ColumnTable {
    /// Name in the header, with or without the unit in brackets; the channel's own name when neither `index` nor `value` is given.
    column: Option<String>,
    /// Position in the row, counted from 1, instead of a name.
    index: Option<usize>,
    /// A constant, where there is no column.
    value: Option<f64>,
    /// Unit; the header's when left out, the SI unit when the header has none.
    unit: Option<String>,
    /// Factor on the value.
    scale: Option<f64>,
    /// 1 or -1: the sense in which the column is positive (-1 for a rudder positive to port).
    sign: Option<f64>,
    /// Added, in the column's unit.
    offset: Option<f64>,
    /// How late the column records what happened \[s\]: a number, or a table of numbers by session.
    delay: Option<Delay>,
    /// Values of the column, as written, that stand for a missing one.
    #[serde(default)]
    blank: Blank,
}

impl JsonSchema for Column {
    fn schema_name() -> Cow<'static, str> {
        "Column".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let table = ColumnTable::json_schema(generator);
        json_schema!({ "anyOf": [{ "type": "string", "description": "Name in the header." }, table] })
    }
}

impl<'de> Deserialize<'de> for Column {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> serde::de::Visitor<'de> for Either {
            type Value = Column;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a column name, or a table with `column`, `index` or `value`")
            }
            fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<Column, E> {
                Ok(Column { name: Some(name.to_owned()), ..Column::default() })
            }
            fn visit_map<M: serde::de::MapAccess<'de>>(self, map: M) -> Result<Column, M::Error> {
                use serde::de::Error;
                let t = ColumnTable::deserialize(serde::de::value::MapAccessDeserializer::new(map))?;
                let sources =
                    [t.column.is_some(), t.index.is_some(), t.value.is_some()].iter().filter(|given| **given).count();
                if sources > 1 {
                    return Err(M::Error::custom(
                        "give exactly one of `column`, `index` and `value`, or none for the column of the channel's own name",
                    ));
                }
                if t.index == Some(0) {
                    return Err(M::Error::custom("`index` counts from 1"));
                }
                if t.sign.is_some_and(|s| s != 1.0 && s != -1.0) {
                    return Err(M::Error::custom("`sign` is 1 or -1; use `scale` for any other factor"));
                }
                if [t.value, t.scale, t.offset].into_iter().flatten().any(|v| !v.is_finite()) || t.scale == Some(0.0) {
                    return Err(M::Error::custom("`value`, `scale` and `offset` must be finite and `scale` not zero"));
                }
                if t.delay.as_ref().is_some_and(|delay| !delay.possible()) {
                    return Err(M::Error::custom(format!(
                        "`delay` is how many seconds late the column is, between -{LONGEST_DELAY} and {LONGEST_DELAY}"
                    )));
                }
                Ok(Column {
                    name: t.column,
                    index: t.index,
                    value: t.value,
                    unit: t.unit,
                    scale: t.scale,
                    sign: t.sign,
                    offset: t.offset,
                    delay: t.delay,
                    blank: t.blank,
                })
            }
        }
        deserializer.deserialize_any(Either)
    }
}

impl ColumnMap {
    /// Whether an error of the recorded heading turns u and v: they were made with it before they were recorded, or are here.
    pub fn turns_with_heading(&self) -> bool {
        let derived = self.derive.iter().any(|d| matches!(d, Derived::U | Derived::V));
        self.velocity_by_heading || self.velocity_frame == VelocityFrame::Earth || derived
    }

    /// Reads and checks a column map.
    ///
    /// # Errors
    /// [`RecordingError::ReadMap`] or [`RecordingError::Map`], the latter with line and near names.
    pub fn read(path: &Path) -> Result<Self, RecordingError> {
        let text = read_text(path).map_err(|source| RecordingError::ReadMap { path: path.to_owned(), source })?;
        Self::parse(&text, path)
    }

    /// Checks the text of a column map; `path` is for messages.
    ///
    /// # Errors
    /// [`RecordingError::Map`], with every mistake.
    pub fn parse(text: &str, path: &Path) -> Result<Self, RecordingError> {
        let fail = |line, message| RecordingError::Map { path: path.to_owned(), line, message };
        let mut map: Self = read_toml(text, Kind::Columns).map_err(|mistakes| {
            let (line, message) = joined(mistakes.into_iter().map(channel_at_the_top).collect(), path);
            fail(line, message)
        })?;
        map.path = Some(path.to_owned());
        map.lines = channel_lines(text);
        let mistakes = map.mistakes(text);
        if mistakes.is_empty() {
            return Ok(map);
        }
        let (line, message) = joined(mistakes, path);
        Err(fail(line, message))
    }

    /// Names that are no channels, and numbers that cannot be.
    fn mistakes(&self, text: &str) -> Vec<Mistake> {
        let mut mistakes = Vec::new();
        let listed = self.columns.iter().flat_map(BTreeMap::keys).map(|name| (name, self.line(name)));
        let left_out = self.leave_out.iter().map(|name| (name, key_line(text, "leave_out")));
        for (name, line) in listed.chain(left_out).filter(|(name, _)| Channel::from_name(name).is_none()) {
            mistakes.push(Mistake::new(line, unknown_channel(name)));
        }
        let positive = [("dt", self.dt), ("derive_span", self.derive_span), ("bridge", self.bridge)];
        for (key, value) in positive {
            if value.is_some_and(|v| !v.is_finite() || v <= 0.0) {
                mistakes
                    .push(Mistake::new(key_line(text, key), format!("`{key}` must be a positive number of seconds")));
            }
        }
        let point = |p: &[f64; 2]| p.iter().all(|v| v.is_finite());
        for (key, finite) in [
            ("reference_point", point(&self.reference_point)),
            ("velocity_point", self.velocity_point.as_ref().is_none_or(point)),
            ("time_zero", self.time_zero.is_finite()),
        ] {
            if !finite {
                mistakes.push(Mistake::new(key_line(text, key), format!("`{key}` must be finite; correct it")));
            }
        }
        mistakes
    }

    /// The delays of the channels in the runs of a session, those that are not 0 \[s\].
    pub(crate) fn delays(&self, session: &str) -> Vec<(Channel, f64)> {
        let delay = |(name, column): (&String, &Column)| {
            let delay = column.delay.as_ref()?.within(session);
            Some((Channel::from_name(name)?, delay)).filter(|(_, delay)| *delay != 0.0)
        };
        self.columns.iter().flatten().filter_map(delay).collect()
    }

    /// The channels of actuators that a file may have: those the craft needs, those the map lists, and those that `header` names.
    pub(crate) fn commands<'a>(
        &'a self,
        header: impl Iterator<Item = &'a str>,
    ) -> impl Iterator<Item = &'static ChannelInfo> {
        let listed = self.columns.iter().flat_map(BTreeMap::keys).map(String::as_str);
        let named = listed.chain(header).filter(|name| name.contains('.')).filter_map(Channel::from_name);
        let ordered = self.driven.needs().filter_map(Channel::ordered);
        let all: BTreeSet<Channel> = named.chain(self.driven.needs()).chain(ordered).collect();
        all.into_iter().filter(|c| matches!(c, Channel::Command(_))).map(Channel::info)
    }

    /// Line of a channel's entry in the map file, 1 when it was not read from one.
    pub(crate) fn line(&self, channel: &str) -> usize {
        self.lines.get(channel).copied().unwrap_or(1)
    }
}

/// A name in `[columns]` or `leave_out` that is no channel, with the one that is meant.
fn unknown_channel(name: &str) -> String {
    let map = schemars::schema_for!(ColumnMap);
    if map.get("properties").is_some_and(|keys| keys.get(name).is_some()) {
        return format!("`{name}` is a key of the whole map: it stands at the top, before [columns]");
    }
    let near = match Channel::meant_by(name) {
        Some(meant) => format!(", did you mean `{meant}` ({})?", meant.info().words),
        None => suggestion(name, CHANNELS.iter().map(|c| c.name)),
    };
    format!("unknown channel `{name}`{near}; `trimtab help channels` lists them")
}

/// A channel that stands at the top of a map, where it is an unknown key.
fn channel_at_the_top(mistake: Mistake) -> Mistake {
    match mistake.unknown.as_deref().filter(|key| Channel::from_name(key).is_some()) {
        Some(name) => {
            Mistake::new(mistake.line, format!("the channel `{name}` stands in the table [columns], below its heading"))
        }
        None => mistake,
    }
}

/// The line of each key of the `[columns]` table (or of its sub-tables `[columns.x]`).
fn channel_lines(text: &str) -> BTreeMap<String, usize> {
    let Ok(document) = toml::from_str::<SpannedColumns>(text) else { return BTreeMap::new() };
    let keys = document.columns.into_iter().flat_map(BTreeMap::into_iter);
    keys.map(|(name, value)| (name, line_at(text, value.span().start))).collect()
}

/// The same document read for the places of its columns alone.
#[derive(Deserialize)]
struct SpannedColumns {
    columns: Option<BTreeMap<String, toml::Spanned<toml::Value>>>,
}

/// The line on which a top-level key is set, for messages about its value.
pub(crate) fn key_line(text: &str, key: &str) -> usize {
    text.lines()
        .position(|l| l.trim_start().strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with('=')))
        .map_or(1, |i| i + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<ColumnMap, String> {
        ColumnMap::parse(text, Path::new("columns.toml")).map_err(|e| e.to_string())
    }

    #[test]
    fn an_error_of_the_heading_turns_velocities_that_were_made_with_it() {
        let of = |text: &str| ColumnMap::parse(text, Path::new("columns.toml")).unwrap().turns_with_heading();
        assert!(!of("") && !of("velocity_frame = \"body\"\nderive = [\"r\"]"));
        assert!(of("velocity_frame = \"earth\"") && of("derive = [\"u\", \"v\"]") && of("velocity_by_heading = true"));
    }

    #[test]
    fn an_empty_map_is_the_canonical_layout() {
        let map = parse("").unwrap();
        assert_eq!(map.delimiter, Delimiter::Comma);
        assert!(map.header.0 && map.columns.is_none());
    }

    #[test]
    fn a_column_is_a_name_or_a_table() {
        let map = parse("[columns]\npsi = \"heading\"\ndelta = { index = 3, unit = \"deg\", sign = -1 }\n").unwrap();
        let columns = map.columns.unwrap();
        assert_eq!(columns["psi"].name.as_deref(), Some("heading"));
        assert_eq!(columns["delta"].linear(), (-1.0, 0.0));
    }

    #[test]
    fn a_delay_is_one_number_or_one_a_session() {
        let map = parse("[columns]\nn = { delay = 3 }\nr = { delay = { \"day 2\" = -4.5 } }\n").unwrap();
        assert_eq!(map.delays("day 2"), [(Channel::N, 3.0), (Channel::R, -4.5)]);
        assert_eq!(map.delays("day 1"), [(Channel::N, 3.0)]);
    }

    #[test]
    fn mistakes_in_a_map_name_line_and_the_near_word() {
        let cases = [
            ("delimter = \"tab\"", "columns.toml:1:", "did you mean `delimiter`?"),
            ("dt = 0.1\nderive = [\"q\"]", "columns.toml:2:", "unknown word `q`"),
            ("[columns]\nrudder = \"delta\"", "columns.toml:2:", "did you mean `delta` (rudder angle)?"),
            ("delta = { sign = -1 }", "columns.toml:1:", "stands in the table [columns]"),
            ("[columns]\ndecimal = \"comma\"", "columns.toml:2:", "stands at the top"),
            ("dt = 0\nbridge = 0\n[columns]\nrpm = \"n\"", "columns.toml:1:", "columns.toml:4: unknown channel `rpm`"),
            ("[columns]\n\npsy = \"heading\"", "columns.toml:3:", "did you mean `psi`?"),
            ("[columns]\nn = { index = 0 }", "columns.toml:2:", "counts from 1"),
            ("[columns]\nn = { index = 1, sing = -1 }", "columns.toml:2:", "did you mean `sign`?"),
            ("[columns]\nn = { index = 1, value = 3.0 }", "columns.toml:2:", "exactly one"),
            ("skip_lines = 1\ndt = -0.1", "columns.toml:2:", "positive"),
            ("speed = \"over water\"", "columns.toml:1:", "did you mean"),
            ("wrap_repiar = true", "columns.toml:1:", "did you mean `wrap_repair`?"),
            ("leave_out = [\"psy\"]", "columns.toml:1:", "did you mean `psi`?"),
            ("[columns]\nn = { dealy = 3.0 }", "columns.toml:2:", "did you mean `delay`?"),
            ("[columns]\nn = { delay = 36000 }", "columns.toml:2:", "seconds late"),
            ("[columns]\nn = { delay = { \"a\" = nan } }", "columns.toml:2:", "seconds late"),
            ("blank = [nan]", "columns.toml:1:", "must be finite"),
            ("\nblank = { outside = [3.0, 2.0] }", "columns.toml:2:", "the first below the second"),
            ("[columns]\nn = { blank = { beyond = [0, 1] } }", "columns.toml:2:", "unknown key `beyond`"),
        ];
        for (text, place, hint) in cases {
            let message = parse(text).unwrap_err();
            assert!(message.starts_with(place) && message.contains(hint), "{text}\n{message}");
        }
    }
}
