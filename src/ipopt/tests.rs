//! The solver on problems whose answers are known, and on callers that misbehave.
//! What concerns the checks of a problem alone is tested beside them.

use rayon::prelude::*;

use super::{Counts, HessianMode, IpoptError, IterationReport, Nlp, OptionValue, Options, Solution, Status, solve};

const INF: f64 = f64::INFINITY;

/// Problem 71 of Hock and Schittkowski: x0 x3 (x0 + x1 + x2) + x2 least, with the product of the four at least 25, the sum
/// of their squares 40, and each between 1 and 5. The hooks make it misbehave.
struct Hs071 {
    panic_in: Option<&'static str>,
    stop_at: usize,
    objective_calls: usize,
    panic_from_call: usize,
    hessian: bool,
    nest: bool,
    parallel: bool,
    nested: Option<IpoptError>,
    reports: Vec<IterationReport>,
}

impl Hs071 {
    fn new() -> Self {
        Self {
            panic_in: None,
            stop_at: usize::MAX,
            objective_calls: 0,
            panic_from_call: 1,
            hessian: true,
            nest: false,
            parallel: false,
            nested: None,
            reports: Vec::new(),
        }
    }

    fn maybe_panic(&self, method: &str) {
        assert!(
            self.panic_in != Some(method) || self.objective_calls < self.panic_from_call,
            "the hull {method} came off"
        );
    }
}

impl Nlp for Hs071 {
    fn variables(&self) -> usize {
        4
    }
    fn constraints(&self) -> usize {
        2
    }
    fn variable_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
        lower.fill(1.0);
        upper.fill(5.0);
    }
    fn constraint_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
        lower.copy_from_slice(&[25.0, 40.0]);
        upper.copy_from_slice(&[INF, 40.0]);
    }
    fn start(&self, x: &mut [f64]) {
        x.copy_from_slice(&[1.0, 5.0, 5.0, 1.0]);
    }
    fn objective(&mut self, x: &[f64]) -> Option<f64> {
        self.objective_calls += 1;
        self.maybe_panic("objective");
        if self.nest {
            self.nested = solve(&mut distance(), &Options::default()).err();
        }
        if self.parallel {
            let pause = || std::thread::sleep(std::time::Duration::from_micros(50));
            (0..4 * rayon::current_num_threads()).into_par_iter().for_each(|_| pause());
        }
        Some(x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2])
    }
    fn gradient(&mut self, x: &[f64], g: &mut [f64]) -> bool {
        self.maybe_panic("gradient");
        g.copy_from_slice(&[
            x[3] * (2.0 * x[0] + x[1] + x[2]),
            x[0] * x[3],
            x[0] * x[3] + 1.0,
            x[0] * (x[0] + x[1] + x[2]),
        ]);
        true
    }
    fn constraint_values(&mut self, x: &[f64], g: &mut [f64]) -> bool {
        self.maybe_panic("constraint_values");
        g[0] = x.iter().product();
        g[1] = x.iter().map(|x| x * x).sum();
        true
    }
    fn jacobian_structure(&self) -> Vec<(usize, usize)> {
        (0..8).map(|entry| (entry / 4, entry % 4)).collect()
    }
    fn jacobian_values(&mut self, x: &[f64], values: &mut [f64]) -> bool {
        self.maybe_panic("jacobian_values");
        for i in 0..4 {
            values[i] = (0..4).filter(|&j| j != i).map(|j| x[j]).product();
            values[4 + i] = 2.0 * x[i];
        }
        true
    }
    fn hessian_structure(&self) -> Vec<(usize, usize)> {
        let rows = if self.hessian { 4 } else { 0 };
        (0..rows).flat_map(|row| (0..=row).map(move |column| (row, column))).collect()
    }
    fn hessian_values(&mut self, x: &[f64], factor: f64, lambda: &[f64], values: &mut [f64]) -> bool {
        self.maybe_panic("hessian_values");
        let objective = [
            [2.0 * x[3], 0.0, 0.0, 0.0],
            [x[3], 0.0, 0.0, 0.0],
            [x[3], 0.0, 0.0, 0.0],
            [2.0 * x[0] + x[1] + x[2], x[0], x[0], 0.0],
        ];
        for (value, (row, column)) in values.iter_mut().zip(self.hessian_structure()) {
            let product: f64 = (0..4).filter(|&k| k != row && k != column).map(|k| x[k]).product();
            let constraints = if row == column { 2.0 * lambda[1] } else { product * lambda[0] };
            *value = factor * objective[row][column] + constraints;
        }
        true
    }
    fn iteration(&mut self, report: &IterationReport) -> bool {
        self.maybe_panic("iteration");
        self.reports.push(report.clone());
        report.iteration < self.stop_at
    }
}

/// Convex quadratic: half the squared distance to `target`, with linear constraints `rows . x` in `range`, in a box.
#[derive(Clone)]
struct Distance {
    target: Vec<f64>,
    start: Vec<f64>,
    rows: Vec<Vec<f64>>,
    range: Vec<(f64, f64)>,
    bounds: (f64, f64),
}

impl Nlp for Distance {
    fn variables(&self) -> usize {
        self.target.len()
    }
    fn constraints(&self) -> usize {
        self.rows.len()
    }
    fn variable_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
        lower.fill(self.bounds.0);
        upper.fill(self.bounds.1);
    }
    fn constraint_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
        for (i, &(low, high)) in self.range.iter().enumerate() {
            (lower[i], upper[i]) = (low, high);
        }
    }
    fn start(&self, x: &mut [f64]) {
        x.copy_from_slice(&self.start);
    }
    fn objective(&mut self, x: &[f64]) -> Option<f64> {
        Some(x.iter().zip(&self.target).map(|(x, t)| 0.5 * (x - t).powi(2)).sum())
    }
    fn gradient(&mut self, x: &[f64], g: &mut [f64]) -> bool {
        for i in 0..x.len() {
            g[i] = x[i] - self.target[i];
        }
        true
    }
    fn constraint_values(&mut self, x: &[f64], g: &mut [f64]) -> bool {
        for (g, row) in g.iter_mut().zip(&self.rows) {
            *g = row.iter().zip(x).map(|(a, x)| a * x).sum();
        }
        true
    }
    fn jacobian_structure(&self) -> Vec<(usize, usize)> {
        let n = self.variables();
        (0..self.constraints()).flat_map(|i| (0..n).map(move |j| (i, j))).collect()
    }
    fn jacobian_values(&mut self, _x: &[f64], values: &mut [f64]) -> bool {
        values.copy_from_slice(&self.rows.concat());
        true
    }
    fn hessian_structure(&self) -> Vec<(usize, usize)> {
        (0..self.variables()).map(|i| (i, i)).collect()
    }
    fn hessian_values(&mut self, _x: &[f64], factor: f64, _lambda: &[f64], values: &mut [f64]) -> bool {
        values.fill(factor);
        true
    }
}

/// Distance to (2, 1) with x0 + x1 <= 2 and x1 - x0 <= 4, from (5, 5), where the first constraint is broken. The nearest
/// point is (1.5, 0.5), at which the gradient (-0.5, -0.5) is balanced by a multiplier of 0.5.
fn distance() -> Distance {
    Distance {
        target: vec![2.0, 1.0],
        start: vec![5.0, 5.0],
        rows: vec![vec![1.0, 1.0], vec![-1.0, 1.0]],
        range: vec![(-INF, 2.0), (-INF, 4.0)],
        bounds: (-INF, INF),
    }
}

/// x - ln x, least at 1 and without a value at x <= 0, where a full Newton step from 10 leads; the one constraint, ln x,
/// is as undefined there.
struct Logarithm {
    start: f64,
    constrained: bool,
    refusals: usize,
    refuse_gradient_after: usize,
    gradients: usize,
}

impl Logarithm {
    fn from(start: f64) -> Self {
        Self { start, constrained: false, refusals: 0, refuse_gradient_after: usize::MAX, gradients: 0 }
    }

    fn log(&mut self, x: f64) -> Option<f64> {
        if x > 0.0 {
            return Some(x.ln());
        }
        self.refusals += 1;
        None
    }
}

impl Nlp for Logarithm {
    fn variables(&self) -> usize {
        1
    }
    fn constraints(&self) -> usize {
        usize::from(self.constrained)
    }
    fn variable_bounds(&self, _lower: &mut [f64], _upper: &mut [f64]) {}
    fn constraint_bounds(&self, _lower: &mut [f64], upper: &mut [f64]) {
        upper.fill(50.0);
    }
    fn start(&self, x: &mut [f64]) {
        x[0] = self.start;
    }
    fn objective(&mut self, x: &[f64]) -> Option<f64> {
        if self.constrained {
            // Leaves the refusing to the constraint.
            return Some(if x[0] > 0.0 { x[0] - x[0].ln() } else { -1e3 });
        }
        Some(x[0] - self.log(x[0])?)
    }
    fn gradient(&mut self, x: &[f64], g: &mut [f64]) -> bool {
        self.gradients += 1;
        g[0] = 1.0 - 1.0 / x[0];
        self.gradients <= self.refuse_gradient_after
    }
    fn constraint_values(&mut self, x: &[f64], g: &mut [f64]) -> bool {
        match self.log(x[0]) {
            Some(log) => {
                g[0] = log;
                true
            }
            None => false,
        }
    }
    fn jacobian_structure(&self) -> Vec<(usize, usize)> {
        vec![(0, 0); self.constraints()]
    }
    fn jacobian_values(&mut self, x: &[f64], values: &mut [f64]) -> bool {
        values.fill(1.0 / x[0]);
        true
    }
    fn hessian_structure(&self) -> Vec<(usize, usize)> {
        vec![(0, 0)]
    }
    fn hessian_values(&mut self, x: &[f64], factor: f64, lambda: &[f64], values: &mut [f64]) -> bool {
        values[0] = (factor - lambda.iter().sum::<f64>()) / (x[0] * x[0]);
        true
    }
}

fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance, "found {found}, expected {expected}");
    }
}

#[allow(clippy::unwrap_used)]
fn assert_solves_hs071(options: &Options) -> Solution {
    let solution = solve(&mut Hs071::new(), options).unwrap();
    assert_eq!(solution.status, Status::Solved);
    assert_close(&solution.x, &[1.0, 4.742_999_6, 3.821_149_9, 1.379_408_3], 1e-6);
    assert_close(&[solution.objective], &[17.014_017_3], 1e-6);
    solution
}

#[test]
fn hs071_reaches_its_published_optimum_and_multipliers() {
    let solution = assert_solves_hs071(&Options::default());
    assert_close(&solution.constraint_values, &[25.0, 40.0], 1e-6);
    assert_close(&solution.multipliers.constraints, &[-0.552_293_7, 0.161_468_6], 1e-5);
    assert_close(&solution.multipliers.lower, &[1.087_871_2, 0.0, 0.0, 0.0], 1e-5);
    assert_close(&solution.multipliers.upper, &[0.0; 4], 1e-5);
}

#[test]
fn the_gradient_of_the_lagrangian_vanishes_at_a_solution() {
    let mut nlp = Hs071::new();
    let solution = solve(&mut nlp, &Options::default()).unwrap();
    let (mut gradient, mut jacobian) = ([0.0; 4], [0.0; 8]);
    assert!(nlp.gradient(&solution.x, &mut gradient) && nlp.jacobian_values(&solution.x, &mut jacobian));
    for i in 0..4 {
        let lambda = &solution.multipliers.constraints;
        let constraints = lambda[0] * jacobian[i] + lambda[1] * jacobian[4 + i];
        let bounds = solution.multipliers.upper[i] - solution.multipliers.lower[i];
        assert_close(&[gradient[i] + constraints + bounds], &[0.0], 1e-7);
    }
}

#[test]
fn a_limited_memory_hessian_leads_to_the_same_optimum_as_the_given_one() {
    let given = assert_solves_hs071(&Options::default());
    let hessian = HessianMode::LimitedMemory { history: 6 };
    let limited = assert_solves_hs071(&Options { hessian, ..Options::default() });
    assert_close(&limited.x, &given.x, 1e-6);
    assert!(given.counts.hessian > 0);
    assert_eq!(limited.counts.hessian, 0);
}

#[test]
fn constrained_least_squares_from_an_infeasible_start_finds_the_nearest_feasible_point() {
    let solution = solve(&mut distance(), &Options::default()).unwrap();
    assert_eq!(solution.status, Status::Solved);
    assert_close(&solution.x, &[1.5, 0.5], 1e-7);
    assert_close(&[solution.objective], &[0.25], 1e-7);
    assert_close(&solution.multipliers.constraints, &[0.5, 0.0], 1e-6);
}

#[test]
fn linear_constraints_have_their_jacobian_evaluated_once() {
    let options = Options { linear_constraints: true, ..Options::default() };
    let linear = solve(&mut distance(), &options).unwrap();
    let general = solve(&mut distance(), &Options::default()).unwrap();
    assert_close(&linear.x, &general.x, 1e-7);
    assert_eq!(linear.counts.jacobian, 1);
    assert!(general.counts.jacobian > 1);
}

#[test]
fn without_constraints_the_bounds_alone_fix_the_optimum() {
    let mut free = distance();
    (free.rows, free.range, free.bounds) = (Vec::new(), Vec::new(), (-1.0, 1.5));
    let solution = solve(&mut free, &Options::default()).unwrap();
    assert_eq!(solution.status, Status::Solved);
    assert_close(&solution.x, &[1.5, 1.0], 1e-6);
    assert!(solution.x[0] <= 1.5);
    assert_close(&solution.multipliers.upper, &[0.5, 0.0], 1e-6);
    assert!(solution.constraint_values.is_empty() && solution.multipliers.constraints.is_empty());
    assert_eq!((solution.counts.constraints, solution.counts.jacobian), (0, 0));
}

#[test]
fn fixed_variables_stay_where_they_are() {
    let mut fixed = distance();
    fixed.bounds = (0.25, 0.25);
    let solution = solve(&mut fixed, &Options::default()).unwrap();
    assert!(solution.status.is_success());
    assert_eq!(solution.x, [0.25, 0.25]);
    assert_close(&[solution.objective], &[0.5 * (1.75 * 1.75 + 0.75 * 0.75)], 1e-12);
}

#[test]
fn a_problem_without_an_own_hessian_falls_back_to_limited_memory() {
    let solution = solve(&mut Hs071 { hessian: false, ..Hs071::new() }, &Options::default()).unwrap();
    assert_eq!(solution.status, Status::Solved);
    assert_close(&[solution.objective], &[17.014_017_3], 1e-6);
    assert_eq!(solution.counts.hessian, 0);
}

#[test]
fn contradictory_constraints_are_reported_as_infeasible() {
    let mut contradictory = distance();
    contradictory.rows = vec![vec![1.0, 1.0], vec![1.0, 1.0]];
    contradictory.range = vec![(-INF, 1.0), (3.0, INF)];
    let solution = solve(&mut contradictory, &Options::default()).unwrap();
    assert_eq!(solution.status, Status::Infeasible);
    assert!(!solution.status.is_success());
    let expected = contradictory.objective(&solution.x).unwrap();
    assert_close(&[solution.objective], &[expected], 1e-9 * expected.abs());
}

#[test]
fn a_panic_in_any_method_ends_the_solve_and_the_next_one_works() {
    let methods = ["objective", "gradient", "constraint_values", "jacobian_values", "hessian_values", "iteration"];
    for method in methods {
        let mut nlp = Hs071 { panic_in: Some(method), ..Hs071::new() };
        let status = match solve(&mut nlp, &Options::default()) {
            Ok(solution) => solution.status,
            Err(IpoptError::NoIterate { status, .. }) => status,
            Err(other) => panic!("{other}"),
        };
        let expected = format!("Nlp::{method} panicked: the hull {method} came off");
        assert_eq!(status, Status::Panicked(expected), "in {method}");
        assert_solves_hs071(&Options::default());
    }
}

#[test]
fn a_panic_half_way_runs_no_more_of_the_callers_code_during_the_solve() {
    let mut nlp = Hs071 { panic_in: Some("gradient"), panic_from_call: 4, ..Hs071::new() };
    let solution = solve(&mut nlp, &Options::default()).unwrap();
    assert!(matches!(&solution.status, Status::Panicked(message) if message.contains("gradient")));
    assert!(!solution.status.is_success());
    // Four by Ipopt, the last of them before the panic, and one to know the objective where it ended.
    assert_eq!(nlp.objective_calls, 5);
    let expected = Hs071::new().objective(&solution.x).unwrap();
    assert_eq!(solution.objective, expected);
}

#[test]
fn a_step_to_where_the_objective_has_no_value_is_shortened() {
    let mut nlp = Logarithm::from(10.0);
    let solution = solve(&mut nlp, &Options::default()).unwrap();
    assert_eq!(solution.status, Status::Solved);
    assert_close(&solution.x, &[1.0], 1e-7);
    assert!(nlp.refusals > 0);
}

#[test]
fn a_step_to_where_the_constraints_have_no_value_is_shortened() {
    let mut nlp = Logarithm { constrained: true, ..Logarithm::from(10.0) };
    let solution = solve(&mut nlp, &Options::default()).unwrap();
    assert_eq!(solution.status, Status::Solved);
    assert_close(&solution.x, &[1.0], 1e-7);
    assert!(nlp.refusals > 0);
}

#[test]
fn a_start_without_a_value_leaves_no_solution() {
    let outcome = solve(&mut Logarithm::from(-1.0), &Options::default());
    assert!(matches!(outcome, Err(IpoptError::NoIterate { status: Status::InvalidNumber, iterations: 0, .. })));
}

#[test]
fn a_refused_derivative_ends_the_solve_at_a_point_whose_objective_is_known() {
    let mut nlp = Logarithm { refuse_gradient_after: 2, ..Logarithm::from(10.0) };
    let solution = solve(&mut nlp, &Options::default()).unwrap();
    assert_eq!(solution.status, Status::InvalidNumber);
    assert_eq!(solution.objective, solution.x[0] - solution.x[0].ln());
}

#[test]
fn the_iteration_callback_reports_progress_and_can_stop_the_solve() {
    let mut nlp = Hs071 { stop_at: 3, ..Hs071::new() };
    let solution = solve(&mut nlp, &Options::default()).unwrap();
    assert_eq!(solution.status, Status::Stopped);
    assert_eq!(solution.iterations, 3);
    let iterations: Vec<usize> = nlp.reports.iter().map(|report| report.iteration).collect();
    assert_eq!(iterations, [0, 1, 2, 3]);
    assert_eq!(solution.objective, Hs071::new().objective(&solution.x).unwrap());
    assert_close(&[nlp.reports[3].objective], &[solution.objective], 1e-12);
}

#[test]
fn the_iteration_limit_is_a_result_that_says_what_to_do() {
    let options = Options { max_iterations: 2, ..Options::default() };
    let solution = solve(&mut Hs071::new(), &options).unwrap();
    assert_eq!(solution.status, Status::MaxIterations { iterations: 2 });
    assert_eq!(solution.objective, Hs071::new().objective(&solution.x).unwrap());
    let text = solution.status.to_string();
    assert!(text.contains("2 iterations") && text.contains("raise max_iterations"), "{text}");
}

#[test]
fn the_same_problem_gives_the_same_bits_twice() {
    let first = solve(&mut Hs071::new(), &Options::default()).unwrap();
    assert_eq!(first, solve(&mut Hs071::new(), &Options::default()).unwrap());
}

#[test]
fn solves_on_several_threads_all_succeed() {
    std::thread::scope(|scope| {
        let solves: Vec<_> = (0..4)
            .map(|_| scope.spawn(|| (0..10).for_each(|_| drop(assert_solves_hs071(&Options::default())))))
            .collect();
        for solve in solves {
            solve.join().unwrap();
        }
    });
}

#[test]
fn a_worker_that_waits_for_its_turn_evaluates_for_the_solve_that_has_it() {
    let some = || {
        for _ in 0..5 {
            let status = solve(&mut Hs071 { parallel: true, ..Hs071::new() }, &Options::default()).map(|s| s.status);
            assert_eq!(status, Ok(Status::Solved));
        }
    };
    std::thread::scope(|scope| {
        let outside: Vec<_> = (0..2).map(|_| scope.spawn(some)).collect();
        rayon::broadcast(|_| some());
        for thread in outside {
            thread.join().unwrap();
        }
    });
}

#[test]
fn a_solve_inside_a_callback_is_refused_instead_of_waiting_for_itself() {
    let mut nesting = Hs071 { nest: true, ..Hs071::new() };
    assert_eq!(solve(&mut nesting, &Options::default()).unwrap().status, Status::Solved);
    assert_eq!(nesting.nested, Some(IpoptError::Nested));
    assert_solves_hs071(&Options::default());
}

/// Runs this test a second time, as a process of its own in a directory with a hostile `ipopt.opt`: the working directory
/// belongs to the whole process, so that this one's must not be changed.
#[test]
fn an_options_file_in_the_working_directory_is_ignored_and_nothing_is_printed() {
    const CHILD: &str = "TRIMTAB_TEST_IPOPT_OPTIONS_FILE";
    if std::env::var_os(CHILD).is_some() {
        assert_solves_hs071(&Options::default());
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("ipopt.opt"), "max_iter 1\nprint_level 5\n").unwrap();
    let name = "ipopt::tests::an_options_file_in_the_working_directory_is_ignored_and_nothing_is_printed";
    let output = std::process::Command::new(std::env::current_exe().unwrap())
        .args([name, "--exact", "--nocapture"])
        .env(CHILD, "1")
        .current_dir(directory.path())
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{printed}{}", String::from_utf8_lossy(&output.stderr));
    assert!(printed.contains("1 passed"), "{printed}");
    assert!(!printed.contains("Ipopt") && !printed.contains("inf_pr"), "{printed}");
}

#[test]
fn problems_that_make_no_sense_are_refused_by_name() {
    let solve = |nlp: &mut Distance| solve(nlp, &Options::default()).unwrap_err();

    let mut empty = Distance { target: vec![], start: vec![], rows: vec![], range: vec![], bounds: (0.0, 1.0) };
    assert_eq!(solve(&mut empty), IpoptError::NoVariables);

    let mut crossed = Distance { bounds: (1.0, 0.0), ..distance() };
    assert_eq!(solve(&mut crossed), IpoptError::Bounds { what: "variable", index: 0, lower: 1.0, upper: 0.0 });

    let mut crossed = Distance { range: vec![(0.0, 1.0), (3.0, 2.0)], ..distance() };
    assert_eq!(solve(&mut crossed), IpoptError::Bounds { what: "constraint", index: 1, lower: 3.0, upper: 2.0 });

    for bounds in [(f64::NAN, 0.0), (0.0, f64::NAN), (INF, INF), (-INF, -INF)] {
        let error = solve(&mut Distance { bounds, ..distance() });
        assert!(matches!(error, IpoptError::Bounds { what: "variable", index: 0, .. }), "{error}");
    }

    let mut lost = Distance { start: vec![0.0, INF], ..distance() };
    assert_eq!(solve(&mut lost), IpoptError::Start { index: 1, value: INF });
}

#[test]
fn extra_options_reach_ipopt_and_wrong_ones_are_refused_by_name() {
    let with = |name: &str, value: OptionValue| Options { extra: vec![(name.into(), value)], ..Options::default() };
    let limited = solve(&mut Hs071::new(), &with("max_iter", OptionValue::Integer(1))).unwrap();
    assert_eq!(limited.status, Status::MaxIterations { iterations: 1 });
    assert_solves_hs071(&with("mu_strategy", OptionValue::Text("adaptive".into())));
    assert_solves_hs071(&with("bound_push", OptionValue::Number(1e-3)));

    for (name, value) in [
        ("no_such_option", OptionValue::Integer(1)),
        ("mu_strategy", OptionValue::Text("hopeful".into())),
        ("tol", OptionValue::Number(-1.0)),
        ("mu_strategy\0", OptionValue::Text("adaptive".into())),
    ] {
        let refused = solve(&mut Hs071::new(), &with(name, value.clone()));
        assert_eq!(refused, Err(IpoptError::Option { name: name.into(), value }));
    }
}

#[test]
fn more_equalities_than_variables_end_without_success() {
    let mut overdetermined = distance();
    overdetermined.rows = vec![vec![1.0, 0.0], vec![0.0, 1.0], vec![1.0, 1.0]];
    overdetermined.range = vec![(1.0, 1.0), (1.0, 1.0), (2.0, 2.0)];
    let outcome = solve(&mut overdetermined, &Options::default());
    let none =
        IpoptError::NoIterate { status: Status::NotEnoughDegreesOfFreedom, iterations: 0, counts: Counts::default() };
    assert_eq!(outcome, Err(none));
}
