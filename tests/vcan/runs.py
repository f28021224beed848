"""Runs of the program on devices that are processes."""

from __future__ import annotations

import contextlib
import json
import pathlib
import subprocess
import tempfile
import time
import unittest

from bench import FIELDPROOF, Device, bench_file, running

RUN_SECONDS = 900


class Run:
    """One run of the program on devices that are there."""

    def __init__(self, folder: pathlib.Path, devices: list[Device], *arguments: str) -> None:
        bench = folder / "bench.yaml"
        bench.write_text(bench_file(devices), encoding="utf-8")
        self.reports = folder / "reports"
        command = [FIELDPROOF, "run", *arguments, "--bench", str(bench), "--reports", str(self.reports)]
        begun = time.monotonic()
        done = subprocess.run(
            [*command, "--format", "json"], capture_output=True, text=True, timeout=RUN_SECONDS, check=False
        )
        self.seconds = time.monotonic() - begun
        self.exit = done.returncode
        self.error = done.stderr
        self.outcome = json.loads(done.stdout) if done.stdout else {"lanes": []}

    def not_passed(self) -> dict[tuple[str, str], str]:
        """What failed, broke or could not be decided: its verdict and reason, by device and case."""
        return {
            (lane["device"], case["id"]): f'{case["verdict"]}: {case["what"]}'
            for lane in self.outcome["lanes"]
            for case in lane["listed"]
            if case["verdict"] != "deviation"
        }

    def lane(self, device: str) -> dict:
        """The summary of one lane."""
        return next(lane for lane in self.outcome["lanes"] if lane["device"] == device)


class FoldersAndRuns(unittest.TestCase):
    """A folder for each test, and runs on devices in it."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="fieldproof-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_on(self, devices: list[Device], *arguments: str) -> Run:
        """Runs the devices, and the program on them."""
        with contextlib.ExitStack() as there:
            for device in devices:
                there.enter_context(running(device, self.folder))
            return Run(self.folder, devices, *arguments)

    def start(self, devices: list[Device], *arguments: str) -> subprocess.Popen[str]:
        """Starts the program on devices that run."""
        bench = self.folder / "bench.yaml"
        bench.write_text(bench_file(devices), encoding="utf-8")
        command = [FIELDPROOF, "run", *arguments, "--bench", str(bench), "--reports", str(self.folder / "reports")]
        run = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, text=True)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        return run
