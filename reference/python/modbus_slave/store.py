"""The registers of a slave, in the place of pymodbus' data store, which has neither access nor limits nor addresses."""

from pymodbus.constants import ExcCodes
from pymodbus.exceptions import NoSuchIdException

from .registers import Register

READ, WRITE_SINGLE, WRITE_MULTIPLE = 3, 6, 16


class Store:
    """The values of a map, and the address that they answer at."""

    # The exception for a value out of its range.
    value_exception = ExcCodes.ILLEGAL_VALUE

    def __init__(self, registers: list[Register], address: int) -> None:
        self.address = address
        # On TCP there is one device behind the connection, whatever the unit identifier says.
        self.any_address = False
        self._owner = {register.address + word: register for register in registers for word in range(register.words)}
        self._words: dict[int, int] = {}
        for register in registers:
            self.put(register.address, register.start)

    def put(self, address: int, value: int) -> None:
        """Sets the value that begins at `address`, from inside."""
        for offset, word in enumerate(self._owner[address].encode(value)):
            self._words[address + offset] = word

    def get(self, address: int) -> int:
        """The value that begins at `address`."""
        register = self._owner[address]
        return register.decode([self._words[address + word] for word in range(register.words)])

    def written(self, address: int) -> None:
        """A value, which begins at `address`, was written from the bus."""

    # What pymodbus asks of a data store.

    def device_ids(self) -> list[int]:
        """Whom a broadcast is for."""
        return [self.address]

    async def async_getValues(
        self, device_id: int, func_code: int, address: int, count: int = 1
    ) -> list[int] | ExcCodes:
        """Reads `count` registers."""
        self._check_address(device_id)
        if func_code != READ:
            return ExcCodes.ILLEGAL_FUNCTION
        asked = range(address, address + count)
        if any(at not in self._owner or not self._owner[at].readable for at in asked):
            return ExcCodes.ILLEGAL_ADDRESS
        return [self._words[at] for at in asked]

    async def async_setValues(self, device_id: int, func_code: int, address: int, values: list[int]) -> ExcCodes | None:
        """Writes registers, all of them or, with an exception, none."""
        self._check_address(device_id)
        if func_code not in (WRITE_SINGLE, WRITE_MULTIPLE):
            return ExcCodes.ILLEGAL_FUNCTION
        new = {address + offset: value for offset, value in enumerate(values)}
        if any(at not in self._owner or not self._owner[at].writable for at in new):
            return ExcCodes.ILLEGAL_ADDRESS
        changed = {self._owner[at].address: self._owner[at] for at in new}
        for register in changed.values():
            places = range(register.address, register.address + register.words)
            value = register.decode([new.get(at, self._words[at]) for at in places])
            if not register.low <= value <= register.high:
                return self.value_exception
        self._words.update(new)
        for start in changed:
            self.written(start)
        return None

    def _check_address(self, device_id: int) -> None:
        if device_id != self.address and not self.any_address:
            raise NoSuchIdException(str(device_id))
