//! One solve: the lock around Ipopt, the guard against a solve inside a solve, and an answer whose every number was computed.
//! What crosses into C is in `ffi`.

use super::ffi::{Outcome, run};
use super::nlp::{Multipliers, Nlp};
use super::options::Options;
use super::problem::{Context, Problem, all_finite};
use super::status::{Counts, IpoptError, Status};
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Duration;

/// The lock around every use of Ipopt in the process; it guards MUMPS, not data, so a poisoned lock is as good as any.
static SOLVER: Mutex<()> = Mutex::new(());

/// How long a worker without work waits before it asks for the lock again: little beside a solve.
const PAUSE: Duration = Duration::from_micros(100);

thread_local! {
    /// Whether this thread is inside [`solve`]: a second solve started from a callback would wait for the lock for ever.
    static SOLVING: Cell<bool> = const { Cell::new(false) };
}

/// The point a solve ended at, and how it ended. It is an optimum only if [`Status::is_success`].
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The variables.
    pub x: Vec<f64>,
    /// The objective at `x`.
    pub objective: f64,
    /// The constraint values at `x`.
    pub constraint_values: Vec<f64>,
    /// The multipliers there; 0 after a failure that left none.
    pub multipliers: Multipliers,
    /// How the solve ended.
    pub status: Status,
    /// Iterations taken.
    pub iterations: usize,
    /// Evaluations taken.
    pub counts: Counts,
}

/// Minimises the objective of `nlp` within its bounds and constraints.
///
/// A solve that does not converge is a result: its [`Solution`] says so in `status`. Waits while another thread is solving.
///
/// # Errors
///
/// An [`IpoptError`] if the problem has no variables, contradictory bounds, a start that is not finite or an impossible
/// structure, if Ipopt refuses an option, if called from a callback of another solve, or if the solve ended before there was
/// a point to report.
pub fn solve(nlp: &mut dyn Nlp, options: &Options) -> Result<Solution, IpoptError> {
    if SOLVING.get() {
        return Err(IpoptError::Nested);
    }
    let problem = Problem::of(nlp, options)?;
    let mut context =
        Context { nlp, problem, placeholder: true, counts: Counts::default(), iterations: 0, panic: None };

    let outcome = {
        let _lock = turn();
        let _mark = SolvingMark::set();
        run(&mut context, options)?
    };
    settle(context, outcome)
}

/// Waits for the lock. A worker of a rayon pool works on meanwhile: the solve that has the lock may wait for just this worker.
fn turn() -> MutexGuard<'static, ()> {
    loop {
        match SOLVER.try_lock() {
            Ok(lock) => return lock,
            Err(TryLockError::Poisoned(lock)) => return lock.into_inner(),
            Err(TryLockError::WouldBlock) => {}
        }
        match rayon::yield_now() {
            Some(rayon::Yield::Executed) => {}
            Some(rayon::Yield::Idle) => std::thread::sleep(PAUSE),
            None => return SOLVER.lock().unwrap_or_else(PoisonError::into_inner),
        }
    }
}

/// Marks this thread as solving for as long as it lives.
struct SolvingMark;

impl SolvingMark {
    fn set() -> Self {
        SOLVING.set(true);
        Self
    }
}

impl Drop for SolvingMark {
    fn drop(&mut self) {
        SOLVING.set(false);
    }
}

/// Turns what Ipopt left into a solution whose every number was computed.
fn settle(mut context: Context<'_>, outcome: Outcome) -> Result<Solution, IpoptError> {
    let Outcome { status, x, mut objective, mut constraint_values, .. } = outcome;
    let none = |status: Status, context: &Context| {
        let (iterations, counts) = (context.iterations, context.counts);
        Err(IpoptError::NoIterate { status, iterations, counts })
    };
    if !all_finite(&x) {
        return none(status, &context);
    }
    if !status.is_success() {
        // After a panic this runs the caller's code once more; if it panics again there is nothing to report.
        let evaluated = catch_unwind(AssertUnwindSafe(|| {
            let value = context.objective(&x)?;
            let feasible = constraint_values.is_empty() || context.constraint_values(&x, &mut constraint_values);
            feasible.then_some(value)
        }));
        match evaluated {
            Ok(Some(value)) => objective = value,
            Ok(None) | Err(_) => return none(status, &context),
        }
    }
    Ok(Solution {
        x,
        objective,
        constraint_values,
        multipliers: outcome.multipliers,
        status,
        iterations: context.iterations,
        counts: context.counts,
    })
}
