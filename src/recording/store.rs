//! Runs that are read one at a time: in memory while they are few, in a temporary file from some size on.
//! It keeps runs and gives them back bit for bit; it neither cuts nor judges them.

use super::run::{Run, Split};
use crate::state::{Inputs, STATES};
use std::borrow::Cow;
use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result, Seek, SeekFrom, Write};
use std::sync::{Mutex, PoisonError};

/// Runs, wherever they are kept.
#[derive(Clone, Copy, Debug)]
pub enum Runs<'a> {
    /// In memory.
    Held(&'a [Run]),
    /// In a store.
    Stored(&'a RunStore),
}

impl<'a> From<&'a [Run]> for Runs<'a> {
    fn from(runs: &'a [Run]) -> Self {
        Self::Held(runs)
    }
}

impl<'a, const N: usize> From<&'a [Run; N]> for Runs<'a> {
    fn from(runs: &'a [Run; N]) -> Self {
        Self::Held(runs)
    }
}

impl<'a> From<&'a Vec<Run>> for Runs<'a> {
    fn from(runs: &'a Vec<Run>) -> Self {
        Self::Held(runs)
    }
}

impl<'a> From<&'a RunStore> for Runs<'a> {
    fn from(store: &'a RunStore) -> Self {
        if store.file.is_none() { Self::Held(&store.held) } else { Self::Stored(store) }
    }
}

impl<'a> Runs<'a> {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Held(runs) => runs.len(),
            Self::Stored(store) => store.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether they are in memory, so that what is computed from them may be as well.
    pub fn held(&self) -> bool {
        matches!(self, Self::Held(_))
    }

    /// A run by its index; `None` beyond the last, and where the file that keeps it cannot be read: see [`RunStore::failure`].
    pub fn get(&self, index: usize) -> Option<Cow<'a, Run>> {
        match self {
            Self::Held(runs) => runs.get(index).map(Cow::Borrowed),
            Self::Stored(store) => store.get(index),
        }
    }

    /// One run after the other, up to the first that cannot be read.
    pub fn iter(self) -> impl Iterator<Item = Cow<'a, Run>> {
        (0..self.len()).map_while(move |index| self.get(index))
    }
}

/// Samples up to which runs are kept in memory: about 200 bytes each, twice as many with what a fit makes of them. In the file a
/// sample of propeller, rudder and six channels takes 72 bytes.
pub const HELD_SAMPLES: usize = 400_000;

/// Keeps runs that are added one after the other.
#[derive(Debug)]
pub struct RunStore {
    held: Vec<Run>,
    samples: usize,
    most: usize,
    file: Option<RunFile>,
    failure: Mutex<Option<Error>>,
}

impl Default for RunStore {
    fn default() -> Self {
        Self::new(HELD_SAMPLES)
    }
}

impl RunStore {
    /// Without a run; more than `most` samples are kept in a file without a name in the folder for temporary files.
    pub fn new(most: usize) -> Self {
        Self { held: Vec::new(), samples: 0, most, file: None, failure: Mutex::new(None) }
    }

    /// Adds a run.
    ///
    /// # Errors
    /// When the temporary file cannot be made or written.
    pub fn push(&mut self, run: Run) -> Result<()> {
        self.samples += run.inputs.len();
        if let Some(file) = &mut self.file {
            return file.push(&run);
        }
        self.held.push(run);
        if self.samples > self.most {
            let mut file = RunFile::new()?;
            self.held.drain(..).try_for_each(|run| file.push(&run))?;
            self.held.shrink_to_fit();
            self.file = Some(file);
        }
        Ok(())
    }

    /// Samples of all runs.
    pub fn samples(&self) -> usize {
        self.samples
    }
}

impl RunStore {
    /// How many runs there are.
    pub fn len(&self) -> usize {
        self.file.as_ref().map_or(self.held.len(), |file| file.places.len())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A run by its index; `None` beyond the last, and where the file cannot be read.
    pub fn get(&self, index: usize) -> Option<Cow<'_, Run>> {
        let Some(file) = &self.file else { return self.held.get(index).map(Cow::Borrowed) };
        let place = *file.places.get(index)?;
        let run = file.read(place);
        if let Err(error) = &run {
            let mut failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
            failure.get_or_insert_with(|| Error::new(error.kind(), error.to_string()));
        }
        run.ok().map(Cow::Owned)
    }

    /// The error of the first run that could not be read, if one could not.
    pub fn failure(&self) -> Option<Error> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// What the runs of one recording share.
#[derive(Debug, PartialEq)]
struct Source {
    recording: String,
    session: String,
    manoeuvre: String,
    split: Split,
}

/// Runs in a temporary file, which ends with the process.
#[derive(Debug)]
struct RunFile {
    file: Mutex<File>,
    end: u64,
    /// First byte and length of each run, and whose it is.
    places: Vec<(u64, u32, u32)>,
    sources: Vec<Source>,
}

impl RunFile {
    fn new() -> Result<Self> {
        Ok(Self { file: Mutex::new(tempfile::tempfile()?), end: 0, places: Vec::new(), sources: Vec::new() })
    }

    fn push(&mut self, run: &Run) -> Result<()> {
        let Run { recording, session, manoeuvre, split, .. } = run.clone();
        let source = Source { recording, session, manoeuvre, split };
        if self.sources.last() != Some(&source) {
            self.sources.push(source);
        }
        let bytes = encoded(run);
        let file = self.file.get_mut().unwrap_or_else(PoisonError::into_inner);
        file.write_all(&bytes)?;
        self.places.push((self.end, bytes.len() as u32, self.sources.len() as u32 - 1));
        self.end += bytes.len() as u64;
        Ok(())
    }

    fn read(&self, (from, length, source): (u64, u32, u32)) -> Result<Run> {
        let mut bytes = vec![0; length as usize];
        {
            let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            file.seek(SeekFrom::Start(from))?;
            file.read_exact(&mut bytes)?;
        }
        let damaged = || Error::new(ErrorKind::InvalidData, "the temporary file with the runs was changed");
        decoded(&bytes, &self.sources[source as usize]).ok_or_else(damaged)
    }
}

/// A run as bytes: name, step, step of the recording, start, disturbed ranges, derived channels, then each input and each channel as one value or as one a
/// sample.
fn encoded(run: &Run) -> Vec<u8> {
    let samples = run.inputs.len();
    let mut bytes = Vec::with_capacity(64 + 8 * samples * (3 + STATES));
    let put = |bytes: &mut Vec<u8>, value: f64| bytes.extend(value.to_le_bytes());
    let count = |bytes: &mut Vec<u8>, value: usize| bytes.extend((value as u64).to_le_bytes());
    count(&mut bytes, run.name.len());
    bytes.extend(run.name.as_bytes());
    put(&mut bytes, run.dt);
    put(&mut bytes, run.recorded_dt);
    run.initial.iter().for_each(|x| put(&mut bytes, *x));
    count(&mut bytes, run.disturbed.len());
    for (from, to) in &run.disturbed {
        count(&mut bytes, *from);
        count(&mut bytes, *to);
    }
    bytes.extend(run.derived.map(u8::from));
    count(&mut bytes, samples);
    count(&mut bytes, run.measured.len());
    let _: Inputs<()> = Inputs::from_entries(|entry: fn(&Inputs<f64>) -> &f64| {
        put_column(&mut bytes, run.inputs.iter().map(|i| *entry(i)));
    });
    for channel in 0..STATES {
        put_column(&mut bytes, run.measured.iter().map(|m| m[channel].unwrap_or(f64::NAN)));
    }
    bytes
}

/// One value where all are the same, and else every value.
fn put_column(bytes: &mut Vec<u8>, values: impl Iterator<Item = f64> + Clone) {
    let first = values.clone().next().unwrap_or(0.0);
    if values.clone().all(|v| v.to_bits() == first.to_bits()) {
        bytes.push(0);
        bytes.extend(first.to_le_bytes());
    } else {
        bytes.push(1);
        values.for_each(|v| bytes.extend(v.to_le_bytes()));
    }
}

/// A column as [`put_column`] writes it.
#[derive(Clone, Copy)]
enum Column<'a> {
    Same(f64),
    Each(&'a [[u8; 8]]),
}

impl Column<'_> {
    fn at(&self, sample: usize) -> f64 {
        match self {
            Self::Same(value) => *value,
            Self::Each(values) => f64::from_le_bytes(values[sample]),
        }
    }
}

/// Bytes that are read from the front.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (front, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(front)
    }

    fn eight(&mut self) -> Option<[u8; 8]> {
        self.take(8)?.try_into().ok()
    }

    fn count(&mut self) -> Option<usize> {
        usize::try_from(u64::from_le_bytes(self.eight()?)).ok()
    }

    fn number(&mut self) -> Option<f64> {
        self.eight().map(f64::from_le_bytes)
    }

    fn column(&mut self, samples: usize) -> Option<Column<'a>> {
        match self.take(1)? {
            [0] => self.number().map(Column::Same),
            _ => Some(Column::Each(self.take(samples.checked_mul(8)?)?.as_chunks().0)),
        }
    }
}

/// The run of some bytes; `None` where they are no run.
fn decoded<'a>(bytes: &'a [u8], source: &Source) -> Option<Run> {
    let mut bytes = Bytes(bytes);
    let letters = bytes.count()?;
    let name = String::from_utf8(bytes.take(letters)?.to_vec()).ok()?;
    let dt = bytes.number()?;
    let recorded_dt = bytes.number()?;
    let mut initial = [0.0; STATES];
    for x in &mut initial {
        *x = bytes.number()?;
    }
    let ranges = bytes.count()?;
    let disturbed = (0..ranges).map(|_| Some((bytes.count()?, bytes.count()?))).collect::<Option<_>>()?;
    let derived: [u8; STATES] = bytes.take(STATES)?.try_into().ok()?;
    let (samples, measured) = (bytes.count()?, bytes.count()?);
    let mut whole = true;
    let columns: Inputs<Column<'a>> = Inputs::from_entries(|_: fn(&Inputs<f64>) -> &f64| {
        let column = bytes.column(samples);
        whole &= column.is_some();
        column.unwrap_or(Column::Same(f64::NAN))
    });
    let mut channels = [Column::Same(f64::NAN); STATES];
    for channel in &mut channels {
        *channel = bytes.column(measured)?;
    }
    let inputs =
        |k| Inputs::from_entries(|entry: for<'b> fn(&'b Inputs<Column<'a>>) -> &'b Column<'a>| entry(&columns).at(k));
    let value = |k: usize, c: usize| Some(channels[c].at(k)).filter(|v| !v.is_nan());
    whole.then(|| Run {
        name,
        recording: source.recording.clone(),
        session: source.session.clone(),
        manoeuvre: source.manoeuvre.clone(),
        split: source.split,
        dt,
        recorded_dt,
        inputs: (0..samples).map(inputs).collect(),
        measured: (0..measured).map(|k| std::array::from_fn(|c| value(k, c))).collect(),
        initial,
        disturbed,
        derived: derived.map(|flag| flag != 0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs of growing length with missing values, wind that changes and a current that does not.
    fn runs() -> Vec<Run> {
        let run = |i: usize| {
            let samples = 3 + 5 * i;
            let inputs = |k: usize| Inputs {
                wind: [0.1 * k as f64, -0.0],
                current: [0.3, 1.0 / 3.0],
                ..Inputs::actuators(0.1 * k as f64, 1.0 + (k as f64).sin(), -0.2)
            };
            let measured = |k: usize| -> [Option<f64>; STATES] {
                std::array::from_fn(|c| (c != 4 && !(k + c).is_multiple_of(7)).then(|| (k * c) as f64 / 7.0))
            };
            Run {
                name: format!("ü {i}"),
                recording: format!("recording {}", i / 3),
                session: "day".into(),
                manoeuvre: "zigzag".into(),
                split: if i.is_multiple_of(2) { Split::Train } else { Split::Test },
                dt: 0.1,
                recorded_dt: 0.05,
                inputs: (0..samples).map(inputs).collect(),
                measured: (0..samples).map(measured).collect(),
                initial: [1.0, -0.0, f64::MIN_POSITIVE, 1e300, 0.1, 2.0],
                disturbed: if i == 2 { vec![(1, 2), (3, 5)] } else { Vec::new() },
                derived: std::array::from_fn(|c| c > 2 && i.is_multiple_of(2)),
            }
        };
        (0..12).map(run).collect()
    }

    #[test]
    fn runs_come_back_bit_for_bit_from_memory_and_from_a_file() {
        let runs = runs();
        for most in [0, 100, usize::MAX] {
            let mut store = RunStore::new(most);
            runs.iter().for_each(|run| store.push(run.clone()).unwrap());
            assert_eq!((store.len(), store.samples()), (12, runs.iter().map(|r| r.inputs.len()).sum()));
            assert_eq!(Runs::from(&store).held(), most == usize::MAX);
            assert!(Runs::from(&store).iter().eq(Runs::from(&runs).iter()));
            for (i, run) in runs.iter().enumerate().rev() {
                assert_eq!(&*store.get(i).unwrap(), run, "{most}");
                assert_eq!(encoded(&store.get(i).unwrap()), encoded(run));
            }
            assert!(store.get(12).is_none() && store.failure().is_none());
        }
    }

    #[test]
    fn a_file_that_cannot_be_read_is_reported_once() {
        let mut store = RunStore::new(0);
        runs().into_iter().for_each(|run| store.push(run).unwrap());
        store.file.as_ref().unwrap().file.lock().unwrap().set_len(100).unwrap();
        assert!(store.get(5).is_none() && Runs::from(&store).iter().count() < 12);
        assert!(store.failure().is_some() && store.failure().is_none());
    }

    #[test]
    fn bytes_that_were_cut_off_are_no_run() {
        let run = &runs()[3];
        let source =
            Source { recording: String::new(), session: String::new(), manoeuvre: String::new(), split: Split::Train };
        let bytes = encoded(run);
        assert!(decoded(&bytes, &source).is_some());
        assert!((0..bytes.len()).all(|end| decoded(&bytes[..end], &source).is_none()));
    }
}
