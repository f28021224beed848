"""A receiver that was held up for too long says how many frames it lost, and that its run is worth nothing.

Run inside `with-vcan`. Needs FIELDPROOF (the program).
"""

from __future__ import annotations

import json
import pathlib
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from bench import FIELDPROOF, Device, bench_file

INTERFACE = "vcan1"

# More than fits into the receive queue, which holds about 11,000. They take longer than the clock of the lane goes
# without being compared with the kernel's, and must stay in their order all the same.
FRAMES = 20_000

# An identifier that no device of node 1 uses.
IDENTIFIER = 0x6E0

FRAME = struct.Struct("=IB3x8s")

END_SECONDS = 60


class Overflow(unittest.TestCase):
    """What a full receive queue does to a run."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="fieldproof-overflow-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.bus = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.addCleanup(self.bus.close)
        self.bus.bind((INTERFACE,))
        self.bus.settimeout(END_SECONDS)

    def test_every_frame_is_either_in_the_journal_or_counted_as_lost(self) -> None:
        # There is no such device: the tester asks for it in vain, again and again.
        nobody = Device("nobody", "kinco-servo", [], {"can": f"socketcan:{INTERFACE}"}, node=1)
        bench = self.folder / "bench.yaml"
        bench.write_text(bench_file([nobody]), encoding="utf-8")
        reports = self.folder / "reports"
        command = [FIELDPROOF, "run", "canopen.sdo", "--no-operator", "--bench", str(bench), "--reports", str(reports)]
        run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(run.kill)
        self.bus.recv(FRAME.size)
        run.send_signal(signal.SIGSTOP)
        for number in range(FRAMES):
            self.bus.send(FRAME.pack(IDENTIFIER, 8, number.to_bytes(8, "little")))
        run.send_signal(signal.SIGCONT)
        text, _ = run.communicate(timeout=END_SECONDS)

        self.assertEqual(run.returncode, 3, text)
        told = re.search(r"port can lost (\d+) frames because its receive queue was full", text)
        self.assertIsNotNone(told, text)
        journal = next(reports.glob("**/*.jsonl")).read_text(encoding="utf-8")
        events = [json.loads(line) for line in journal.splitlines()]
        self.assertEqual(events[-2]["event"], "lane-finished")
        ours = [event for event in events if event["event"] == "frame" and event["id"] == IDENTIFIER]
        numbers = [int.from_bytes(bytes.fromhex(event["data"]), "little") for event in ours]
        self.assertEqual(numbers, list(range(len(numbers))))
        self.assertEqual(len(numbers) + int(told[1]), FRAMES)
        print(f"{len(numbers)} in the journal, {told[1]} lost")


if __name__ == "__main__":
    unittest.main(verbosity=2)
