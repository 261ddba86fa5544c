//! The processes (ranks) that share one job, as `mpirun -n N` starts them: which part is whose, and sums over all of them.
//! It divides and adds; its callers decide what is computed. A program that was started alone is rank 0 of 1.
//!
//! Every rank runs the same program on the same input and takes the same decisions; only runs, starts, draws or cases are
//! divided. What comes out has the same bytes for any number of ranks, since sums over them are exact ([`ExactSums`]) and rows
//! are put in the order of what they belong to. A sum takes two exchanges: first, which digits of each sum are not 0 on any
//! rank (16 bytes a sum), then those digits (8 bytes each, 3 to 6 a sum).

#[cfg(not(feature = "mpi"))]
mod alone;
mod exact;
#[cfg(feature = "mpi")]
mod joined;

#[cfg(not(feature = "mpi"))]
use alone::World;
pub use exact::ExactSums;
#[cfg(feature = "mpi")]
use joined::World;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// The ranks of a job, seen from one of them.
pub struct Ranks {
    world: Option<World>,
    exchanges: AtomicU64,
    bytes: AtomicU64,
}

/// What one rank sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Traffic {
    /// Exchanges between all ranks that it took part in.
    pub exchanges: u64,
    /// Bytes that it contributed to them.
    pub bytes: u64,
}

/// A job of one rank.
static ONE: Ranks = Ranks { world: None, exchanges: AtomicU64::new(0), bytes: AtomicU64::new(0) };

/// How long a rank waits with an error for rank 0, which most likely reports the same.
const AFTER_YOU: Duration = Duration::from_secs(2);

impl Ranks {
    /// Joins the job that this process was started in. Call it once, at the start of the program.
    pub fn join() -> Self {
        Self { world: World::join(), exchanges: AtomicU64::new(0), bytes: AtomicU64::new(0) }
    }

    /// One rank, whatever job the process is in: for work that is not divided.
    pub fn one() -> &'static Self {
        &ONE
    }

    /// The number of this rank, from 0.
    pub fn rank(&self) -> usize {
        self.world.as_ref().map_or(0, World::rank)
    }

    /// The number of ranks.
    pub fn size(&self) -> usize {
        self.world.as_ref().map_or(1, World::size)
    }

    /// Whether this rank prints and writes files: the first one does.
    pub fn is_first(&self) -> bool {
        self.rank() == 0
    }

    /// The part of `0..n` that is this rank's; the parts follow each other in the order of the ranks.
    pub fn share(&self, n: usize) -> Range<usize> {
        part(n, self.rank(), self.size())
    }

    /// Whether the piece of work at `index` is this rank's, where pieces are dealt out one by one.
    pub fn takes(&self, index: usize) -> bool {
        index % self.size() == self.rank()
    }

    /// What this rank has sent so far.
    pub fn traffic(&self) -> Traffic {
        let of = |count: &AtomicU64| count.load(Ordering::Relaxed);
        Traffic { exchanges: of(&self.exchanges), bytes: of(&self.bytes) }
    }

    /// The sums over all ranks, each rounded to the nearest `f64`; `None` if something that was added anywhere is not finite.
    pub fn total(&self, mut sums: ExactSums) -> Option<Vec<f64>> {
        let Some(world) = &self.world else { return sums.values() };
        sums.carry();
        let mut ends: Vec<i64> = sums.extents().iter().flat_map(|(from, to)| [-(*from as i64), *to as i64]).collect();
        ends.extend([i64::from(!sums.is_finite()), sums.point(), -sums.point()]);
        self.count(&ends);
        let ends = world.largest(&ends);
        let (ends, last) = ends.split_at(ends.len() - 3);
        if last[1] != -last[2] {
            self.fail(
                "the ranks evaluate different points, so that their sums mean nothing; run all of them with one program on \
                 processors of one kind",
            );
        }
        if last[0] > 0 {
            return None;
        }
        let extents: Vec<(usize, usize)> = ends.chunks(2).map(|e| ((-e[0]) as usize, e[1] as usize)).collect();
        let digits = sums.within(&extents);
        self.count(&digits);
        sums.set_within(&extents, &world.sum(&digits));
        sums.values()
    }

    /// The largest of each number over all ranks; none of them may be NaN.
    pub fn largest(&self, own: &[f64]) -> Vec<f64> {
        let Some(world) = &self.world else { return own.to_vec() };
        let own: Vec<i64> = own.iter().map(|x| ordered(x.to_bits() as i64)).collect();
        self.count(&own);
        world.largest(&own).into_iter().map(|x| f64::from_bits(ordered(x) as u64)).collect()
    }

    /// The sum of each count over all ranks.
    pub fn counts<const N: usize>(&self, own: [usize; N]) -> [usize; N] {
        let Some(world) = &self.world else { return own };
        let own = own.map(|n| n as i64);
        self.count(&own);
        let all = world.sum(&own);
        std::array::from_fn(|i| all[i] as usize)
    }

    /// How many of something the ranks before this one have.
    pub fn before(&self, own: usize) -> usize {
        self.gather(&own).iter().take(self.rank()).sum()
    }

    /// What every rank has, in the order of the ranks, on every rank. A number that is not finite arrives as nothing.
    pub fn gather<T: Clone + Serialize + DeserializeOwned>(&self, own: &T) -> Vec<T> {
        let Some(world) = &self.world else { return vec![own.clone()] };
        let sent = serde_json::to_vec(own).unwrap_or_else(|e| self.fail(&format!("cannot be sent: {e}")));
        self.count(&sent);
        let read = |bytes: Vec<u8>| serde_json::from_slice(&bytes);
        let all: Result<Vec<T>, _> = world.gather(&sent).into_iter().map(read).collect();
        all.unwrap_or_else(|e| self.fail(&format!("what another rank sent cannot be read: {e}")))
    }

    /// Rows of all ranks by their index, on every rank.
    pub fn rows<T: Clone + Serialize + DeserializeOwned>(&self, own: Vec<(usize, T)>) -> Vec<T> {
        let mut all: Vec<(usize, T)> = self.gather(&own).into_iter().flatten().collect();
        all.sort_by_key(|row| row.0);
        all.into_iter().map(|row| row.1).collect()
    }

    /// Sends a text to the first rank, which takes it from [`Self::handed_in`].
    pub fn hand_in(&self, text: &str) {
        if let Some(world) = &self.world {
            self.count(text.as_bytes());
            world.hand_in(text.as_bytes());
        }
    }

    /// A text that another rank has handed in, if there is one yet.
    pub fn handed_in(&self) -> Option<String> {
        let bytes = self.world.as_ref()?.handed_in()?;
        Some(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// Ends the job on all ranks with exit code 2 and a message on standard error.
    ///
    /// The other ranks give the first one time to report the same error: one that all ranks meet is printed once.
    pub fn fail(&self, message: &str) -> ! {
        if !self.is_first() {
            std::thread::sleep(AFTER_YOU);
        }
        let of = if self.size() > 1 { format!("rank {} of {}: ", self.rank(), self.size()) } else { String::new() };
        eprintln!("trimtab: {of}{message}");
        match &self.world {
            Some(world) => world.abort(2),
            None => std::process::exit(2),
        }
    }

    fn count<T>(&self, sent: &[T]) {
        self.exchanges.fetch_add(1, Ordering::Relaxed);
        self.bytes.fetch_add(size_of_val(sent) as u64, Ordering::Relaxed);
    }
}

/// The part of `0..n` of one of several ranks; the first has one if any has.
fn part(n: usize, rank: usize, size: usize) -> Range<usize> {
    (rank * n).div_ceil(size)..((rank + 1) * n).div_ceil(size)
}

/// The bits of an `f64` as a number of the same order, and back.
fn ordered(bits: i64) -> i64 {
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_all_there_is_in_the_order_of_the_ranks() {
        for n in [0, 1, 3, 13, 165] {
            for size in 1..=8 {
                let all: Vec<usize> = (0..size).flat_map(|rank| part(n, rank, size)).collect();
                assert_eq!(all, (0..n).collect::<Vec<_>>());
                assert!(n == 0 || !part(n, 0, size).is_empty());
            }
        }
    }

    #[test]
    fn bits_are_ordered_as_their_numbers_are() {
        let numbers = [f64::NEG_INFINITY, -2.0, -1e-300, -0.0, 0.0, 1e-300, 2.0, f64::INFINITY];
        let of = |x: f64| ordered(x.to_bits() as i64);
        assert!(numbers.windows(2).all(|w| of(w[0]) < of(w[1])));
        assert!(numbers.iter().all(|x| ordered(of(*x)) == x.to_bits() as i64));
    }

    #[test]
    fn one_rank_has_everything_and_sends_nothing() {
        let one = Ranks::one();
        let mut sums = ExactSums::new(2);
        sums.add(0, 0.5);
        sums.add(1, -1.0);
        assert_eq!(one.total(sums), Some(vec![0.5, -1.0]));
        assert_eq!((one.share(5), one.takes(7), one.before(3)), (0..5, true, 0));
        assert_eq!(one.rows(vec![(1, "b".to_owned()), (0, "a".to_owned())]), ["a", "b"]);
        assert_eq!((one.largest(&[-1.0]), one.counts([4]), one.handed_in()), (vec![-1.0], [4], None));
        assert_eq!(one.traffic(), Traffic { exchanges: 0, bytes: 0 });
    }
}
