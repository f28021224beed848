"""The console as people and build machines meet it: colours and a moving line on a terminal, plain lines anywhere else.

Needs FIELDPROOF (the program).
"""

from __future__ import annotations

import json
import os
import pathlib
import pty
import subprocess
import tempfile
import unittest

from runs import FIELDPROOF

ESCAPE = "\x1b["
# Whatever decides on colours and is not part of a test.
DECIDING = ("NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "CI")
RUN = ("run", "canopen.nmt", "--device", "kinco-servo")
FAILS = ("run", "canopen.sdo-segmented", "--case", "*unknown-object", "--device", "kinco-servo", "--fault", "abort-names-another-object")


class Console(unittest.TestCase):
    """What is printed."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def environment(self, more: dict[str, str]) -> dict[str, str]:
        kept = {name: value for name, value in os.environ.items() if name not in DECIDING}
        return kept | {"TERM": "xterm"} | more

    def on_terminal(self, *arguments: str, **more: str) -> str:
        master, slave = pty.openpty()
        program = subprocess.Popen([FIELDPROOF, *arguments], stdout=slave, stderr=slave, cwd=self.folder, env=self.environment(more))
        os.close(slave)
        shown = b""
        while True:
            try:
                piece = os.read(master, 65536)
            except OSError:
                break
            if not piece:
                break
            shown += piece
        os.close(master)
        program.wait()
        return shown.decode(errors="replace")

    def piped(self, *arguments: str, **more: str) -> str:
        ran = subprocess.run([FIELDPROOF, *arguments], capture_output=True, cwd=self.folder, env=self.environment(more), check=False)
        return (ran.stdout + ran.stderr).decode()

    def test_colours_are_for_terminals(self) -> None:
        self.assertIn(f"{ESCAPE}32m", self.on_terminal(*RUN))
        self.assertNotIn(ESCAPE, self.piped(*RUN))

    def test_no_color_is_kept_to(self) -> None:
        coloured = [f"{ESCAPE}{code}m" for code in (31, 32, 33, 35, 36)]
        shown = self.on_terminal(*FAILS, NO_COLOR="1")
        self.assertIn("FAIL kinco-servo", shown)
        self.assertFalse([code for code in coloured if code in shown])

    def test_line_moves_on_terminals_that_somebody_looks_at(self) -> None:
        self.assertIn("kinco-servo  canopen.nmt/", self.on_terminal(*RUN))
        for shown in (self.on_terminal(*RUN, CI="true"), self.on_terminal(*RUN, "--quiet"), self.piped(*RUN)):
            self.assertNotIn("kinco-servo  canopen.nmt/", shown)
            self.assertNotIn("\r\x1b[2K", shown)

    def test_json_is_nothing_but_json(self) -> None:
        outcome = json.loads(self.on_terminal(*FAILS, "--format", "json"))
        self.assertEqual(outcome["lanes"][0]["counts"]["fail"], 1)

    def test_quiet_shows_failures_and_the_summary(self) -> None:
        shown = self.piped(*FAILS, "--quiet")
        self.assertIn("another frame came than expected", shown)
        self.assertIn("1 of 1 did not pass", shown)
        self.assertNotIn("1 case ", shown)


if __name__ == "__main__":
    unittest.main(verbosity=2)
