"""PDOs: canopen reads and packs the mapping; when they go, and whether they come, is decided here."""

import time
from typing import TYPE_CHECKING

from canopen.pdo import PdoMap
from canopen.sdo import SdoAbortedError

if TYPE_CHECKING:
    from .node import Node


def _configure(map_: PdoMap) -> None:
    """Reads the parameters anew. canopen forgets the identifier that it listened to before."""
    network = map_.pdo_node.network
    if map_.cob_id in network.subscribers and map_.on_message in network.subscribers[map_.cob_id]:
        network.unsubscribe(map_.cob_id, map_.on_message)
    map_.read()


class TransmitPdo:
    """Sent with SYNC (types 0 to 240), or on change and by its timer (254 and 255)."""

    def __init__(self, node: "Node", map_: PdoMap) -> None:
        self.node = node
        self.map = map_
        self._syncs = 0
        self._changed = False
        self.configure()

    def configure(self) -> None:
        """Takes over what was written to 18xxh or 1Axxh."""
        _configure(self.map)
        if self.map.enabled:
            self.node.network.unsubscribe(self.map.cob_id, self.map.on_message)
        self._syncs = 0
        self.stop()
        if self.node.operational:
            self._start_timer(time.monotonic())

    def start(self) -> None:
        """The node is operational."""
        self._syncs = 0
        self._changed = True
        if self._event_driven:
            self._fire(time.monotonic())

    def stop(self) -> None:
        """The node is not operational any more, or the PDO is set up anew."""
        self.node.timers.cancel(("event", id(self)))
        self.node.timers.cancel(("inhibit", id(self)))
        self._changed = False

    def sync(self) -> None:
        """A SYNC came."""
        if not self._valid or self.map.trans_type > 240:
            return
        self._syncs += 1
        if self.map.trans_type == 0:
            due = self._changed
        else:
            due = self._syncs >= self.map.trans_type
        if due:
            self._syncs = 0
            self._changed = False
            self._send()

    def value_changed(self, index: int, sub_index: int) -> None:
        """The value of an entry is another than before."""
        if any((variable.index, variable.subindex) == (index, sub_index) for variable in self.map.map):
            self._changed = True
            if self._event_driven:
                self._fire(time.monotonic())

    @property
    def _valid(self) -> bool:
        return self.node.operational and self.map.enabled and bool(self.map.map)

    @property
    def _event_driven(self) -> bool:
        return self._valid and self.map.trans_type >= 254

    def _fire(self, instant: float) -> None:
        """Sends, or waits until the inhibit time (in 100 us) is over."""
        key = ("inhibit", id(self))
        if not self._event_driven:
            return
        if self.node.timers.pending(key):
            self._changed = True
            return
        self._changed = False
        self._send()
        if self.map.inhibit_time:
            self.node.timers.call_at(key, instant + self.map.inhibit_time / 10_000, self._inhibit_ended)
        self._start_timer(instant)

    def _inhibit_ended(self, instant: float) -> None:
        if self._changed:
            self._fire(instant)

    def _start_timer(self, instant: float) -> None:
        """The event timer, in ms, counts from one PDO to the next."""
        if self._event_driven and self.map.event_timer:
            self.node.timers.call_at(("event", id(self)), instant + self.map.event_timer / 1000, self._fire)

    def _send(self) -> None:
        for variable in self.map.map:
            variable.set_data(self.node.get_data(variable.index, variable.subindex))
        self.map.transmit()


class ReceivePdo:
    """Takes effect at once (254 and 255), or with the next SYNC."""

    def __init__(self, node: "Node", map_: PdoMap) -> None:
        self.node = node
        self.map = map_
        self._waiting: bytes | None = None
        map_.add_callback(self._received)
        self.configure()

    def configure(self) -> None:
        """Takes over what was written to 14xxh or 16xxh."""
        _configure(self.map)
        self._waiting = None

    def sync(self) -> None:
        """A SYNC came."""
        if self._waiting is not None:
            data, self._waiting = self._waiting, None
            self._apply(data)

    def stop(self) -> None:
        """The node is not operational any more."""
        self._waiting = None

    def _received(self, map_: PdoMap) -> None:
        if not self.node.operational or not map_.enabled or not map_.map:
            return
        if len(map_.data) < map_.length // 8:
            self.node.emergency(0x8210, 0x10)
            return
        self.node.clear_error(0x8210)
        if map_.trans_type <= 240:
            self._waiting = bytes(map_.data)
        else:
            self._apply(bytes(map_.data))

    def _apply(self, data: bytes) -> None:
        self.map.data = bytearray(data)
        for variable in self.map.map:
            try:
                self.node.set_data(variable.index, variable.subindex, bytes(variable.get_data()), check_writable=True)
            except SdoAbortedError:
                # A value out of its limits: there is nobody to tell.
                continue
