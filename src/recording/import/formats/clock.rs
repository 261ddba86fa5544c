//! Times as loggers write them, to seconds: ISO 8601, date and time apart, epochs, time of day, spreadsheet days.
//! A time without a zone counts as UTC; no daylight saving is guessed.

use crate::recording::import::signals::log::Clock;
use crate::recording::import::signals::signal::median;
use jiff::civil::DateTime;
use jiff::fmt::rfc2822;
use jiff::tz::TimeZone;
use jiff::{SignedDuration, Timestamp};

/// Seconds of a day.
pub const DAY: f64 = 86_400.0;

/// Which of day and month comes first in dates with slashes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DateOrder {
    /// `24/12/2024`
    DayFirst,
    /// `12/24/2024`
    MonthFirst,
}

/// Dates with the name of the month, as `strptime` has them.
const NAMED_MONTHS: [&str; 6] = [
    "%d-%b-%Y %H:%M:%S%.f",
    "%d %b %Y %H:%M:%S%.f",
    "%d/%b/%Y %H:%M:%S%.f",
    "%b %d, %Y %H:%M:%S%.f",
    "%b %d %Y %H:%M:%S%.f",
    "%a %b %d %H:%M:%S %Y",
];

/// Seconds since 1970 of a written date and time; `None` where it is none.
pub fn date_time(text: &str, order: DateOrder) -> Option<f64> {
    let text = text.trim().trim_matches('"').trim();
    if !text.contains(|c: char| c.is_ascii_digit()) || text.len() < 8 || text.len() > 64 {
        return None;
    }
    let text = text.strip_suffix("UTC").or_else(|| text.strip_suffix("GMT")).map_or(text, str::trim_end);
    let (text, half) = half_of_day(text);
    if text.as_bytes().windows(3).any(|w| w.iter().all(u8::is_ascii_alphabetic)) {
        return half.shift(named_month(text)?);
    }
    if !text.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    // A comma may separate the fraction.
    let iso = reordered(&text.replace(',', "."), order)?;
    if let Ok(stamp) = iso.parse::<Timestamp>() {
        return half.shift(seconds(stamp));
    }
    let civil: DateTime = iso.trim_end_matches(['Z', 'z']).parse().ok()?;
    half.shift(utc(civil)?)
}

fn utc(civil: DateTime) -> Option<f64> {
    Some(seconds(civil.to_zoned(TimeZone::UTC).ok()?.timestamp()))
}

fn named_month(text: &str) -> Option<f64> {
    if let Ok(stamp) = rfc2822::parse(text) {
        return Some(seconds(stamp.timestamp()));
    }
    let read = |format: &&str| {
        let civil = DateTime::strptime(format, text).ok()?;
        // Two figures of a year are of this century.
        if civil.year() < 100 { utc(civil.with().year(civil.year() + 2000).build().ok()?) } else { utc(civil) }
    };
    NAMED_MONTHS.iter().find_map(read)
}

/// The half of the day that a clock of twelve hours shows.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Half {
    Before,
    After,
    /// A clock of 24 hours.
    None,
}

/// A time without its `AM` or `PM`.
fn half_of_day(text: &str) -> (&str, Half) {
    for (end, half) in [("AM", Half::Before), ("PM", Half::After), ("a.m.", Half::Before), ("p.m.", Half::After)] {
        let at = text.len().saturating_sub(end.len());
        if let (Some(rest), Some(last)) = (text.get(..at), text.get(at..))
            && last.eq_ignore_ascii_case(end)
            && rest.ends_with(|c: char| c.is_ascii_digit() || c == ' ')
        {
            return (rest.trim_end(), half);
        }
    }
    (text, Half::None)
}

impl Half {
    /// Seconds as a clock of 24 hours has them; `None` where its hour is none of the twelve.
    fn shift(self, seconds: f64) -> Option<f64> {
        let hour = (seconds / 3600.0).floor().rem_euclid(24.0);
        match self {
            Self::None => Some(seconds),
            _ if !(1.0..=12.0).contains(&hour) => None,
            Self::Before => Some(if hour == 12.0 { seconds - 0.5 * DAY } else { seconds }),
            Self::After => Some(if hour == 12.0 { seconds } else { seconds + 0.5 * DAY }),
        }
    }
}

/// Whether a text is a date and time with the day or the month first.
pub fn is_date_time(text: &str) -> bool {
    [DateOrder::DayFirst, DateOrder::MonthFirst].iter().any(|order| date_time(text, *order).is_some())
}

/// Whether a text is a date without a time of day.
pub fn is_date_alone(text: &str) -> bool {
    text.len() <= 12 && !text.contains(':') && digits(text) < 12 && is_date_time(text)
}

fn seconds(stamp: Timestamp) -> f64 {
    stamp.as_second() as f64 + f64::from(stamp.subsec_nanosecond()) * 1e-9
}

/// The same with the date as ISO 8601 has it: `24.12.2024 10:00` is `2024-12-24 10:00`.
fn reordered(text: &str, order: DateOrder) -> Option<String> {
    // Fourteen digits are a date and a time of day.
    if digits(text) >= 14 {
        return Some(format!("{}T{}", &text[..8], &text[8..]));
    }
    // Twelve begin with the last two of the year.
    if digits(text) == 12 && (text.len() == 12 || text[12..].starts_with('.')) {
        return Some(format!("20{}T{}", &text[..6], &text[6..]));
    }
    let at = text.find([' ', 'T', '_']).or_else(|| end_of_date(text)).unwrap_or(text.len());
    let (date, rest) = (text.get(..at)?, text.get(at..)?);
    let rest = rest.trim_start_matches([' ', 'T', '_', '-']);
    let separator = date.chars().find(|c| ['.', '/'].contains(c) || (*c == '-' && date.find('-') < Some(4)));
    let date = match separator {
        None => date.to_owned(),
        Some(separator) => {
            let parts: Vec<&str> = date.split(separator).collect();
            let [a, b, c] = parts.as_slice() else { return None };
            let (year, month, day) = match (a.len(), separator, order) {
                (4, ..) => (*a, *b, *c),
                (_, '.', _) | (_, _, DateOrder::DayFirst) => (*c, *b, *a),
                (_, _, DateOrder::MonthFirst) => (*c, *a, *b),
            };
            let year = if year.len() == 2 { format!("20{year}") } else { year.to_owned() };
            format!("{year}-{month:0>2}-{day:0>2}")
        }
    };
    // Ten in the morning without its leading nought.
    let rest = if rest.find(':') == Some(1) { format!("0{rest}") } else { rest.to_owned() };
    // Hours, minutes and seconds with the separator of the date: `10-00-03`.
    let dashed = rest
        .as_bytes()
        .get(..6)
        .is_some_and(|b| [b[2], b[5]] == *b"--" && is_digits(&rest[..2]) && is_digits(&rest[3..5]));
    let rest = if dashed { rest.replacen('-', ":", 2) } else { rest };
    Some(if rest.is_empty() { date } else { format!("{date}T{}", rest.replace(' ', "")) })
}

/// Figures that a text begins with.
fn digits(text: &str) -> usize {
    text.bytes().take_while(u8::is_ascii_digit).count()
}

/// Where a date ends after which a dash and a time of day follow: `2024-06-12-10:00:03`, `20240612-100003`.
fn end_of_date(text: &str) -> Option<usize> {
    let lengths = if text.get(..8).is_some_and(is_digits) { [8, 8] } else { [10, 9] };
    let follows = |at: &usize| {
        let rest = text.get(*at..).and_then(|rest| rest.strip_prefix('-'));
        rest.is_some_and(|rest| rest.get(..2).is_some_and(is_digits) && rest.len() >= 5)
    };
    lengths.into_iter().find(follows)
}

/// Seconds that a clock is ahead of UTC by the name of its column: `Time (UTC+2)`, `Zeit GMT+02:00`.
pub fn zone(name: &str) -> Option<f64> {
    let upper = name.to_uppercase();
    let at = ["UTC", "GMT"].iter().find_map(|mark| upper.find(mark))?;
    let rest = upper[at + 3..].trim_start();
    let sign = if rest.starts_with('+') { 1.0 } else { -1.0 };
    let rest = rest.strip_prefix(['+', '-', '\u{2212}'])?.trim_start();
    let end = rest.find(|c: char| !c.is_ascii_digit() && c != ':').unwrap_or(rest.len());
    let (hours, minutes) = match (rest[..end].split_once(':'), end) {
        (Some((h, m)), _) => (h.parse::<f64>().ok()?, m.parse::<f64>().ok()?),
        (None, 4) => (rest[..2].parse().ok()?, rest[2..4].parse().ok()?),
        (None, _) => (rest[..end].parse().ok()?, 0.0),
    };
    (hours <= 14.0 && minutes < 60.0).then_some(sign * (3600.0 * hours + 60.0 * minutes))
}

/// Whether a written time has its own zone: `10:00Z`, `10:00+02:00`.
pub fn has_zone(text: &str) -> bool {
    let text = text.trim().trim_matches('"').trim_end();
    let of_day = text.find(':').map_or("", |at| &text[at..]);
    of_day.contains(['+', '-']) || ["Z", "z", "UTC", "GMT"].iter().any(|end| text.ends_with(end))
}

/// Whether a date may have the day or the month first: `05/01/2024`, `5-1-2024`.
pub fn two_orders(text: &str) -> bool {
    let (digits, mut rest) = (digits(text), text.bytes().skip_while(u8::is_ascii_digit));
    let separated = rest.next().is_some_and(|b| [b'/', b'-'].contains(&b));
    (1..=2).contains(&digits) && separated && rest.next().is_some_and(|b| b.is_ascii_digit())
}

/// Whether dates with slashes have the day first; `None` where no date says.
pub fn date_order<'a>(texts: impl Iterator<Item = &'a str>) -> Option<DateOrder> {
    for text in texts {
        let numbers: Vec<u32> =
            text.split(|c: char| !c.is_ascii_digit()).take(2).filter_map(|n| n.parse().ok()).collect();
        match numbers.as_slice() {
            [a, _] if (13..=31).contains(a) => return Some(DateOrder::DayFirst),
            [_, b] if (13..=31).contains(b) => return Some(DateOrder::MonthFirst),
            _ => {}
        }
    }
    None
}

/// Hours that a time since some start may have.
const MOST_HOURS: u32 = 10_000;

/// The forms of times that are read, for messages.
pub const FORMS: &str = "2024-05-14 08:00:00, 14.05.2024 08:00:00, 05/14/2024 8:00:00 AM, 20240514T080000Z, 2024-05-14-08:00:00, a date in one column and 08:00:00, 08.00.00 or 080000 in another, \
year, month, day, hour, minute and second in six columns, 08h00m00s, 135/08:00:00 (day of the year), and numbers of seconds or of any unit in the name (`Time [ms]`) or passed with `--unit t=`";

/// Seconds since midnight, or since some start, of a time such as `10:03:05.25`, `10:03 PM`, `03:05.25`, `10.03.05`, `10h03m05s`,
/// `135/10:03:05` or `1 days 02:03:05`.
pub fn time_of_day(text: &str) -> Option<f64> {
    let text = text.trim().trim_matches('"').trim_end_matches(['Z', 'z']).replace(',', ".");
    let parted = [" days ", " day ", "/"].iter().find_map(|mark| text.split_once(mark));
    let (days, text) = parted.filter(|(_, time)| time.contains(':')).unwrap_or(("0", &text));
    let days: u16 = days.trim().parse().ok()?;
    let (text, half) = half_of_day(text.trim());
    let lettered = text.contains('h').then(|| text.replace(['h', 'm'], ":").trim_end_matches(['s', ':']).to_owned());
    let dotted = || text.len() >= 8 && text.split('.').take(3).filter(|p| p.len() == 2 && is_digits(p)).count() == 3;
    let dotted = (!text.contains(':') && dotted()).then(|| text.replacen('.', ":", 2));
    let text = lettered.or(dotted).unwrap_or_else(|| text.to_owned());
    let parts: Vec<&str> = text.split(':').collect();
    let (hours, minutes, seconds) = match parts.as_slice() {
        [h, m, s] => (h.parse::<u32>().ok()?, m.parse::<u8>().ok()?, s.parse::<f64>().ok()?),
        // Only seconds have a fraction.
        [m, s] if s.contains('.') => (0, m.parse().ok()?, s.parse().ok()?),
        [h, m] => (h.parse().ok()?, m.parse().ok()?, 0.0),
        _ => return None,
    };
    let possible = hours < MOST_HOURS && minutes < 60 && (0.0..61.0).contains(&seconds);
    let total = f64::from(days) * DAY + 3600.0 * f64::from(hours) + 60.0 * f64::from(minutes) + seconds;
    possible.then(|| half.shift(total)).flatten()
}

fn is_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit())
}

/// Seconds since 1970 of year, month, day, hour, minute and second.
pub fn calendar(parts: [f64; 6]) -> Option<f64> {
    let [year, month, day, hour, minute, second] = parts;
    let whole = |v: f64, range: std::ops::RangeInclusive<f64>| (range.contains(&v) && v.fract() == 0.0).then_some(v);
    let year = whole(year, 0.0..=9000.0).map(|y| if y < 100.0 { 2000.0 + y } else { y })? as i16;
    let (month, day) = (whole(month, 1.0..=12.0)? as i8, whole(day, 1.0..=31.0)? as i8);
    let of_day = whole(hour, 0.0..=23.0)? * 3600.0 + whole(minute, 0.0..=59.0)? * 60.0;
    let date = jiff::civil::Date::new(year, month, day).ok()?;
    (0.0..61.0).contains(&second).then_some(utc(date.at(0, 0, 0, 0))? + of_day + second)
}

/// Seconds since midnight of hours, minutes and seconds in one number: `101530.25`.
pub fn digits_of_day(value: f64) -> Option<f64> {
    let (hours, minutes, seconds) = ((value / 1e4).floor(), (value / 100.0).floor() % 100.0, value % 100.0);
    let possible = (0.0..24.0).contains(&hours) && minutes < 60.0 && seconds < 61.0;
    possible.then_some(3600.0 * hours + 60.0 * minutes + seconds)
}

/// Whether numbers are times of day as `101530.25`: from 59 they go on to 100, where a count of seconds has the forty between.
pub fn are_digits_of_day(values: &[f64]) -> bool {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    let (low, high) = finite().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
    let step = values.windows(2).map(|v| v[1] - v[0]).filter(|s| *s > 0.0).fold(f64::MAX, f64::min);
    high - low > 100.0 && step <= 30.0 && finite().all(|v| v % 100.0 < 60.0 && digits_of_day(v).is_some())
}

/// Whether numbers are shares of a day: below one, in steps far below it.
pub fn are_shares_of_day(values: &[f64]) -> bool {
    let mut finite = values.iter().filter(|v| v.is_finite()).peekable();
    finite.peek().is_some() && finite.all(|v| (0.0..1.0).contains(v)) && fine(values)
}

/// Steps within which a time that starts again at the full hour follows the one before: stamps of minutes and seconds that began anew with a run
/// do so anywhere else.
const AT_THE_HOUR: f64 = 10.0;

/// Whether a time has minutes and seconds alone, as a spreadsheet writes those that have a fraction: `59:59.0`.
pub fn is_of_hour(text: &str) -> bool {
    text.matches(':').count() == 1 && text.contains(['.', ',']) && time_of_day(text).is_some()
}

/// What stamps of two numbers, `21:40`, are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stamps {
    /// Hours and minutes of a day, or stamps of another form.
    HoursMinutes,
    /// Minutes and seconds.
    MinutesSeconds,
    /// Either: a clock that begins at 00:00 may have been started, or it is midnight.
    Either,
}

/// What stamps are, by what the user and the header call the first of their two numbers, by numbers that no hour has, and by where they begin.
pub fn stamps<'a>(
    texts: impl Iterator<Item = &'a str> + Clone,
    header: &str,
    unit: Option<&str>,
    dated: bool,
) -> Stamps {
    let parts = |text: &'a str| text.split_once(':').filter(|(a, b)| is_digits(a) && is_digits(b) && b.len() == 2);
    let mut written = texts.clone().filter(|t| !t.is_empty());
    let header = header.to_lowercase();
    let called = |hours: &[&str]| hours.iter().any(|form| header.contains(form));
    if dated || !written.clone().all(|t| parts(t).is_some()) || unit == Some("h") || called(&["hh:mm", "h:m"]) {
        return Stamps::HoursMinutes;
    }
    let no_hour = |text: &'a str| parts(text).and_then(|(a, _)| a.parse::<u32>().ok()).is_some_and(|a| a >= 24);
    if unit == Some("min") || called(&["mm:ss", "m:s", "min:s"]) || texts.clone().any(no_hour) {
        return Stamps::MinutesSeconds;
    }
    let begins =
        written.next().and_then(parts).is_some_and(|(a, b)| [a, b].iter().all(|p| p.bytes().all(|b| b == b'0')));
    if begins { Stamps::Either } else { Stamps::HoursMinutes }
}

/// Times of minutes and seconds that go on past the full hour; gives how often.
pub fn past_the_hour(times: &mut [f64]) -> usize {
    let steps = times.windows(2).map(|t| t[1] - t[0]).filter(|s| *s > 0.0).collect();
    let Some(longest) = median(steps).map(|step| AT_THE_HOUR * step) else { return 0 };
    let (mut hours, mut last) = (0, f64::NAN);
    for t in times.iter_mut().filter(|t| t.is_finite()) {
        if *t < last && *t + 3600.0 - last <= longest {
            hours += 1;
        }
        last = *t;
        *t += 3600.0 * hours as f64;
    }
    hours
}

/// Times of day that go on past midnight.
pub fn past_midnight(times: &mut [f64]) {
    let (mut days, mut last) = (0.0, f64::NAN);
    for t in times.iter_mut().filter(|t| t.is_finite()) {
        if last - *t > 0.5 * DAY {
            days += DAY;
        }
        last = *t;
        *t += days;
    }
}

/// How numbers are to be read as times: what they count from, the seconds of one, what to subtract first, and why.
pub struct NumericTime {
    /// What they count from.
    pub clock: Clock,
    /// Seconds of one.
    pub factor: f64,
    /// Subtracted first.
    pub zero: f64,
    /// In words.
    pub words: &'static str,
}

/// Steps of a log are no longer than this \[s\].
const LONGEST_STEP: f64 = 3600.0;

/// Seconds since 1970 of the dates from 2000 to 2050.
pub const THIS_CENTURY: std::ops::Range<f64> = 946_684_800.0..2_524_608_000.0;
/// Epochs beside that of 1970, by which numbers are dates of this century: the seconds of one, the number of 1970, and its name. LabVIEW counts
/// from 1904, the FILETIME of Windows from 1601, the ticks of .NET from the year 1, both in tenths of a microsecond.
const EPOCHS: [(f64, f64, &str); 3] = [
    (1.0, 2_082_844_800.0, "seconds since 1904, as LabVIEW counts them"),
    (1e-7, 116_444_736e9, "tenths of a microsecond since 1601, a FILETIME of Windows"),
    (1e-7, 621_355_968e9, "tenths of a microsecond since the year 1, ticks of .NET"),
];

/// What a column of numbers counts, by its size: epochs are unlike any other number.
pub fn numeric_time(values: &[f64], unit: Option<f64>) -> NumericTime {
    let mut finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let middle = finite.len() / 2;
    let typical = if finite.is_empty() { 0.0 } else { *finite.select_nth_unstable_by(middle, f64::total_cmp).1 };
    let time = |clock, factor, zero, words| NumericTime { clock, factor, zero, words };
    let step = median(values.windows(2).map(|v| v[1] - v[0]).filter(|s| *s > 0.0).collect()).unwrap_or(0.0);
    let other = |(factor, zero, _): &&(f64, f64, &str)| {
        let usual = unit.is_none_or(|unit| (unit / factor - 1.0).abs() < 1e-9) && step * factor <= LONGEST_STEP;
        usual && THIS_CENTURY.contains(&((typical - zero) * factor))
    };
    if let Some((factor, zero, words)) = EPOCHS.iter().find(other) {
        return time(Clock::Utc, *factor, *zero, words);
    }
    // A unit that takes the numbers to a date since 1973 is that of an epoch.
    if let Some(unit) = unit.filter(|unit| (1e8..1e11).contains(&(typical * unit))) {
        return time(Clock::Utc, unit, 0.0, "time since 1970");
    }
    let own = unit.filter(|unit| typical * unit < 1e8);
    // Numbers that would be an epoch by their size and whose steps would then be hours count something finer from a start of their own.
    let epoch = |v: f64, above: f64, factor: f64| v > above && step * factor <= LONGEST_STEP;
    match typical {
        _ if own.is_some() => time(Clock::Own, own.unwrap_or(1.0), 0.0, "time from a start of its own"),
        v if epoch(v, 1e17, 1e-9) => time(Clock::Utc, 1e-9, 0.0, "nanoseconds since 1970"),
        v if epoch(v, 1e14, 1e-6) => time(Clock::Utc, 1e-6, 0.0, "microseconds since 1970"),
        v if epoch(v, 1e11, 1e-3) => time(Clock::Utc, 1e-3, 0.0, "milliseconds since 1970"),
        v if epoch(v, 1e8, 1.0) => time(Clock::Utc, 1.0, 0.0, "seconds since 1970"),
        // Days of this century until 2050, by what they count from; a second is a hundred-thousandth.
        v if (36_526.0..54_789.0).contains(&v) && fine(values) => {
            time(Clock::Utc, DAY, 25_569.0, "days of a spreadsheet")
        }
        v if (54_789.0..69_807.0).contains(&v) && fine(values) => {
            time(Clock::Utc, DAY, 40_587.0, "modified Julian days")
        }
        v if (730_486.0..748_749.0).contains(&v) && fine(values) => time(Clock::Utc, DAY, 719_529.0, "days of MATLAB"),
        v if (2_451_544.0..2_469_808.0).contains(&v) && fine(values) => {
            time(Clock::Utc, DAY, 2_440_587.5, "Julian days")
        }
        _ => time(Clock::Own, 1.0, 0.0, "seconds from a start of its own"),
    }
}

/// Whether steps are far below one, as those of days are.
fn fine(values: &[f64]) -> bool {
    let mut steps: Vec<f64> = values.windows(2).map(|v| v[1] - v[0]).filter(|s| *s > 0.0).collect();
    if steps.is_empty() {
        return false;
    }
    let middle = steps.len() / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1 < 0.01
}

/// Spreads times that were rounded over the interval they stand for: ten rows with the same second are a tenth of a second
/// apart. Gives how many rows share a time, where most do.
pub fn spread(times: &mut [f64]) -> Option<usize> {
    let repeats = times.windows(2).filter(|t| t[0] == t[1]).count();
    if times.len() < 4 || repeats * 3 < times.len() {
        return None;
    }
    let mut groups: Vec<(usize, usize)> = Vec::new();
    for (i, t) in times.iter().enumerate() {
        match groups.last_mut() {
            Some((start, count)) if times[*start] == *t => *count += 1,
            _ => groups.push((i, 1)),
        }
    }
    let usual = |mut all: Vec<f64>| -> Option<f64> {
        let middle = all.len() / 2;
        (!all.is_empty()).then(|| *all.select_nth_unstable_by(middle, f64::total_cmp).1)
    };
    let count = usual(groups.iter().map(|(_, count)| *count as f64).collect())?.max(1.0);
    let step = usual(groups.windows(2).map(|g| times[g[1].0] - times[g[0].0]).filter(|s| *s > 0.0).collect())?;
    for (g, (start, rows)) in groups.iter().enumerate() {
        let spacing = step / count.max(*rows as f64);
        // The first interval may have begun before the file.
        let late = if g == 0 { step - *rows as f64 * spacing } else { 0.0 };
        for i in 0..*rows {
            times[start + i] += late + i as f64 * spacing;
        }
    }
    Some(count as usize)
}

/// A time as people and file names write it: `2024-05-01 10:00:03`.
pub fn written(seconds: f64) -> String {
    let parts = Timestamp::UNIX_EPOCH.checked_add(SignedDuration::from_secs(seconds.floor() as i64));
    parts.map_or_else(
        |_| format!("{seconds:.0} s"),
        |t| t.to_zoned(TimeZone::UTC).strftime("%Y-%m-%d %H:%M:%S").to_string(),
    )
}

/// Seconds since 1970 of a time that is so written, as that at which a recording began.
pub fn moment(text: &str) -> Option<f64> {
    date_time(text, DateOrder::DayFirst)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn epochs_of_other_programs_are_dates_of_this_century() {
        let moment = 1_761_125_400.0;
        for (number, step) in [(3_843_970_200.0, 1.0), (134_055_990_000_000_000.0, 1e7), (638_967_222e9, 1e7)] {
            let NumericTime { clock, factor, zero, words } = numeric_time(&[number, number + step], None);
            assert!(clock == Clock::Utc && ((number - zero) * factor - moment).abs() < 1e-3, "{words}");
        }
    }

    #[test]
    fn a_month_in_letters_leaves_no_doubt_of_the_order() {
        assert!(
            two_orders("05/01/2024") && two_orders("5-1-2024") && !two_orders("03-May-24") && !two_orders("2024-05-01")
        );
        assert!(is_date_alone("2024-05-01") && !is_date_alone("240501100003"));
    }

    #[test]
    fn stamps_of_two_numbers_are_told_apart_or_asked_for() {
        let of = |texts: &[&'static str], header: &str, unit: Option<&str>| {
            stamps(texts.iter().copied(), header, unit, false)
        };
        use Stamps::{Either, HoursMinutes, MinutesSeconds};
        assert_eq!(of(&["10:15", "10:16"], "Time", None), HoursMinutes);
        assert_eq!(of(&["10:15", "24:16"], "Time", None), MinutesSeconds);
        assert_eq!(of(&["00:00", "00:01"], "Time", None), Either);
        assert_eq!(of(&["00:00", "00:01"], "Time mm:ss", None), MinutesSeconds);
        assert_eq!(of(&["00:00", "00:01"], "Time", Some("min")), MinutesSeconds);
        assert_eq!(of(&["00:00", "00:01"], "Time", Some("h")), HoursMinutes);
        assert_eq!(of(&["00:00:00", "00:00:01"], "Time", None), HoursMinutes);
        assert_eq!(stamps(["00:00", "00:01"].into_iter(), "Time", None, true), HoursMinutes);
    }

    #[test]
    fn one_instant_written_in_many_ways_is_one_number() {
        let same = [
            "2024-05-01T10:00:03.250Z",
            "2024-05-01 10:00:03.25",
            "2024-05-01T12:00:03.25+02:00",
            "2024-05-01 10:00:03,25 UTC",
            "01.05.2024 10:00:03.25",
            "2024/05/01 10:00:03.25",
            "1/5/2024 10:00:03.25",
            "1-5-2024 10:00:03.25 AM",
            "01-May-2024 10:00:03.25",
            "01-May-24 10:00:03.25",
            "01-MAY-24 10:00:03.25",
            "May 1, 2024 10:00:03.25",
            "20240501100003.25",
            "240501100003.25",
            "2024-05-01_10:00:03.25",
            "2024-05-01-10:00:03.25",
            "2024-05-01T10-00-03.25",
            "20240501-100003.25",
            "01.05.2024-10:00:03.25",
        ];
        for text in same {
            assert_eq!(date_time(text, DateOrder::DayFirst), Some(1_714_557_603.25), "{text}");
        }
        assert_eq!(date_time("5/1/2024 10:00:03.25", DateOrder::MonthFirst), Some(1_714_557_603.25));
        for text in ["Wed May  1 22:00:03 2024", "Wed, 01 May 2024 22:00:03 +0000", "01/05/2024 10:00:03 pm"] {
            assert_eq!(date_time(text, DateOrder::DayFirst), Some(1_714_600_803.0), "{text}");
        }
        for text in ["12345678.5", "01/05/2024 13:00:03 PM", "engine 1 stopped"] {
            assert_eq!(date_time(text, DateOrder::DayFirst), None, "{text}");
        }
        assert_eq!(written(1_714_557_603.25), "2024-05-01 10:00:03");
    }

    #[test]
    fn the_name_of_a_column_may_have_the_zone() {
        let cases = [
            ("Time (UTC+2)", Some(7200.0)),
            ("Zeit GMT-03:30", Some(-12_600.0)),
            ("time UTC +0530", Some(19_800.0)),
            ("Time (UTC)", None),
            ("Time", None),
        ];
        for (name, seconds) in cases {
            assert_eq!(zone(name), seconds, "{name}");
        }
        let own = ["2024-05-01T10:00:03Z", "2024-05-01 10:00:03+02:00", "2024-05-01 10:00 UTC"];
        assert!(own.into_iter().all(has_zone) && !has_zone("2024-05-01 10:00:03"));
    }

    #[test]
    fn epochs_are_known_by_their_size_and_spreadsheet_days_by_their_step() {
        assert_eq!(numeric_time(&[1_714_557_603.0], None).factor, 1.0);
        assert_eq!(numeric_time(&[1_714_557_603_000.0], None).factor, 1e-3);
        let days = numeric_time(&[45_413.5, 45_413.500_01], None);
        assert_eq!((days.clock, (45_413.5 - days.zero) * days.factor), (Clock::Utc, 1_714_564_800.0));
        assert_eq!(numeric_time(&[0.0, 1.0, 45_000.0], None).clock, Clock::Own);
        for noon in [60_431.5, 739_373.5, 2_460_432.0] {
            let days = numeric_time(&[noon, noon + 1e-5], None);
            assert_eq!((days.clock, (noon - days.zero) * days.factor), (Clock::Utc, 1_714_564_800.0));
        }
    }

    #[test]
    fn times_of_day_are_read_as_people_write_them() {
        let cases = [
            ("10:03:05.25", 36_185.25),
            ("12:03:05 AM", 185.0),
            ("12:03:05PM", 43_385.0),
            ("03:05.25", 185.25),
            ("1 days 00:00:01", 86_401.0),
            ("25:00:01", 90_001.0),
            ("10.03.05", 36_185.0),
            ("10h03m05s", 36_185.0),
            ("10h03", 36_180.0),
            ("135/10:03:05", 135.0 * DAY + 36_185.0),
        ];
        for (text, seconds) in cases {
            assert_eq!(time_of_day(text), Some(seconds), "{text}");
        }
        for text in ["13:00:00 PM", "10.03", "110.03.05", "5/7", "heading"] {
            assert_eq!(time_of_day(text), None, "{text}");
        }
        assert_eq!(calendar([2024.0, 5.0, 1.0, 10.0, 0.0, 3.25]), Some(1_714_557_603.25));
        assert_eq!(calendar([2024.0, 13.0, 1.0, 10.0, 0.0, 3.25]), None);
        let clock: Vec<f64> = (0..200).map(|i| f64::from(101_500 + i / 60 * 100 + i % 60)).collect();
        assert!(are_digits_of_day(&clock) && digits_of_day(101_530.25) == Some(36_930.25));
        let seconds: Vec<f64> = (0..200).map(f64::from).collect();
        assert!(!are_digits_of_day(&seconds));
    }

    #[test]
    fn rounded_times_are_spread_over_their_seconds() {
        let mut times = vec![10.0, 10.0, 11.0, 11.0, 11.0, 11.0, 12.0, 12.0, 12.0, 12.0];
        assert_eq!(spread(&mut times), Some(4));
        assert_eq!(times, [10.5, 10.75, 11.0, 11.25, 11.5, 11.75, 12.0, 12.25, 12.5, 12.75]);
        assert_eq!(spread(&mut [1.0, 2.0, 3.0, 4.0, 5.0]), None);
    }

    #[test]
    fn minutes_and_seconds_go_on_past_the_hour_and_not_where_a_run_begins_anew() {
        let mut times: Vec<f64> = (0..60).map(|i| f64::from(3570 + i) % 3600.0).collect();
        assert_eq!((past_the_hour(&mut times), times[59]), (1, 3629.0));
        let mut runs: Vec<f64> = (0..60).map(|i| f64::from(i % 30)).collect();
        assert_eq!((past_the_hour(&mut runs), runs[59]), (0, 29.0));
        assert!(is_of_hour("59:59.0") && !is_of_hour("10:59") && !is_of_hour("10:59:59.0"));
    }

    #[test]
    fn a_clock_goes_on_past_midnight() {
        let mut times = vec![time_of_day("23:59:59").unwrap(), time_of_day("00:00:01.5").unwrap()];
        past_midnight(&mut times);
        assert_eq!(times[1] - times[0], 2.5);
    }
}
