//! Nothing but tests and benches: Modbus stacks that others wrote, against our engine and our reference devices.
