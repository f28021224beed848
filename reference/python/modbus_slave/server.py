"""Servers of pymodbus with the store, decoder and framing of this package."""

import asyncio
import os

from pymodbus.pdu import ModbusPDU
from pymodbus.server import ModbusSerialServer, ModbusTcpServer
from pymodbus.server.base import ModbusBaseServer
from pymodbus.simulator import DataType, SimData, SimDevice

from .devices import COMMAND_ADDRESS
from .framing import Decoder, RtuHandler, SilentRtu
from .store import Store


def _nothing() -> SimDevice:
    """pymodbus wants a device of its own; `_furnish` takes it away again."""
    return SimDevice(1, simdata=[SimData(0, values=0, datatype=DataType.REGISTERS)])


def _furnish(server: ModbusBaseServer, store: Store) -> None:
    server.context = store
    server.decoder = Decoder()


class SerialServer(ModbusSerialServer):
    """RTU on a serial port or pseudo-terminal. `baud` is in bit/s, `parity` N, E or O."""

    def __init__(self, store: Store, port: str, baud: int, parity: str, stop_bits: int) -> None:
        def answer(sending: bool, pdu: ModbusPDU) -> ModbusPDU:
            # The encoder answers the command to FFh from the address that it has then.
            if sending and pdu.dev_id == COMMAND_ADDRESS:
                pdu.dev_id = store.address
            return pdu

        super().__init__(
            _nothing(),
            port=port,
            baudrate=baud,
            # A pseudo-terminal has no parity, and Linux refuses to set one (EINVAL).
            parity="N" if is_pseudo_terminal(port) else parity,
            stopbits=stop_bits,
            ignore_missing_devices=True,
            broadcast_enable=True,
            trace_pdu=answer,
        )
        _furnish(self, store)
        self.framer = SilentRtu
        # Set when the port is closed, or gone.
        self.disconnected = asyncio.Event()

    def callback_new_connection(self) -> RtuHandler:
        """The port is open."""
        return RtuHandler(self, self.trace_packet, self.trace_pdu, self.trace_connect)


class TcpServer(ModbusTcpServer):
    """Modbus TCP. The store answers for every unit identifier."""

    def __init__(self, store: Store, host: str, port: int) -> None:
        super().__init__(_nothing(), address=(host, port))
        store.any_address = True
        _furnish(self, store)


def is_pseudo_terminal(port: str) -> bool:
    """Whether `port` leads to a pseudo-terminal."""
    return os.path.realpath(port).startswith("/dev/pts/")
