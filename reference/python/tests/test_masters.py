"""The masters against the devices: both find each other right, and the masters do fail."""

import contextlib
import io
import unittest

from masters import canopen_master, modbus_master
from tests.bench import Bench
from tests.terminal import open_line
from tests.test_modbus import start


def output_of(main, *arguments: str) -> tuple[int, list[str]]:
    """The exit code of a master and its lines."""
    output = io.StringIO()
    with contextlib.redirect_stdout(output):
        code = main(list(arguments))
    return code, output.getvalue().splitlines()


class Encoder(Bench):
    """The encoder, on a bus of its own."""

    def check(self) -> None:
        """The master finds nothing wrong with the device."""
        code, lines = output_of(canopen_master.main, self.device, "--interface", "virtual", "--channel", self.channel)
        self.assertEqual([line for line in lines if not line.startswith("ok ")], [])
        self.assertGreater(len(lines), 50)
        self.assertEqual(code, 0)

    def test_nothing_is_wrong(self) -> None:
        self.check()

    def test_another_default_is_found(self) -> None:
        self.ask("2B04200001000000", "6004200000000000")
        code, lines = output_of(canopen_master.main, self.device, "--interface", "virtual", "--channel", self.channel)
        failed = [line for line in lines if not line.startswith("ok ")]
        self.assertEqual(failed, ["FAILED upload 2004:00: '01 00' instead of '00 00'"])
        self.assertEqual(code, 1)


class Kinco(Encoder):
    """A servo drive with RPDOs."""

    device = "kinco-servo"
    test_another_default_is_found = None


class Huacheng(Kinco):
    """The other servo drive."""

    device = "huacheng-ssts1"


class Teco(Kinco):
    """The gateway."""

    device = "teco-jn5-cm-can"


class Modbus(unittest.TestCase):
    """Each device over TCP, and one between two pseudo-terminals."""

    def check(self, name: str, *where: str) -> None:
        """The master finds nothing wrong with a device."""
        code, lines = output_of(modbus_master.main, name, *where)
        self.assertEqual([line for line in lines if not line.startswith("ok ")], [])
        self.assertGreater(len(lines), 20)
        self.assertEqual(code, 0)

    def test_tcp(self) -> None:
        for name in ("huacheng-ssts1", "liaomiao-encoder", "teco-jn5-cm-can"):
            with self.subTest(name):
                _, ready = start(self, name, "--tcp", "127.0.0.1:0")
                self.check(name, "--tcp", f"127.0.0.1:{ready.split()[1]}")

    def test_rtu(self) -> None:
        one_name, other_name = open_line(self)
        start(self, "liaomiao-encoder", "--port", one_name)
        self.check("liaomiao-encoder", "--port", other_name)

    def test_another_map_is_found(self) -> None:
        _, ready = start(self, "teco-jn5-cm-can", "--tcp", "127.0.0.1:0")
        code, lines = output_of(modbus_master.main, "huacheng-ssts1", "--tcp", f"127.0.0.1:{ready.split()[1]}")
        self.assertIn("FAILED read 003A: 2 came", lines)
        self.assertEqual(code, 1)


if __name__ == "__main__":
    unittest.main()
