"""What canopen and pymodbus do by themselves where the standards say otherwise: the evidence for README.md.

A test that fails after an update says that an addition of ours may not be needed any more.
"""

import itertools
import logging
import termios
import unittest

import can
import canopen
import serial
from pymodbus.exceptions import ModbusIOException
from pymodbus.framer import FramerRTU
from pymodbus.pdu import DecodePDU
from pymodbus.simulator import DataType, SimData, SimDevice
from pymodbus.simulator.simcore import SimCore

from canopen_device import default_eds
from tests.terminal import open_pseudo_terminal

_channels = itertools.count()


class LocalNode(unittest.TestCase):
    """A `canopen.LocalNode` of the encoder's EDS with nothing added."""

    def setUp(self) -> None:
        logging.disable(logging.CRITICAL)
        self.addCleanup(logging.disable, logging.NOTSET)
        channel = f"plain{next(_channels)}"
        self.tester = can.Bus(interface="virtual", channel=channel)
        self.addCleanup(self.tester.shutdown)
        network = canopen.Network()
        network.NOTIFIER_CYCLE = 0.05
        network.connect(interface="virtual", channel=channel)
        self.addCleanup(network.disconnect)
        self.node = network.create_node(32, canopen.import_od(str(default_eds("liaomiao-encoder")), 32))
        self.node.nmt.state = "INITIALISING"
        self.node.nmt.state = "PRE-OPERATIONAL"
        self.assertEqual(self.next(), "720#00")

    def next(self, within: float = 1.0) -> str | None:
        """The next frame of the node, or None."""
        message = self.tester.recv(within)
        return message and f"{message.arbitration_id:03X}#{message.data.hex().upper()}"

    def send(self, identifier: int, data: str, remote: bool = False) -> None:
        """A frame of the tester."""
        frame = can.Message(
            arbitration_id=identifier, is_extended_id=False, data=bytes.fromhex(data), is_remote_frame=remote
        )
        self.tester.send(frame)

    def answer(self, request: str) -> str | None:
        """The data of the answer to an SDO request, or None."""
        self.send(0x620, request)
        answer = self.next(0.1)
        return answer and answer.removeprefix("5A0#")

    def test_every_sub_index_of_a_var_is_there(self) -> None:
        self.assertEqual(self.answer("4000100100000000"), "4300100196010200")

    def test_every_sub_index_of_an_array_is_there(self) -> None:
        self.assertEqual(self.answer("4003100700000000"), "4303100700000000")

    def test_an_entry_without_a_default_cannot_be_read(self) -> None:
        self.assertEqual(self.answer("4004600000000000"), "8004600023000A06")

    def test_limits_are_not_looked_at(self) -> None:
        self.assertEqual(self.answer("2B03200007000000"), "6003200000000000")

    def test_one_code_for_every_wrong_length(self) -> None:
        self.assertEqual(self.answer("2F17100064000000"), "8017100010000706")
        self.assertEqual(self.answer("2317100064000000"), "8017100010000706")

    def test_a_size_that_is_not_indicated_is_four(self) -> None:
        self.assertEqual(self.answer("22171000E8030000"), "8017100010000706")

    def test_a_segmented_download_is_refused_with_its_last_segment(self) -> None:
        self.assertEqual(self.answer("2100100004000000"), "6000100000000000")
        self.assertEqual(self.answer("0701020304000000"), "8000100002000106")

    def test_a_segment_without_a_transfer_is_not_answered(self) -> None:
        self.assertIsNone(self.answer("6000000000000000"))
        self.assertIsNone(self.answer("E000100000000000"))

    def test_a_transfer_goes_on_after_a_toggle_error(self) -> None:
        self.assertEqual(self.answer("4008100000000000"), "410810000F000000")
        self.assertEqual(self.answer("7000000000000000"), "8008100000000305")
        self.assertEqual(self.answer("6000000000000000"), "004C69616F6D6961")

    def test_a_block_upload_that_may_not_change_its_protocol_does(self) -> None:
        self.assertEqual(self.answer("A00810007F000000"), "410810000F000000")

    def test_sdo_in_stopped(self) -> None:
        self.send(0, "0220")
        self.assertEqual(self.answer("4000100000000000"), "4300100096010200")

    def test_a_reset_is_a_state_and_nothing_else(self) -> None:
        self.assertEqual(self.answer("2301600010000000"), "6001600000000000")
        self.send(0, "8120")
        self.assertIsNone(self.next(0.1))
        self.assertEqual(self.answer("4001600000000000"), "4301600010000000")
        self.assertEqual(self.node.nmt.state, "INITIALISING")

    def test_commands_that_there_are_not_and_wrong_lengths_are_obeyed(self) -> None:
        for command, state in (("5020", "SLEEP"), ("6020", "STANDBY"), ("022000", "STOPPED")):
            self.send(0, command)
            self.answer("4000100000000000")
            self.assertEqual(self.node.nmt.state, state)

    def test_no_guarding_no_sync_no_lss(self) -> None:
        self.send(0, "0120")
        self.send(0x720, "", remote=True)
        self.send(0x080, "")
        self.send(0x7E5, "0401000000000000")
        self.send(0x7E5, "5A00000000000000")
        self.assertIsNone(self.next(0.1))


class Rpdo(unittest.TestCase):
    """What an RPDO does to the dictionary of a `canopen.LocalNode`."""

    def test_nothing(self) -> None:
        network = canopen.Network(can.Bus(interface="virtual", channel=f"plain{next(_channels)}"))
        self.addCleanup(network.disconnect)
        node = network.create_node(1, canopen.import_od(str(default_eds("kinco-servo")), 1))
        node.sdo[0x6040].raw = 0
        node.rpdo.read()
        network.notify(0x201, bytearray.fromhex("E8030000060003"), 0.0)
        self.assertEqual(node.rpdo[1]["6040"].raw, 6)
        self.assertEqual(node.sdo[0x6040].raw, 0)


class Pymodbus(unittest.TestCase):
    """The framer, decoder and data store of pymodbus."""

    def test_an_incomplete_frame_swallows_the_next(self) -> None:
        framer = FramerRTU(DecodePDU(True))
        incomplete, request = bytes.fromhex("200300010001"), bytes.fromhex("200300010001D37B")
        self.assertEqual(framer.handleFrame(incomplete, 0, 0), (0, None))
        self.assertEqual(framer.handleFrame(incomplete + request, 0, 0), (14, None))

    def test_a_count_of_0_is_refused_before_the_address_is_known(self) -> None:
        with self.assertRaises(ModbusIOException):
            FramerRTU(DecodePDU(True)).handleFrame(bytes.fromhex("21030000000042AA"), 0, 0)

    def test_an_unknown_function_is_waited_for(self) -> None:
        request = bytes.fromhex("204E0000")
        request += FramerRTU.compute_CRC(request).to_bytes(2, "big")
        self.assertEqual(FramerRTU(DecodePDU(True)).handleFrame(request, 0, 0), (0, None))

    def test_another_address_is_an_error_of_the_store(self) -> None:
        store = SimCore(SimDevice(32, simdata=[SimData(0, values=0, datatype=DataType.REGISTERS)]))
        with self.assertRaises(KeyError):
            store._SimCore__get_device(33)


class Pyserial(unittest.TestCase):
    """Parity on a pseudo-terminal, which has none: refused when nothing else changes, else ignored."""

    def test_parity_is_refused(self) -> None:
        _, name = open_pseudo_terminal(self)
        serial.Serial(name, 19200).close()
        with self.assertRaises(termios.error):
            serial.Serial(name, 19200, parity="E")


if __name__ == "__main__":
    unittest.main()
