"""The bus: python-can's interfaces under canopen's network."""

import logging
import socket
import threading
from collections.abc import Callable

import can
import canopen

logger = logging.getLogger(__name__)


class Bus(canopen.Network):
    """A network that also passes on remote frames, which canopen drops, and handles one frame at a time."""

    # Seconds until the receiving thread sees that it shall end.
    NOTIFIER_CYCLE = 0.05

    def __init__(self, bus: can.BusABC) -> None:
        super().__init__(bus)
        self.lock = threading.RLock()
        self.listeners = [self._received]
        self._remote: dict[int, Callable[[], None]] = {}

    def on_remote(self, can_id: int, function: Callable[[], None] | None) -> None:
        """Calls `function` for each remote frame with `can_id`; None ends it."""
        if function is None:
            self._remote.pop(can_id, None)
        else:
            self._remote[can_id] = function

    def set_bit_rate(self, bit_rate: int) -> None:
        """Changes the bit rate, in bit/s, where the interface can; else the bus keeps the one it has."""
        try:
            self.bus.set_bitrate(bit_rate)
        except (AttributeError, ValueError) as error:
            logger.warning("the bit rate stays as it is: %s", error)

    def _received(self, message: can.Message) -> None:
        if message.is_error_frame or message.is_extended_id:
            return
        with self.lock:
            try:
                if not message.is_remote_frame:
                    self.notify(message.arbitration_id, message.data, message.timestamp)
                elif function := self._remote.get(message.arbitration_id):
                    function()
            # As canopen does: what one frame did wrong shall not end the receiving thread.
            except Exception:
                logger.exception("%s", message)


def open_bus(interface: str, channel: str, bit_rate: int | None) -> Bus:
    """Opens a bus and begins to receive. `bit_rate` is in bit/s; None leaves that of the interface.

    Raises `can.CanError`, `OSError` or `ValueError` when the interface cannot be opened so.
    """
    options: dict[str, object] = {} if bit_rate is None else {"bitrate": bit_rate}
    if interface == "slcan":
        # The default waits two seconds for an Arduino to start.
        options["sleep_after_open"] = 0
    bus = can.Bus(channel=channel, interface=interface, **options)
    port = getattr(bus, "serialPortOrig", None)
    if (plain_socket := getattr(port, "_socket", None)) is not None:
        # pyserial leaves Nagle's algorithm on, which holds an answer back for 40 ms.
        plain_socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    network = Bus(bus)
    network.connect()
    return network
