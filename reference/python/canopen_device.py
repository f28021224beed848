"""A reference device on python-can and canopen, which share nothing with our own.

    canopen_device.py DEVICE --interface socketcan --channel can0 [--bitrate BITS] [--node N] [--eds FILE]

Prints `ready` when it is on the bus, and ends with 0 on SIGTERM or SIGINT, with 1 when the bus is gone.
"""

import argparse
import logging
import re
import signal
import sys
import threading
from pathlib import Path

import can

from canopen_slave.bus import open_bus
from canopen_slave.device import Device
from canopen_slave.devices import DEVICES

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures" / "devices"


def default_node(device: str) -> int:
    """The node-ID in the description of the device."""
    text = (FIXTURES / device / "device.yaml").read_text(encoding="utf-8")
    return int(re.search(r"^canopen: \{node: (\d+)", text, re.MULTILINE)[1])


def default_eds(device: str) -> Path:
    """The EDS beside that description."""
    return next((FIXTURES / device).glob("*.eds"))


def arguments() -> argparse.Namespace:
    """What to be, and where."""
    parser = argparse.ArgumentParser(description="A reference device on python-can and canopen.")
    parser.add_argument("device", choices=sorted(DEVICES))
    parser.add_argument("--interface", default="socketcan", help="of python-can: socketcan, slcan, virtual")
    parser.add_argument("--channel", required=True, help="can0, /dev/ttyACM0, socket://host:port")
    parser.add_argument("--bitrate", type=int, help="in bit/s, for an adapter that sets it")
    parser.add_argument("--node", type=int, help="the node-ID; else that of the description")
    parser.add_argument("--eds", type=Path, help="another EDS than the one in fixtures/devices")
    return parser.parse_args()


def main() -> int:
    """Runs until told to end."""
    logging.basicConfig(level=logging.WARNING, stream=sys.stderr)
    options = arguments()
    ended = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: ended.set())
    try:
        bus = open_bus(options.interface, options.channel, options.bitrate)
    except (can.CanError, OSError, ValueError) as error:
        print(f"{options.interface}:{options.channel}: {error}", file=sys.stderr)
        return 1
    node = options.node or default_node(options.device)
    device = Device(bus, options.eds or default_eds(options.device), node, DEVICES[options.device]())
    try:
        device.power_on()
        print("ready", flush=True)
        while not ended.wait(0.2):
            bus.check()
        device.power_off()
        bus.disconnect()
    # Whatever python-can and pyserial raise when an adapter goes.
    except Exception as error:
        print(f"{options.interface}:{options.channel}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
