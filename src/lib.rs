//! Automatic differentiation for ship dynamics: fit an interpretable manoeuvring model to recordings of a ship, and find
//! the physics it lacks.
//!
//! The whole job on the example study that is built in, forty recordings of a container ship of 85 m made by a simulator
//! that knows more physics than the model has:
//!
#![cfg_attr(feature = "ipopt", doc = "```")]
#![cfg_attr(not(feature = "ipopt"), doc = "```ignore")]
//! use trimtab::{EvaluationSettings, FitSettings, Judging, Settings, diagnose, fit, prove};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     // A model with eleven free parameters, 32 recordings to fit it to, and 8 that are kept aside.
//!     let study = trimtab::study::demo::example()?;
//!
//!     // Least squares through the simulation, with exact gradients.
//!     let settings = FitSettings::default();
//!     let fitted = fit(&study.model, &study.train, &settings, &mut |_| true)?;
//!     println!("{}", fitted.brief());
//!     assert!(fitted.converged);
//!
//!     // How well does it predict recordings it has not seen, beside the published parameters?
//!     let judging = Judging::new(&settings, EvaluationSettings::default());
//!     let judged = prove(&study.baseline, &fitted.model, &study.test, &judging);
//!     let summary = judged.summary("test").ok_or("no test run")?;
//!     println!("better on {} of {} runs", summary.runs_better, summary.runs);
//!     assert!(summary.runs_better > summary.runs_worse);
//!
//!     // Which physics does it lack?
//!     let settings = Settings { judging, ..Settings::default() };
//!     let diagnosis = diagnose(&fitted.model, &study.train, &study.test, &settings, &|step| println!("{step}"))?;
//!     println!("{}", diagnosis.headline);
//!     assert!(!diagnosis.ranking.is_empty());
//!     Ok(())
//! }
//! ```
//!
//! # Where to go on
//!
//! | to | see |
//! |---|---|
//! | learn it: tutorial, every key of every file, theory, glossary | [`guide`] |
//! | fit recordings of your own | [`recording`], [`study`], `examples/fit_csv.rs` |
//! | write a physical effect of your own | [`physics`], [`terms`], `examples/own_term.rs` |
//! | choose how derivatives are taken | [`fit::Derivatives`], `examples/gradients.rs` |
//! | simulate | [`simulate`](mod@simulate), [`evaluate::maneuver`] |
//! | know where a term's law is valid | [`recording::validity`] |
//! | use numbers that carry derivatives elsewhere | the crate [`trimtab_ad`], which knows no ship |
//!
//! Units are SI and radians; x is north, y east, psi clockwise from north, v, r and delta positive to starboard.
//! Divergence and failed convergence are results, not panics; errors say what, where and what to do next.
//!
//! # Cargo features
//!
//! | feature | gives | without it |
//! |---|---|---|
//! | `ipopt` | `fit`, and the refit of a diagnosis' result | no C++ dependency; a diagnosis keeps its own estimate by Fisher scoring |
//! | `plot` | `plot`, figures and the HTML page of a diagnosis | tables, summaries in words and JSON remain |
//! | `parquet` | logs in Parquet files; off by default | CSV and NMEA 0183, and a message with the line that adds it |
//! | `cli` | the command `trimtab`; needs `ipopt` and `plot` | the library alone |
//!
//! All but `parquet` are on by default; `default-features = false` leaves simulation, trials, sensitivities, audit, evaluation and
//! diagnosis.
//!
//! # What to set in your own project
//!
//! * `fit` calls Ipopt through the crate `ipopt-sys`. On Debian and its relatives install `coinor-libipopt-dev cmake libclang-dev
//!   g++ pkg-config`, and set `IPOPT_NO_PKG_CONFIG=1` while building: Debian's pkg-config file asks for a static libm, which
//!   does not link. In a project this is three lines of `.cargo/config.toml`, which cargo does not take from a dependency:
//!
//!   ```toml
//!   [env]
//!   IPOPT_NO_PKG_CONFIG = "1"
//!   ```
//! * Simulations run on SIMD lanes, several at a time. On x86-64 they are fast only where the compiler may use AVX2 (every
//!   machine since about 2015): `rustflags = ["-C", "target-cpu=x86-64-v3"]` under `[build]`. Without, results are the same and
//!   a fit takes several times as long.

pub mod diagnose;
pub mod evaluate;
pub mod files;
pub mod fit;
pub mod guide;
pub(crate) mod ipopt;
pub mod likelihood;
pub mod model;
pub mod numbers;
pub mod physics;
pub mod recording;
pub mod report;
pub mod ship;
pub mod simulate;
pub mod study;
pub mod terms;

// Short names of the crate's vocabulary, within the crate.
pub(crate) use files::ranks;
pub(crate) use model::dynamics;
pub(crate) use numbers::{numerals, ranges, statistics, uncertainty};
pub(crate) use recording::validity;
pub(crate) use ship::{parameter, state, units};
pub(crate) use simulate::sensitivity;

pub use diagnose::{Diagnosis, Settings, Verdict, diagnose};
pub use evaluate::{Evaluation, EvaluationSettings, Judging, prove};
pub use fit::FitSettings;
#[cfg(feature = "ipopt")]
pub use fit::{Fit, fit};
pub use model::Model;
pub use physics::Form;
pub use recording::{Channel, ColumnMap, Labels, Recording, Run, Split, WindowSettings};
pub use ship::Ship;
pub use simulate::{Integration, Method, Scenario, Trajectory, simulate};
pub use state::{Force, Inputs, State};
pub use study::Study;
