"""Register maps: one register a line, eight columns apart by `|`, comments after `#`.

address | access (r, w, rw) | type (u16, i16, u32, i32) | range (low..high or -) | default or - | unit | persists | name
"""

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Register:
    """One value of a map."""

    # Of its first register in the PDU.
    address: int
    readable: bool
    writable: bool
    signed: bool
    # How many registers it takes: 1, or 2 with the high word first.
    words: int
    low: int
    high: int
    default: int | None
    name: str

    def encode(self, value: int) -> list[int]:
        """The registers of a value."""
        data = value.to_bytes(2 * self.words, "big", signed=self.signed)
        return [int.from_bytes(data[at : at + 2], "big") for at in range(0, len(data), 2)]

    def decode(self, words: list[int]) -> int:
        """The value of its registers."""
        return int.from_bytes(b"".join(word.to_bytes(2, "big") for word in words), "big", signed=self.signed)

    @property
    def start(self) -> int:
        """A value within its range: the default, or else the one nearest to 0."""
        return max(self.low, min(0, self.high)) if self.default is None else self.default


def read_map(path: Path) -> list[Register]:
    """The registers of a map, in address order. Raises `ValueError` for a line that is none."""
    registers: list[Register] = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        if text := line.split("#")[0].strip():
            try:
                registers.append(_register(text))
            except (KeyError, ValueError) as error:
                raise ValueError(f"{path}:{number}: {error}") from error
    return sorted(registers, key=lambda register: register.address)


def _register(text: str) -> Register:
    address, access, kind, span, default, _unit, _persists, name = (column.strip() for column in text.split("|"))
    signed, words = {"u16": (False, 1), "i16": (True, 1), "u32": (False, 2), "i32": (True, 2)}[kind]
    bits = 16 * words
    low, high = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
    if span != "-":
        low, high = (int(limit, 0) for limit in span.split(".."))
    if access not in ("r", "w", "rw"):
        raise ValueError(f"`{access}` is no access")
    return Register(
        address=int(address, 0),
        readable="r" in access,
        writable="w" in access,
        signed=signed,
        words=words,
        low=low,
        high=high,
        default=None if default == "-" else int(default, 0),
        name=name,
    )
