//! How a concealed case is sailed and recorded: design of the runs, helm, truth simulator, noise.
//! What is concealed, and how strong, is decided elsewhere.

pub mod craft;
pub mod design;
pub mod helm;
pub mod noise;
pub mod recorded;
pub mod sail;
pub mod track;
pub mod tweak;
