//! What day it is.

use std::env;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// The date and time of day, UTC, or what `SOURCE_DATE_EPOCH` says, so that a run can be repeated to the byte.
pub(crate) fn now() -> String {
    let fixed = env::var("SOURCE_DATE_EPOCH")
        .ok()
        .and_then(|seconds| seconds.parse().ok())
        .map(|seconds| UNIX_EPOCH + Duration::from_secs(seconds));
    let now = fixed.unwrap_or_else(SystemTime::now);
    humantime::format_rfc3339_millis(now).to_string()
}

/// The day alone: `2026-11-22`.
pub(crate) fn today() -> String {
    now().chars().take(10).collect()
}
