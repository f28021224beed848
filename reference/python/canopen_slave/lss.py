"""An LSS slave (CiA 305), which canopen does not have.

Every frame has eight bytes: byte 0 the command specifier, then its parameters, numbers with the low byte first. The
master sends on 7E5h, the slave answers on 7E4h.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .device import Device

MASTER_ID, SLAVE_ID = 0x7E5, 0x7E4
SWITCH_GLOBAL, CONFIGURE_NODE_ID, CONFIGURE_BIT_TIMING, STORE = 0x04, 0x11, 0x13, 0x17
SELECTIVE = (0x40, 0x41, 0x42, 0x43)
SELECTED = 0x44
# Vendor, product, lowest and highest revision, lowest and highest serial number.
IDENTIFY = (0x46, 0x47, 0x48, 0x49, 0x4A, 0x4B)
IDENTIFIED = 0x4F
INQUIRE_IDENTITY = (0x5A, 0x5B, 0x5C, 0x5D)
INQUIRE_NODE_ID = 0x5E
TABLE_OF_CIA = 0
# Bit rates in bit/s by their index in that table; 5 is that of older editions.
BIT_RATES = {0: 1_000_000, 1: 800_000, 2: 500_000, 3: 250_000, 4: 125_000, 5: 100_000, 6: 50_000, 7: 20_000, 8: 10_000}


class LssSlave:
    """Waiting, or in configuration; what is configured comes into force with the next NMT reset."""

    def __init__(self, device: "Device") -> None:
        self._device = device
        self._configuring = False
        self._heard: list[int] = []
        self._node_id = device.next_node_id
        self._bit_timing: int | None = None
        device.bus.subscribe(MASTER_ID, self._on_request)

    def reset(self) -> None:
        """An NMT reset: the slave waits again."""
        self._configuring = False
        self._heard = []
        self._node_id = self._device.next_node_id
        self._bit_timing = None

    def _identity(self) -> list[int]:
        return [self._device.node.number(0x1018, sub) for sub in range(1, 5)]

    def _on_request(self, _can_id: int, data: bytes, _timestamp: float) -> None:
        if len(data) != 8:
            return
        specifier, number = data[0], int.from_bytes(data[1:5], "little")
        if specifier == SWITCH_GLOBAL:
            if data[1] in (0, 1):
                self._configuring = data[1] == 1
        elif specifier in SELECTIVE:
            self._select(SELECTIVE.index(specifier), number)
        elif specifier in IDENTIFY:
            self._identify(IDENTIFY.index(specifier), number)
        elif self._configuring:
            self._configure(specifier, data)

    def _select(self, place: int, number: int) -> None:
        """Four frames in this order; the one whose address they are answers and is in configuration."""
        self._heard = [*self._heard[:place], number] if len(self._heard) >= place else []
        if place == 3 and not self._configuring and self._heard == self._identity():
            self._configuring = True
            self._answer(SELECTED)

    def _identify(self, place: int, number: int) -> None:
        """Six frames in this order; everyone in their ranges answers."""
        self._heard = [*self._heard[:place], number] if len(self._heard) >= place else []
        if place == 5 and len(self._heard) == 6:
            vendor, product, revision, serial = self._identity()
            heard = self._heard
            if heard[:2] == [vendor, product] and heard[2] <= revision <= heard[3] and heard[4] <= serial <= heard[5]:
                self._answer(IDENTIFIED)

    def _configure(self, specifier: int, data: bytes) -> None:
        if specifier in INQUIRE_IDENTITY:
            self._answer(specifier, self._identity()[INQUIRE_IDENTITY.index(specifier)].to_bytes(4, "little"))
        elif specifier == INQUIRE_NODE_ID:
            self._answer(specifier, bytes([self._device.node.id]))
        elif specifier == CONFIGURE_NODE_ID:
            if 1 <= data[1] <= 127:
                self._node_id = data[1]
                self._answer(specifier, bytes([0]))
            else:
                self._answer(specifier, bytes([1]))
        elif specifier == CONFIGURE_BIT_TIMING:
            if data[1] == TABLE_OF_CIA and data[2] in BIT_RATES:
                self._bit_timing = data[2]
                self._answer(specifier, bytes([0]))
            else:
                self._answer(specifier, bytes([1]))
        elif specifier == STORE:
            self._device.next_node_id = self._node_id
            if self._bit_timing is not None:
                self._device.set_bit_timing(self._bit_timing)
            self._answer(specifier, bytes([0]))

    def _answer(self, specifier: int, parameters: bytes = b"") -> None:
        self._device.bus.send_message(SLAVE_ID, (bytes([specifier]) + parameters).ljust(8, b"\0"))
