//! The commands.

pub(crate) mod bus;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod devices;
pub(crate) mod eds;
pub(crate) mod export;
pub(crate) mod list;
pub(crate) mod new_device;
pub(crate) mod prove;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod scan;
pub(crate) mod schema;
pub(crate) mod serve;
pub(crate) mod stimulate;
