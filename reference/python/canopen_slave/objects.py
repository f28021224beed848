"""What CiA 301 asks of the values of communication objects, beyond the limits in an EDS."""

from typing import TYPE_CHECKING

from canopen.sdo import SdoAbortedError

from . import abort

if TYPE_CHECKING:
    from .node import Node

INVALID = 1 << 31
EXTENDED = 1 << 29
GENERATE_SYNC = 1 << 30
SIGNATURES = {0x1010: 0x65766173, 0x1011: 0x64616F6C}
# First and last identifiers that no PDO, SYNC or EMCY may have.
RESTRICTED = ((0x000, 0x07F), (0x101, 0x180), (0x581, 0x5FF), (0x601, 0x67F), (0x6E0, 0x6FF), (0x701, 0x7FF))


def check(node: "Node", index: int, sub_index: int, value: int) -> None:
    """Refuses a value that the object cannot have, or cannot have now."""
    if index == 0x1003 and sub_index == 0 and value != 0:
        abort.refuse(abort.VALUE)
    elif index == 0x1005:
        _check_sync(node, value)
    elif index in SIGNATURES and sub_index:
        if not node.number(index, sub_index) & 1 or value != SIGNATURES[index]:
            abort.refuse(abort.CANNOT_STORE)
    elif index in range(0x1400, 0x1600) or index in range(0x1800, 0x1A00):
        if sub_index == 1:
            _check_cob_id(node, index, value)
        elif sub_index == 2:
            _check_transmission_type(value)
    elif index in range(0x1600, 0x1800) or index in range(0x1A00, 0x1C00):
        _check_mapping(node, index, sub_index, value)


def _check_sync(node: "Node", value: int) -> None:
    """Bits 10 to 0 the identifier, bit 29 an extended one, bit 30 whether the node sends SYNC."""
    if value & EXTENDED or value & GENERATE_SYNC and not node.behaviour.produces_sync:
        abort.refuse(abort.VALUE)


def _check_cob_id(node: "Node", index: int, value: int) -> None:
    """Bits 10 to 0 the identifier, bit 29 an extended one, bit 31 whether the PDO is out of force."""
    if value & EXTENDED:
        abort.refuse(abort.VALUE)
    if value & INVALID:
        return
    identifier = value & 0x7FF
    if any(first <= identifier <= last for first, last in RESTRICTED):
        abort.refuse(abort.VALUE)
    before = node.number(index, 1)
    if not before & INVALID and before & 0x7FF != identifier:
        abort.refuse(abort.VALUE)


def _check_transmission_type(value: int) -> None:
    """241 to 251 are reserved; 252 and 253 are for remote frames, which the slave does not answer with PDOs."""
    if 241 <= value <= 253:
        abort.refuse(abort.VALUE)


def _check_mapping(node: "Node", index: int, sub_index: int, value: int) -> None:
    """An entry is index (31 to 16), sub-index (15 to 8), bits (7 to 0); sub-index 0 counts those in force."""
    if not node.number(index - 0x200, 1) & INVALID:
        abort.refuse(abort.DEVICE_STATE)
    if sub_index:
        if node.number(index, 0):
            abort.refuse(abort.DEVICE_STATE)
        if value:
            _check_mapped(node, index, value)
        return
    entries = [node.number(index, sub) for sub in range(1, value + 1)]
    for entry in entries:
        _check_mapped(node, index, entry)
    if sum(entry & 0xFF for entry in entries) > 64:
        abort.refuse(abort.MAPPING_TOO_LONG)


def _check_mapped(node: "Node", index: int, value: int) -> None:
    try:
        entry = node.entry(value >> 16, value >> 8 & 0xFF)
    except SdoAbortedError:
        abort.refuse(abort.NO_OBJECT)
    allowed = entry.readable if index >= 0x1A00 else entry.writable
    if not entry.pdo_mappable or not allowed or len(entry) != value & 0xFF:
        abort.refuse(abort.NOT_MAPPABLE)
