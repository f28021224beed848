//! A record made into what people and their tools read: the console's lines, JUnit, a summary as data.
//!
//! Everything here is made from [`fieldproof_record::Event`]s, as they come or out of a saved journal; no bench is
//! needed. [`Problem`] is the one form in which a mistake in a file, a finding in a dictionary and a failed
//! expectation are shown.

mod capture;
mod case_text;
pub mod compare;
mod console;
mod difference;
mod html;
mod ink;
mod json;
pub mod junit;
mod problem;
mod render;
mod summary;
mod tap;

pub use capture::{Candump, Pcapng};
pub use case_text::case_text;
pub use console::{Console, ConsoleOptions};
pub use html::Html;
pub use ink::Ink;
pub use json::{CaseReport, JSON_FORMAT, Json, LaneEnd, LaneReport, RunReport, report_schema};
pub use problem::{Also, Elsewhere, Problem, Severity, SourceText, Span};
pub use render::render;
pub use summary::{LaneSummary, ListedCase, SuiteSummary, left_text, summary_text};
pub use tap::Tap;
