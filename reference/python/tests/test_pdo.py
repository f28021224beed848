"""PDOs: with SYNC, on change, by timer, within the inhibit time."""

import unittest

from tests.bench import Bench


class Encoder(Bench):
    """Two transmit PDOs."""

    def test_event_timer(self) -> None:
        self.ask("2B00620014000000", "6000620000000000")
        self.ask("4000180500000000", "4B00180514000000")
        self.send("000#0120")
        instants = [self.expect("1A0#0000000000000000") for _ in range(6)]
        self.assertAlmostEqual((instants[-1] - instants[0]) / 5, 0.02, delta=0.005)

    def test_one_for_each_sync_and_none_before_operational(self) -> None:
        self.ask("2B006200FFFF0000", "6000620000000000")
        self.send("080#")
        self.expect_silence(0.05)
        self.send("000#0120")
        self.expect("1A0#0000000000000000")
        for _ in range(2):
            self.send("080#")
            self.expect("2A0#0000000000000000")
        self.send("080#05")
        self.expect("2A0#0000000000000000")
        self.expect_silence(0.05)

    def test_every_third_sync(self) -> None:
        self.ask("2B006200FFFF0000", "6000620000000000")
        self.ask("2F01180203000000", "6001180200000000")
        self.send("000#0120")
        self.expect("1A0#0000000000000000")
        for _ in range(2):
            self.send("080#")
            self.send("080#")
            self.expect_silence(0.05)
            self.send("080#")
            self.expect("2A0#0000000000000000")


class Kinco(Bench):
    """Transmit and receive PDOs with a mapping of one's own."""

    device = "kinco-servo"

    def start(self) -> None:
        """TPDO1 is sent once when the node is operational."""
        self.send("000#0101")
        self.expect("181#000000005002")

    def test_rpdo_takes_effect_and_its_change_sends_the_tpdo(self) -> None:
        self.start()
        self.send("201#E8030000060003")
        self.expect("181#000000003102")
        self.ask("4040600000000000", "4B40600006000000")
        self.ask("4061600000000000", "4F61600003000000")

    def test_synchronous_rpdo_waits(self) -> None:
        self.ask("2F00140201000000", "6000140200000000")
        self.start()
        self.send("201#E8030000060003")
        self.ask("4040600000000000", "4B40600000000000")
        self.send("080#")
        self.expect("181#000000003102")
        self.ask("4040600000000000", "4B40600006000000")

    def test_short_rpdo_is_an_emergency_and_changes_nothing(self) -> None:
        self.start()
        self.send("201#E80300000600")
        self.expect("081#1082110000000000")
        self.ask("4040600000000000", "4B40600000000000")
        self.ask("4001100000000000", "4F01100011000000")
        self.send("201#00000000000000")
        self.expect("081#0000000000000000")

    def test_rpdo_in_pre_operational_is_not_taken(self) -> None:
        self.send("201#E8030000060003")
        self.ask("4040600000000000", "4B40600000000000")

    def test_inhibit_time(self) -> None:
        self.ask("2300180181010080", "6000180100000000")
        self.ask("2B001803F4010000", "6000180300000000")
        self.ask("2B00180505000000", "6000180500000000")
        self.ask("2300180181010000", "6000180100000000")
        self.send("000#0101")
        instants = [self.expect("181#000000005002") for _ in range(4)]
        self.assertAlmostEqual((instants[-1] - instants[0]) / 3, 0.05, delta=0.01)

    def test_moved_and_remapped(self) -> None:
        self.ask("2300180181010080", "6000180100000000")
        self.ask("2F001A0000000000", "60001A0000000000")
        self.ask("23001A0110004160", "60001A0100000000")
        self.ask("2F001A0001000000", "60001A0000000000")
        self.ask("2F00180201000000", "6000180200000000")
        self.ask("2300180191010040", "6000180100000000")
        self.send("000#0101")
        self.send("080#")
        self.expect("191#5002")
        self.expect_silence(0.05)


class Huacheng(Bench):
    """A drive that can send SYNC."""

    device = "huacheng-ssts1"

    def test_sync_producer(self) -> None:
        self.ask("23061000204E0000", "6006100000000000")
        self.expect_silence(0.05)
        self.send("601#2305100080000040")
        frames = sorted((self.tester.recv(1).arbitration_id for _ in range(2)))
        self.assertEqual(frames, [0x080, 0x581])
        instants = [self.expect("080#") for _ in range(4)]
        self.assertAlmostEqual((instants[-1] - instants[0]) / 3, 0.02, delta=0.005)


if __name__ == "__main__":
    unittest.main()
