//! One short line for what travels, for people who read evidence.

mod canopen;
mod modbus;

pub use canopen::describe_frame;
pub use modbus::{Direction, describe_modbus, describe_modbus_tcp};

/// `D1 FF`
fn spaced(bytes: &[u8]) -> String {
    let bytes: Vec<String> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    bytes.join(" ")
}
