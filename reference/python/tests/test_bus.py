"""`fieldproof bus` with python-can as its clients, as if each had an adapter.

The program is that of the environment variable FIELDPROOF, else target/debug/fieldproof.
"""

import os
import signal
import subprocess
import unittest
from pathlib import Path

import can

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = os.environ.get("FIELDPROOF", str(ROOT / "target/debug/fieldproof"))

FRAMES = 500


class Bus(unittest.TestCase):
    def setUp(self) -> None:
        command = [PROGRAM, "bus", "--tcp", "127.0.0.1:0", "--pty", "1"]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        self.addCleanup(self.interrupt)
        tcp, self.terminal = (self.process.stdout.readline().strip().removeprefix("slcan:") for _ in range(2))
        self.socket = tcp.replace("tcp://", "socket://")

    def interrupt(self) -> None:
        self.process.send_signal(signal.SIGINT)
        self.assertEqual(self.process.wait(5), 0)
        self.process.stdout.close()

    def client(self, channel: str, bitrate: int = 500_000) -> can.BusABC:
        bus = can.Bus(interface="slcan", channel=channel, bitrate=bitrate, sleep_after_open=0)
        self.addCleanup(bus.shutdown)
        # The answer to this comes after the channel is open.
        self.assertEqual(bus.get_version(5), (10, 13))
        return bus

    def exchange(self, first: can.BusABC, second: can.BusABC) -> None:
        """Frames of every kind, both ways."""
        messages = [
            can.Message(arbitration_id=0x60A, is_extended_id=False, data=bytes.fromhex("4000100000000000")),
            can.Message(arbitration_id=0x080, is_extended_id=False),
            can.Message(arbitration_id=0x1FFFFFFF, is_extended_id=True, data=b"\xaa"),
            can.Message(arbitration_id=0x701, is_extended_id=False, is_remote_frame=True, dlc=1),
        ]
        for sender, receiver in [(first, second), (second, first)]:
            for message in messages:
                sender.send(message)
                self.expect(receiver, message)

    def expect(self, receiver: can.BusABC, message: can.Message) -> None:
        # Acknowledges of own frames are no messages, but end a call of recv.
        came = next((came for came in (receiver.recv(5) for _ in range(10)) if came is not None), None)
        self.assertIsNotNone(came, f"{message} did not come")
        self.assertTrue(came.equals(message, timestamp_delta=None, check_channel=False, check_direction=False), came)

    def test_two_clients_over_tcp(self) -> None:
        self.exchange(self.client(self.socket), self.client(self.socket))

    def test_tcp_and_a_pseudo_terminal(self) -> None:
        self.exchange(self.client(self.socket), self.client(self.terminal))

    def test_no_frame_is_lost(self) -> None:
        sender, receiver = self.client(self.terminal), self.client(self.socket)
        for number in range(FRAMES):
            sender.send(can.Message(arbitration_id=0x181, is_extended_id=False, data=number.to_bytes(4, "little")))
        for number in range(FRAMES):
            self.assertEqual(receiver.recv(5).data, number.to_bytes(4, "little"))

    def test_another_bit_rate_is_not_heard(self) -> None:
        sender, receiver = self.client(self.socket, 500_000), self.client(self.socket, 125_000)
        sender.send(can.Message(arbitration_id=0x181, is_extended_id=False))
        # The answer to this comes after the frame was on the bus.
        self.assertEqual(sender.get_version(5), (10, 13))
        self.assertIsNone(receiver.recv(0.1))


if __name__ == "__main__":
    unittest.main()
