//! A fit in words and tables, for people: what was estimated, with which errors, which constraints are active and what it cost.
//! The same content for programs is the fit itself, serialised.

use super::active::lines;
use super::table::Table;
use crate::fit::{CovarianceKind, Derivatives, Estimate, Fit, Hessian, SeenInput, StartOutcome, labels};
use crate::numerals::{interval, sig};

/// Significant digits of every number.
const DIGITS: usize = 5;

fn number(x: f64) -> String {
    sig(x, DIGITS)
}

impl Estimate {
    fn error_in_words(&self) -> String {
        match self.standard_error {
            None => "not determined".into(),
            Some(0.0) => "fixed".into(),
            Some(e) => number(e),
        }
    }

    fn interval_in_words(&self) -> String {
        match (self.at_bound, self.standard_error, self.interval) {
            (Some(side), Some(e), Some([lower, upper])) if e > 0.0 => {
                format!("{} at its {side} bound", interval(lower, upper, DIGITS))
            }
            (Some(side), _, _) => format!("at its {side} bound"),
            (None, Some(0.0), _) => "fixed by constraints".into(),
            (None, _, Some([lower, upper])) => interval(lower, upper, DIGITS),
            (None, _, None) => "not determined".into(),
        }
    }
}

impl Fit {
    /// One line: `converged in 14 iterations (0.05 s): cost 312.41 -> 8.3120, 11 parameters, 165 runs, 2 active constraints`; the
    /// log-posterior of a fit by likelihood instead of the cost.
    pub fn brief(&self) -> String {
        let (what, from, to) = match &self.likelihood {
            Some(likelihood) => ("log-posterior", likelihood.start_log_posterior, likelihood.log_posterior),
            None => ("cost", self.start_cost, self.cost),
        };
        format!(
            "{} in {} iterations ({:.2} s): {what} {} -> {}, {} parameters, {} runs, {} active constraints",
            if self.converged { "converged" } else { "did not converge" },
            self.iterations,
            self.seconds,
            number(from),
            number(to),
            self.estimates.len(),
            self.runs,
            self.active.len(),
        )
    }

    /// The whole report.
    pub fn report(&self) -> String {
        let validity = self.validity.line();
        let sections = [self.course(), self.table(), self.active_constraints(), self.what_is_open(), validity];
        sections.join("\n\n") + "\n"
    }

    /// What was fitted, how it ended, and what it cost.
    fn course(&self) -> String {
        let mut cost = format!("{} -> {}", number(self.start_cost), number(self.cost));
        if self.prior_cost > 0.0 {
            cost += &format!(", priors add {}", number(self.prior_cost));
        }
        let derivatives = match self.settings.derivatives {
            Derivatives::Lanes => "exact, dual numbers over SIMD lanes",
            Derivatives::Dual => "exact, dual numbers",
            Derivatives::NumDual => "exact, num-dual",
            Derivatives::FiniteDifferences => "central differences",
            Derivatives::ForwardDifferences => "forward differences",
        };
        let hessian = match self.settings.hessian {
            Hessian::GaussNewton => "Gauss-Newton",
            Hessian::Exact => "exact second order",
            Hessian::LimitedMemory => "limited memory",
        };
        let (c, variance) = (&self.counts, number(self.residual_variance));
        let (residuals, parameters, rows) = (self.residuals, self.estimates.len(), self.constraints);
        let passes = self.iterations;
        let (checks, lower) = (self.checks[0], self.checks[1]);
        let check = match (checks, lower) {
            (0, _) => "none was made".to_owned(),
            (_, 0) => "a second solve from a disturbed point found no lower cost".to_owned(),
            _ => format!(
                "{lower} of {checks} second solves from a disturbed point found a lower cost, and the fit went on from there"
            ),
        };
        [
            self.headline.clone(),
            format!("Fit of {} to {} runs of {} recordings", self.model.name, self.runs, self.recordings),
            format!("Status       {} (Ipopt: {})", self.status, self.solver_status),
            format!("Check        {check}"),
            format!("Cost         {cost} (residual variance {variance})"),
            self.likelihood_lines(),
            format!("Size         {residuals} residuals, {parameters} parameters, {rows} constraint rows"),
            format!("Derivatives  {derivatives}; Hessian {hessian}"),
            format!(
                "Work         {passes} iterations, {} cost, {} gradient and {} Hessian evaluations",
                c.objective, c.gradient, c.hessian
            ),
        ]
        .into_iter()
        .filter(|line| !line.is_empty())
        .collect::<Vec<String>>()
        .join("\n")
    }

    /// What a fit by likelihood says beside the cost: how far the log-posterior rose, and the noise.
    fn likelihood_lines(&self) -> String {
        let Some(l) = &self.likelihood else { return String::new() };
        let size = |g: usize| number(l.noise.sensors[g].white.hypot(l.noise.sensors[g].coloured));
        let [x, y, n] = l.noise.force.map(number);
        format!(
            "Likelihood   log-posterior {} -> {} in {} rounds of noise and parameters\n\
             Noise        position {} m, heading {} rad, speed {} m/s, yaw rate {} rad/s\n\
             Force        unknown, standard deviation {x} N, {y} N, {n} N m over {} s",
            number(l.start_log_posterior),
            number(l.log_posterior),
            l.rounds,
            size(0),
            size(1),
            size(2),
            size(3),
            number(l.noise.force_time),
        )
    }

    /// The estimates, and how their errors are to be read.
    fn table(&self) -> String {
        let mut table = Table::new(["parameter", "symbol", "unit", "start", "estimate", "std. error", "95 % interval"]);
        for e in &self.reported() {
            table.row([
                e.name.clone(),
                e.symbol.to_string(),
                e.unit.to_string(),
                number(e.start),
                number(e.value),
                e.error_in_words(),
                e.interval_in_words(),
            ]);
        }
        let errors = match (self.covariance_kind, self.design_effect) {
            (CovarianceKind::Sandwich, Some(effect)) => format!(
                "Standard errors take the {} recordings as independent, not their samples: variances are {} times those of \
                 independent residuals.",
                self.recordings,
                number(effect)
            ),
            (CovarianceKind::Correlated, _) => format!(
                "Standard errors count as many successive residuals as one as are alike: {} ({} recordings are too few to take \
                 whole recordings as independent).",
                number(self.residual_statistics.likeness.unwrap_or(1.0)),
                self.recordings
            ),
            _ => format!(
                "Standard errors take residuals as independent, which along a trajectory they are not: read them as lower \
                 limits ({} recordings are too few to do better).",
                self.recordings
            ),
        };
        format!("{table}\n{errors}")
    }

    /// The constraints that are active at the estimate.
    fn active_constraints(&self) -> String {
        if self.active.is_empty() {
            return "No constraint is active at the estimate.".to_owned();
        }
        let rows = lines(&self.active).into_iter().map(|line| format!("\n  {line}"));
        format!("Constraints active at the estimate:{}", rows.collect::<String>())
    }

    /// What the data do not determine, and strong correlations.
    fn what_is_open(&self) -> String {
        let mut text = if self.undetermined.is_empty() {
            "The data determine every combination of the parameters to better than one scale unit.".to_owned()
        } else {
            "Combinations that the data do not determine (parameters in units of their scale):".to_owned()
        };
        for combination in &self.undetermined {
            let how = combination
                .standard_deviation
                .map_or("not at all".to_owned(), |deviation| format!("std. deviation {}", number(deviation)));
            text += &format!("\n  {}   ({how})", combination.words);
        }
        let strong = self.strong_correlations();
        if !strong.is_empty() {
            text += &format!("\n\nCorrelations beyond 0.9: {}", strong.join(", "));
        }
        text += &format!("\n\n{}", SeenInput::sentences(&self.seen_inputs, self.recordings));
        text
    }

    fn strong_correlations(&self) -> Vec<String> {
        let names = labels(self.estimates.iter().map(|e| (e.symbol, e.name.as_str())));
        let mut strong = Vec::new();
        for i in 0..self.estimates.len() {
            for j in 0..i {
                if let Some(r) = self.correlations[i][j].filter(|r| r.abs() > 0.9) {
                    strong.push(format!("{}-{} {r:.2}", names[j], names[i]));
                }
            }
        }
        strong
    }
}

impl StartOutcome {
    /// One line: where it ended, or why it did not.
    pub fn brief(&self) -> String {
        self.outcome.as_ref().map_or_else(ToString::to_string, Fit::brief)
    }
}
