"""Requests that pymodbus answers otherwise than the Modbus application protocol.

pymodbus decodes a request before it looks at its address. One that it cannot decode it answers at once, with exception
01, whoever it was for. These classes decode any request, and refuse in `datastore_update`, after the address.
"""

import struct

from pymodbus.constants import ExcCodes
from pymodbus.pdu import ExceptionResponse, ModbusPDU
from pymodbus.pdu.register_message import (
    ReadHoldingRegistersRequest,
    WriteMultipleRegistersRequest,
    WriteSingleRegisterRequest,
    WriteSingleRegisterResponse,
)

from .store import Store


class ReadRequest(ReadHoldingRegistersRequest):
    """03: address and count, two bytes each."""

    def decode(self, data: bytes) -> None:
        """Takes any count."""
        self.well_formed = len(data) == 4
        if self.well_formed:
            self.address, self.count = struct.unpack(">HH", data)

    async def datastore_update(self, context: Store, device_id: int) -> ModbusPDU:
        """Refuses a wrong count with exception 03."""
        if not self.well_formed or not 1 <= self.count <= self.MAX_COUNT:
            return await _refuse(self, context, device_id)
        return await super().datastore_update(context, device_id)


class WriteSingleRequest(WriteSingleRegisterRequest):
    """06: address and value, two bytes each."""

    def decode(self, data: bytes) -> None:
        """Takes any length."""
        self.well_formed = len(data) == 4
        if self.well_formed:
            super().decode(data)

    async def datastore_update(self, context: Store, device_id: int) -> ModbusPDU:
        """Echoes. pymodbus reads the register back, which a write-only one refuses."""
        if not self.well_formed:
            return await _refuse(self, context, device_id)
        refused = await context.async_setValues(device_id, self.function_code, self.address, self.registers)
        if refused:
            return ExceptionResponse(self.function_code, refused)
        return WriteSingleRegisterResponse(address=self.address, registers=self.registers)


class WriteMultipleRequest(WriteMultipleRegistersRequest):
    """10h: address and count, two bytes each, the count of bytes, the values."""

    def decode(self, data: bytes) -> None:
        """Takes any length."""
        self.well_formed = len(data) >= 5
        if self.well_formed:
            super().decode(data)

    async def datastore_update(self, context: Store, device_id: int) -> ModbusPDU:
        """Refuses a wrong count with exception 03."""
        if not self.well_formed:
            return await _refuse(self, context, device_id)
        return await super().datastore_update(context, device_id)


class UnknownRequest(ModbusPDU):
    """Any other function."""

    def decode(self, data: bytes) -> None:
        """Takes anything."""

    async def datastore_update(self, context: Store, device_id: int) -> ModbusPDU:
        """Refuses with exception 01, if the request was for this slave."""
        refused = await context.async_getValues(device_id, self.function_code, 0)
        return ExceptionResponse(self.function_code, refused)


async def _refuse(request: ModbusPDU, context: Store, device_id: int) -> ModbusPDU:
    """Exception 03, if the request was for this slave: the store raises if not."""
    await context.async_getValues(device_id, request.function_code, 0)
    return ExceptionResponse(request.function_code, ExcCodes.ILLEGAL_VALUE)
