//! The calls of MPI, for a build with the feature `mpi`: a job that `mpirun` started, seen from one of its ranks.
//! It knows bytes and whole numbers; what they mean is described in [`Ranks`](super::Ranks).

use mpi::collective::SystemOperation;
use mpi::datatype::PartitionMut;
use mpi::environment::{Threading, Universe};
use mpi::point_to_point::MatchedReceiveVec;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives, Destination, Equivalence, Source};
use std::sync::{Mutex, PoisonError};

/// Variables that launchers set for every rank (Open MPI, PMIx, Hydra of MPICH).
const LAUNCHED: [&str; 3] = ["OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"];

/// A job of several ranks.
pub(super) struct World {
    /// One thread at a time: that much every MPI library allows.
    universe: Mutex<Universe>,
    rank: usize,
    size: usize,
}

impl World {
    /// Joins the job that this process is a rank of; `None` where no launcher started it.
    pub fn join() -> Option<Self> {
        if !LAUNCHED.iter().any(|name| std::env::var_os(name).is_some()) {
            return None;
        }
        let (universe, _) = mpi::initialize_with_threading(Threading::Serialized)?;
        let world = universe.world();
        let (rank, size) = (world.rank() as usize, world.size() as usize);
        end_all_where_one_panics();
        Some(Self { universe: Mutex::new(universe), rank, size })
    }

    pub fn rank(&self) -> usize {
        self.rank
    }

    pub fn size(&self) -> usize {
        self.size
    }

    fn with<R>(&self, call: impl FnOnce(&SimpleCommunicator) -> R) -> R {
        let universe = self.universe.lock().unwrap_or_else(PoisonError::into_inner);
        call(&universe.world())
    }

    pub fn sum(&self, own: &[i64]) -> Vec<i64> {
        self.reduce(own, SystemOperation::sum())
    }

    pub fn largest(&self, own: &[i64]) -> Vec<i64> {
        self.reduce(own, SystemOperation::max())
    }

    fn reduce(&self, own: &[i64], by: SystemOperation) -> Vec<i64> {
        let mut all = vec![0; own.len()];
        self.with(|world| world.all_reduce_into(own, &mut all[..], by));
        all
    }

    /// The bytes of every rank, in the order of the ranks, on every rank.
    pub fn gather(&self, own: &[u8]) -> Vec<Vec<u8>> {
        let mut lengths = vec![0_i32; self.size];
        self.with(|world| world.all_gather_into(&(own.len() as i32), &mut lengths[..]));
        let starts: Vec<i32> = lengths.iter().scan(0, |at, n| Some(std::mem::replace(at, *at + n))).collect();
        let mut all = vec![0_u8; lengths.iter().map(|n| *n as usize).sum()];
        let mut parts = PartitionMut::new(&mut all[..], &lengths[..], &starts[..]);
        self.with(|world| world.all_gather_varcount_into(own, &mut parts));
        starts.iter().zip(&lengths).map(|(from, n)| all[*from as usize..(from + n) as usize].to_vec()).collect()
    }

    /// Sends bytes to rank 0.
    pub fn hand_in(&self, text: &[u8]) {
        self.with(|world| world.process_at_rank(0).send(text));
    }

    /// Bytes that a rank sent to this one, if there are any yet.
    pub fn handed_in(&self) -> Option<Vec<u8>> {
        let taken = |world: &SimpleCommunicator| world.any_process().immediate_matched_probe().map(received::<u8>);
        self.with(taken)
    }

    pub fn abort(&self, code: i32) -> ! {
        SimpleCommunicator::world().abort(code)
    }
}

fn received<T: Equivalence>(message: (mpi::point_to_point::Message, mpi::point_to_point::Status)) -> Vec<T> {
    message.matched_receive_vec().0
}

/// A rank that panics would leave the others waiting for it.
fn end_all_where_one_panics() {
    let said = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        said(panic);
        SimpleCommunicator::world().abort(2);
    }));
}
