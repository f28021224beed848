"""A device: its memory, and the node that lives from one reset to the next."""

from pathlib import Path

import canopen
from canopen.objectdictionary import ObjectDictionary

from .behaviour import Behaviour
from .bus import Bus
from .lss import BIT_RATES, LssSlave
from .node import Node
from .timers import Timers

# Sub-indices of 1010h and 1011h, and the indices they are about.
AREAS = {1: (0x1000, 0x10000), 2: (0x1000, 0x2000), 3: (0x6000, 0xA000)}
DEFAULT_BIT_TIMING = 3


class Device:
    """One device on one bus."""

    def __init__(self, bus: Bus, eds: Path, node_id: int, behaviour: Behaviour) -> None:
        self.bus = bus
        self.behaviour = behaviour
        self.timers = Timers(bus.lock)
        # In force after the next reset.
        self.next_node_id = node_id
        self.bit_timing = DEFAULT_BIT_TIMING
        self._bit_timing_changes = False
        self.node: Node | None = None
        self._eds = eds
        self._dictionaries: dict[int, ObjectDictionary] = {}
        self._saved: dict[int, dict[int, bytes]] = {}
        self.lss = LssSlave(self) if behaviour.has_lss else None

    def power_on(self) -> None:
        """The first boot."""
        with self.bus.lock:
            self._boot({})

    def power_off(self) -> None:
        """The end."""
        with self.bus.lock:
            if self.node is not None:
                self.node.end()
        self.timers.end()

    def reset(self, application: bool) -> None:
        """All values are those after power-on; without `application`, those above 1FFFh stay as they are."""
        kept = {} if application else {index: subs for index, subs in self.node.data_store.items() if index >= 0x2000}
        if self._bit_timing_changes:
            self._bit_timing_changes = False
            self.bus.set_bit_rate(BIT_RATES[self.bit_timing])
        if self.lss is not None:
            self.lss.reset()
        self._boot(kept)

    def set_bit_timing(self, bit_timing: int) -> None:
        """The bit rate is that of `bit_timing`, an index of `BIT_RATES`, after the next reset."""
        self._bit_timing_changes = bit_timing != self.bit_timing
        self.bit_timing = bit_timing

    def save(self, area: int) -> None:
        """Stores the values of an area, as its sub-index of 1010h says."""
        first, end = AREAS[area]
        for index, members in self.node.data_store.items():
            if first <= index < end:
                self._keep(index, members)

    def save_by_itself(self, index: int) -> None:
        """Stores the values of one object."""
        self._keep(index, self.node.data_store.get(index, {}))

    def forget(self, area: int) -> None:
        """The defaults of an area are back after the next reset, as its sub-index of 1011h says."""
        first, end = AREAS[area]
        self._saved = {index: subs for index, subs in self._saved.items() if not first <= index < end}

    def _keep(self, index: int, members: dict[int, bytes]) -> None:
        for sub_index, data in members.items():
            if self.node.entry(index, sub_index).writable:
                self._saved.setdefault(index, {})[sub_index] = data

    def _boot(self, kept: dict[int, dict[int, bytes]]) -> None:
        if self.node is not None:
            self.node.end()
            del self.bus[self.node.id]
        node = Node(self.next_node_id, self._dictionary(self.next_node_id), self)
        for values in (self._saved, kept):
            for index, members in values.items():
                node.data_store.setdefault(index, {}).update(members)
        self.bus[node.id] = node
        self.node = node
        node.boot()

    def _dictionary(self, node_id: int) -> ObjectDictionary:
        """The EDS with the defaults of this node-ID. It takes some 10 ms to read, so it is read once for each."""
        if node_id not in self._dictionaries:
            self._dictionaries[node_id] = canopen.import_od(str(self._eds), node_id=node_id)
        return self._dictionaries[node_id]
