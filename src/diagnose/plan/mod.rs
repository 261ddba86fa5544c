//! What planned trials and sensors would show: which mechanisms are identifiable, from which size on, and which cannot be parted.
//! It needs no recordings and diagnoses nothing: the trials are simulated with the model, and read by the diagnosis' score tests.

mod error;
mod outlook;
mod part;
mod planned;
mod sail;
mod sensors;
mod settings;

pub use error::PlanError;
pub use outlook::{Isolability, Outlook, Pair, TOLERANCE};
pub use part::Parting;
pub use planned::{Plan, Question, plan};
pub use sail::Sailed;
pub use sensors::Level;
pub use settings::{Headings, Kind, PlanSettings, PlannedTrial, Sensor, SensorSettings};
