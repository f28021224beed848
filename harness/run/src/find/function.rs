//! Modbus functions that a device claims, and those that it does not.

use fieldproof_suite::Columns;
use fieldproof_suite::device::{FunctionCode, ModbusDescription};
use fieldproof_suite::model::Query;

/// The number of each, in decimal. Nothing where the description says nothing.
pub(super) fn functions(query: &Query, modbus: &ModbusDescription) -> Vec<Columns> {
    if modbus.functions.is_empty() {
        return Vec::new();
    }
    let is_claimed = |function: u8| {
        modbus.claims(FunctionCode {
            function,
            sub_function: None,
        })
    };
    (1..=127)
        .filter(|code| {
            query
                .claimed
                .is_none_or(|claimed| claimed == is_claimed(*code))
        })
        .map(|code| vec![("", code.to_string())])
        .collect()
}
