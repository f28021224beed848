"""The CAN side of the TECO JN5-CM-CAN, with the inverter behind it held as numbers: no serial line is driven."""

from .. import abort
from ..behaviour import Behaviour
from ..node import Node

REGISTERS = 0x2025
OPERATION, FREQUENCY = 0x02, 0x03
STATE, ERROR, FREQUENCY_IN_FORCE, OUTPUT_FREQUENCY, MODEL = 0x21, 0x22, 0x24, 0x25, 0x30
RUN, REVERSE, EXTERNAL_FAULT, RESET = 1 << 0, 1 << 1, 1 << 2, 1 << 3
READY, FAULT = 1 << 2, 1 << 3
CONTROL_WORD, TARGET, DEMAND, ERROR_CODE = 0x6040, 0x6042, 0x6043, 0x603F
FAULT_RESET, BACKWARDS = 1 << 7, 1 << 15
# Counts of 0.02 Hz in bits 14 to 0 of 6042h; register 2502h counts 0.01 Hz.
HIGHEST_TARGET = 20_000
A510 = 300
# What 2521h reads for an external fault is not sure; any other than 0 is a fault.
EXTERNAL = 17


class Gateway(Behaviour):
    """6040h, 6042h and 6043h are the registers of 2025h in other words."""

    def booted(self, node: Node) -> None:
        """An A510, at rest and ready."""
        node.put(REGISTERS, MODEL, A510)
        self._run(node)

    def check(self, node: Node, index: int, sub_index: int, value: int) -> None:
        """The inverter does not take more than 400 Hz."""
        if index == TARGET and value & ~BACKWARDS & 0xFFFF > HIGHEST_TARGET:
            abort.refuse(abort.TOO_HIGH)

    def written(self, node: Node, index: int, sub_index: int, value: int) -> None:
        """Passes a value on to the registers."""
        if index == TARGET:
            node.put(REGISTERS, FREQUENCY, 2 * (value & ~BACKWARDS & 0xFFFF))
            node.put(DEMAND, 0, value)
            self._operate(node)
        elif index == CONTROL_WORD:
            if value & FAULT_RESET and not node.number(REGISTERS, OPERATION) & EXTERNAL_FAULT:
                node.put(REGISTERS, ERROR, 0)
                node.put(ERROR_CODE, 0, 0)
            self._operate(node)
        elif (index, sub_index) == (REGISTERS, OPERATION) and value & EXTERNAL_FAULT:
            node.put(REGISTERS, ERROR, EXTERNAL)
            node.put(ERROR_CODE, 0, 0xFF00 | EXTERNAL)
        elif (index, sub_index) == (REGISTERS, OPERATION) and value & RESET:
            node.put(REGISTERS, ERROR, 0)
            node.put(ERROR_CODE, 0, 0)
        self._run(node)

    def _operate(self, node: Node) -> None:
        """The operation signal of the control word and the sign of the target."""
        signal = RUN if node.number(CONTROL_WORD, 0) & 1 else 0
        if signal and node.number(TARGET, 0) & BACKWARDS:
            signal |= REVERSE
        node.put(REGISTERS, OPERATION, signal)

    def _run(self, node: Node) -> None:
        """What the inverter shows of its state."""
        signal, fault = node.number(REGISTERS, OPERATION), node.number(REGISTERS, ERROR)
        runs = signal & RUN and not fault
        frequency = node.number(REGISTERS, FREQUENCY)
        node.put(REGISTERS, STATE, (signal & (RUN | REVERSE) if runs else 0) | (FAULT if fault else READY))
        node.put(REGISTERS, FREQUENCY_IN_FORCE, frequency)
        node.put(REGISTERS, OUTPUT_FREQUENCY, frequency if runs else 0)
