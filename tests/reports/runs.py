"""The runs whose reports are looked at: one that passes, one that fails, one that is killed, one of every device."""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
import tempfile

FIELDPROOF = os.environ["FIELDPROOF"]
SCREENSHOTS = pathlib.Path(os.environ.get("SCREENSHOTS", pathlib.Path(__file__).parents[2] / "target/screenshots"))


class Runs:
    """Made once, for they are only read."""

    folder = pathlib.Path(tempfile.mkdtemp(prefix="fieldproof-reports-"))

    @classmethod
    def remove(cls) -> None:
        shutil.rmtree(cls.folder, ignore_errors=True)

    @classmethod
    def run(cls, name: str, *arguments: str, exits: int = 0) -> pathlib.Path:
        """The reports of a run with these arguments."""
        reports = cls.folder / name
        if not reports.exists():
            command = [FIELDPROOF, "run", "--quiet", "--reports", str(reports), *arguments]
            ran = subprocess.run(command, capture_output=True, text=True, check=False)
            assert ran.returncode == exits, f"{ran.returncode}: {ran.stdout}{ran.stderr}"
        return reports

    @classmethod
    def passing(cls) -> pathlib.Path:
        settings = ("--set", "operator=A. Smith", "--set", "order=PO-2231 <b>&")
        return cls.run("passing", "--device", "kinco-servo", *settings)

    @classmethod
    def failing(cls) -> pathlib.Path:
        fault = ("--fault", "abort-names-another-object", "--case", "canopen.sdo*")
        return cls.run("failing", "--device", "kinco-servo", *fault, exits=1)

    @classmethod
    def modbus(cls) -> pathlib.Path:
        return cls.run("modbus", "modbus", "--device", "modbus-complete")

    @classmethod
    def everything(cls) -> pathlib.Path:
        return cls.run("everything")

    @classmethod
    def killed(cls) -> pathlib.Path:
        """A run that was killed in the middle of its third case: its journal ends there, in the middle of a line."""
        reports = cls.folder / "killed"
        if not reports.exists():
            reports.mkdir()
            whole = (cls.passing() / "run.jsonl").read_bytes().splitlines(keepends=True)
            ends = [index for index, line in enumerate(whole) if b'"event":"case-finished"' in line]
            cut = ends[200] + 4
            (reports / "run.jsonl").write_bytes(b"".join(whole[:cut]) + whole[cut][:20])
            ran = subprocess.run([FIELDPROOF, "report", str(reports)], capture_output=True, text=True, check=False)
            assert ran.returncode == 3, ran.stderr
        return reports

    @classmethod
    def events(cls, reports: pathlib.Path, kind: str) -> list[dict]:
        lines = (reports / "run.jsonl").read_text(encoding="utf-8").splitlines()
        return [json.loads(line) for line in lines if f'"event":"{kind}"' in line]
