"""The Modbus suites against devices that are processes, on pseudo-terminals and TCP: devices of ours and on pymodbus, and a
pymodbus master on ours.

Needs FIELDPROOF (the program) and PYTHON (an interpreter with reference/python/requirements.txt).
"""

from __future__ import annotations

import os
import pathlib
import socket
import subprocess
import sys
import time
import unittest

TESTS = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS / "vcan"), str(TESTS.parent / "reference/python")]

from bench import FIELDPROOF, ROOT, Device, running
from runs import FoldersAndRuns
from tests.terminal import open_line

PYTHON = os.environ.get("PYTHON", str(ROOT / "target/python/bin/python"))
DEVICE = str(ROOT / "reference/python/modbus_device.py")
MASTER = str(ROOT / "reference/python/masters/modbus_master.py")

# The devices with a serial port of their own, and how many cases at least pass on each kind of link.
DEVICES = {"liaomiao-encoder": (40, 5), "huacheng-ssts1": (10, 2)}


def free_port() -> int:
    """A TCP port that nobody listens on."""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


class Modbus(FoldersAndRuns):
    """Every pair of a device and a link."""

    def on_a_line(self, kind: str, command: list[str], link: str, least: int) -> None:
        device = Device(kind, kind, command, {"serial": link})
        run = self.run_on([device], "modbus", f"{kind}.modbus", "--no-operator")
        self.assertEqual((run.exit, run.not_passed()), (0, {}), run.error)
        self.assertGreaterEqual(run.lane(kind)["counts"]["pass"], least, run.outcome)

    def test_our_devices_on_a_pseudo_terminal(self) -> None:
        for kind, (least, _) in DEVICES.items():
            with self.subTest(kind):
                ours, theirs = open_line(self)
                command = [FIELDPROOF, "serve", kind, "--on", f"serial:{theirs}"]
                self.on_a_line(kind, command, f"serial:{ours}", least)

    def test_our_devices_over_tcp(self) -> None:
        for kind, (least_rtu, least_tcp) in DEVICES.items():
            for framing, least in (("?framing=rtu", least_rtu), ("", least_tcp)):
                with self.subTest(kind, framing=framing):
                    link = f"tcp:127.0.0.1:{free_port()}{framing}"
                    self.on_a_line(kind, [FIELDPROOF, "serve", kind, "--on", link], link, least)

    def test_devices_on_pymodbus_on_a_pseudo_terminal(self) -> None:
        for kind, (least, _) in DEVICES.items():
            with self.subTest(kind):
                ours, theirs = open_line(self)
                command = [PYTHON, DEVICE, kind, "--port", theirs, "--parity", "N"]
                self.on_a_line(kind, command, f"serial:{ours}", least)

    def test_everything_over_modbus_tcp(self) -> None:
        kind = "modbus-complete"
        link = f"tcp:127.0.0.1:{free_port()}"
        device = Device(kind, kind, [FIELDPROOF, "serve", kind, "--on", link], {"tcp": link})
        run = self.run_on([device], "modbus", f"{kind}.functions", "--no-operator")
        self.assertEqual((run.exit, run.not_passed()), (0, {}), run.error)
        self.assertGreaterEqual(run.lane(kind)["counts"]["pass"], 900, run.outcome)

    def test_devices_on_pymodbus_over_tcp(self) -> None:
        for kind, (_, least) in DEVICES.items():
            with self.subTest(kind):
                port = free_port()
                command = [PYTHON, DEVICE, kind, "--tcp", f"127.0.0.1:{port}"]
                self.on_a_line(kind, command, f"tcp:127.0.0.1:{port}", least)

    def test_a_pymodbus_master_on_our_devices(self) -> None:
        for kind in DEVICES:
            with self.subTest(kind, link="pseudo-terminal"):
                ours, theirs = open_line(self)
                command = [FIELDPROOF, "serve", kind, "--on", f"serial:{theirs}"]
                self.master(kind, command, ["--port", ours, "--parity", "N"])
            with self.subTest(kind, link="tcp"):
                address = f"127.0.0.1:{free_port()}"
                self.master(kind, [FIELDPROOF, "serve", kind, "--on", f"tcp:{address}"], ["--tcp", address])

    def master(self, kind: str, command: list[str], link: list[str]) -> None:
        with running(Device(kind, kind, command, {}), self.folder):
            done = subprocess.run(
                [PYTHON, MASTER, kind, *link], capture_output=True, text=True, timeout=120, check=False
            )
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertGreater(done.stdout.count("ok"), 10, done.stdout)

    def test_a_device_that_goes_away_breaks_the_run_and_keeps_what_was_seen(self) -> None:
        kind = "liaomiao-encoder"
        link = f"tcp:127.0.0.1:{free_port()}?framing=rtu"
        device = Device(kind, kind, [FIELDPROOF, "serve", kind, "--on", link], {"serial": link})
        with self.assertRaisesRegex(AssertionError, "ended"), running(device, self.folder) as process:
            run = self.start([device], "modbus")
            # The cases of these suites take twelve seconds.
            time.sleep(3)
            process.kill()
            run.wait(30)
        self.assertEqual(run.returncode, 3)
        self.assertTrue(list((self.folder / "reports").glob("**/*.xml")), "there is no JUnit report")


if __name__ == "__main__":
    unittest.main(verbosity=2)
