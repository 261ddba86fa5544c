//! How many past steps a Hessian that is learnt from gradients remembers.
//! The settings of a fit name it also where Ipopt is left out.

/// Number of past steps the limited-memory Hessian keeps unless set otherwise. Ipopt's own 6 suits thousands of variables;
/// with a few dozen, a longer memory costs nothing and saves most of the iterations.
pub const DEFAULT_HISTORY: usize = 50;
