"""The devices, by the names of their folders: what each does beyond its register map."""

from pymodbus.constants import ExcCodes

from .registers import Register
from .store import WRITE_MULTIPLE, Store

# The encoder takes a new address from whoever writes these two registers and `:` to registers 1 to 3 at address FFh.
ADDRESS_COMMAND = [int.from_bytes(b"ad", "big"), int.from_bytes(b"dr", "big")]
COMMAND_ADDRESS = 0xFF


class Encoder(Store):
    """The Liaomiao encoder. Its shaft is at rest; the baud rate is held and not taken into force."""

    VERSION, ADDRESS, POSITION_HIGH, POSITION_LOW, SET_ANGLE, ANGLE = 0x00, 0x01, 0x02, 0x03, 0x07, 0x0B
    PRESET_HIGH, PRESET_LOW, RESTORE = 0x12, 0x13, 0x16

    def __init__(self, registers: list[Register], address: int) -> None:
        super().__init__(registers, address)
        self._defaults = {register.address: register.default for register in registers if register.default is not None}
        self.put(self.ADDRESS, address)
        self.put(self.VERSION, 4020)

    async def async_setValues(self, device_id: int, func_code: int, address: int, values: list[int]) -> ExcCodes | None:
        """The address is changed by a command to FFh."""
        if device_id != COMMAND_ADDRESS or self.any_address:
            return await super().async_setValues(device_id, func_code, address, values)
        new = values[2] & 0xFF if len(values) == 3 else 0
        asked = func_code == WRITE_MULTIPLE and address == self.ADDRESS and values[:2] == ADDRESS_COMMAND
        if not asked or values[2] >> 8 != ord(":") or not 1 <= new <= 247:
            # Not for this slave.
            self._check_address(device_id)
        self.address = new
        self.put(self.ADDRESS, new)
        return None

    def written(self, address: int) -> None:
        """Does what a write asks for."""
        value = self.get(address)
        if address == self.ADDRESS:
            self.address = value
        elif address == self.SET_ANGLE:
            self.put(self.POSITION_LOW, value)
        elif address == self.PRESET_HIGH:
            self.put(self.POSITION_HIGH, value)
        elif address == self.PRESET_LOW:
            self.put(self.POSITION_LOW, value)
        elif address == self.RESTORE and value == 1:
            for place, default in self._defaults.items():
                if place != self.ADDRESS:
                    self.put(place, default)
        self.put(self.ANGLE, self.get(self.POSITION_LOW))


class Servo(Store):
    """The Huacheng servo drive, whose manual has exception 02 for a value."""

    value_exception = ExcCodes.ILLEGAL_ADDRESS


class Inverter(Store):
    """The TECO A510: its state and frequencies follow the two commands."""

    OPERATION, FREQUENCY, STATE, IN_FORCE, OUTPUT = 0x2501, 0x2502, 0x2520, 0x2523, 0x2524
    RUN, REVERSE, READY = 1 << 0, 1 << 1, 1 << 2
    MODEL, A510 = 0x252F, 300

    def __init__(self, registers: list[Register], address: int) -> None:
        super().__init__(registers, address)
        self.put(self.MODEL, self.A510)
        self.written(self.OPERATION)

    def written(self, address: int) -> None:
        """A command is obeyed at once, without a ramp."""
        signal, frequency = self.get(self.OPERATION), self.get(self.FREQUENCY)
        runs = signal & self.RUN
        self.put(self.STATE, self.READY | (signal & (self.RUN | self.REVERSE) if runs else 0))
        self.put(self.IN_FORCE, frequency)
        self.put(self.OUTPUT, frequency if runs else 0)


DEVICES: dict[str, type[Store]] = {
    "huacheng-ssts1": Servo,
    "liaomiao-encoder": Encoder,
    "teco-jn5-cm-can": Inverter,
}
