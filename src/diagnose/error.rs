//! Why there is no diagnosis.
//! Recordings that cannot answer are a verdict and no error, see [`Verdict::Insufficient`](super::Verdict::Insufficient).

use crate::model::ModelError;
use crate::ranges::OutOfRange;

/// Why there is no diagnosis.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnoseError {
    /// A setting with a value that cannot be used.
    #[error("[diagnose] {0}")]
    Setting(#[from] OutOfRange),
    /// A term of the catalogue cannot be added to the model.
    #[error(transparent)]
    Model(#[from] ModelError),
}
