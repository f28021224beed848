"""The LSS slave of the encoder."""

import unittest

from tests.bench import Bench


class Lss(Bench):
    """Requests on 7E5h, answers on 7E4h."""

    def configure(self) -> None:
        """Every LSS slave is in configuration."""
        self.send("7E5#0401000000000000")

    def change_node(self, node: int) -> None:
        """Configures and stores a node-ID."""
        self.configure()
        self.send(f"7E5#11{node:02X}000000000000")
        self.expect("7E4#1100000000000000")
        self.send("7E5#1700000000000000")
        self.expect("7E4#1700000000000000")

    def test_waits_at_first(self) -> None:
        self.send("7E5#5A00000000000000")
        self.expect_silence(0.05)

    def test_identity(self) -> None:
        self.configure()
        for request, answer in (
            ("5A", "5A3C060000000000"),
            ("5B", "5B01000000000000"),
            ("5C", "5C01000000000000"),
            ("5D", "5DB8615D0E000000"),
            ("5E", "5E20000000000000"),
        ):
            self.send(f"7E5#{request}00000000000000")
            self.expect(f"7E4#{answer}")
        self.send("7E5#0400000000000000")
        self.send("7E5#5A00000000000000")
        self.expect_silence(0.05)

    def test_selective(self) -> None:
        for serial in ("B9615D0E", "B8615D0E"):
            for frame in ("403C060000000000", "4101000000000000", "4201000000000000", f"43{serial}000000"):
                self.send(f"7E5#{frame}")
            if serial == "B8615D0E":
                self.expect("7E4#4400000000000000")
            self.expect_silence(0.05)

    def test_identify(self) -> None:
        frames = ("463C060000000000", "4701000000000000", "4800000000000000", "4901000000000000")
        for frame in (*frames, "4A00000000000000", "4BFFFFFFFF000000"):
            self.send(f"7E5#{frame}")
        self.expect("7E4#4F00000000000000")

    def test_node_comes_into_force_with_the_reset(self) -> None:
        self.change_node(5)
        self.ask("4000100000000000", "4300100096010200")
        self.send("000#8120")
        self.expect("705#00")
        self.node = 5
        self.ask("4000300000000000", "4F00300005000000")
        self.ask("4000180100000000", "4300180185010000")
        self.send("7E5#5A00000000000000")
        self.expect_silence(0.05)

    def test_node_by_sdo(self) -> None:
        self.ask("2F00300005000000", "6000300000000000")
        self.send("000#8120")
        self.expect("705#00")

    def test_refused(self) -> None:
        self.configure()
        for request, answer in (("1100", "1101"), ("1180", "1101"), ("1300C8", "1301"), ("130004", "1300")):
            self.send(f"7E5#{request:0<16}")
            self.expect(f"7E4#{answer:0<16}")


if __name__ == "__main__":
    unittest.main()
