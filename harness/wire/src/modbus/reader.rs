//! Reading bytes from the front.

use crate::violation::plural;
use crate::{Rule, Violation};

/// Bytes and how many of them have been read.
pub(super) struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Reader<'a> {
        Reader { bytes, at: 0 }
    }

    /// Where the next byte is.
    pub(super) fn offset(&self) -> usize {
        self.at
    }

    /// How many bytes are left.
    pub(super) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], Violation> {
        let Some(taken) = self.bytes.get(self.at..self.at + count) else {
            return Err(Violation::new(
                Rule::Length,
                self.bytes.len(),
                plural(self.bytes.len(), "byte"),
                format!("at least {}", plural(self.at + count, "byte")),
            ));
        };
        self.at += count;
        Ok(taken)
    }

    pub(super) fn rest(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        self.at = self.bytes.len();
        rest
    }

    pub(super) fn u8(&mut self) -> Result<u8, Violation> {
        let taken = self.take(1)?;
        Ok(taken[0])
    }

    pub(super) fn u16(&mut self) -> Result<u16, Violation> {
        let taken = self.take(2)?;
        Ok(u16::from_be_bytes([taken[0], taken[1]]))
    }

    /// Nothing may be left.
    pub(super) fn end(&self) -> Result<(), Violation> {
        match self.left() {
            0 => Ok(()),
            _ => Err(Violation::length(self.bytes.len(), self.at)),
        }
    }
}
