//! Why a link could not be opened.

/// A link could not be opened.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{link}: {reason}")]
pub struct OpenError {
    /// The link as a bench file writes it.
    pub link: String,
    /// Why, and what to do, in words.
    pub reason: String,
}

impl OpenError {
    /// `link` could not be opened for `reason`.
    pub fn new(link: &str, reason: impl ToString) -> OpenError {
        OpenError {
            link: link.to_owned(),
            reason: reason.to_string(),
        }
    }
}
