"""The NMT slave: canopen's states and heartbeat, with resets and node guarding added."""

import time
from typing import TYPE_CHECKING

import canopen.nmt

if TYPE_CHECKING:
    from .node import Node

START, STOP, ENTER_PRE_OPERATIONAL, RESET_NODE, RESET_COMMUNICATION = 1, 2, 128, 129, 130
INITIALISING, STOPPED, OPERATIONAL, PRE_OPERATIONAL = 0, 4, 5, 127


class NmtSlave(canopen.nmt.NmtSlave):
    """Obeys the five commands of CiA 301 and no others."""

    def __init__(self, node: "Node") -> None:
        super().__init__(node.id, node)
        self._toggle = 0

    @property
    def code(self) -> int:
        """The state as it is on the bus."""
        return self._state

    @property
    def guarded(self) -> bool:
        """Whether the device has node guarding: its guard time is in the EDS."""
        return 0x100C in self._local_node.object_dictionary

    def boot(self) -> None:
        """Initialising ends: the boot-up message, Pre-operational, the heartbeat if 1017h has a time."""
        self.state = "INITIALISING"
        self.state = "PRE-OPERATIONAL"
        if self.guarded:
            self.network.on_remote(0x700 + self.id, self._guard)

    def end(self) -> None:
        """No heartbeat and no answer to guarding any more."""
        self.stop_heartbeat()
        self.network.on_remote(0x700 + self.id, None)
        self._local_node.timers.cancel("life")

    def on_command(self, can_id: int, data: bytes, timestamp: float) -> None:
        """A command: byte 0 the specifier, byte 1 the node-ID, 0 for all."""
        if len(data) != 2 or data[1] not in (0, self.id):
            return
        if data[0] in (RESET_NODE, RESET_COMMUNICATION):
            self._local_node.reset(application=data[0] == RESET_NODE)
        elif data[0] in (START, STOP, ENTER_PRE_OPERATIONAL):
            before = self._state
            super().on_command(can_id, data, timestamp)
            if self._state != before:
                self._local_node.state_changed()

    def _guard(self) -> None:
        """A guard request: bits 6 to 0 are the state, bit 7 changes from answer to answer. The heartbeat excludes it."""
        if self._send_task is not None:
            return
        self.network.send_message(0x700 + self.id, [self._state | self._toggle])
        self._toggle ^= 0x80
        node = self._local_node
        node.clear_error(0x8130)
        life_ms = node.number(0x100C, 0) * node.number(0x100D, 0)
        if life_ms:
            node.timers.call_at("life", time.monotonic() + life_ms / 1000, self._life_ended)

    def _life_ended(self, _instant: float) -> None:
        self._local_node.emergency(0x8130, 0x10)
        if self._state == OPERATIONAL:
            self._state = PRE_OPERATIONAL
            self._local_node.state_changed()
