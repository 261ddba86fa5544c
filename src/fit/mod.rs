//! Fitting a model's parameters to recordings: from the cost and its constraints to estimates with their uncertainty.
//! It does not say which physics a model contains or how a ship is simulated; it takes both as given.

pub mod ipopt;
