"""The reports for programs, read by the programs they are for.

Needs FIELDPROOF (the program) and tshark.
"""

from __future__ import annotations

import pathlib
import subprocess
import unittest
from collections import Counter

import can
import tap.parser
import xmlschema
from junitparser import JUnitXml

from runs import Runs

SCHEMA = pathlib.Path(__file__).with_name("junit.xsd")


def tearDownModule() -> None:
    Runs.remove()


def tshark(capture: pathlib.Path, *arguments: str) -> list[list[str]]:
    """The fields of each packet."""
    command = ["tshark", "-r", str(capture), "-T", "fields", *arguments]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    return [line.split("\t") for line in ran.stdout.splitlines()]


class Captures(unittest.TestCase):
    """The traffic."""

    def test_wireshark_decodes_canopen_and_knows_the_case(self) -> None:
        reports = Runs.passing()
        fields = ("frame.time_epoch", "frame.comment", "frame.protocols", "can.id", "canopen.sdo.main_idx")
        arguments = [part for field in fields for part in ("-e", field)]
        packets = tshark(reports / "traffic/kinco-servo.pcapng", "-d", "can.subdissector,canopen", *arguments)
        frames = Runs.events(reports, "frame")
        self.assertEqual(len(packets), len(frames))
        # Wireshark does not look into remote frames, those without data, and 29-bit identifiers.
        for packet, frame in zip(packets, frames):
            self.assertTrue("canopen" in packet[2] or "remote" in frame or "extended" in frame or not frame["data"], packet)
        self.assertEqual([int(packet[3]) for packet in packets], [frame["id"] for frame in frames])
        commented = Counter(packet[1] for packet in packets)
        self.assertIn("kinco-servo.sdo/download-response-reserved-bytes", commented)
        self.assertGreater(sum("1017" in packet[4] for packet in packets), 10)
        # Nanoseconds, in the order of time.
        times = [packet[0] for packet in packets]
        self.assertTrue(all(len(time.split(".")[1]) == 9 for time in times))
        self.assertEqual(times, sorted(times))

    def test_wireshark_decodes_modbus_rtu(self) -> None:
        reports = Runs.modbus()
        arguments = ("-e", "frame.protocols", "-e", "modbus.func_code", "-e", "_ws.col.Info")
        packets = tshark(reports / "traffic/modbus-complete.pcapng", *arguments)
        self.assertEqual(len(packets), len(Runs.events(reports, "serial")))
        decoded = [packet for packet in packets if "modbus" in packet[0]]
        self.assertGreater(len(decoded), 0.8 * len(packets))
        kinds = Counter(packet[2].strip().split(":")[0] for packet in decoded)
        self.assertGreater(kinds["Query"], 100, kinds)
        self.assertGreater(kinds["Response"], 100, kinds)

    def test_candump_log_is_read_by_python_can(self) -> None:
        reports = Runs.passing()
        with can.CanutilsLogReader(str(reports / "traffic/kinco-servo.log")) as log:
            messages = list(log)
        frames = Runs.events(reports, "frame")
        self.assertEqual(len(messages), len(frames))
        for message, frame in zip(messages, frames):
            self.assertEqual(message.arbitration_id, frame["id"])
            self.assertEqual(message.is_rx, frame["direction"] != "sent")
            self.assertEqual(bytes(message.data).hex().upper(), frame["data"])


class Results(unittest.TestCase):
    """The verdicts."""

    def test_junit_keeps_the_schema_and_adds_up(self) -> None:
        schema = xmlschema.XMLSchema(SCHEMA)
        for reports in (Runs.failing(), Runs.killed(), Runs.modbus()):
            with self.subTest(reports.name):
                path = reports / "junit.xml"
                schema.validate(str(path))
                report = JUnitXml.fromfile(str(path))
                cases = [case for suite in report for case in suite]
                self.assertEqual(report.tests, len(cases))
                played = len(Runs.events(reports, "case-finished"))
                # Of a run that was killed, one more says so, and the case that was cut off is an error.
                self.assertEqual(len(cases), played + (2 if reports == Runs.killed() else 0))
                self.assertEqual(report.errors, 2 if reports == Runs.killed() else 0)
                self.assertEqual(report.failures > 0, reports == Runs.failing())

    def test_tap_is_read_by_a_tap_parser(self) -> None:
        for reports in (Runs.passing(), Runs.failing()):
            with self.subTest(reports.name):
                # This parser knows version 13, in which nothing is escaped.
                text = (reports / "report.tap").read_text(encoding="utf-8").replace("\\#", "_")
                lines = list(tap.parser.Parser().parse_text(text))
                points = [line for line in lines if line.category == "test"]
                verdicts = Counter(case["verdict"] for case in Runs.events(reports, "case-finished"))
                self.assertEqual(len(points), sum(verdicts.values()))
                self.assertEqual(sum(point.skip for point in points), verdicts["skipped"])
                self.assertEqual(sum(not point.ok for point in points), verdicts["fail"])
                plans = [line for line in lines if line.category == "plan"]
                self.assertEqual([plan.expected_tests for plan in plans], [len(points)])

    def test_manifest_is_checked_by_sha256sum(self) -> None:
        for reports in (Runs.passing(), Runs.killed()):
            command = ["sha256sum", "--check", "--quiet", "SHA256SUMS"]
            subprocess.run(command, cwd=reports, check=True)


if __name__ == "__main__":
    unittest.main(verbosity=2)
