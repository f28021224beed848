"""A device and a tester on one virtual bus."""

import itertools
import logging
import sys
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import can

from canopen_device import default_eds, default_node
from canopen_slave.bus import open_bus
from canopen_slave.device import Device
from canopen_slave.devices import DEVICES

# Each bench has a bus of its own.
_channels = itertools.count()


class Bench(unittest.TestCase):
    """Powers a device on before each test, and off after it. Frames are written as `601#4000100000000000`."""

    device = "liaomiao-encoder"

    def setUp(self) -> None:
        # The slave survives what goes wrong in it; a test does not.
        no_errors = self.assertNoLogs("canopen_slave", "ERROR")
        no_errors.__enter__()
        self.addCleanup(no_errors.__exit__, None, None, None)
        # canopen complains of each block download.
        logging.getLogger("canopen").setLevel(logging.CRITICAL)
        self.channel = f"bench{next(_channels)}"
        self.tester = can.Bus(interface="virtual", channel=self.channel)
        self.addCleanup(self.tester.shutdown)
        self.bus = open_bus("virtual", self.channel, None)
        self.node = default_node(self.device)
        self.dut = Device(self.bus, default_eds(self.device), self.node, DEVICES[self.device]())
        self.dut.power_on()
        self.addCleanup(self._power_off)
        self.expect(f"{0x700 + self.node:03X}#00")

    def _power_off(self) -> None:
        self.dut.power_off()
        self.bus.disconnect()

    def send(self, text: str) -> None:
        """Sends a frame; `701#R1` is a remote frame of one byte."""
        identifier, data = text.split("#")
        remote = data.startswith("R")
        self.tester.send(
            can.Message(
                arbitration_id=int(identifier, 16),
                is_extended_id=False,
                is_remote_frame=remote,
                dlc=int(data[1:]) if remote else None,
                data=None if remote else bytes.fromhex(data),
            )
        )

    def expect(self, text: str, within: float = 2.0) -> float:
        """The next frame is `text`, within so many seconds; when it came, in seconds."""
        message = self.tester.recv(within)
        self.assertIsNotNone(message, f"no answer, expected {text}")
        self.assertEqual(text, f"{message.arbitration_id:03X}#{message.data.hex().upper()}")
        return message.timestamp

    def expect_silence(self, lasting: float) -> None:
        """Nothing comes for so many seconds."""
        message = self.tester.recv(lasting)
        self.assertIsNone(message, f"silence expected, {message} came")

    def ask(self, request: str, answer: str) -> None:
        """An SDO request and its answer, without identifiers."""
        self.send(f"{0x600 + self.node:03X}#{request}")
        self.expect(f"{0x580 + self.node:03X}#{answer}")

    def wait(self, seconds: float) -> None:
        """Lets the time of a producer go by."""
        time.sleep(seconds)
