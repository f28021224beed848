//! What a slave serves.

use std::time::Duration;

use fieldproof_link::{SerialSettings, State};

use super::{Behaviour, Exception};

/// What a device makes of a request that is not one of the ordinary functions on its own address.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Command {
    /// It did what was asked, or not, and stays silent.
    Silent,
    /// It answers this: address, function and data, without CRC.
    Answer(Vec<u8>),
}

/// What a slave serves: the tables of one device, by their addresses on the wire (the first is 0), and what else its
/// functions reach. A device says what it has; the rest is refused.
pub trait Registers {
    /// The own address, 1 to 247.
    fn address(&self) -> u8;

    /// How the line is to be set.
    fn serial(&self) -> SerialSettings;

    /// The functions it has.
    fn functions(&self) -> &'static [u8] {
        &[0x03, 0x06, 0x10]
    }

    /// Why nothing that is asked with `function` can be done at the moment.
    fn unable(&self, function: u8) -> Option<Exception> {
        let _ = function;
        None
    }

    /// The content of a holding register.
    ///
    /// # Errors
    /// [`Exception::IllegalDataAddress`]: there is none, or it cannot be read.
    fn read(&self, register: u16, behaviour: &Behaviour) -> Result<u16, Exception>;

    /// Whether a holding register takes a value.
    ///
    /// # Errors
    /// [`Exception::IllegalDataAddress`]: there is none, or it cannot be written.
    /// [`Exception::IllegalDataValue`]: not this value.
    fn check_write(&self, register: u16, value: u16) -> Result<(), Exception>;

    /// Writes a value that [`Registers::check_write`] allowed.
    fn write(&mut self, register: u16, value: u16);

    /// The content of an input register.
    ///
    /// # Errors
    /// [`Exception::IllegalDataAddress`]: there is none.
    fn read_input(&self, register: u16) -> Result<u16, Exception> {
        let _ = register;
        Err(Exception::IllegalDataAddress)
    }

    /// Whether a coil is on.
    ///
    /// # Errors
    /// [`Exception::IllegalDataAddress`]: there is none.
    fn read_coil(&self, coil: u16) -> Result<bool, Exception> {
        let _ = coil;
        Err(Exception::IllegalDataAddress)
    }

    /// Switches a coil that can be read.
    fn write_coil(&mut self, coil: u16, on: bool) {
        let _ = (coil, on);
    }

    /// Whether a discrete input is on.
    ///
    /// # Errors
    /// [`Exception::IllegalDataAddress`]: there is none.
    fn read_discrete_input(&self, input: u16) -> Result<bool, Exception> {
        let _ = input;
        Err(Exception::IllegalDataAddress)
    }

    /// The eight outputs of function 07h.
    fn exception_status(&self) -> u8 {
        0
    }

    /// The server ID and what a device adds to it, without the run indicator.
    fn server_id(&self) -> (Vec<u8>, Vec<u8>) {
        (Vec::new(), Vec::new())
    }

    /// A record of a file.
    ///
    /// # Errors
    /// [`Exception::IllegalDataAddress`]: there is none.
    fn read_record(&self, file: u16, record: u16) -> Result<u16, Exception> {
        let _ = (file, record);
        Err(Exception::IllegalDataAddress)
    }

    /// Writes a record that can be read.
    fn write_record(&mut self, file: u16, record: u16, value: u16) {
        let _ = (file, record, value);
    }

    /// What waits in the FIFO with this pointer.
    ///
    /// # Errors
    /// [`Exception::IllegalDataAddress`]: there is none.
    fn fifo(&self, pointer: u16) -> Result<Vec<u16>, Exception> {
        let _ = pointer;
        Err(Exception::IllegalDataAddress)
    }

    /// The objects of the device identification, in order.
    fn identification(&self) -> &'static [(u8, &'static str)] {
        &[]
    }

    /// Takes a whole request (address, function, data; its CRC was right) before the address is looked at; `None` if it
    /// is an ordinary one.
    fn command(&mut self, request: &[u8], behaviour: &Behaviour) -> Option<Command> {
        let _ = (request, behaviour);
        None
    }

    /// From the end of the silence after a request to the answer, jitter apart.
    fn processing_delay(&self, behaviour: &Behaviour) -> Duration {
        behaviour.processing_delay
    }

    /// What a case could have left changed: names and values.
    fn state(&self) -> State;
}
