//! 14h, 15h, 18h: files of records, and queues.

use super::{Service, counted};
use crate::modbus::{Departure, Exception, Registers};

const REFERENCE_TYPE: u8 = 6;
const LAST_RECORD: u16 = 0x270F;
/// Of a request of 14h, and of the data of a 15h.
const READ_BYTES: std::ops::RangeInclusive<u8> = 0x07..=0xF5;
const WRITE_BYTES: std::ops::RangeInclusive<u8> = 0x09..=0xFB;
/// More cannot be told in one answer.
const LONGEST_QUEUE: usize = 31;
const LONGEST_READ: usize = 0xF5;

/// A row of records of one file.
struct Records {
    file: u16,
    first: u16,
    length: u16,
}

impl Records {
    /// Reference type, file, record, length.
    fn of(head: &[u8; 7]) -> Result<Records, Exception> {
        let &[kind, file_high, file_low, first_high, first_low, high, low] = head;
        let records = Records {
            file: u16::from_be_bytes([file_high, file_low]),
            first: u16::from_be_bytes([first_high, first_low]),
            length: u16::from_be_bytes([high, low]),
        };
        let last = u32::from(records.first) + u32::from(records.length.max(1)) - 1;
        let known = kind == REFERENCE_TYPE && records.file > 0 && last <= u32::from(LAST_RECORD);
        match known {
            true => Ok(records),
            false => Err(Exception::IllegalDataAddress),
        }
    }

    fn numbers(&self) -> impl Iterator<Item = u16> + use<> {
        let first = self.first;
        (0..self.length).map(move |offset| first.saturating_add(offset))
    }
}

impl<R: Registers> Service<'_, R> {
    /// A byte count and a row of records for every seven bytes; answered by each row.
    pub(super) fn read_files(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let Some((&byte_count, requests)) = data.split_first() else {
            return Err(Exception::IllegalDataValue);
        };
        let (heads, rest) = requests.as_chunks::<7>();
        let counts = usize::from(byte_count) == requests.len() && rest.is_empty();
        if !counts || !READ_BYTES.contains(&byte_count) {
            return Err(Exception::IllegalDataValue);
        }
        let mut answer = Vec::new();
        for head in heads {
            let records = Records::of(head)?;
            let mut row = vec![REFERENCE_TYPE];
            for number in records.numbers() {
                let word = self.registers.read_record(records.file, number)?;
                row.extend(word.to_be_bytes());
            }
            answer.extend(counted(row));
            if self.behaviour.departs(Departure::FirstRowOnly) {
                break;
            }
            if answer.len() > LONGEST_READ {
                return Err(Exception::IllegalDataValue);
            }
        }
        Ok(counted(answer))
    }

    /// A byte count and rows of records with their values; answered by the same. Writes all or none.
    pub(super) fn write_files(&mut self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let Some((&byte_count, mut rest)) = data.split_first() else {
            return Err(Exception::IllegalDataValue);
        };
        if usize::from(byte_count) != rest.len() || !WRITE_BYTES.contains(&byte_count) {
            return Err(Exception::IllegalDataValue);
        }
        let mut writes = Vec::new();
        while let Some((head, after)) = rest.split_first_chunk::<7>() {
            let length = usize::from(u16::from_be_bytes([head[5], head[6]]));
            let Some((values, after)) = after.split_at_checked(2 * length) else {
                return Err(Exception::IllegalDataValue);
            };
            let records = Records::of(head)?;
            let (pairs, _) = values.as_chunks::<2>();
            for (number, pair) in records.numbers().zip(pairs) {
                self.registers.read_record(records.file, number)?;
                writes.push((records.file, number, u16::from_be_bytes(*pair)));
            }
            rest = after;
        }
        if !rest.is_empty() {
            return Err(Exception::IllegalDataValue);
        }
        let most = match self.behaviour.departs(Departure::RecordsNotWritten) {
            true => 0,
            false => self.behaviour.most_written,
        };
        for (file, record, value) in writes.into_iter().take(most) {
            self.registers.write_record(file, record, value);
        }
        Ok(data.to_vec())
    }

    /// The pointer of a queue; answered by a byte count of two bytes, the number of values, and the values.
    pub(super) fn read_fifo(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let &[high, low] = data else {
            return Err(Exception::IllegalDataValue);
        };
        let queue = self.registers.fifo(u16::from_be_bytes([high, low]))?;
        if queue.len() > LONGEST_QUEUE {
            return Err(Exception::IllegalDataValue);
        }
        let count = u16::try_from(queue.len()).unwrap_or(0);
        let bytes = match self.behaviour.fifo_count_missing_in_bytes {
            true => 2 * count,
            false => 2 * count + 2,
        };
        let mut answer = [bytes.to_be_bytes(), count.to_be_bytes()].concat();
        answer.extend(queue.iter().flat_map(|value| value.to_be_bytes()));
        Ok(answer)
    }
}
