//! The reason why a compliance cannot be used.

use std::fmt;

/// The reason why a compliance cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ComplianceError(pub String);

impl fmt::Display for ComplianceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ComplianceError {}

pub(super) fn refuse<T>(reason: String) -> Result<T, ComplianceError> {
    Err(ComplianceError(reason))
}
