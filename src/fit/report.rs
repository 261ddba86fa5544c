//! A fit in words and tables, for people: what was estimated, how surely, what held it back and what it cost.
//! The same content for programs is the fit itself, serialised.

use super::{CovarianceKind, Derivatives, Estimate, Fit, Hessian};
use crate::report::{Table, interval, sig};
use std::fmt::Write;

/// Significant digits of every number.
const DIGITS: usize = 5;

fn number(x: f64) -> String {
    sig(x, DIGITS)
}

impl Estimate {
    fn error_in_words(&self) -> String {
        match self.standard_error {
            None => "not determined".into(),
            Some(0.0) => "held".into(),
            Some(e) => number(e),
        }
    }

    fn interval_in_words(&self) -> String {
        match (self.at_bound, self.standard_error, self.interval) {
            (Some(side), _, _) => format!("at its {side} bound"),
            (None, Some(0.0), _) => "held by constraints".into(),
            (None, _, Some([lower, upper])) => interval(lower, upper, DIGITS),
            (None, _, None) => "the data do not say".into(),
        }
    }
}

impl Fit {
    /// One line: `converged in 14 iterations (0.05 s): cost 312.41 -> 8.3120, 11 parameters, 165 runs, 2 active constraints`.
    pub fn brief(&self) -> String {
        format!(
            "{} in {} iterations ({:.2} s): cost {} -> {}, {} parameters, {} runs, {} active constraints",
            if self.converged { "converged" } else { "did not converge" },
            self.iterations,
            self.seconds,
            number(self.start_cost),
            number(self.cost),
            self.estimates.len(),
            self.runs,
            self.active.len(),
        )
    }

    /// The whole report.
    pub fn report(&self) -> String {
        let mut text = String::new();
        let mut line = |words: String| {
            let _ = writeln!(text, "{words}");
        };
        line(format!("Fit of {} to {} runs of {} recordings", self.model.name, self.runs, self.recordings));
        line(format!("Status       {}", self.status));
        let mut cost = format!("{} -> {}", number(self.start_cost), number(self.cost));
        if self.prior_cost > 0.0 {
            cost += &format!(", priors add {}", number(self.prior_cost));
        }
        line(format!("Cost         {cost} (residual variance {})", number(self.residual_variance)));
        line(format!(
            "Size         {} residuals, {} parameters, {} constraint rows",
            self.residuals,
            self.estimates.len(),
            self.constraints
        ));
        let derivatives = match self.settings.derivatives {
            Derivatives::Lanes => "exact, dual numbers over SIMD lanes",
            Derivatives::Dual => "exact, dual numbers",
            Derivatives::NumDual => "exact, num-dual",
            Derivatives::FiniteDifferences => "central differences",
        };
        let hessian = match self.settings.hessian {
            Hessian::GaussNewton => "Gauss-Newton",
            Hessian::Exact => "exact second order",
            Hessian::LimitedMemory => "limited memory",
        };
        line(format!("Derivatives  {derivatives}; Hessian {hessian}"));
        let c = &self.counts;
        line(format!(
            "Work         {} iterations, {} cost, {} gradient and {} Hessian evaluations, {:.2} s",
            self.iterations, c.objective, c.gradient, c.hessian, self.seconds
        ));
        line(String::new());

        let mut table = Table::new(["parameter", "symbol", "unit", "start", "estimate", "std. error", "95 % interval"]);
        for e in &self.estimates {
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
        line(table.to_string());
        line(match (self.covariance_kind, self.design_effect) {
            (CovarianceKind::Sandwich, Some(effect)) => format!(
                "Standard errors take the {} recordings as independent, not their samples: variances are {} times those of \
                 independent residuals.",
                self.recordings,
                number(effect)
            ),
            _ => format!(
                "Standard errors take residuals as independent, which along a trajectory they are not: read them as lower \
                 limits ({} recordings are too few to do better).",
                self.recordings
            ),
        });

        line(String::new());
        if self.active.is_empty() {
            line("No constraint holds the fit back.".into());
        } else {
            line("Constraints that hold the fit back:".into());
            for active in &self.active {
                line(format!("  {}   ({})", active.sentence, active.rule));
            }
        }
        line(String::new());
        if self.undetermined.is_empty() {
            line("The data determine every combination of the parameters to better than one scale unit.".into());
        } else {
            line("What the data do not determine (parameters in units of their scale):".into());
            for combination in &self.undetermined {
                line(match combination.standard_deviation {
                    Some(deviation) => format!("  {}   (std. deviation {})", combination.words, number(deviation)),
                    None => format!("  {}   (not at all)", combination.words),
                });
            }
        }
        let strong = self.strong_correlations();
        if !strong.is_empty() {
            line(String::new());
            line(format!("Correlations beyond 0.9: {}", strong.join(", ")));
        }
        line(String::new());
        line(self.validity.line());
        text
    }

    fn strong_correlations(&self) -> Vec<String> {
        let mut strong = Vec::new();
        for i in 0..self.estimates.len() {
            for j in 0..i {
                if let Some(r) = self.correlations[i][j].filter(|r| r.abs() > 0.9) {
                    strong.push(format!("{}-{} {r:.2}", self.estimates[j].symbol, self.estimates[i].symbol));
                }
            }
        }
        strong
    }
}
