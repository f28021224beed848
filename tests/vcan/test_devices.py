"""The suites against devices that are processes on real CAN interfaces of a kernel, and masters of others against ours.

Run inside `with-vcan`. Needs FIELDPROOF (the program) and PYTHON (an interpreter with reference/python/requirements.txt).
"""

from __future__ import annotations

import contextlib
import json
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from bench import FIELDPROOF, ROOT, UNCERTAINTY, Device, bench_file, running, served
from runs import FoldersAndRuns, Run

PYTHON = os.environ.get("PYTHON", str(ROOT / "target/python/bin/python"))

# Every device has a bus of its own, so that cases which disturb a bus disturb nobody else.
KINDS = {"kinco": "kinco-servo", "huacheng": "huacheng-ssts1", "encoder": "liaomiao-encoder", "teco": "teco-jn5-cm-can"}
COMPLETE = {"complete": "canopen-complete"}
INTERFACES = dict(zip(KINDS | COMPLETE, ["vcan0", "vcan1", "vcan2", "vcan3", "vcan4"]))
NODES = {"kinco": 1, "huacheng": 1, "encoder": 32, "teco": 1, "complete": 10}

def written_in_python(name: str) -> Device:
    """A device on python-can and canopen, which share no line with us."""
    interface = INTERFACES[name]
    script = str(ROOT / "reference/python/canopen_device.py")
    command = [PYTHON, script, KINDS[name], "--interface", "socketcan", "--channel", interface, "--node", str(NODES[name])]
    link = f"socketcan:{interface}?uncertainty={UNCERTAINTY}"
    return Device(name, KINDS[name], command, {"can": link}, node=NODES[name])


class OnVcan(FoldersAndRuns):
    """Everything that runs on the buses of this kernel."""

    def passes(self, make: dict[str, Device], least: dict[str, int], *arguments: str) -> Run:
        """All suites pass on all devices. A case that did not is played again, once: a processor that was not there for
        some milliseconds is not the device's fault, and does not strike the same case twice."""
        run = self.run_on(list(make.values()), *arguments)
        self.assertIn(run.exit, (0, 1), f"{run.error}\n{run.outcome}")
        for name, count in least.items():
            self.assertGreaterEqual(run.lane(name)["counts"]["pass"], count, (name, run.outcome["lanes"]))
            self.assertTrue(run.lane(name)["complete"], name)
        # What this link is too coarse for stays undecided, as it should; it must not be much.
        too_coarse = {key for key, what in run.not_passed().items() if "cannot be decided on this link" in what}
        self.assertLess(len(too_coarse), 20, too_coarse)
        again = {key: what for key, what in run.not_passed().items() if key not in too_coarse}
        self.assertLess(len(again), 12, again)
        for name in {name for name, _ in again}:
            cases = [f"--case={case}" for device, case in again if device == name]
            print(f"once more on {name}: {[again[key] for key in again if key[0] == name]} {cases}")
            second = self.run_on([make[name]], *cases)
            self.assertEqual((second.exit, second.not_passed()), (0, {}), second.error)
        return run

    def test_our_devices_as_processes(self) -> None:
        kinds = KINDS | COMPLETE
        devices = {name: served(name, kind, INTERFACES[name], self.folder, NODES[name]) for name, kind in kinds.items()}
        run = self.passes(devices, {"kinco": 100, "huacheng": 85, "encoder": 115, "teco": 135, "complete": 150})
        lanes = [lane["lane_time_ns"] / 1e9 for lane in run.outcome["lanes"]]
        self.assertLess(run.seconds, max(lanes) + 15, "the lanes did not run beside each other")
        self.assertLess(run.seconds, 0.75 * sum(lanes))

    def test_devices_written_in_python(self) -> None:
        devices = {name: written_in_python(name) for name in KINDS}
        # They have what the manuals show of SDO, PDO, NMT and LSS, and not every service that the standard has.
        suites = ["kinco-servo.nmt", "kinco-servo.sdo", "kinco-servo.pdo", "liaomiao-encoder.lss"]
        suites += ["huacheng-ssts1.pdo", "teco-jn5-cm-can.nmt", "teco-jn5-cm-can.sdo", "teco-jn5-cm-can.pdo"]
        self.passes(devices, {"kinco": 20, "huacheng": 5, "encoder": 5, "teco": 20}, *suites, "--no-operator")

    def test_a_master_written_in_python_on_our_devices(self) -> None:
        script = str(ROOT / "reference/python/masters/canopen_master.py")
        for name, kind in KINDS.items():
            with self.subTest(name), running(
                served(name, kind, INTERFACES[name], self.folder, NODES[name]), self.folder
            ):
                command = [PYTHON, script, kind, "--channel", INTERFACES[name], "--node", str(NODES[name])]
                done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertGreater(done.stdout.count("ok"), 20, done.stdout)

    def test_a_fault_is_found_on_a_real_bus_too(self) -> None:
        device = served("kinco", "kinco-servo", "vcan0", self.folder, 1, fault="abort-names-another-object")
        run = self.run_on([device], "canopen.sdo", "kinco-servo.sdo")
        self.assertEqual(run.exit, 1, run.error)
        self.assertTrue(any(verdict.startswith("fail") for verdict in run.not_passed().values()), run.outcome)

    def test_a_bus_that_goes_down_breaks_the_run_and_keeps_what_was_seen(self) -> None:
        device = served("kinco", "kinco-servo", "vcan0", self.folder, 1)
        down = threading.Timer(4, lambda: subprocess.run(["ip", "link", "set", "vcan0", "down"], check=True))
        try:
            with contextlib.suppress(AssertionError), running(device, self.folder):
                # The device loses its bus as well, and may end.
                down.start()
                run = Run(self.folder, [device], "canopen.nmt")
        finally:
            down.join()
            subprocess.run(["ip", "link", "set", "vcan0", "up"], check=True)
        self.assertEqual(run.exit, 3, run.error)
        self.assertIn("vcan0" if "vcan0" in str(run.outcome) else "can", str(run.lane("kinco")["stopped"]))
        self.assertGreater(run.lane("kinco")["counts"]["pass"], 0)
        journal = next(run.reports.glob("**/*.jsonl")).read_text(encoding="utf-8").splitlines()
        self.assertEqual(json.loads(journal[-2])["event"], "lane-finished")
        self.assertTrue(list(run.reports.glob("**/*.xml")), "there is no JUnit report")

    def test_an_error_frame_is_an_event_of_the_run(self) -> None:
        device = served("kinco", "kinco-servo", "vcan0", self.folder, 1)
        # Controller trouble with both counters: error passive when sending, 136 and 0 errors (linux/can/error.h).
        error_frame = struct.pack("=IB3x8B", 0x2000_0204, 8, 0, 0x20, 0, 0, 0, 0, 136, 0)
        with socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW) as bus, running(device, self.folder):
            bus.bind(("vcan0",))
            trouble = threading.Timer(2, lambda: bus.send(error_frame))
            trouble.start()
            run = Run(self.folder, [device], "canopen.error-control")
            trouble.join()
        self.assertEqual(run.exit, 0, run.error)
        journal = next(run.reports.glob("**/*.jsonl")).read_text(encoding="utf-8")
        events = [event for event in map(json.loads, journal.splitlines()) if event["event"] == "bus-error"]
        self.assertEqual(
            [(event["what"], event["counters"]) for event in events],
            [("controller: transmit error passive; transmit errors 136, receive errors 0", [136, 0])],
        )

    def test_an_interrupted_run_puts_the_device_back(self) -> None:
        device = served("kinco", "kinco-servo", "vcan0", self.folder, 1)
        bench = self.folder / "bench.yaml"
        bench.write_text(bench_file([device]), encoding="utf-8")
        with running(device, self.folder):
            command = [FIELDPROOF, "run", "canopen.error-control", "--bench", str(bench)]
            run = subprocess.Popen([*command, "--reports", str(self.folder / "reports")], stdout=subprocess.PIPE, text=True)
            time.sleep(3)
            run.send_signal(signal.SIGINT)
            text, _ = run.communicate(timeout=30)
            self.assertEqual(run.returncode, 3, text)
            self.assertIn("interrupted", text)
            after = Run(self.folder, [device], "canopen.sdo")
            self.assertEqual(after.exit, 0, after.error)


if __name__ == "__main__":
    unittest.main(verbosity=2)
