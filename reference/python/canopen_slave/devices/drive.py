"""A servo drive: the state machine of CiA 402. Its motor stays where it is."""

from ..behaviour import Behaviour
from ..node import Node

# Bits 6, 5 and 3 to 0 of the status word, which name the state.
SWITCH_ON_DISABLED, READY_TO_SWITCH_ON, SWITCHED_ON, OPERATION_ENABLED, QUICK_STOP_ACTIVE = 0x40, 0x21, 0x23, 0x27, 0x07
VOLTAGE_ENABLED, REMOTE = 1 << 4, 1 << 9


def next_state(state: int, control_word: int) -> int:
    """The state after a control word.

    Bits of the control word: 0 switch on, 1 enable voltage, 2 quick stop (active low), 3 enable operation.
    """
    if not control_word & 0b0010:
        return SWITCH_ON_DISABLED
    if not control_word & 0b0100:
        stops = state in (OPERATION_ENABLED, QUICK_STOP_ACTIVE)
        return QUICK_STOP_ACTIVE if stops else SWITCH_ON_DISABLED
    if state == QUICK_STOP_ACTIVE:
        return OPERATION_ENABLED if control_word & 0b1001 == 0b1001 else state
    if not control_word & 0b0001:
        return READY_TO_SWITCH_ON
    if state == SWITCH_ON_DISABLED:
        return state
    if control_word & 0b1000 and state in (SWITCHED_ON, OPERATION_ENABLED):
        return OPERATION_ENABLED
    return SWITCHED_ON


class Drive(Behaviour):
    """The Kinco servo drive."""

    def __init__(self) -> None:
        self._state = SWITCH_ON_DISABLED

    def booted(self, node: Node) -> None:
        """The drive is disabled, in the mode of operation that 6060h has."""
        self._show(node, SWITCH_ON_DISABLED)
        node.put(0x6061, 0, node.number(0x6060, 0))

    def written(self, node: Node, index: int, sub_index: int, value: int) -> None:
        """Follows the control word and the mode of operation."""
        if index == 0x6040:
            self._show(node, next_state(self._state, value))
        elif index == 0x6060:
            node.put(0x6061, 0, value)

    def _show(self, node: Node, state: int) -> None:
        self._state = state
        node.put(0x6041, 0, state | VOLTAGE_ENABLED | REMOTE)


class SyncingDrive(Drive):
    """The Huacheng servo drive, which can be the one that sends SYNC."""

    produces_sync = True
