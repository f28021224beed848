"""The Modbus devices, byte by byte, on a pseudo-terminal and over TCP."""

import os
import select
import socket
import subprocess
import sys
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tests.terminal import open_pseudo_terminal

PROGRAM = Path(__file__).resolve().parents[1] / "modbus_device.py"


def start(test: unittest.TestCase, *options: str) -> tuple[subprocess.Popen, str]:
    """Runs a device until the test ends; what it printed when it was ready."""
    process = subprocess.Popen([sys.executable, PROGRAM, *options], stdout=subprocess.PIPE, text=True)

    def stop() -> None:
        process.terminate()
        test.assertEqual(process.wait(5), 0)
        process.stdout.close()

    test.addCleanup(stop)
    return process, process.stdout.readline().strip()


def crc(data: bytes) -> bytes:
    """CRC-16/MODBUS, the low byte first."""
    register = 0xFFFF
    for byte in data:
        register ^= byte
        for _ in range(8):
            register = register >> 1 ^ (0xA001 if register & 1 else 0)
    return register.to_bytes(2, "little")


class Rtu(unittest.TestCase):
    """One process serves all tests of a class; each test leaves the registers that others read as they were."""

    device = "liaomiao-encoder"

    def setUp(self) -> None:
        self.line, name = open_pseudo_terminal(self)
        _, ready = start(self, self.device, "--port", name)
        self.assertEqual(ready, "ready")

    def read(self, within: float) -> bytes:
        """What comes until the line is silent."""
        data = b""
        while select.select([self.line], [], [], within)[0]:
            data += os.read(self.line, 256)
            within = 0.02
        return data

    def ask(self, request: str, answer: str | None) -> None:
        """A request and its answer, both without the CRC; None for silence."""
        data = bytes.fromhex(request)
        os.write(self.line, data + crc(data))
        if answer is None:
            self.assertEqual(self.read(0.1), b"")
        else:
            expected = bytes.fromhex(answer)
            self.assertEqual(self.read(2).hex(" "), (expected + crc(expected)).hex(" "))

    def send(self, data: str) -> None:
        """Bytes as they are, and the silence after them."""
        os.write(self.line, bytes.fromhex(data))
        time.sleep(0.15)


class Encoder(Rtu):
    """The encoder at address 32."""

    def test_reads_and_exceptions(self) -> None:
        self.ask("20 03 00 01 00 01", "20 03 02 00 20")
        self.ask("20 03 00 00 00 0A", "20 83 02")
        self.ask("20 03 00 02 00 03", "20 03 06 00 00 00 00 00 00")
        self.ask("20 03 00 0A 00 01", "20 83 02")
        self.ask("20 03 00 00 00 00", "20 83 03")
        self.ask("20 03 00 00 00 7E", "20 83 03")
        self.ask("20 03 FF FF 00 02", "20 83 02")
        self.ask("20 4E 00 00", "20 CE 01")
        self.ask("20 04 00 00 00 01", "20 84 01")
        self.ask("20 2B 0E 01 00", "20 AB 01")
        self.ask("20 06 00 00 00 01", "20 86 02")
        self.ask("20 06 00 0E 00 0B", "20 86 03")

    def test_who_is_asked(self) -> None:
        for address in ("21", "F7", "00"):
            self.ask(f"{address} 03 00 00 00 00", None)
            self.ask(f"{address} 03 00 01 00 01", None)
            self.ask(f"{address} 4E 00 00", None)
        self.ask("20 03 00 01 00 01", "20 03 02 00 20")

    def test_what_is_no_frame(self) -> None:
        for data in ("20 03 00 01 00 01 D3 7A", "20 03 00 01 00 01", "20 03 00 01 00 01 7B D3", "20", "20 03 00 01"):
            self.send(data)
            self.ask("20 03 00 01 00 01", "20 03 02 00 20")

    def test_writes(self) -> None:
        self.ask("20 06 00 0E 00 05", "20 06 00 0E 00 05")
        self.ask("20 03 00 0E 00 01", "20 03 02 00 05")
        self.ask("20 10 00 0E 00 02 04 00 06 00 01", "20 10 00 0E 00 02")
        self.ask("20 03 00 0E 00 02", "20 03 04 00 06 00 01")
        self.ask("20 10 00 0E 00 02 03 00 06 00", "20 90 03")
        self.ask("20 10 00 0E 00 02 04 00 07 00 02", "20 90 03")
        self.ask("20 03 00 0E 00 02", "20 03 04 00 06 00 01")
        self.ask("20 06 00 07 01 6C", "20 06 00 07 01 6C")
        self.ask("20 03 00 07 00 01", "20 83 02")
        self.ask("20 03 00 0B 00 01", "20 03 02 01 6C")

    def test_broadcast_is_carried_out_and_not_answered(self) -> None:
        self.ask("00 06 00 0E 00 05", None)
        self.ask("20 03 00 0E 00 01", "20 03 02 00 05")

    def test_change_of_address(self) -> None:
        self.ask("FF 03 00 01 00 01", None)
        self.ask("FF 10 00 01 00 03 06 61 64 64 72 3A 03", "03 10 00 01 00 03")
        self.ask("20 03 00 01 00 01", None)
        self.ask("03 03 00 01 00 03", "03 03 06 00 03 00 00 00 00")


class Servo(Rtu):
    """The servo drive, at address 1, asked for even parity on a pseudo-terminal, which has none."""

    device = "huacheng-ssts1"

    def test_value_out_of_range(self) -> None:
        self.ask("01 06 01 45 03 E8", "01 06 01 45 03 E8")
        self.ask("01 06 01 45 27 10", "01 86 02")
        self.ask("01 03 01 45 00 01", "01 03 02 03 E8")


class Unplugged(unittest.TestCase):
    """A port that goes."""

    def test_ends_with_1(self) -> None:
        line, other = os.openpty()
        name = os.ttyname(other)
        command = [sys.executable, PROGRAM, "huacheng-ssts1", "--port", name]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            self.assertEqual(process.stdout.readline(), "ready\n")
            os.close(other)
            os.close(line)
            self.assertEqual(process.wait(5), 1)
            self.assertIn("the port is gone", process.stderr.read())


class Tcp(unittest.TestCase):
    """The inverter over TCP."""

    def test_state_follows_the_operation_signal(self) -> None:
        _, ready = start(self, "teco-jn5-cm-can", "--tcp", "127.0.0.1:0")
        word, port = ready.split()
        self.assertEqual(word, "ready")
        with socket.create_connection(("127.0.0.1", int(port)), timeout=2) as connection:
            for request, answer in (
                ("0001 0000 0006 01 03 2520 0001", "0001 0000 0005 01 03 02 0004"),
                ("0002 0000 0006 01 06 2501 0003", "0002 0000 0006 01 06 2501 0003"),
                ("0003 0000 0006 01 03 2520 0001", "0003 0000 0005 01 03 02 0007"),
                ("0004 0000 0006 01 06 2502 9C41", "0004 0000 0003 01 86 03"),
                ("0005 0000 0004 01 4E 0000", "0005 0000 0003 01 CE 01"),
                ("0006 0000 0006 FF 03 252F 0001", "0006 0000 0005 FF 03 02 012C"),
            ):
                connection.sendall(bytes.fromhex(request))
                self.assertEqual(connection.recv(64).hex(), bytes.fromhex(answer).hex())


if __name__ == "__main__":
    unittest.main()
