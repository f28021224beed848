"""The CANopen device as a process behind an SLCAN adapter, which this test is."""

import os
import select
import signal
import socket
import subprocess
import sys
import time
import unittest
from pathlib import Path

from tests.terminal import open_pseudo_terminal

PROGRAM = Path(__file__).resolve().parents[1] / "canopen_device.py"


class Slcan(unittest.TestCase):
    """`t` identifier, length and data of a frame, ended by a carriage return."""

    def start(self, channel: str, *options: str) -> subprocess.Popen:
        """Runs a device that is ended when the test is, if it has not ended itself."""
        command = [sys.executable, PROGRAM, "liaomiao-encoder", "--interface", "slcan", "--channel", channel, *options]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

        def stop() -> None:
            process.kill()
            process.communicate()

        self.addCleanup(stop)
        return process

    def read_until(self, file: int, end: str) -> str:
        """What the device sends, up to and with `end`."""
        text = ""
        deadline = time.monotonic() + 5
        while not text.endswith(end):
            self.assertTrue(select.select([file], [], [], deadline - time.monotonic())[0], f"only {text!r}")
            text += os.read(file, 1).decode("ascii")
        return text

    def converse(self, file: int, process: subprocess.Popen) -> None:
        """Boot-up, a request, and the end on SIGTERM."""
        self.assertEqual(self.read_until(file, "t720100\r"), "C\rS5\r\rO\rO\rt720100\r")
        self.assertEqual(process.stdout.readline(), "ready\n")
        os.write(file, b"t62084000100000000000\r")
        self.read_until(file, "t5A084300100096010200\r")
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(5), 0)

    def test_tcp(self) -> None:
        with socket.create_server(("127.0.0.1", 0)) as server:
            process = self.start(f"socket://127.0.0.1:{server.getsockname()[1]}", "--bitrate", "250000")
            connection, _ = server.accept()
            with connection:
                self.converse(connection.fileno(), process)

    def test_pseudo_terminal(self) -> None:
        line, name = open_pseudo_terminal(self)
        self.converse(line, self.start(name, "--bitrate", "250000"))

    def test_an_adapter_that_goes(self) -> None:
        with socket.create_server(("127.0.0.1", 0)) as server:
            process = self.start(f"socket://127.0.0.1:{server.getsockname()[1]}")
            connection, _ = server.accept()
            with connection:
                self.read_until(connection.fileno(), "t720100\r")
        self.assertEqual(process.wait(5), 1)

    def test_no_adapter(self) -> None:
        with socket.create_server(("127.0.0.1", 0)) as server:
            port = server.getsockname()[1]
        self.assertEqual(self.start(f"socket://127.0.0.1:{port}").wait(5), 1)

    def test_another_bit_rate_than_adapters_have(self) -> None:
        _, name = open_pseudo_terminal(self)
        self.assertEqual(self.start(name, "--bitrate", "800000").wait(5), 1)


if __name__ == "__main__":
    unittest.main()
