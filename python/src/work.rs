//! How work is done without the lock of the interpreter: short work at once, long work beside a loop that hears Ctrl-C.
//! It does not depend on what is computed.

use crate::errors::fault;
use crate::term::failed;
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread::Scope;
use std::time::Duration;

/// How often a long work looks for signals: often enough for a person who waits.
const LISTEN: Duration = Duration::from_millis(40);

/// The threads that compute, and the process that started them: they do not outlive a fork.
struct Threads {
    process: u32,
    /// 0 for one on each processor.
    count: usize,
    pool: Option<Arc<ThreadPool>>,
}

/// More threads than this are another number.
const MOST_THREADS: usize = 1024;

/// Locked by a long work: another one on the same threads could be begun by a thread that waits for a part of the first, inside its solver.
static TURN: Mutex<()> = Mutex::new(());

static THREADS: Mutex<Threads> = Mutex::new(Threads { process: 0, count: 0, pool: None });

/// Sets the number of threads for all work that begins from now on; `None` for the number of processors. Results do not depend on it.
pub fn set_threads(count: Option<i128>) -> PyResult<()> {
    let count = match count {
        None => 0,
        Some(given) => usize::try_from(given).ok().filter(|n| (1..=MOST_THREADS).contains(n)).ok_or_else(|| {
            PyValueError::new_err(format!(
                "count = {given} must be between 1 and {MOST_THREADS}: a number of threads; None is one for each processor"
            ))
        })?,
    };
    let mut threads = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    threads.count = count;
    threads.pool = None;
    Ok(())
}

/// The threads of this process.
fn pool() -> PyResult<Arc<ThreadPool>> {
    let mut threads = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if threads.process != process {
        // Threads that a fork left behind cannot be ended: there are none.
        std::mem::forget(threads.pool.take());
        threads.process = process;
    }
    if let Some(pool) = &threads.pool {
        return Ok(Arc::clone(pool));
    }
    let built = ThreadPoolBuilder::new().num_threads(threads.count).build();
    let pool =
        built.map_err(|e| PyValueError::new_err(format!("cannot start the threads ({e}); set fewer threads")))?;
    let pool = Arc::new(pool);
    threads.pool = Some(Arc::clone(&pool));
    Ok(pool)
}

/// A long work was given up: what is thrown through it, and caught by [`long`].
struct GivenUp;

/// What a panic of the library becomes.
fn broken(panic: &(dyn Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
    fault(text.unwrap_or("a computation broke off"))
}

/// Does some work on the threads, without the lock of the interpreter.
pub fn short<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let pool = pool()?;
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(|| pool.install(work)))).map_err(|panic| broken(&*panic))?;
    failed().map_or(Ok(done), Err)
}

/// As [`short`], for work that chooses its own threads.
pub fn alone<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| catch_unwind(AssertUnwindSafe(work))).map_err(|panic| broken(&*panic))
}

/// The line by which a long work reports its progress and learns whether it is still wanted.
pub struct Line<'a, E> {
    events: Sender<E>,
    stopped: &'a AtomicBool,
}

impl<E> Line<'_, E> {
    /// Sends an event; false where the work is to end.
    pub fn tell(&self, event: E) -> bool {
        // Nobody listens only where the work is to end anyway.
        let _ = self.events.send(event);
        !self.is_stopped()
    }

    /// Whether the work is to end.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Tells an event, and ends a work that has no better way to end where it is to.
    pub fn tell_or_give_up(&self, event: E) {
        if !self.tell(event) {
            resume_unwind(Box::new(GivenUp));
        }
    }
}

/// How a long work ended.
pub struct Ended<T> {
    /// What it gave; `None` where it was given up.
    pub value: Option<T>,
    /// Whether Ctrl-C was pressed.
    pub interrupted: bool,
}

/// Waits for the turn of a long work; given up where it is no longer wanted.
fn turn(stopped: &AtomicBool) -> Result<MutexGuard<'static, ()>, Box<dyn Any + Send>> {
    loop {
        match TURN.try_lock() {
            Ok(turn) => return Ok(turn),
            Err(TryLockError::Poisoned(turn)) => return Ok(turn.into_inner()),
            Err(TryLockError::WouldBlock) if stopped.load(Ordering::Relaxed) => return Err(Box::new(GivenUp)),
            Err(TryLockError::WouldBlock) => std::thread::sleep(LISTEN),
        }
    }
}

/// Does a long work on the threads while this thread hands its events to `handle` and looks for signals.
///
/// Ctrl-C, or `handle` giving false, asks the work to end. Another exception of `handle` or of a signal's handler is raised when it has.
pub fn long<T: Send, E: Send>(
    py: Python<'_>,
    mut handle: impl FnMut(E) -> PyResult<bool>,
    work: impl FnOnce(&Line<E>) -> T + Send,
) -> PyResult<Ended<T>> {
    let (pool, stopped) = (pool()?, AtomicBool::new(false));
    let (events, heard) = channel();
    // Only this thread hears; the lock lets it wait without that of the interpreter.
    let heard = Mutex::new(heard);
    let line = Line { events, stopped: &stopped };
    let (mut raised, mut interrupted): (Option<PyErr>, bool) = (None, false);
    let value = std::thread::scope(|scope: &Scope| {
        let worker = scope.spawn(move || {
            let _turn = turn(line.stopped)?;
            catch_unwind(AssertUnwindSafe(|| pool.install(|| work(&line))))
        });
        loop {
            let event = py.detach(|| heard.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(LISTEN));
            let mut outcome = match event {
                Ok(event) if raised.is_none() => handle(event),
                Ok(_) | Err(RecvTimeoutError::Timeout) => Ok(true),
                Err(RecvTimeoutError::Disconnected) => break,
            };
            if let Err(error) = py.check_signals() {
                outcome = Err(error);
            }
            match outcome {
                Ok(true) => {}
                Ok(false) => stopped.store(true, Ordering::Relaxed),
                // Also where Ctrl-C was pressed while `handle` ran.
                Err(error) if error.is_instance_of::<PyKeyboardInterrupt>(py) => {
                    interrupted = true;
                    stopped.store(true, Ordering::Relaxed);
                }
                Err(error) => {
                    raised.get_or_insert(error);
                    stopped.store(true, Ordering::Relaxed);
                }
            }
        }
        py.detach(|| worker.join().unwrap_or_else(Err))
    });
    match (raised.or_else(failed), value) {
        (Some(error), _) => Err(error),
        (None, Ok(value)) => Ok(Ended { value: Some(value), interrupted }),
        (None, Err(panic)) if panic.is::<GivenUp>() => Ok(Ended { value: None, interrupted }),
        (None, Err(panic)) => Err(broken(&*panic)),
    }
}

/// As [`long`], for work that gives nothing where it was interrupted: `KeyboardInterrupt` then.
pub fn whole<T: Send, E: Send>(
    py: Python<'_>,
    handle: impl FnMut(E) -> PyResult<bool>,
    work: impl FnOnce(&Line<E>) -> T + Send,
) -> PyResult<T> {
    match long(py, handle, work)? {
        Ended { value: Some(value), interrupted: false } => Ok(value),
        _ => Err(PyKeyboardInterrupt::new_err(())),
    }
}
