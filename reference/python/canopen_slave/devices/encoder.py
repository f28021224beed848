"""The Liaomiao encoder. Its shaft is at rest."""

from .. import abort
from ..behaviour import Behaviour
from ..node import Node

SAME_PERIOD = ((0x6200, 0), (0x1800, 5))
PRESET = 0x6003
NODE_ID, BIT_RATE = 0x3000, 0x3001


class Encoder(Behaviour):
    """Saves by itself, has LSS, and one period for TPDO1 in two objects."""

    has_lss = True
    saved_by_itself = frozenset({0x2002, 0x2003, 0x2004, 0x2005, 0x6000, 0x6003, 0x6200})

    def booted(self, node: Node) -> None:
        """What other objects say again."""
        node.put(NODE_ID, 0, node.id)
        node.put(BIT_RATE, 0, node.device.bit_timing)
        node.put(0x6004, 0, node.number(PRESET, 0))
        node.put(0x6500, 0, node.number(0x6000, 0) & 1)
        node.put(0x1800, 5, node.number(0x6200, 0))
        node.reconfigure(0x1800)

    def check(self, node: Node, index: int, sub_index: int, value: int) -> None:
        """6000h has one bit, 2002h cannot say more than 2001h."""
        if index == 0x6000 and value > 1 or index == 0x2002 and value > node.number(0x2001, 0):
            abort.refuse(abort.VALUE)
        if (index, sub_index) == (0x1800, 5) and value == 0:
            abort.refuse(abort.VALUE)

    def written(self, node: Node, index: int, sub_index: int, value: int) -> None:
        """Does what a write asks for."""
        if (index, sub_index) in SAME_PERIOD:
            for other, sub in SAME_PERIOD:
                node.put(other, sub, value)
            node.reconfigure(0x1800)
            node.device.save_by_itself(0x6200)
        elif index == NODE_ID:
            node.device.next_node_id = value
        elif index == BIT_RATE:
            node.device.set_bit_timing(value)
        elif index == 0x6000:
            node.put(0x6500, 0, value & 1)
            node.put(0x2000, 0, -node.number(0x2000, 0))
        elif index == PRESET:
            node.put(0x6004, 0, value)
        if index in self.saved_by_itself:
            node.device.save_by_itself(index)
