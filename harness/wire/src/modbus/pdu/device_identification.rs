//! Read device identification: function code 2Bh, MEI type 0Eh.

use std::ops::Deref;

use super::READ_DEVICE_IDENTIFICATION;
use crate::modbus::FunctionCode;
use crate::modbus::reader::Reader;
use crate::{Rule, Violation};

/// Which objects are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ReadDeviceId {
    /// 01h: the basic ones, as a stream.
    Basic,
    /// 02h: the regular ones, as a stream.
    Regular,
    /// 03h: the extended ones, as a stream.
    Extended,
    /// 04h: one.
    Specific,
}

impl ReadDeviceId {
    /// The code.
    pub const fn code(self) -> u8 {
        match self {
            ReadDeviceId::Basic => 1,
            ReadDeviceId::Regular => 2,
            ReadDeviceId::Extended => 3,
            ReadDeviceId::Specific => 4,
        }
    }

    /// What this code reads; `None` if it is none.
    pub const fn from_code(code: u8) -> Option<ReadDeviceId> {
        match code {
            1 => Some(ReadDeviceId::Basic),
            2 => Some(ReadDeviceId::Regular),
            3 => Some(ReadDeviceId::Extended),
            4 => Some(ReadDeviceId::Specific),
            _ => None,
        }
    }

    pub(super) fn parse(reader: &mut Reader<'_>) -> Result<ReadDeviceId, Violation> {
        let offset = reader.offset();
        let code = reader.u8()?;
        ReadDeviceId::from_code(code).ok_or_else(|| Violation::range(offset, u64::from(code), 1, 4))
    }
}

/// One object of a device's identification.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct DeviceObject {
    /// 00h vendor name, 01h product code, 02h revision, and so on.
    pub id: u8,
    /// Its value, text for those that the protocol names.
    pub value: Vec<u8>,
}

/// Objects that fit into one PDU: 246 bytes with two more for each object.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct DeviceObjects(Vec<DeviceObject>);

impl DeviceObjects {
    const MAX_LEN: usize = 246;

    /// These objects; `None` if they do not fit.
    pub fn new(objects: Vec<DeviceObject>) -> Option<DeviceObjects> {
        let len: usize = objects.iter().map(|object| 2 + object.value.len()).sum();
        (len <= DeviceObjects::MAX_LEN).then_some(DeviceObjects(objects))
    }
}

impl Deref for DeviceObjects {
    type Target = [DeviceObject];

    fn deref(&self) -> &[DeviceObject] {
        &self.0
    }
}

/// The answer.
///
/// | byte | content |
/// | --- | --- |
/// | 0, 1 | 2Bh, 0Eh |
/// | 2 | the code of the request |
/// | 3 | conformity level |
/// | 4 | FFh more follows, else 00h |
/// | 5 | the next object to ask for, else 00h |
/// | 6 | number of objects |
/// | 7.. | of each: id, length, value |
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct DeviceIdentification {
    /// What was read.
    pub read: ReadDeviceId,
    /// 01h to 03h as in [`ReadDeviceId`], with bit 7 if single objects can be read.
    pub conformity: u8,
    /// The object to go on with, if not all fitted.
    pub next: Option<u8>,
    /// The objects.
    pub objects: DeviceObjects,
}

impl DeviceIdentification {
    pub(super) fn encode(&self) -> Vec<u8> {
        let mut pdu = vec![
            FunctionCode::ENCAPSULATED_INTERFACE.0,
            READ_DEVICE_IDENTIFICATION,
            self.read.code(),
            self.conformity,
            if self.next.is_some() { 0xFF } else { 0x00 },
            self.next.unwrap_or(0),
            self.objects.len() as u8,
        ];
        for object in self.objects.iter() {
            pdu.extend([object.id, object.value.len() as u8]);
            pdu.extend(&object.value);
        }
        pdu
    }

    /// Reads what follows 2Bh 0Eh.
    pub(super) fn parse(reader: &mut Reader<'_>) -> Result<DeviceIdentification, Violation> {
        let read = ReadDeviceId::parse(reader)?;
        let conformity = reader.u8()?;
        let offset = reader.offset();
        let more = reader.u8()?;
        let next = reader.u8()?;
        let next = match more {
            0x00 => None,
            0xFF => Some(next),
            _ => return Err(Violation::byte(Rule::Range, offset, more, "00h or FFh")),
        };
        let count = reader.u8()?;
        let mut objects = Vec::new();
        for _ in 0..count {
            let id = reader.u8()?;
            let len = usize::from(reader.u8()?);
            let value = reader.take(len)?.to_vec();
            objects.push(DeviceObject { id, value });
        }
        reader.end()?;
        let objects = DeviceObjects::new(objects)
            .ok_or_else(|| Violation::length(reader.offset(), super::MAX_PDU_LEN))?;
        Ok(DeviceIdentification {
            read,
            conformity,
            next,
            objects,
        })
    }
}
