//! A record made into what people and their tools read: the console's lines, JUnit, a summary as data.
//!
//! Everything here is made from [`fieldproof_record::Event`]s, as they come or out of a saved journal; no bench is
//! needed. [`Problem`] is the one form in which a mistake in a file, a finding in a dictionary and a failed
//! expectation are shown.

mod case_text;
mod console;
mod difference;
mod ink;
pub mod junit;
mod problem;
mod render;
mod summary;

pub use case_text::case_text;
pub use console::{Console, ConsoleOptions};
pub use ink::Ink;
pub use problem::{Also, Elsewhere, Problem, Severity, SourceText, Span};
pub use render::render;
pub use summary::{LaneSummary, ListedCase, SuiteSummary, summary_text};
