"""The SDO server, frame by frame."""

import unittest

from tests.bench import Bench


class Encoder(Bench):
    """Access, lengths, limits and the order of frames."""

    def test_expedited_upload(self) -> None:
        self.ask("4000100000000000", "4300100096010200")

    def test_segmented_upload_of_five_bytes(self) -> None:
        self.ask("4010650000000000", "4110650005000000")
        self.ask("6000000000000000", "0500000000000000")
        self.ask("4000100000000000", "4300100096010200")

    def test_segments_alternate(self) -> None:
        self.ask("4008100000000000", "410810000F000000")
        self.ask("6000000000000000", "004C69616F6D6961")
        self.ask("7000000000000000", "106F2D474D452D35")
        self.ask("6000000000000000", "0D38000000000000")

    def test_toggle_that_stays_ends_the_transfer(self) -> None:
        self.ask("4008100000000000", "410810000F000000")
        self.ask("7000000000000000", "8008100000000305")
        self.ask("6000000000000000", "8008100001000405")

    def test_segment_without_a_transfer(self) -> None:
        self.ask("6000000000000000", "8000000001000405")
        self.ask("0001000000000000", "8000000001000405")

    def test_unknown_command(self) -> None:
        self.ask("E000100000000000", "8000100001000405")
        self.ask("C400100000000000", "8000100001000405")

    def test_block_upload_is_refused_unless_segments_are_allowed(self) -> None:
        self.ask("A00810007F000000", "8008100001000405")
        self.ask("A00810007F7F0000", "410810000F000000")

    def test_object_and_sub_index(self) -> None:
        self.ask("40FF5F0000000000", "80FF5F0000000206")
        self.ask("4000100100000000", "8000100111000906")
        self.ask("4003100700000000", "8003100711000906")

    def test_access(self) -> None:
        self.ask("2300100000000000", "8000100002000106")
        self.ask("2110650005000000", "8010650002000106")

    def test_length(self) -> None:
        self.ask("2317100064000000", "8017100012000706")
        self.ask("2F17100064000000", "8017100013000706")
        self.ask("2117100003000000", "8017100012000706")

    def test_size_not_indicated(self) -> None:
        self.ask("220320000C000000", "6003200000000000")
        self.ask("4003200000000000", "4B0320000C000000")

    def test_segmented_download(self) -> None:
        self.ask("2103600004000000", "6003600000000000")
        self.ask("0701020304000000", "2000000000000000")
        self.ask("4003600000000000", "4303600001020304")

    def test_announced_size_is_kept(self) -> None:
        self.ask("2103600004000000", "6003600000000000")
        self.ask("0901020300000000", "8003600010000706")

    def test_limits(self) -> None:
        self.ask("2B03200007000000", "8003200032000906")
        self.ask("2B03200011000000", "8003200031000906")
        self.ask("2B03200008000000", "6003200000000000")

    def test_history_takes_only_0(self) -> None:
        self.ask("2F03100001000000", "8003100030000906")
        self.ask("2F03100000000000", "6003100000000000")

    def test_stores_nothing_on_command(self) -> None:
        self.ask("2310100173617665", "8010100102000106")
        self.ask("231110016C6F6164", "8011100120000008")

    def test_short_frame_is_ignored(self) -> None:
        self.send("620#40001000")
        self.expect_silence(0.05)

    def test_not_in_stopped(self) -> None:
        self.send("000#0220")
        self.send("620#4000100000000000")
        self.expect_silence(0.05)


class Kinco(Bench):
    """What only a servo drive has."""

    device = "kinco-servo"

    def test_write_only(self) -> None:
        self.ask("407A600000000000", "807A600001000106")

    def test_reserved_transmission_type(self) -> None:
        self.ask("2F001802F5000000", "8000180230000906")

    def test_mapping(self) -> None:
        self.ask("2F001A0000000000", "80001A0022000008")
        self.ask("2300180181010080", "6000180100000000")
        self.ask("2F001A0000000000", "60001A0000000000")
        self.ask("23001A0120000010", "80001A0141000406")
        self.ask("23001A012000FF5F", "80001A0100000206")
        self.ask("23001A0220006360", "60001A0200000000")
        self.ask("23001A0310004160", "60001A0300000000")
        self.ask("2F001A0003000000", "80001A0042000406")

    def test_cob_id_is_changed_while_invalid(self) -> None:
        self.ask("2300180182010000", "8000180130000906")
        self.ask("2300180181010020", "8000180130000906")

    def test_status_follows_control_word(self) -> None:
        self.ask("4041600000000000", "4B41600050020000")
        for control, status in (("06", "3102"), ("07", "3302"), ("0F", "3702"), ("00", "5002")):
            self.ask(f"2B406000{control}000000", "6040600000000000")
            self.ask("4041600000000000", f"4B416000{status}0000")

    def test_store_and_restore(self) -> None:
        self.ask("2B5A600005000000", "605A600000000000")
        self.ask("2310100100000000", "8010100120000008")
        self.ask("2310100173617665", "6010100100000000")
        self.send("000#8101")
        self.expect("701#00")
        self.ask("405A600000000000", "4B5A600005000000")
        self.ask("231110016C6F6164", "6011100100000000")
        self.send("000#8101")
        self.expect("701#00")
        self.ask("405A600000000000", "4B5A600002000000")


class Teco(Bench):
    """The gateway."""

    device = "teco-jn5-cm-can"

    def test_target_reaches_the_registers(self) -> None:
        self.ask("2B42600052A40000", "6042600000000000")
        self.ask("2B40600001000000", "6040600000000000")
        self.ask("4025200200000000", "4B25200203000000")
        self.ask("4025200300000000", "4B252003A4480000")

    def test_target_above_the_limit(self) -> None:
        self.ask("2B426000214E0000", "8042600031000906")

    def test_no_sync_producer(self) -> None:
        self.ask("2305100080000040", "8005100030000906")


if __name__ == "__main__":
    unittest.main()
