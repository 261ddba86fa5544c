//! The motion that an audit reads, and regressions on it: lags, gains, angles, responses of one run against all others.
//! No doubt is raised here.

pub(super) mod clocks;
pub(super) mod course;
pub(super) mod kinematics;
pub(super) mod plateau;
pub(super) mod pooled;
pub(super) mod response;
pub(super) mod series;
pub(super) mod sources;
pub(super) mod sums;
