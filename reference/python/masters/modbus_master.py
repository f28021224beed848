"""pymodbus as the client of a device: does an independent stack get on with it?

    modbus_master.py DEVICE --port /dev/ttyUSB0 [--baud 19200] [--parity N|E|O] [--stop-bits N] [--address N]
    modbus_master.py DEVICE --tcp HOST:PORT [--address N]

What is written is put back. Prints a line for each check, and ends with 1 if one failed.
"""

import argparse
import logging
import sys
from pathlib import Path

from pymodbus import FramerType
from pymodbus.client import ModbusSerialClient, ModbusTcpClient
from pymodbus.exceptions import ModbusIOException

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from masters.checks import Checks
from modbus_device import default_map, description
from modbus_slave.registers import Register, read_map
from modbus_slave.server import is_pseudo_terminal

Client = ModbusSerialClient | ModbusTcpClient

# Registers that may be written without moving anything or losing the connection.
SAFE = {
    "huacheng-ssts1": [86, 113, 325, 326],
    "liaomiao-encoder": [0x000E, 0x000F],
    "teco-jn5-cm-can": [0x2502, 0x2505],
}
# What is answered to a value out of its range and to a register that there is not: the exception, or silence where the
# manual of the device shows no exceptions. The first is that of the Modbus application protocol.
SILENCE = "silence"
REFUSALS = {
    "huacheng-ssts1": ([3, 2], [2, 3]),
    "liaomiao-encoder": ([3, SILENCE], [2, SILENCE]),
    "teco-jn5-cm-can": ([3], [2]),
}


class Device:
    """A device at its address."""

    def __init__(self, client: Client, address: int) -> None:
        self._client = client
        self._address = address

    def read(self, address: int, count: int) -> list[int] | int | str:
        """The registers, the code of the exception, or silence."""
        return self._outcome(self._client.read_holding_registers, address, count=count)

    def write(self, address: int, values: list[int], multiple: bool) -> list[int] | int | str:
        """With function 10h, or 06h for one register."""
        if multiple:
            return self._outcome(self._client.write_registers, address, values)
        return self._outcome(self._client.write_register, address, values[0])

    def _outcome(self, function, *arguments, **options) -> list[int] | int | str:
        try:
            answer = function(*arguments, **options, device_id=self._address)
        except ModbusIOException:
            return SILENCE
        return answer.exception_code if answer.isError() else list(answer.registers)


def check_reads(device: Device, registers: list[Register], checks: Checks) -> None:
    """Every register that can be read, and that its value is in its range."""
    for register in registers:
        if register.readable:
            name = f"read {register.address:04X}"
            words = device.read(register.address, register.words)
            if not isinstance(words, list) or len(words) != register.words:
                checks.that(name, False, f"{words} came")
            else:
                value = register.decode(words)
                in_range = register.low <= value <= register.high
                checks.that(name, in_range, f"{value} is outside {register.low}..{register.high}")


def check_writes(device: Device, registers: list[Register], safe: list[int], refusals: list, checks: Checks) -> None:
    """A few registers: written with either function, read back, refused above their range, put back."""
    for register in registers:
        if register.address not in safe:
            continue
        before = device.read(register.address, 1)
        if not isinstance(before, list):
            checks.that(f"read {register.address:04X} before writing", False, f"{before} came")
            continue
        for value, multiple in ((register.high, False), (max(register.low, 1), True)):
            name = f"{'10' if multiple else '06'}h writes {value} to {register.address:04X}"
            words = register.encode(value)
            outcome = device.write(register.address, words, multiple)
            checks.that(name, isinstance(outcome, list), f"{outcome} came")
            checks.equal(f"{name}, read back", device.read(register.address, 1), words)
        if register.high < 0x7FFF:
            outcome = device.write(register.address, [register.high + 1], False)
            checks.that(f"{register.high + 1} to {register.address:04X}", outcome in refusals, f"{outcome} came")
            checks.equal(f"{register.address:04X} unchanged", device.read(register.address, 1), words)
        device.write(register.address, before, False)
        checks.equal(f"{register.address:04X} put back", device.read(register.address, 1), before)


def check_holes(device: Device, registers: list[Register], refusals: list, checks: Checks) -> None:
    """What is read where no register is."""
    taken = {register.address + word for register in registers for word in range(register.words)}
    holes = [register.address + register.words for register in registers]
    for hole in [*sorted(at for at in holes if at not in taken)[-3:], 0xFFF0]:
        outcome = device.read(hole, 1)
        checks.that(f"read {hole:04X}, where no register is", outcome in refusals, f"{outcome} came")


def arguments(given: list[str] | None) -> argparse.Namespace:
    """What to check, and where."""
    parser = argparse.ArgumentParser(description="pymodbus as the client of a device.")
    parser.add_argument("device", choices=sorted(SAFE), help="teco-jn5-cm-can is the inverter behind the module")
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument("--port", help="a serial port or pseudo-terminal")
    where.add_argument("--tcp", metavar="HOST:PORT")
    parser.add_argument("--baud", type=int, help="in bit/s; these four are else those of the description")
    parser.add_argument("--parity", choices=("N", "E", "O"))
    parser.add_argument("--stop-bits", type=int, choices=(1, 2))
    parser.add_argument("--address", type=int)
    parser.add_argument("--registers", type=Path, help="another map than the one in fixtures/devices")
    return parser.parse_args(given)


def connect(options: argparse.Namespace, known: dict[str, str]) -> Client:
    """A client that waits half a second for an answer, and asks once."""
    if options.tcp:
        host, port = options.tcp.rsplit(":", 1)
        return ModbusTcpClient(host, port=int(port), timeout=0.5, retries=0)
    parity = "N" if is_pseudo_terminal(options.port) else options.parity or known["parity"]
    return ModbusSerialClient(
        options.port,
        framer=FramerType.RTU,
        baudrate=options.baud or int(known["baud"]),
        parity=parity,
        stopbits=options.stop_bits or int(known["stop_bits"]),
        timeout=0.5,
        retries=0,
    )


def main(given: list[str] | None = None) -> int:
    """Makes every check."""
    logging.getLogger("pymodbus").setLevel(logging.CRITICAL)
    options, checks = arguments(given), Checks()
    known = description(options.device)
    registers = read_map(options.registers or default_map(options.device))
    client = connect(options, known)
    if not client.connect():
        checks.that("connection", False, f"none to {options.tcp or options.port}")
        return checks.exit_code()
    device = Device(client, options.address or int(known["address"]))
    value_refusals, address_refusals = REFUSALS[options.device]
    check_reads(device, registers, checks)
    check_writes(device, registers, SAFE[options.device], value_refusals, checks)
    check_holes(device, registers, address_refusals, checks)
    client.close()
    return checks.exit_code()


if __name__ == "__main__":
    sys.exit(main())
