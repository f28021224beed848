//! `fieldproof schema`

use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::options::SchemaKind;
use crate::screen::Screen;

/// Prints the JSON Schema of a kind of file.
pub(crate) fn schema(kind: SchemaKind, screen: &mut Screen) -> Result<Exit, Complaint> {
    let schema = match kind {
        SchemaKind::Suite => fieldproof_suite::schema(),
        SchemaKind::Device => fieldproof_suite::device_schema(),
        SchemaKind::Registers => fieldproof_suite::registers_schema(),
        SchemaKind::Bench => fieldproof_suite::bench_schema(),
        SchemaKind::Catalogue => fieldproof_suite::catalogue_schema(),
        SchemaKind::Waivers => fieldproof_suite::waivers_schema(),
        SchemaKind::Comparison => fieldproof_report::compare::comparison_schema(),
        SchemaKind::Report => fieldproof_report::report_schema(),
        SchemaKind::Journal => fieldproof_record::journal_schema(),
    };
    screen.print_json(&schema);
    Ok(Exit::Passed)
}
