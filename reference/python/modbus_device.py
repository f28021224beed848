"""A reference device on pymodbus, which shares nothing with our own.

    modbus_device.py DEVICE --port /dev/ttyUSB0 [--baud 19200] [--parity N|E|O] [--stop-bits N] [--address N]
    modbus_device.py DEVICE --tcp HOST:PORT

Prints `ready` when it listens (with --tcp and port 0, `ready` and the port), and ends with 0 on SIGTERM or SIGINT,
with 1 when the port is gone.
"""

import argparse
import asyncio
import logging
import re
import signal
import sys
from pathlib import Path

from modbus_slave.devices import DEVICES
from modbus_slave.registers import read_map
from modbus_slave.server import SerialServer, TcpServer

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures" / "devices"
PARITIES = {"none": "N", "even": "E", "odd": "O"}
# The inverter's station behind the gateway is not in a `modbus:` line.
INVERTER = 1


def description(device: str) -> dict[str, str]:
    """Address, baud rate, parity and stop bits of the description of the device."""
    text = (FIXTURES / device / "device.yaml").read_text(encoding="utf-8")
    line = re.search(r"\{serial: (\d+), parity: (\w+), stop-bits: (\d)", text)
    address = re.search(r"^modbus: \{address: (\d+)", text, re.MULTILINE)
    return {
        "baud": line[1],
        "parity": PARITIES[line[2]],
        "stop_bits": line[3],
        "address": address[1] if address else str(INVERTER),
    }


def default_map(device: str) -> Path:
    """The register map beside that description."""
    folder = "teco-inverter" if device == "teco-jn5-cm-can" else device
    return FIXTURES / folder / "registers.yaml"


def arguments() -> argparse.Namespace:
    """What to be, and where."""
    parser = argparse.ArgumentParser(description="A reference device on pymodbus.")
    parser.add_argument("device", choices=sorted(DEVICES), help="teco-jn5-cm-can is the inverter behind the module")
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument("--port", help="a serial port or pseudo-terminal")
    where.add_argument("--tcp", metavar="HOST:PORT")
    parser.add_argument("--baud", type=int, help="in bit/s; these four are else those of the description")
    parser.add_argument("--parity", choices=sorted(PARITIES.values()))
    parser.add_argument("--stop-bits", type=int, choices=(1, 2))
    parser.add_argument("--address", type=int)
    parser.add_argument("--registers", type=Path, help="another map than the one in fixtures/devices")
    return parser.parse_args()


async def serve(options: argparse.Namespace) -> int:
    """Serves until told to end, or the port is gone."""
    known = description(options.device)
    registers = read_map(options.registers or default_map(options.device))
    store = DEVICES[options.device](registers, options.address or int(known["address"]))
    if options.tcp:
        host, port = options.tcp.rsplit(":", 1)
        server = TcpServer(store, host, int(port))
    else:
        baud = options.baud or int(known["baud"])
        server = SerialServer(
            store, options.port, baud, options.parity or known["parity"], options.stop_bits or int(known["stop_bits"])
        )
    ended = asyncio.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        asyncio.get_running_loop().add_signal_handler(number, ended.set)
    try:
        await server.serve_forever(background=True)
    except RuntimeError as error:
        print(f"{options.tcp or options.port}: {error}", file=sys.stderr)
        return 1
    listening = f" {server.transport.sockets[0].getsockname()[1]}" if options.tcp else ""
    print(f"ready{listening}", flush=True)
    waits = [asyncio.ensure_future(ended.wait())]
    if isinstance(server, SerialServer):
        waits.append(asyncio.ensure_future(server.disconnected.wait()))
    await asyncio.wait(waits, return_when=asyncio.FIRST_COMPLETED)
    for wait in waits:
        wait.cancel()
    if not ended.is_set():
        print(f"{options.port}: the port is gone", file=sys.stderr)
        return 1
    await server.shutdown()
    return 0


def main() -> int:
    """Runs until told to end."""
    logging.basicConfig(level=logging.WARNING, stream=sys.stderr)
    # Every refused request would be a line.
    logging.getLogger("pymodbus").setLevel(logging.ERROR)
    return asyncio.run(serve(arguments()))


if __name__ == "__main__":
    sys.exit(main())
