"""The SDO server: canopen's, kept to the order of frames of CiA 301."""

from typing import TYPE_CHECKING

from canopen.sdo import SdoAbortedError, SdoServer

from . import abort, rules

if TYPE_CHECKING:
    from .node import Node

# Client command specifiers: bits 7 to 5 of byte 0.
DOWNLOAD_SEGMENT, DOWNLOAD, UPLOAD, UPLOAD_SEGMENT, ABORT, BLOCK_UPLOAD = range(6)
EXPEDITED, SIZE_INDICATED, LAST_SEGMENT = 0x02, 0x01, 0x01


class Server(SdoServer):
    """Knows whether a transfer is running, which canopen's server does not ask, and refuses what does not fit it."""

    def __init__(self, node: "Node") -> None:
        super().__init__(0x600 + node.id, 0x580 + node.id, node)
        self._index = self._subindex = 0
        self._running: int | None = None
        self._announced: int | None = None

    def on_request(self, can_id: int, data: bytearray, timestamp: float) -> None:
        """One frame of the client: byte 0 the command, 1 and 2 the index, 3 the sub-index, 4 to 7 data."""
        if len(data) != 8 or not self._node.serves_sdo:
            return
        specifier = data[0] >> 5
        try:
            if specifier in (DOWNLOAD_SEGMENT, UPLOAD_SEGMENT):
                if specifier != self._running:
                    abort.refuse(abort.UNKNOWN_COMMAND)
            else:
                self._running = None
                self._index, self._subindex = int.from_bytes(data[1:3], "little"), data[3]
            if specifier == DOWNLOAD:
                data = self._check_download(data)
            elif specifier == BLOCK_UPLOAD:
                self._check_block_upload(data)
        except SdoAbortedError as error:
            self.abort(error.code)
            return
        super().on_request(can_id, data, timestamp)

    def abort(self, abort_code: int = 0x08000000) -> None:
        """Ends the running transfer and says so."""
        self._running = None
        super().abort(abort_code)

    def init_upload(self, request: bytes) -> None:
        """A number or string of up to four bytes goes at once, a longer one in segments."""
        super().init_upload(request)
        if len(self._node.get_data(self._index, self._subindex)) > 4:
            self._running = UPLOAD_SEGMENT

    def segmented_upload(self, command: int) -> None:
        """The next seven bytes."""
        super().segmented_upload(command)
        if not self._buffer:
            self._running = None

    def segmented_download(self, command: int, request: bytes) -> None:
        """The next seven bytes; with the last the value is written."""
        size = len(self._buffer) + 7 - (command >> 1 & 7)
        if command & LAST_SEGMENT and self._announced not in (None, size):
            abort.refuse(abort.WRONG_LENGTH)
        super().segmented_download(command, request)
        if command & LAST_SEGMENT:
            self._running = None

    def _check_download(self, request: bytearray) -> bytearray:
        """Refuses what cannot be written before the first segment; the request with the size of the entry in it."""
        entry = self._node.entry(self._index, self._subindex)
        rules.check_access(entry)
        if request[0] & EXPEDITED:
            if not request[0] & SIZE_INDICATED:
                # The server is free to take as many bytes as the entry has.
                unused = max(0, 4 - len(entry) // 8)
                request = bytearray([request[0] & 0xF2 | SIZE_INDICATED | unused << 2]) + request[1:]
            return request
        self._announced = None
        if request[0] & SIZE_INDICATED:
            self._announced = int.from_bytes(request[4:8], "little")
            rules.check_length(entry, self._announced)
        self._running = DOWNLOAD_SEGMENT
        return request

    def _check_block_upload(self, request: bytes) -> None:
        """canopen answers every block upload with segments; byte 5 says up to how many bytes that is allowed."""
        if request[0] & 0x03 or len(self._node.get_data(self._index, self._subindex, True)) > request[5]:
            abort.refuse(abort.UNKNOWN_COMMAND)
