//! 07h, 08h, 0Bh, 0Ch, 11h: what a slave tells of itself and of the line.

use super::{Service, counted};
use crate::modbus::{Departure, Exception, Registers};

const RETURN_QUERY_DATA: u16 = 0x00;
const RESTART: u16 = 0x01;
const DIAGNOSTIC_REGISTER: u16 = 0x02;
const FORCE_LISTEN_ONLY: u16 = 0x04;
const CLEAR: u16 = 0x0A;
const BUS_MESSAGES: u16 = 0x0B;
const COMMUNICATION_ERRORS: u16 = 0x0C;
const EXCEPTIONS: u16 = 0x0D;
const SERVER_MESSAGES: u16 = 0x0E;
const UNANSWERED: u16 = 0x0F;
const NAKS: u16 = 0x10;
const BUSY: u16 = 0x11;
const OVERRUNS: u16 = 0x12;
const CLEAR_OVERRUNS: u16 = 0x14;

const KEEP_LOG: [u8; 2] = [0x00, 0x00];
const CLEAR_LOG: [u8; 2] = [0xFF, 0x00];
/// No program command is running: the slave has none.
const READY: [u8; 2] = [0x00, 0x00];
const RUNNING: u8 = 0xFF;
const STOPPED: u8 = 0x00;

impl<R: Registers> Service<'_, R> {
    /// Nothing; answered by eight bits.
    pub(super) fn exception_status(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        nothing(data)?;
        let status = self.registers.exception_status();
        match self.behaviour.departs(Departure::ExceptionStatusLong) {
            true => Ok(vec![0, status]),
            false => Ok(vec![status]),
        }
    }

    /// Sub-function and data; answered by the same, or by the sub-function and a counter.
    pub(super) fn diagnostics(&mut self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let Some((&sub_function, argument)) = data.split_first_chunk::<2>() else {
            return Err(Exception::IllegalDataValue);
        };
        let counter = match u16::from_be_bytes(sub_function) {
            RETURN_QUERY_DATA => return self.return_query_data(data),
            RESTART => return self.restart(data, argument),
            FORCE_LISTEN_ONLY => {
                zero(argument)?;
                self.counters.listen_only();
                return Ok(data.to_vec());
            }
            CLEAR => {
                zero(argument)?;
                if !self.behaviour.counters_not_cleared {
                    self.counters.clear();
                }
                return Ok(data.to_vec());
            }
            CLEAR_OVERRUNS => {
                zero(argument)?;
                return Ok(data.to_vec());
            }
            DIAGNOSTIC_REGISTER | NAKS | OVERRUNS => 0,
            BUS_MESSAGES => self.counters.bus_messages,
            COMMUNICATION_ERRORS => self.counters.communication_errors,
            EXCEPTIONS => self.counters.exceptions,
            SERVER_MESSAGES => self.counters.server_messages,
            UNANSWERED => self.counters.unanswered,
            BUSY => self.counters.busy,
            _ if self.behaviour.departs(Departure::UnknownSubFunctionEchoed) => {
                return Ok(data.to_vec());
            }
            _ => return Err(Exception::IllegalFunction),
        };
        zero(argument)?;
        let [_, low] = sub_function;
        let counter = match self.behaviour.departs(Departure::CounterStays(low)) {
            true => 0,
            false => counter,
        };
        Ok([sub_function, counter.to_be_bytes()].concat())
    }

    fn return_query_data(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        if data.len() < 4 {
            return Err(Exception::IllegalDataValue);
        }
        if data.len() > 4 && self.behaviour.departs(Departure::LongLoopbackRefused) {
            return Err(Exception::IllegalDataValue);
        }
        let length = match self.behaviour.loopback_cut {
            true => 4,
            false => data.len(),
        };
        Ok(data[..length].to_vec())
    }

    fn restart(&mut self, data: &[u8], argument: &[u8]) -> Result<Vec<u8>, Exception> {
        let with_log = match argument {
            argument if argument == KEEP_LOG => false,
            argument if argument == CLEAR_LOG => true,
            _ => return Err(Exception::IllegalDataValue),
        };
        self.counters.restart(with_log);
        Ok(data.to_vec())
    }

    /// Nothing; answered by a status and the event counter.
    pub(super) fn event_counter(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        nothing(data)?;
        Ok([READY, self.counters.events.to_be_bytes()].concat())
    }

    /// Nothing; answered by a byte count, the status, two counters and the log, the newest event first.
    pub(super) fn event_log(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        nothing(data)?;
        let counters = &self.counters;
        let heads = [
            READY,
            counters.events.to_be_bytes(),
            counters.bus_messages.to_be_bytes(),
        ];
        let mut bytes = heads.concat();
        if !self.behaviour.departs(Departure::LogEmpty) {
            bytes.extend(counters.log());
        }
        Ok(counted(bytes))
    }

    /// Nothing; answered by a byte count, the server ID, whether it runs, and what it adds.
    pub(super) fn server_id(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        nothing(data)?;
        let (mut bytes, more) = self.registers.server_id();
        bytes.push(match self.behaviour.run_indicator_off {
            true => STOPPED,
            false => RUNNING,
        });
        bytes.extend(more);
        Ok(counted(bytes))
    }
}

fn nothing(data: &[u8]) -> Result<(), Exception> {
    match data.is_empty() {
        true => Ok(()),
        false => Err(Exception::IllegalDataValue),
    }
}

fn zero(argument: &[u8]) -> Result<(), Exception> {
    match argument {
        [0, 0] => Ok(()),
        _ => Err(Exception::IllegalDataValue),
    }
}
