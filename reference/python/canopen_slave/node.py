"""The node: canopen's LocalNode, from one reset to the next."""

from typing import TYPE_CHECKING

from canopen import LocalNode
from canopen.objectdictionary import INTEGER_TYPES, ObjectDictionary, ODVariable
from canopen.sdo import SdoAbortedError

from . import abort, nmt, objects, rules
from .pdo import ReceivePdo, TransmitPdo
from .sdo import Server
from .timers import Timers

if TYPE_CHECKING:
    from .behaviour import Behaviour
    from .device import Device


class Node(LocalNode):
    """A node with the values of its dictionary, its NMT state and its PDOs."""

    def __init__(self, node_id: int, dictionary: ObjectDictionary, device: "Device") -> None:
        super().__init__(node_id, dictionary)
        self.device = device
        self.sdo = Server(self)
        self._write_callbacks.clear()
        self.nmt = nmt.NmtSlave(self)
        self.add_write_callback(self.nmt.on_write)
        self._transmit: list[TransmitPdo] = []
        self._receive: list[ReceivePdo] = []
        self._sync_id: int | None = None
        self._sends_sync = False
        self._errors: list[int] = []

    # What the rest of the slave asks.

    @property
    def timers(self) -> Timers:
        """The timers of the device."""
        return self.device.timers

    @property
    def behaviour(self) -> "Behaviour":
        """What the device does beyond its dictionary."""
        return self.device.behaviour

    @property
    def operational(self) -> bool:
        """Whether PDOs come and go."""
        return self.nmt.code == nmt.OPERATIONAL

    @property
    def serves_sdo(self) -> bool:
        """Whether SDO requests are answered."""
        return self.nmt.code in (nmt.OPERATIONAL, nmt.PRE_OPERATIONAL)

    # Life.

    def boot(self) -> None:
        """From the reset to Pre-operational."""
        self._transmit = [TransmitPdo(self, map_) for map_ in self.tpdo.map.values()]
        self._receive = [ReceivePdo(self, map_) for map_ in self.rpdo.map.values()]
        self._follow_sync()
        self._follow_emcy()
        self.behaviour.booted(self)
        self.nmt.boot()

    def end(self) -> None:
        """The node falls silent and hears nothing any more."""
        self.nmt.end()
        self._stop_sync()
        for pdo in [*self._transmit, *self._receive]:
            pdo.stop()
            identifier, callback = pdo.map.cob_id, pdo.map.on_message
            if callback in self.network.subscribers.get(identifier, []):
                self.network.unsubscribe(identifier, callback)
        self._unsubscribe_sync()

    def reset(self, application: bool) -> None:
        """NMT reset node, or reset communication."""
        self.device.reset(application)

    def state_changed(self) -> None:
        """The NMT state is another."""
        for pdo in [*self._transmit, *self._receive]:
            if not self.operational:
                pdo.stop()
            elif isinstance(pdo, TransmitPdo):
                pdo.start()

    # Entries and their values.

    def entry(self, index: int, sub_index: int) -> ODVariable:
        """The entry of the EDS; aborts if there is none."""
        return self._find_object(index, sub_index)

    def number(self, index: int, sub_index: int) -> int:
        """The value of an entry that is a number."""
        return self.entry(index, sub_index).decode_raw(self.get_data(index, sub_index))

    def put(self, index: int, sub_index: int, value: int) -> None:
        """Sets the value of an entry from inside, whatever its access is; nothing happens if it is not there."""
        try:
            entry = self.entry(index, sub_index)
        except SdoAbortedError:
            return
        if value != self.number(index, sub_index):
            super().set_data(index, sub_index, entry.encode_raw(value))
            self._changed(index, sub_index)

    def get_data(self, index: int, subindex: int, check_readable: bool = False) -> bytes:
        """The bytes of an entry. One without a default in the EDS begins with 0."""
        try:
            return super().get_data(index, subindex, check_readable)
        except SdoAbortedError as error:
            entry = self.entry(index, subindex)
            if error.code != 0x060A0023 or entry.data_type not in INTEGER_TYPES:
                raise
            return bytes(len(entry) // 8)

    def set_data(self, index: int, subindex: int, data: bytes, check_writable: bool = False) -> None:
        """Writes an entry; `check_writable` says that it comes from the bus and must keep to the rules."""
        entry = self.entry(index, subindex)
        if check_writable:
            rules.check_access(entry)
            rules.check_length(entry, len(data))
            rules.check_limits(entry, data)
        if entry.data_type not in INTEGER_TYPES:
            super().set_data(index, subindex, data)
            return
        value = entry.decode_raw(data)
        if check_writable:
            objects.check(self, index, subindex, value)
            self.behaviour.check(self, index, subindex, value)
        if index in objects.SIGNATURES and subindex:
            (self.device.save if index == 0x1010 else self.device.forget)(subindex)
            return
        before = self.get_data(index, subindex)
        super().set_data(index, subindex, data)
        self._written(index, subindex, value)
        if bytes(data) != before:
            self._changed(index, subindex)

    def _find_object(self, index: int, subindex: int) -> ODVariable:
        """canopen has every sub-index of a VAR, and 255 of an ARRAY."""
        thing = self.object_dictionary.indices.get(index)
        if thing is None:
            abort.refuse(abort.NO_OBJECT)
        members = {0: thing} if isinstance(thing, ODVariable) else thing.subindices
        if subindex not in members:
            abort.refuse(abort.NO_SUB_INDEX)
        return members[subindex]

    def _written(self, index: int, sub_index: int, value: int) -> None:
        """A download, or an RPDO, wrote the entry."""
        if index == 0x1003 and sub_index == 0:
            self._write_history([])
        elif index in (0x1005, 0x1006):
            self._follow_sync()
        elif index == 0x1014:
            self._follow_emcy()
        elif 0x1400 <= index < 0x1C00:
            self.reconfigure(index)
        self.behaviour.written(self, index, sub_index, value)

    def _changed(self, index: int, sub_index: int) -> None:
        for pdo in self._transmit:
            pdo.value_changed(index, sub_index)

    def reconfigure(self, index: int) -> None:
        """The PDO that `index` is a parameter of is set up anew."""
        for pdo in [*self._transmit, *self._receive]:
            if index in (pdo.map.com_record.od.index, pdo.map.map_array.od.index):
                pdo.configure()

    # SYNC and EMCY.

    def _follow_sync(self) -> None:
        """Listens for SYNC as 1005h says, and sends it every 1006h microseconds if bit 30 of 1005h is set."""
        self._unsubscribe_sync()
        self._stop_sync()
        if 0x1005 not in self.object_dictionary:
            return
        cob_id = self.number(0x1005, 0)
        self._sync_id = cob_id & 0x7FF
        self.network.subscribe(self._sync_id, self._on_sync)
        period_us = self.number(0x1006, 0) if 0x1006 in self.object_dictionary else 0
        if cob_id & objects.GENERATE_SYNC and period_us:
            self.network.sync.cob_id = self._sync_id
            self.network.sync.start(period_us / 1_000_000)
            self._sends_sync = True

    def _stop_sync(self) -> None:
        # The library keeps a task that has ended, and the kernel refuses to end one twice.
        if self._sends_sync:
            self._sends_sync = False
            self.network.sync.stop()

    def _unsubscribe_sync(self) -> None:
        if self._sync_id is not None:
            self.network.unsubscribe(self._sync_id, self._on_sync)
            self._sync_id = None

    def _on_sync(self, _can_id: int, _data: bytes, _timestamp: float) -> None:
        if self.operational:
            # What TPDOs carry was sampled at this SYNC; what RPDOs bring counts from it on.
            for pdo in [*self._transmit, *self._receive]:
                pdo.sync()

    def _follow_emcy(self) -> None:
        if 0x1014 in self.object_dictionary:
            self.emcy.cob_id = self.number(0x1014, 0) & 0x7FF

    def emergency(self, code: int, register: int) -> None:
        """An error appears: 1001h, 1003h and EMCY. `register` has the bits of 1001h for it beside bit 0."""
        if code in self._errors:
            return
        self._errors.append(code)
        self.put(0x1001, 0, register | 0x01)
        self._write_history([code, *self._history()])
        self._send_emcy(code)

    def clear_error(self, code: int) -> None:
        """An error is gone: 1001h and, when it was the last, EMCY 0000h."""
        if code not in self._errors:
            return
        self._errors.remove(code)
        if not self._errors:
            self.put(0x1001, 0, 0)
            self._send_emcy(0)

    def _send_emcy(self, code: int) -> None:
        present = 0x1014 in self.object_dictionary and not self.number(0x1014, 0) & objects.INVALID
        if present and self.serves_sdo:
            self.emcy.send(code, self.number(0x1001, 0))

    def _history(self) -> list[int]:
        if 0x1003 not in self.object_dictionary:
            return []
        return [self.number(0x1003, sub) for sub in range(1, self.number(0x1003, 0) + 1)]

    def _write_history(self, errors: list[int]) -> None:
        """1003h: the number of errors, then the errors, the newest first."""
        if 0x1003 not in self.object_dictionary:
            return
        room = max(self.object_dictionary[0x1003].subindices)
        errors = errors[:room]
        for sub, error in enumerate(errors, start=1):
            self.put(0x1003, sub, error)
        for sub in range(len(errors) + 1, room + 1):
            self.put(0x1003, sub, 0)
        self.put(0x1003, 0, len(errors))
