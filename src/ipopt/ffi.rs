//! The C interface of Ipopt: a problem of the shim, its callbacks, and the answer copied out of it.
//! It is the only file of the project that contains `unsafe`; what is solved and what an answer is worth are decided elsewhere.

use super::nlp::{IterationReport, Multipliers};
use super::options::{HessianMode, OptionValue, Options};
use super::problem::{Context, Problem};
use super::status::{IpoptError, Status};
use ipopt_sys as sys;
use std::any::Any;
use std::ffi::{CString, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What Ipopt leaves behind.
pub(super) struct Outcome {
    pub(super) status: Status,
    pub(super) x: Vec<f64>,
    pub(super) objective: f64,
    pub(super) constraint_values: Vec<f64>,
    pub(super) multipliers: Multipliers,
}

/// A problem of the C shim, freed when dropped.
struct Handle(sys::CNLP_ProblemPtr);

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: the pointer came from `cnlp_create_problem`, is freed only here, and no result that points into it outlives
        // `run`, which copies them.
        unsafe { sys::cnlp_free_problem(self.0) }
    }
}

impl Handle {
    fn create() -> Result<Self, IpoptError> {
        let mut pointer: sys::CNLP_ProblemPtr = std::ptr::null_mut();
        let index_from_zero = 0;
        // SAFETY: `pointer` outlives the call; every callback but the optional scaling is given, as the shim demands, and each
        // has the signature its slot declares. None is called before `cnlp_init_solution` and `cnlp_solve`.
        let code = unsafe {
            sys::cnlp_create_problem(
                &raw mut pointer,
                index_from_zero,
                Some(sizes),
                Some(start),
                Some(bounds),
                Some(objective),
                Some(constraint_values),
                Some(gradient),
                Some(jacobian),
                Some(hessian),
                None,
            )
        };
        if code != sys::CNLP_CreateProblemStatus_CNLP_SUCCESS || pointer.is_null() {
            return Err(IpoptError::Create { code });
        }
        let handle = Self(pointer);
        // SAFETY: the problem was just created, and the callback has the signature its slot declares.
        unsafe { sys::cnlp_set_intermediate_callback(handle.0, Some(iteration)) };
        Ok(handle)
    }

    fn set(&self, name: &str, value: &OptionValue) -> Result<(), IpoptError> {
        let refused = || IpoptError::Option { name: name.to_owned(), value: value.clone() };
        let keyword = CString::new(name).map_err(|_| refused())?;
        let accepted = match value {
            OptionValue::Text(text) => {
                let text = CString::new(text.as_str()).map_err(|_| refused())?;
                // SAFETY: the problem is alive, both strings end in NUL and outlive the call, which copies them.
                unsafe { sys::cnlp_add_str_option(self.0, keyword.as_ptr(), text.as_ptr()) }
            }
            // SAFETY: as above.
            OptionValue::Number(number) => unsafe { sys::cnlp_add_num_option(self.0, keyword.as_ptr(), *number) },
            // SAFETY: as above.
            OptionValue::Integer(integer) => unsafe { sys::cnlp_add_int_option(self.0, keyword.as_ptr(), *integer) },
        };
        if accepted == 0 { Err(refused()) } else { Ok(()) }
    }

    fn set_all(&self, options: &Options, problem: &Problem) -> Result<(), IpoptError> {
        let text = |text: &str| OptionValue::Text(text.to_owned());
        let number = OptionValue::Number;
        let integer = |count: usize| OptionValue::Integer(i32::try_from(count).unwrap_or(i32::MAX));

        self.set("option_file_name", &text(""))?;
        self.set("sb", &text("yes"))?;
        self.set("print_level", &integer(if options.print { 5 } else { 0 }))?;
        self.set("nlp_scaling_method", &text("none"))?;
        self.set("tol", &number(options.tolerance))?;
        self.set("constr_viol_tol", &number(options.constraint_tolerance))?;
        self.set("bound_relax_factor", &number(options.bound_relaxation))?;
        self.set("max_iter", &integer(options.max_iterations))?;
        if let Some(seconds) = options.max_cpu_seconds {
            self.set("max_cpu_time", &number(seconds))?;
        }
        if let HessianMode::LimitedMemory { history } = problem.hessian_mode {
            self.set("hessian_approximation", &text("limited-memory"))?;
            self.set("limited_memory_max_history", &integer(history))?;
        }
        if problem.multipliers.is_some() {
            self.set("warm_start_init_point", &text("yes"))?;
        }
        if options.linear_constraints {
            self.set("jac_c_constant", &text("yes"))?;
            self.set("jac_d_constant", &text("yes"))?;
        }
        for (name, value) in &options.extra {
            self.set(name, value)?;
        }
        Ok(())
    }
}

/// Solves; the caller holds the lock.
pub(super) fn run(context: &mut Context<'_>, options: &Options) -> Result<Outcome, IpoptError> {
    let (n, m) = (context.problem.variables(), context.problem.constraints());
    let handle = Handle::create()?;
    handle.set_all(options, &context.problem)?;

    let user_data = (&raw mut *context).cast::<c_void>();
    // SAFETY: the problem is alive; `user_data` points to the context, which outlives the call and which nothing but the
    // callbacks touches until the solve is over. The call sizes the result arrays, so that they exist however the solve ends.
    unsafe { sys::cnlp_init_solution(handle.0, user_data) };
    // SAFETY: as above, and the pointer's target is written between two calls into C, while no callback runs.
    unsafe { (*user_data.cast::<Context<'_>>()).placeholder = false };
    // SAFETY: as for `cnlp_init_solution`.
    let result = unsafe { sys::cnlp_solve(handle.0, user_data) };

    // SAFETY: the shim's result arrays have n (x and its multipliers) and m (constraints and theirs) entries, written by
    // `cnlp_init_solution` or the solve, and live until the problem is freed, at the end of this function; they are copied here.
    let outcome = unsafe {
        Outcome {
            status: status_of(result.status, context.iterations),
            x: view(result.data.x, n).to_vec(),
            objective: result.obj_val,
            constraint_values: view(result.g, m).to_vec(),
            multipliers: Multipliers {
                constraints: view(result.data.mult_g, m).to_vec(),
                lower: view(result.data.mult_x_L, n).to_vec(),
                upper: view(result.data.mult_x_U, n).to_vec(),
            },
        }
    };
    match &context.panic {
        Some(message) => Ok(Outcome { status: Status::Panicked(message.clone()), ..outcome }),
        None => Ok(outcome),
    }
}

/// The array behind a pointer from C; empty for a null pointer, which C passes for an array without entries.
///
/// # Safety
///
/// A pointer that is not null must point to `length` initialised values that stay alive and unchanged for `'a`.
unsafe fn view<'a, T>(pointer: *const T, length: usize) -> &'a [T] {
    if pointer.is_null() || length == 0 {
        return &[];
    }
    // SAFETY: the caller's promise, for a pointer that is not null.
    unsafe { std::slice::from_raw_parts(pointer, length) }
}

/// As [`view`], to write to.
///
/// # Safety
///
/// As for [`view`], and nothing else may read or write the array for `'a`.
unsafe fn view_mut<'a, T>(pointer: *mut T, length: usize) -> &'a mut [T] {
    if pointer.is_null() || length == 0 {
        return &mut [];
    }
    // SAFETY: the caller's promise, for a pointer that is not null.
    unsafe { std::slice::from_raw_parts_mut(pointer, length) }
}

/// Runs the body of a callback on the context behind `user_data`: false if it says so, if it panics, or if an earlier one did.
///
/// # Safety
///
/// `user_data` must be the pointer `run` gave to the shim, and no other reference to the context may be in use.
unsafe fn guarded(
    user_data: sys::CNLP_UserDataPtr,
    method: &str,
    body: impl FnOnce(&mut Context<'_>) -> bool,
) -> sys::CNLP_Bool {
    // SAFETY: the caller's promise; the context outlives the solve, and callbacks do not nest.
    let context = unsafe { &mut *user_data.cast::<Context<'_>>() };
    if context.panic.is_some() {
        return 0;
    }
    match catch_unwind(AssertUnwindSafe(|| body(context))) {
        Ok(accepted) => sys::CNLP_Bool::from(accepted),
        Err(payload) => {
            context.panic = Some(format!("{method} panicked: {}", panic_message(payload.as_ref())));
            0
        }
    }
}

fn panic_message(payload: &(dyn Any + Send)) -> &str {
    if let Some(message) = payload.downcast_ref::<&str>() {
        message
    } else if let Some(message) = payload.downcast_ref::<String>() {
        message
    } else {
        "(without a message)"
    }
}

// The callbacks. Ipopt calls them one at a time, from the thread that solves, with arrays of the sizes `sizes` gave it: n
// variables, m constraints, and as many entries as the structures have. The length of every slice is therefore taken from the
// context, and the promise of `guarded` holds because `run` lends the context to nobody else during a solve.

unsafe extern "C" fn sizes(
    n: *mut sys::CNLP_Index,
    m: *mut sys::CNLP_Index,
    jacobian_entries: *mut sys::CNLP_Index,
    hessian_entries: *mut sys::CNLP_Index,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks; the four pointers are to variables of the C++ caller.
    unsafe {
        guarded(user_data, "the problem's sizes", |context| {
            let problem = &context.problem;
            // `Problem::of` made sure that they fit.
            *n = problem.variables() as sys::CNLP_Index;
            *m = problem.constraints() as sys::CNLP_Index;
            *jacobian_entries = problem.jacobian.len() as sys::CNLP_Index;
            *hessian_entries = problem.hessian.len() as sys::CNLP_Index;
            true
        })
    }
}

unsafe extern "C" fn bounds(
    _n: sys::CNLP_Index,
    x_lower: *mut sys::CNLP_Number,
    x_upper: *mut sys::CNLP_Number,
    _m: sys::CNLP_Index,
    g_lower: *mut sys::CNLP_Number,
    g_upper: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks; the four arrays are distinct.
    unsafe {
        guarded(user_data, "the problem's bounds", |context| {
            let problem = &context.problem;
            view_mut(x_lower, problem.variables()).copy_from_slice(&problem.variable_lower);
            view_mut(x_upper, problem.variables()).copy_from_slice(&problem.variable_upper);
            view_mut(g_lower, problem.constraints()).copy_from_slice(&problem.constraint_lower);
            view_mut(g_upper, problem.constraints()).copy_from_slice(&problem.constraint_upper);
            true
        })
    }
}

unsafe extern "C" fn start(
    _n: sys::CNLP_Index,
    wants_x: sys::CNLP_Bool,
    x: *mut sys::CNLP_Number,
    wants_bound_multipliers: sys::CNLP_Bool,
    z_lower: *mut sys::CNLP_Number,
    z_upper: *mut sys::CNLP_Number,
    _m: sys::CNLP_Index,
    wants_multipliers: sys::CNLP_Bool,
    lambda: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks; the four arrays are distinct and written only where C++ asks for them.
    unsafe {
        guarded(user_data, "the problem's start", |context| {
            let (n, m) = (context.problem.variables(), context.problem.constraints());
            if wants_x != 0 {
                let x = view_mut(x, n);
                if context.placeholder { x.fill(f64::NAN) } else { x.copy_from_slice(&context.problem.start) }
            }
            // Wanted for the placeholder, and for a warm start.
            let known = context.problem.multipliers.as_ref().filter(|_| !context.placeholder);
            if wants_bound_multipliers != 0 {
                let (lower, upper) = (view_mut(z_lower, n), view_mut(z_upper, n));
                match known {
                    Some(known) => {
                        lower.copy_from_slice(&known.lower);
                        upper.copy_from_slice(&known.upper);
                    }
                    None => {
                        lower.fill(0.0);
                        upper.fill(0.0);
                    }
                }
            }
            if wants_multipliers != 0 {
                let lambda = view_mut(lambda, m);
                match known {
                    Some(known) => lambda.copy_from_slice(&known.constraints),
                    None => lambda.fill(0.0),
                }
            }
            true
        })
    }
}

unsafe extern "C" fn objective(
    _n: sys::CNLP_Index,
    x: *const sys::CNLP_Number,
    _new_x: sys::CNLP_Bool,
    value: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks; `value` is a variable of the C++ caller.
    unsafe {
        guarded(user_data, "Nlp::objective", |context| {
            let x = view(x, context.problem.variables());
            match context.objective(x) {
                Some(objective) => {
                    *value = objective;
                    true
                }
                None => false,
            }
        })
    }
}

unsafe extern "C" fn gradient(
    _n: sys::CNLP_Index,
    x: *const sys::CNLP_Number,
    _new_x: sys::CNLP_Bool,
    values: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks.
    unsafe {
        guarded(user_data, "Nlp::gradient", |context| {
            let n = context.problem.variables();
            context.gradient(view(x, n), view_mut(values, n))
        })
    }
}

unsafe extern "C" fn constraint_values(
    _n: sys::CNLP_Index,
    x: *const sys::CNLP_Number,
    _new_x: sys::CNLP_Bool,
    _m: sys::CNLP_Index,
    values: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks.
    unsafe {
        guarded(user_data, "Nlp::constraint_values", |context| {
            let (n, m) = (context.problem.variables(), context.problem.constraints());
            m == 0 || context.constraint_values(view(x, n), view_mut(values, m))
        })
    }
}

unsafe extern "C" fn jacobian(
    _n: sys::CNLP_Index,
    x: *const sys::CNLP_Number,
    _new_x: sys::CNLP_Bool,
    _m: sys::CNLP_Index,
    _entries: sys::CNLP_Index,
    rows: *mut sys::CNLP_Index,
    columns: *mut sys::CNLP_Index,
    values: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks; C++ passes either `rows` and `columns` or `x` and `values`, the others null.
    unsafe {
        guarded(user_data, "Nlp::jacobian_values", |context| {
            let (n, entries) = (context.problem.variables(), context.problem.jacobian.len());
            if values.is_null() {
                write_structure(&context.problem.jacobian, view_mut(rows, entries), view_mut(columns, entries));
                return true;
            }
            entries == 0 || context.jacobian_values(view(x, n), view_mut(values, entries))
        })
    }
}

unsafe extern "C" fn hessian(
    _n: sys::CNLP_Index,
    x: *const sys::CNLP_Number,
    _new_x: sys::CNLP_Bool,
    objective_factor: sys::CNLP_Number,
    _m: sys::CNLP_Index,
    lambda: *const sys::CNLP_Number,
    _new_lambda: sys::CNLP_Bool,
    _entries: sys::CNLP_Index,
    rows: *mut sys::CNLP_Index,
    columns: *mut sys::CNLP_Index,
    values: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks; C++ passes either `rows` and `columns` or `x`, `lambda` and `values`, the others null.
    unsafe {
        guarded(user_data, "Nlp::hessian_values", |context| {
            let (n, m) = (context.problem.variables(), context.problem.constraints());
            let entries = context.problem.hessian.len();
            if values.is_null() {
                write_structure(&context.problem.hessian, view_mut(rows, entries), view_mut(columns, entries));
                return true;
            }
            let (x, lambda) = (view(x, n), view(lambda, m));
            entries == 0 || context.hessian_values(x, objective_factor, lambda, view_mut(values, entries))
        })
    }
}

fn write_structure(structure: &[(i32, i32)], rows: &mut [i32], columns: &mut [i32]) {
    for ((row, column), entry) in rows.iter_mut().zip(columns).zip(structure) {
        (*row, *column) = *entry;
    }
}

unsafe extern "C" fn iteration(
    mode: sys::CNLP_AlgorithmMode,
    iteration: sys::CNLP_Index,
    objective: sys::CNLP_Number,
    inf_pr: sys::CNLP_Number,
    inf_du: sys::CNLP_Number,
    mu: sys::CNLP_Number,
    step: sys::CNLP_Number,
    regularisation: sys::CNLP_Number,
    alpha_du: sys::CNLP_Number,
    alpha_pr: sys::CNLP_Number,
    trials: sys::CNLP_Index,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks.
    unsafe {
        guarded(user_data, "Nlp::iteration", |context| {
            let report = IterationReport {
                iteration: usize::try_from(iteration).unwrap_or(0),
                restoration: mode == sys::CNLP_AlgorithmMode_CNLP_RESTORATION_PHASE_MODE,
                objective,
                inf_pr,
                inf_du,
                mu,
                step,
                regularisation,
                alpha_du,
                alpha_pr,
                trials: usize::try_from(trials).unwrap_or(0),
            };
            context.iterations = report.iteration;
            context.nlp.iteration(&report)
        })
    }
}

fn status_of(code: sys::CNLP_ApplicationReturnStatus, iterations: usize) -> Status {
    match code {
        sys::CNLP_ApplicationReturnStatus_CNLP_SOLVE_SUCCEEDED => Status::Solved,
        sys::CNLP_ApplicationReturnStatus_CNLP_SOLVED_TO_ACCEPTABLE_LEVEL => Status::SolvedToAcceptable,
        sys::CNLP_ApplicationReturnStatus_CNLP_INFEASIBLE_PROBLEM_DETECTED => Status::Infeasible,
        sys::CNLP_ApplicationReturnStatus_CNLP_SEARCH_DIRECTION_BECOMES_TOO_SMALL => Status::TinyStep,
        sys::CNLP_ApplicationReturnStatus_CNLP_DIVERGING_ITERATES => Status::Diverging,
        sys::CNLP_ApplicationReturnStatus_CNLP_USER_REQUESTED_STOP => Status::Stopped,
        sys::CNLP_ApplicationReturnStatus_CNLP_FEASIBLE_POINT_FOUND => Status::FeasiblePointFound,
        sys::CNLP_ApplicationReturnStatus_CNLP_MAXIMUM_ITERATIONS_EXCEEDED => Status::MaxIterations { iterations },
        sys::CNLP_ApplicationReturnStatus_CNLP_RESTORATION_FAILED => Status::RestorationFailed,
        sys::CNLP_ApplicationReturnStatus_CNLP_ERROR_IN_STEP_COMPUTATION => Status::StepComputationFailed,
        sys::CNLP_ApplicationReturnStatus_CNLP_MAXIMUM_CPUTIME_EXCEEDED => Status::MaxCpuTime,
        sys::CNLP_ApplicationReturnStatus_CNLP_NOT_ENOUGH_DEGREES_OF_FREEDOM => Status::NotEnoughDegreesOfFreedom,
        sys::CNLP_ApplicationReturnStatus_CNLP_INVALID_PROBLEM_DEFINITION => Status::InvalidProblem,
        sys::CNLP_ApplicationReturnStatus_CNLP_INVALID_OPTION => Status::InvalidOption,
        sys::CNLP_ApplicationReturnStatus_CNLP_INVALID_NUMBER_DETECTED => Status::InvalidNumber,
        sys::CNLP_ApplicationReturnStatus_CNLP_UNRECOVERABLE_EXCEPTION => Status::UnrecoverableException,
        sys::CNLP_ApplicationReturnStatus_CNLP_NONIPOPT_EXCEPTION_THROWN => Status::NonIpoptException,
        sys::CNLP_ApplicationReturnStatus_CNLP_INSUFFICIENT_MEMORY => Status::InsufficientMemory,
        _ => Status::InternalError,
    }
}
