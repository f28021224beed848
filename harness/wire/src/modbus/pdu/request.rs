//! What the client asks.

use super::values::{bytes_to_bits, counted, registers};
use super::{
    BitQuantity, CoilWriteQuantity, MAX_PDU_LEN, READ_DEVICE_IDENTIFICATION, ReadDeviceId,
    ReadQuantity, RegisterWriteQuantity, Values, bits_to_bytes, coil_value, parse_coil_value,
};
use crate::modbus::FunctionCode;
use crate::modbus::reader::Reader;
use crate::violation::plural;
use crate::{Rule, Violation};

/// A request PDU.
///
/// | function code | data |
/// | --- | --- |
/// | 01h..04h | start (2), quantity (2) |
/// | 05h, 06h | address (2), value (2) |
/// | 08h | sub-function (2), data (2 or more) |
/// | 0Bh, 11h | |
/// | 0Fh, 10h | start (2), quantity (2), byte count (1), values |
/// | 16h | address (2), AND mask (2), OR mask (2) |
/// | 17h | read start (2), read quantity (2), write start (2), write quantity (2), byte count (1), values |
/// | 2Bh | MEI type 0Eh (1), what is read (1), object (1) |
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Request {
    /// 01h
    ReadCoils {
        /// The first address.
        start: u16,
        /// How many.
        quantity: BitQuantity,
    },
    /// 02h
    ReadDiscreteInputs {
        /// The first address.
        start: u16,
        /// How many.
        quantity: BitQuantity,
    },
    /// 03h
    ReadHoldingRegisters {
        /// The first address.
        start: u16,
        /// How many.
        quantity: ReadQuantity,
    },
    /// 04h
    ReadInputRegisters {
        /// The first address.
        start: u16,
        /// How many.
        quantity: ReadQuantity,
    },
    /// 05h
    WriteSingleCoil {
        /// The address.
        address: u16,
        /// The value.
        on: bool,
    },
    /// 06h
    WriteSingleRegister {
        /// The address.
        address: u16,
        /// The value.
        value: u16,
    },
    /// 08h
    Diagnostics {
        /// The sub-function, 0000h returns the data.
        sub_function: u16,
        /// Its data.
        data: Values<u16, 1, 125>,
    },
    /// 0Bh
    GetCommEventCounter,
    /// 0Fh
    WriteMultipleCoils {
        /// The first address.
        start: u16,
        /// The values.
        values: Values<bool, 1, 1968>,
    },
    /// 10h
    WriteMultipleRegisters {
        /// The first address.
        start: u16,
        /// The values.
        values: Values<u16, 1, 123>,
    },
    /// 11h
    ReportServerId,
    /// 16h: the register becomes (itself AND `and`) OR (`or` AND NOT `and`).
    MaskWriteRegister {
        /// The address.
        address: u16,
        /// The bits that stay.
        and: u16,
        /// What the others become.
        or: u16,
    },
    /// 17h: writes, then reads.
    ReadWriteMultipleRegisters {
        /// The first address read.
        read_start: u16,
        /// How many are read.
        read_quantity: ReadQuantity,
        /// The first address written.
        write_start: u16,
        /// The values written.
        values: Values<u16, 1, 121>,
    },
    /// 2Bh with MEI type 0Eh
    ReadDeviceIdentification {
        /// Which objects.
        read: ReadDeviceId,
        /// The first object.
        object: u8,
    },
    /// Any other function code, or MEI type.
    Other {
        /// The function code.
        function: FunctionCode,
        /// What follows it.
        data: Values<u8, 0, 252>,
    },
}

impl Request {
    /// The function code.
    pub const fn function(&self) -> FunctionCode {
        match self {
            Request::ReadCoils { .. } => FunctionCode::READ_COILS,
            Request::ReadDiscreteInputs { .. } => FunctionCode::READ_DISCRETE_INPUTS,
            Request::ReadHoldingRegisters { .. } => FunctionCode::READ_HOLDING_REGISTERS,
            Request::ReadInputRegisters { .. } => FunctionCode::READ_INPUT_REGISTERS,
            Request::WriteSingleCoil { .. } => FunctionCode::WRITE_SINGLE_COIL,
            Request::WriteSingleRegister { .. } => FunctionCode::WRITE_SINGLE_REGISTER,
            Request::Diagnostics { .. } => FunctionCode::DIAGNOSTICS,
            Request::GetCommEventCounter => FunctionCode::GET_COMM_EVENT_COUNTER,
            Request::WriteMultipleCoils { .. } => FunctionCode::WRITE_MULTIPLE_COILS,
            Request::WriteMultipleRegisters { .. } => FunctionCode::WRITE_MULTIPLE_REGISTERS,
            Request::ReportServerId => FunctionCode::REPORT_SERVER_ID,
            Request::MaskWriteRegister { .. } => FunctionCode::MASK_WRITE_REGISTER,
            Request::ReadWriteMultipleRegisters { .. } => {
                FunctionCode::READ_WRITE_MULTIPLE_REGISTERS
            }
            Request::ReadDeviceIdentification { .. } => FunctionCode::ENCAPSULATED_INTERFACE,
            Request::Other { function, .. } => *function,
        }
    }

    /// The PDU.
    pub fn encode(&self) -> Vec<u8> {
        let mut pdu = vec![self.function().0];
        match self {
            Request::ReadCoils { start, quantity }
            | Request::ReadDiscreteInputs { start, quantity } => {
                put(&mut pdu, &[*start, quantity.raw()]);
            }
            Request::ReadHoldingRegisters { start, quantity }
            | Request::ReadInputRegisters { start, quantity } => {
                put(&mut pdu, &[*start, quantity.raw()]);
            }
            Request::WriteSingleCoil { address, on } => put(&mut pdu, &[*address, coil_value(*on)]),
            Request::WriteSingleRegister { address, value } => put(&mut pdu, &[*address, *value]),
            Request::Diagnostics { sub_function, data } => {
                put(&mut pdu, &[*sub_function]);
                put(&mut pdu, data);
            }
            Request::GetCommEventCounter | Request::ReportServerId => {}
            Request::WriteMultipleCoils { start, values } => {
                put(&mut pdu, &[*start, values.len() as u16]);
                put_counted(&mut pdu, bits_to_bytes(values));
            }
            Request::WriteMultipleRegisters { start, values } => {
                put(&mut pdu, &[*start, values.len() as u16]);
                put_counted(&mut pdu, values.to_be_bytes().collect());
            }
            Request::MaskWriteRegister { address, and, or } => {
                put(&mut pdu, &[*address, *and, *or]);
            }
            Request::ReadWriteMultipleRegisters {
                read_start,
                read_quantity,
                write_start,
                values,
            } => {
                let quantity = values.len() as u16;
                put(
                    &mut pdu,
                    &[*read_start, read_quantity.raw(), *write_start, quantity],
                );
                put_counted(&mut pdu, values.to_be_bytes().collect());
            }
            Request::ReadDeviceIdentification { read, object } => {
                pdu.extend([READ_DEVICE_IDENTIFICATION, read.code(), *object]);
            }
            Request::Other { data, .. } => pdu.extend(data.iter()),
        }
        pdu
    }

    /// Reads a PDU. The padding bits of coils are passed over.
    ///
    /// # Errors
    /// [`Violation`]: a function code that no request has, a wrong length, a quantity out of range, a byte count that
    /// does not fit the quantity, a coil value that is neither on nor off.
    pub fn parse(pdu: &[u8]) -> Result<Request, Violation> {
        if pdu.len() > MAX_PDU_LEN {
            return Err(Violation::length(pdu.len(), MAX_PDU_LEN));
        }
        let mut reader = Reader::new(pdu);
        let function = FunctionCode(reader.u8()?);
        let request = Request::parse_data(function, &mut reader)?;
        reader.end()?;
        Ok(request)
    }

    fn parse_data(function: FunctionCode, r: &mut Reader<'_>) -> Result<Request, Violation> {
        Ok(match function {
            FunctionCode::READ_COILS => Request::ReadCoils {
                start: r.u16()?,
                quantity: BitQuantity::parse(r.u16()?, 3)?,
            },
            FunctionCode::READ_DISCRETE_INPUTS => Request::ReadDiscreteInputs {
                start: r.u16()?,
                quantity: BitQuantity::parse(r.u16()?, 3)?,
            },
            FunctionCode::READ_HOLDING_REGISTERS => Request::ReadHoldingRegisters {
                start: r.u16()?,
                quantity: ReadQuantity::parse(r.u16()?, 3)?,
            },
            FunctionCode::READ_INPUT_REGISTERS => Request::ReadInputRegisters {
                start: r.u16()?,
                quantity: ReadQuantity::parse(r.u16()?, 3)?,
            },
            FunctionCode::WRITE_SINGLE_COIL => Request::WriteSingleCoil {
                address: r.u16()?,
                on: parse_coil_value(r.u16()?, 3)?,
            },
            FunctionCode::WRITE_SINGLE_REGISTER => Request::WriteSingleRegister {
                address: r.u16()?,
                value: r.u16()?,
            },
            FunctionCode::DIAGNOSTICS => Request::Diagnostics {
                sub_function: r.u16()?,
                data: parse_diagnostics_data(r)?,
            },
            FunctionCode::GET_COMM_EVENT_COUNTER => Request::GetCommEventCounter,
            FunctionCode::WRITE_MULTIPLE_COILS => Request::parse_write_coils(r)?,
            FunctionCode::WRITE_MULTIPLE_REGISTERS => Request::parse_write_registers(r)?,
            FunctionCode::REPORT_SERVER_ID => Request::ReportServerId,
            FunctionCode::MASK_WRITE_REGISTER => Request::MaskWriteRegister {
                address: r.u16()?,
                and: r.u16()?,
                or: r.u16()?,
            },
            FunctionCode::READ_WRITE_MULTIPLE_REGISTERS => Request::parse_read_write(r)?,
            FunctionCode::ENCAPSULATED_INTERFACE => Request::parse_encapsulated(r)?,
            other if other.is_requestable() => Request::Other {
                function: other,
                data: Values::parse(r.rest().to_vec(), 1)?,
            },
            FunctionCode(code) => {
                let expected = "a function code from 01h to 7Fh";
                return Err(Violation::byte(Rule::Command, 0, code, expected));
            }
        })
    }

    fn parse_write_coils(r: &mut Reader<'_>) -> Result<Request, Violation> {
        let start = r.u16()?;
        let quantity = usize::from(CoilWriteQuantity::parse(r.u16()?, 3)?.raw());
        let bytes = counted(r, quantity.div_ceil(8))?;
        Ok(Request::WriteMultipleCoils {
            start,
            values: Values::parse(bytes_to_bits(bytes, quantity), 3)?,
        })
    }

    fn parse_write_registers(r: &mut Reader<'_>) -> Result<Request, Violation> {
        let start = r.u16()?;
        let quantity = usize::from(RegisterWriteQuantity::parse(r.u16()?, 3)?.raw());
        let bytes = counted(r, 2 * quantity)?;
        Ok(Request::WriteMultipleRegisters {
            start,
            values: Values::parse(registers(bytes), 3)?,
        })
    }

    fn parse_read_write(r: &mut Reader<'_>) -> Result<Request, Violation> {
        let read_start = r.u16()?;
        let read_quantity = ReadQuantity::parse(r.u16()?, 3)?;
        let write_start = r.u16()?;
        let quantity = r.u16()?;
        if !(1..=121).contains(&quantity) {
            return Err(Violation::range(7, u64::from(quantity), 1, 121));
        }
        let bytes = counted(r, 2 * usize::from(quantity))?;
        Ok(Request::ReadWriteMultipleRegisters {
            read_start,
            read_quantity,
            write_start,
            values: Values::parse(registers(bytes), 7)?,
        })
    }

    fn parse_encapsulated(r: &mut Reader<'_>) -> Result<Request, Violation> {
        let mei_type = r.u8()?;
        if mei_type != READ_DEVICE_IDENTIFICATION {
            let mut data = vec![mei_type];
            data.extend(r.rest());
            return Ok(Request::Other {
                function: FunctionCode::ENCAPSULATED_INTERFACE,
                data: Values::parse(data, 1)?,
            });
        }
        Ok(Request::ReadDeviceIdentification {
            read: ReadDeviceId::parse(r)?,
            object: r.u8()?,
        })
    }
}

/// The data of 08h: an even number of bytes, 2 at least.
pub(super) fn parse_diagnostics_data(r: &mut Reader<'_>) -> Result<Values<u16, 1, 125>, Violation> {
    let offset = r.offset();
    let bytes = r.rest();
    if bytes.len() % 2 == 1 {
        return Err(Violation::new(
            Rule::Length,
            offset + bytes.len(),
            format!("{} of data", plural(bytes.len(), "byte")),
            "an even number",
        ));
    }
    Values::parse(registers(bytes), offset)
}

pub(super) fn put(pdu: &mut Vec<u8>, values: &[u16]) {
    pdu.extend(values.iter().flat_map(|value| value.to_be_bytes()));
}

pub(super) fn put_counted(pdu: &mut Vec<u8>, bytes: Vec<u8>) {
    pdu.push(bytes.len() as u8);
    pdu.extend(bytes);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn some<T, const LEAST: usize, const MOST: usize>(values: Vec<T>) -> Values<T, LEAST, MOST> {
        Values::new(values).unwrap()
    }

    #[test]
    #[rustfmt::skip]
    fn requests_are_these_bytes() {
        let registers = |raw| ReadQuantity::new(raw).unwrap();
        let bits = |raw| BitQuantity::new(raw).unwrap();
        let cases: [(&[u8], Request); 15] = [
            (&[0x01, 0x00, 0x13, 0x00, 0x13], Request::ReadCoils { start: 0x13, quantity: bits(19) }),
            (&[0x02, 0x00, 0xC4, 0x07, 0xD0], Request::ReadDiscreteInputs { start: 0xC4, quantity: bits(2000) }),
            (&[0x03, 0x00, 0xD4, 0x00, 0x02], Request::ReadHoldingRegisters { start: 0xD4, quantity: registers(2) }),
            (&[0x04, 0x00, 0x08, 0x00, 0x7D], Request::ReadInputRegisters { start: 8, quantity: registers(125) }),
            (&[0x05, 0x00, 0xAC, 0xFF, 0x00], Request::WriteSingleCoil { address: 0xAC, on: true }),
            (&[0x06, 0x01, 0x45, 0x03, 0xE8], Request::WriteSingleRegister { address: 0x145, value: 1000 }),
            (&[0x08, 0x00, 0x00, 0xA5, 0x37], Request::Diagnostics { sub_function: 0, data: some(vec![0xA537]) }),
            (&[0x0B], Request::GetCommEventCounter),
            (
                &[0x0F, 0x00, 0x13, 0x00, 0x0A, 0x02, 0xCD, 0x01],
                Request::WriteMultipleCoils {
                    start: 0x13,
                    values: some(vec![true, false, true, true, false, false, true, true, true, false]),
                },
            ),
            (
                &[0x10, 0x01, 0x45, 0x00, 0x02, 0x04, 0x03, 0xE8, 0x07, 0xD0],
                Request::WriteMultipleRegisters { start: 0x145, values: some(vec![1000, 2000]) },
            ),
            (&[0x11], Request::ReportServerId),
            (
                &[0x16, 0x00, 0x04, 0x00, 0xF2, 0x00, 0x25],
                Request::MaskWriteRegister { address: 4, and: 0xF2, or: 0x25 },
            ),
            (
                &[0x17, 0x00, 0x03, 0x00, 0x06, 0x00, 0x0E, 0x00, 0x01, 0x02, 0x00, 0xFF],
                Request::ReadWriteMultipleRegisters {
                    read_start: 3,
                    read_quantity: registers(6),
                    write_start: 14,
                    values: some(vec![0xFF]),
                },
            ),
            (
                &[0x2B, 0x0E, 0x01, 0x00],
                Request::ReadDeviceIdentification { read: ReadDeviceId::Basic, object: 0 },
            ),
            (
                &[0x41, 1, 2, 3],
                Request::Other { function: FunctionCode(0x41), data: some(vec![1, 2, 3]) },
            ),
        ];
        for (pdu, request) in cases {
            assert_eq!(Request::parse(pdu), Ok(request.clone()), "{pdu:02X?}");
            assert_eq!(request.encode(), pdu, "{request:?}");
        }
    }

    #[test]
    #[rustfmt::skip]
    fn what_is_not_a_request_says_why() {
        let cases: [(&[u8], &str); 15] = [
            (&[], "length: found 0 bytes, expected at least 1 byte"),
            (&[0x00], "command: found 00h at byte 0, expected a function code from 01h to 7Fh"),
            (&[0x83, 2], "command: found 83h at byte 0, expected a function code from 01h to 7Fh"),
            (&[0x03, 0, 0, 0], "length: found 4 bytes, expected at least 5 bytes"),
            (&[0x03, 0, 0, 0, 1, 0], "length: found 6 bytes, expected 5 bytes"),
            (&[0x03, 0, 0, 0, 0], "range: found 0 at byte 3, expected 1 to 125"),
            (&[0x04, 0, 0, 0, 126], "range: found 126 at byte 3, expected 1 to 125"),
            (&[0x01, 0, 0, 0x07, 0xD1], "range: found 2001 at byte 3, expected 1 to 2000"),
            (&[0x05, 0, 0, 0x00, 0x01], "range: found 0001h at byte 3, expected 0000h or FF00h"),
            (&[0x0F, 0, 0, 0x07, 0xB1, 0xF7], "range: found 1969 at byte 3, expected 1 to 1968"),
            (&[0x10, 0, 0, 0, 124, 248], "range: found 124 at byte 3, expected 1 to 123"),
            (&[0x10, 0, 0, 0, 1, 3, 0, 0, 0], "byte count: found 3 at byte 5, expected 2"),
            (&[0x17, 0, 0, 0, 1, 0, 0, 0, 122, 244], "range: found 122 at byte 7, expected 1 to 121"),
            (&[0x2B, 0x0E, 5, 0], "range: found 5 at byte 2, expected 1 to 4"),
            (&[0x08, 0, 0, 1], "length: found 1 byte of data, expected an even number"),
        ];
        for (pdu, message) in cases {
            assert_eq!(Request::parse(pdu).unwrap_err().to_string(), message);
        }
        assert!(Request::parse(&[0x41; 253]).is_ok());
        assert!(Request::parse(&[0x41; 254]).is_err());
    }

    proptest! {
        #[test]
        fn what_is_read_is_read_again_from_what_is_written(
            pdu in proptest::collection::vec(prop_oneof![0u8..=0x2B, any::<u8>()], 0..20),
        ) {
            if let Ok(request) = Request::parse(&pdu) {
                let written = request.encode();
                prop_assert_eq!(written.len(), pdu.len());
                prop_assert_eq!(Request::parse(&written), Ok(request));
            }
        }

        #[test]
        fn written_values_are_read(start: u16, values in proptest::collection::vec(any::<u16>(), 1..=123)) {
            let request = Request::WriteMultipleRegisters { start, values: some(values) };
            prop_assert_eq!(Request::parse(&request.encode()), Ok(request));
        }

        #[test]
        fn written_coils_are_read(start: u16, values in proptest::collection::vec(any::<bool>(), 1..=1968)) {
            let request = Request::WriteMultipleCoils { start, values: some(values) };
            prop_assert!(request.encode().len() <= MAX_PDU_LEN);
            prop_assert_eq!(Request::parse(&request.encode()), Ok(request));
        }
    }
}
