//! What the server answers.

use super::request::{parse_diagnostics_data, put, put_counted};
use super::values::{counted_registers, counted_rest};
use super::{
    CoilWriteQuantity, DeviceIdentification, MAX_PDU_LEN, READ_DEVICE_IDENTIFICATION,
    RegisterWriteQuantity, Values, coil_value, parse_coil_value,
};
use crate::modbus::reader::Reader;
use crate::modbus::{ExceptionCode, FunctionCode};
use crate::{Rule, Violation};

/// A response PDU, an exception among them.
///
/// | function code | data |
/// | --- | --- |
/// | 01h..04h, 11h, 17h | byte count (1), values |
/// | 05h, 06h | address (2), value (2) |
/// | 08h | sub-function (2), data (2 or more) |
/// | 0Bh | status (2), count (2) |
/// | 0Fh, 10h | start (2), quantity (2) |
/// | 16h | address (2), AND mask (2), OR mask (2) |
/// | 2Bh | [`DeviceIdentification`] |
/// | that of the request + 80h | exception code (1) |
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Response {
    /// 01h: eight coils a byte, the first in bit 0.
    ReadCoils(Values<u8, 1, 250>),
    /// 02h: eight inputs a byte, the first in bit 0.
    ReadDiscreteInputs(Values<u8, 1, 250>),
    /// 03h
    ReadHoldingRegisters(Values<u16, 1, 125>),
    /// 04h
    ReadInputRegisters(Values<u16, 1, 125>),
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
        /// The sub-function.
        sub_function: u16,
        /// Its data.
        data: Values<u16, 1, 125>,
    },
    /// 0Bh
    GetCommEventCounter {
        /// FFFFh while an earlier command is still being carried out, else 0000h.
        status: u16,
        /// Messages completed.
        count: u16,
    },
    /// 0Fh
    WriteMultipleCoils {
        /// The first address.
        start: u16,
        /// How many.
        quantity: CoilWriteQuantity,
    },
    /// 10h
    WriteMultipleRegisters {
        /// The first address.
        start: u16,
        /// How many.
        quantity: RegisterWriteQuantity,
    },
    /// 11h: what the device says of itself.
    ReportServerId(Values<u8, 1, 251>),
    /// 16h
    MaskWriteRegister {
        /// The address.
        address: u16,
        /// The bits that stay.
        and: u16,
        /// What the others become.
        or: u16,
    },
    /// 17h
    ReadWriteMultipleRegisters(Values<u16, 1, 125>),
    /// 2Bh with MEI type 0Eh
    ReadDeviceIdentification(DeviceIdentification),
    /// The request is refused.
    Exception {
        /// The function code of the request, without the exception bit.
        function: FunctionCode,
        /// Why.
        code: ExceptionCode,
    },
    /// Any other function code, or MEI type.
    Other {
        /// The function code.
        function: FunctionCode,
        /// What follows it.
        data: Values<u8, 0, 252>,
    },
}

impl Response {
    /// The function code of the request that is answered.
    pub const fn function(&self) -> FunctionCode {
        match self {
            Response::ReadCoils(_) => FunctionCode::READ_COILS,
            Response::ReadDiscreteInputs(_) => FunctionCode::READ_DISCRETE_INPUTS,
            Response::ReadHoldingRegisters(_) => FunctionCode::READ_HOLDING_REGISTERS,
            Response::ReadInputRegisters(_) => FunctionCode::READ_INPUT_REGISTERS,
            Response::WriteSingleCoil { .. } => FunctionCode::WRITE_SINGLE_COIL,
            Response::WriteSingleRegister { .. } => FunctionCode::WRITE_SINGLE_REGISTER,
            Response::Diagnostics { .. } => FunctionCode::DIAGNOSTICS,
            Response::GetCommEventCounter { .. } => FunctionCode::GET_COMM_EVENT_COUNTER,
            Response::WriteMultipleCoils { .. } => FunctionCode::WRITE_MULTIPLE_COILS,
            Response::WriteMultipleRegisters { .. } => FunctionCode::WRITE_MULTIPLE_REGISTERS,
            Response::ReportServerId(_) => FunctionCode::REPORT_SERVER_ID,
            Response::MaskWriteRegister { .. } => FunctionCode::MASK_WRITE_REGISTER,
            Response::ReadWriteMultipleRegisters(_) => FunctionCode::READ_WRITE_MULTIPLE_REGISTERS,
            Response::ReadDeviceIdentification(_) => FunctionCode::ENCAPSULATED_INTERFACE,
            Response::Exception { function, .. } | Response::Other { function, .. } => *function,
        }
    }

    /// The PDU.
    pub fn encode(&self) -> Vec<u8> {
        let mut pdu = vec![self.function().0];
        match self {
            Response::ReadCoils(bytes) | Response::ReadDiscreteInputs(bytes) => {
                put_counted(&mut pdu, bytes.to_vec());
            }
            Response::ReadHoldingRegisters(values)
            | Response::ReadInputRegisters(values)
            | Response::ReadWriteMultipleRegisters(values) => {
                put_counted(&mut pdu, values.to_be_bytes().collect());
            }
            Response::WriteSingleCoil { address, on } => {
                put(&mut pdu, &[*address, coil_value(*on)])
            }
            Response::WriteSingleRegister { address, value } => put(&mut pdu, &[*address, *value]),
            Response::Diagnostics { sub_function, data } => {
                put(&mut pdu, &[*sub_function]);
                put(&mut pdu, data);
            }
            Response::GetCommEventCounter { status, count } => put(&mut pdu, &[*status, *count]),
            Response::WriteMultipleCoils { start, quantity } => {
                put(&mut pdu, &[*start, quantity.raw()]);
            }
            Response::WriteMultipleRegisters { start, quantity } => {
                put(&mut pdu, &[*start, quantity.raw()]);
            }
            Response::ReportServerId(bytes) => put_counted(&mut pdu, bytes.to_vec()),
            Response::MaskWriteRegister { address, and, or } => {
                put(&mut pdu, &[*address, *and, *or]);
            }
            Response::ReadDeviceIdentification(identification) => {
                return identification.encode();
            }
            Response::Exception { function, code } => {
                return vec![function.0 | FunctionCode::EXCEPTION_BIT, code.code()];
            }
            Response::Other { data, .. } => pdu.extend(data.iter()),
        }
        pdu
    }

    /// Reads a PDU.
    ///
    /// # Errors
    /// [`Violation`]: function code 00h or 80h, a wrong length, a quantity out of range, a byte count that does not fit
    /// what follows, a coil value that is neither on nor off.
    pub fn parse(pdu: &[u8]) -> Result<Response, Violation> {
        if pdu.len() > MAX_PDU_LEN {
            return Err(Violation::length(pdu.len(), MAX_PDU_LEN));
        }
        let mut reader = Reader::new(pdu);
        let function = FunctionCode(reader.u8()?);
        let answered = FunctionCode(function.0 & !FunctionCode::EXCEPTION_BIT);
        if !answered.is_requestable() {
            let expected = "a function code from 01h to 7Fh, or that of an exception to one";
            return Err(Violation::byte(Rule::Command, 0, function.0, expected));
        }
        let response = if answered == function {
            Response::parse_data(function, &mut reader)?
        } else {
            Response::Exception {
                function: answered,
                code: ExceptionCode::from_code(reader.u8()?),
            }
        };
        reader.end()?;
        Ok(response)
    }

    fn parse_data(function: FunctionCode, r: &mut Reader<'_>) -> Result<Response, Violation> {
        Ok(match function {
            FunctionCode::READ_COILS => {
                Response::ReadCoils(Values::parse(counted_rest(r)?.to_vec(), 1)?)
            }
            FunctionCode::READ_DISCRETE_INPUTS => {
                Response::ReadDiscreteInputs(Values::parse(counted_rest(r)?.to_vec(), 1)?)
            }
            FunctionCode::READ_HOLDING_REGISTERS => {
                Response::ReadHoldingRegisters(counted_registers(r)?)
            }
            FunctionCode::READ_INPUT_REGISTERS => {
                Response::ReadInputRegisters(counted_registers(r)?)
            }
            FunctionCode::WRITE_SINGLE_COIL => Response::WriteSingleCoil {
                address: r.u16()?,
                on: parse_coil_value(r.u16()?, 3)?,
            },
            FunctionCode::WRITE_SINGLE_REGISTER => Response::WriteSingleRegister {
                address: r.u16()?,
                value: r.u16()?,
            },
            FunctionCode::DIAGNOSTICS => Response::Diagnostics {
                sub_function: r.u16()?,
                data: parse_diagnostics_data(r)?,
            },
            FunctionCode::GET_COMM_EVENT_COUNTER => Response::GetCommEventCounter {
                status: r.u16()?,
                count: r.u16()?,
            },
            FunctionCode::WRITE_MULTIPLE_COILS => Response::WriteMultipleCoils {
                start: r.u16()?,
                quantity: CoilWriteQuantity::parse(r.u16()?, 3)?,
            },
            FunctionCode::WRITE_MULTIPLE_REGISTERS => Response::WriteMultipleRegisters {
                start: r.u16()?,
                quantity: RegisterWriteQuantity::parse(r.u16()?, 3)?,
            },
            FunctionCode::REPORT_SERVER_ID => {
                Response::ReportServerId(Values::parse(counted_rest(r)?.to_vec(), 1)?)
            }
            FunctionCode::MASK_WRITE_REGISTER => Response::MaskWriteRegister {
                address: r.u16()?,
                and: r.u16()?,
                or: r.u16()?,
            },
            FunctionCode::READ_WRITE_MULTIPLE_REGISTERS => {
                Response::ReadWriteMultipleRegisters(counted_registers(r)?)
            }
            FunctionCode::ENCAPSULATED_INTERFACE => Response::parse_encapsulated(r)?,
            function => Response::Other {
                function,
                data: Values::parse(r.rest().to_vec(), 1)?,
            },
        })
    }

    fn parse_encapsulated(r: &mut Reader<'_>) -> Result<Response, Violation> {
        let mei_type = r.u8()?;
        if mei_type == READ_DEVICE_IDENTIFICATION {
            return DeviceIdentification::parse(r).map(Response::ReadDeviceIdentification);
        }
        let mut data = vec![mei_type];
        data.extend(r.rest());
        Ok(Response::Other {
            function: FunctionCode::ENCAPSULATED_INTERFACE,
            data: Values::parse(data, 1)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modbus::pdu::{DeviceObject, DeviceObjects, ReadDeviceId};
    use proptest::prelude::*;

    fn some<T, const LEAST: usize, const MOST: usize>(values: Vec<T>) -> Values<T, LEAST, MOST> {
        Values::new(values).unwrap()
    }

    #[test]
    #[rustfmt::skip]
    fn responses_are_these_bytes() {
        let identification = DeviceIdentification {
            read: ReadDeviceId::Basic,
            conformity: 0x81,
            next: Some(2),
            objects: DeviceObjects::new(vec![
                DeviceObject { id: 0, value: b"AB".to_vec() },
                DeviceObject { id: 1, value: b"C".to_vec() },
            ]).unwrap(),
        };
        let cases: [(&[u8], Response); 16] = [
            (&[0x01, 3, 0xCD, 0x6B, 0x05], Response::ReadCoils(some(vec![0xCD, 0x6B, 0x05]))),
            (&[0x02, 1, 0xAC], Response::ReadDiscreteInputs(some(vec![0xAC]))),
            (&[0x03, 4, 0x01, 0xF4, 0x03, 0xE8], Response::ReadHoldingRegisters(some(vec![500, 1000]))),
            (&[0x04, 2, 0x00, 0x0A], Response::ReadInputRegisters(some(vec![10]))),
            (&[0x05, 0x00, 0xAC, 0x00, 0x00], Response::WriteSingleCoil { address: 0xAC, on: false }),
            (&[0x06, 0x01, 0x45, 0x03, 0xE8], Response::WriteSingleRegister { address: 0x145, value: 1000 }),
            (&[0x08, 0x00, 0x00, 0xA5, 0x37], Response::Diagnostics { sub_function: 0, data: some(vec![0xA537]) }),
            (&[0x0B, 0xFF, 0xFF, 0x01, 0x08], Response::GetCommEventCounter { status: 0xFFFF, count: 264 }),
            (
                &[0x0F, 0x00, 0x13, 0x00, 0x0A],
                Response::WriteMultipleCoils { start: 0x13, quantity: CoilWriteQuantity::new(10).unwrap() },
            ),
            (
                &[0x10, 0x01, 0x45, 0x00, 0x02],
                Response::WriteMultipleRegisters { start: 0x145, quantity: RegisterWriteQuantity::new(2).unwrap() },
            ),
            (&[0x11, 2, 0x09, 0xFF], Response::ReportServerId(some(vec![9, 0xFF]))),
            (
                &[0x16, 0x00, 0x04, 0x00, 0xF2, 0x00, 0x25],
                Response::MaskWriteRegister { address: 4, and: 0xF2, or: 0x25 },
            ),
            (&[0x17, 2, 0x00, 0xFE], Response::ReadWriteMultipleRegisters(some(vec![0xFE]))),
            (
                &[0x2B, 0x0E, 0x01, 0x81, 0xFF, 2, 2, 0, 2, b'A', b'B', 1, 1, b'C'],
                Response::ReadDeviceIdentification(identification),
            ),
            (
                &[0x86, 0x02],
                Response::Exception {
                    function: FunctionCode::WRITE_SINGLE_REGISTER,
                    code: ExceptionCode::IllegalDataAddress,
                },
            ),
            (&[0x41], Response::Other { function: FunctionCode(0x41), data: some(vec![]) }),
        ];
        for (pdu, response) in cases {
            assert_eq!(Response::parse(pdu), Ok(response.clone()), "{pdu:02X?}");
            assert_eq!(response.encode(), pdu, "{response:?}");
        }
    }

    #[test]
    #[rustfmt::skip]
    fn what_is_not_a_response_says_why() {
        let no_code = "expected a function code from 01h to 7Fh, or that of an exception to one";
        let cases: [(&[u8], &str); 10] = [
            (&[], "length: found 0 bytes, expected at least 1 byte"),
            (&[0x00], &format!("command: found 00h at byte 0, {no_code}")),
            (&[0x80, 1], &format!("command: found 80h at byte 0, {no_code}")),
            (&[0x83], "length: found 1 byte, expected at least 2 bytes"),
            (&[0x83, 2, 0], "length: found 3 bytes, expected 2 bytes"),
            (&[0x03, 2, 0], "byte count: found 2 at byte 1, expected 1"),
            (&[0x03, 1, 0], "byte count: found 1 at byte 1, expected an even number"),
            (&[0x03, 0], "range: found 0 at byte 1, expected 1 to 125"),
            (&[0x10, 0, 0, 0, 124], "range: found 124 at byte 3, expected 1 to 123"),
            (&[0x2B, 0x0E, 1, 1, 7, 0, 0], "range: found 07h at byte 4, expected 00h or FFh"),
        ];
        for (pdu, message) in cases {
            assert_eq!(Response::parse(pdu).unwrap_err().to_string(), message);
        }
    }

    #[test]
    fn device_objects_fit_into_one_pdu() {
        let object = |len| DeviceObject {
            id: 0,
            value: vec![b'x'; len],
        };
        let longest = DeviceObjects::new(vec![object(244)]).unwrap();
        let response = Response::ReadDeviceIdentification(DeviceIdentification {
            read: ReadDeviceId::Specific,
            conformity: 0x83,
            next: None,
            objects: longest,
        });
        assert_eq!(response.encode().len(), MAX_PDU_LEN);
        assert_eq!(Response::parse(&response.encode()), Ok(response));
        assert_eq!(DeviceObjects::new(vec![object(245)]), None);
    }

    proptest! {
        #[test]
        fn what_is_read_is_read_again_from_what_is_written(
            pdu in proptest::collection::vec(prop_oneof![0u8..=0x2B, any::<u8>()], 0..20),
        ) {
            if let Ok(response) = Response::parse(&pdu) {
                let written = response.encode();
                prop_assert_eq!(written.len(), pdu.len());
                prop_assert_eq!(Response::parse(&written), Ok(response));
            }
        }

        #[test]
        fn read_registers_are_read(values in proptest::collection::vec(any::<u16>(), 1..=125)) {
            let response = Response::ReadHoldingRegisters(some(values));
            prop_assert!(response.encode().len() <= MAX_PDU_LEN);
            prop_assert_eq!(Response::parse(&response.encode()), Ok(response));
        }
    }
}
