"""The holding registers of a register map: `registers.yaml` beside the description of a device."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

# Signed, and how many registers: the types of a map that are whole numbers.
TYPES = {"u16": (False, 1), "i16": (True, 1), "u32": (False, 2), "i32": (True, 2)}


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
    """The holding registers of a map, in address order. Raises `ValueError` for a file that is none."""
    try:
        ranges = yaml.safe_load(path.read_text(encoding="utf-8"))["holding"]["ranges"]
        registers = [register for entry in ranges for register in _registers(entry)]
    except (KeyError, TypeError, yaml.YAMLError) as error:
        raise ValueError(f"{path}: {error}") from error
    return sorted(registers, key=lambda register: register.address)


def _registers(entry: dict[str, Any]) -> Iterator[Register]:
    signed, words = TYPES[entry.get("type", "u16")]
    bits = 16 * words
    lowest, highest = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
    for number in range(entry.get("count", 1)):
        yield Register(
            address=entry["address"] + number * words,
            readable="r" in entry["access"],
            writable="w" in entry["access"],
            signed=signed,
            words=words,
            low=entry.get("low", lowest),
            high=entry.get("high", highest),
            default=entry.get("default"),
            name=entry["name"],
        )
