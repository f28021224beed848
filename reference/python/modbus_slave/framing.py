"""RTU frames end with a silence, which pymodbus does not look at."""

import asyncio

from pymodbus.framer import FramerRTU
from pymodbus.pdu import DecodePDU, ModbusPDU
from pymodbus.server.requesthandler import ServerRequestHandler

from .pdus import ReadRequest, UnknownRequest, WriteMultipleRequest, WriteSingleRequest

# Longer than the pauses that a scheduler makes in a frame, shorter than one a tester makes after it.
SILENCE_S = 0.01
LONGEST_FRAME = 256
KNOWN = (ReadRequest, WriteSingleRequest, WriteMultipleRequest)


class Decoder(DecodePDU):
    """The three functions of the devices, and everything else as a request to refuse."""

    def __init__(self) -> None:
        super().__init__(True)
        self._classes = {known.function_code: known for known in KNOWN}

    def lookupPduClass(self, data: bytes) -> type[ModbusPDU]:
        """The class of the frame that begins with an address."""
        return self._classes.get(data[1], UnknownRequest)

    def decode(self, frame: bytes) -> ModbusPDU:
        """The request in a PDU."""
        request = self._classes.get(frame[0], UnknownRequest)()
        request.function_code = frame[0]
        request.decode(frame[1:])
        return request


class SilentRtu(FramerRTU):
    """Takes all that came since the last silence as one frame."""

    def decode(self, data: bytes) -> tuple[int, int, int, bytes]:
        """The bytes used, the address, no transaction and the PDU."""
        possible = self.MIN_SIZE <= len(data) <= LONGEST_FRAME
        if not possible or not self.check_CRC(data[:-2], int.from_bytes(data[-2:], "big")):
            return 0, 0, 0, self.EMPTY
        return len(data), data[0], 0, data[1:-2]


class RtuHandler(ServerRequestHandler):
    """Waits for the silence that ends a frame."""

    _collected = b""
    _end: asyncio.TimerHandle | None = None

    def callback_disconnected(self, exc: Exception | None) -> None:
        """The port is closed, or gone."""
        super().callback_disconnected(exc)
        self.server.disconnected.set()

    def data_received(self, data: bytes) -> None:
        """Bytes from the line."""
        self._collected += data
        if self._end:
            self._end.cancel()
        self._end = asyncio.get_running_loop().call_later(SILENCE_S, self._frame_ended)

    def _frame_ended(self) -> None:
        frame, self._collected = self._collected, b""
        self.recv_buffer = b""
        super().data_received(frame)
