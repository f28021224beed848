"""NMT, error control and EMCY."""

import unittest

from tests.bench import Bench


class Encoder(Bench):
    """States, boot-up, heartbeat, guarding."""

    def test_boots_once(self) -> None:
        self.expect_silence(0.1)

    def test_resets_end_in_a_boot_up(self) -> None:
        for command in ("81", "82"):
            self.send(f"000#{command}20")
            self.expect("720#00")
            self.expect_silence(0.05)
            self.ask("4000100000000000", "4300100096010200")

    def test_heartbeat_has_its_period_and_state(self) -> None:
        # The library's thread may be ahead of the confirmation.
        self.send("620#2B17100032000000")
        frames = sorted((self.tester.recv(1).arbitration_id for _ in range(2)))
        self.assertEqual(frames, [0x5A0, 0x720])
        instants = [self.expect("720#7F") for _ in range(5)]
        self.assertAlmostEqual((instants[-1] - instants[0]) / 4, 0.05, delta=0.01)
        self.send("000#0220")
        self.tester.recv(1)
        self.expect("720#04")

    def test_a_reset_ends_the_heartbeat_that_is_not_stored(self) -> None:
        self.send("620#2B17100014000000")
        self.wait(0.05)
        self.send("000#8220")
        while (message := self.tester.recv(1)) is not None and message.data != b"\0":
            self.assertIn(message.arbitration_id, (0x5A0, 0x720))
        self.expect_silence(0.1)

    def test_reset_communication_leaves_the_application(self) -> None:
        self.ask("2B04200001000000", "6004200000000000")
        self.ask("2301600010000000", "6001600000000000")
        self.ask("2B0C1000E8030000", "600C100000000000")
        self.send("000#8220")
        self.expect("720#00")
        self.ask("4001600000000000", "4301600010000000")
        self.ask("400C100000000000", "4B0C100000000000")
        self.send("000#8120")
        self.expect("720#00")
        self.ask("4001600000000000", "4301600000200000")
        # Saved by itself.
        self.ask("4004200000000000", "4B04200001000000")

    def test_other_frames_change_nothing(self) -> None:
        for frame in ("000#0221", "000#02", "000#022000", "000#5020", "000#6020", "000#0020"):
            self.send(frame)
        self.ask("4000100000000000", "4300100096010200")

    def test_guarding_toggles_from_0_after_a_reset(self) -> None:
        for _ in range(2):
            for answer in ("7F", "FF", "7F"):
                self.send("720#R1")
                self.expect(f"720#{answer}")
            self.send("000#8220")
            self.expect("720#00")

    def test_life_time_ends_with_an_emergency(self) -> None:
        self.ask("2B0C100014000000", "600C100000000000")
        self.ask("2F0D100002000000", "600D100000000000")
        self.send("720#R1")
        self.expect("720#7F")
        self.expect("0A0#3081110000000000")
        self.ask("4003100100000000", "4303100130810000")
        self.send("720#R1")
        self.expect("720#FF")
        self.expect("0A0#0000000000000000")


class Teco(Bench):
    """A device without node guarding."""

    device = "teco-jn5-cm-can"

    def test_no_guarding(self) -> None:
        self.send("701#R1")
        self.expect_silence(0.05)

    def test_no_lss(self) -> None:
        self.send("7E5#0401000000000000")
        self.send("7E5#5A00000000000000")
        self.expect_silence(0.05)


if __name__ == "__main__":
    unittest.main()
