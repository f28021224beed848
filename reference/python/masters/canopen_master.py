"""python-canopen as the master of a device: does an independent stack get on with it?

    canopen_master.py DEVICE --interface socketcan --channel can0 [--bitrate BITS] [--node N] [--eds FILE]

The device is reset, and left in Pre-operational with the values that it has after a reset. Prints a line for each
check, and ends with 1 if one failed.
"""

import argparse
import queue
import sys
from pathlib import Path

import canopen
from canopen.lss import LssError
from canopen.nmt import NmtError
from canopen.objectdictionary import INTEGER_TYPES, ODVariable
from canopen.sdo import SdoAbortedError, SdoCommunicationError

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from canopen_device import default_eds, default_node
from canopen_slave.bus import open_bus
from masters.checks import Checks

# Entries whose value after a reset is not the default of the EDS: what the inverter behind the module reads.
OTHER_DEFAULTS = {("teco-jn5-cm-can", 0x2025, sub) for sub in range(0x21, 0x31)} | {("teco-jn5-cm-can", 0x6043, 0)}
# Devices with LSS, and objects of an RPDO1 that may be written while the drive is at rest.
WITH_LSS = {"liaomiao-encoder"}
RPDO_VALUES = {
    "huacheng-ssts1": {0x6040: 6, 0x6060: 1},
    "kinco-servo": {0x60FF: 0, 0x6040: 6, 0x6060: 1},
    "teco-jn5-cm-can": {0x6040: 0, 0x6042: 500},
}


def entries(node: canopen.RemoteNode) -> list[ODVariable]:
    """Every entry of the EDS."""
    things = node.object_dictionary.values()
    return [entry for thing in things for entry in ([thing] if isinstance(thing, ODVariable) else thing.values())]


def upload(node: canopen.RemoteNode, index: int, sub_index: int) -> bytes | str:
    """The bytes of an entry, or what came instead."""
    try:
        return node.sdo.upload(index, sub_index)
    except SdoAbortedError as error:
        return f"abort {error.code:08X}"
    except SdoCommunicationError as error:
        return str(error)


def check_reset(node: canopen.RemoteNode, checks: Checks) -> None:
    """NMT reset node, and the boot-up message."""
    states: queue.Queue[int] = queue.Queue()
    # The library's `wait_for_bootup` misses a message that comes before it is called.
    node.nmt.add_heartbeat_callback(states.put)
    node.nmt.state = "RESET"
    try:
        checks.equal("boot-up after reset node", states.get(timeout=5), 0)
    except queue.Empty:
        checks.that("boot-up after reset node", False, "nothing came")


def check_dictionary(device: str, node: canopen.RemoteNode, checks: Checks) -> None:
    """Every entry: its length, its default, or that it cannot be read."""
    for entry in entries(node):
        name = f"upload {entry.index:04X}:{entry.subindex:02X}"
        data = upload(node, entry.index, entry.subindex)
        if not entry.readable:
            checks.equal(name, data, "abort 06010001")
        elif isinstance(data, str):
            checks.that(name, False, data)
        elif entry.default is None or (device, entry.index, entry.subindex) in OTHER_DEFAULTS:
            whole = entry.data_type not in INTEGER_TYPES or len(data) == len(entry) // 8
            checks.that(name, whole, f"{len(data)} bytes instead of {len(entry) // 8}")
        else:
            checks.equal(name, data.hex(" "), entry.encode_raw(entry.default).hex(" "))
    checks.equal("upload of an object that there is not", upload(node, 0x5FFF, 0), "abort 06020000")
    checks.equal("upload of a sub-index that there is not", upload(node, 0x1000, 1), "abort 06090011")


def check_string(node: canopen.RemoteNode, checks: Checks) -> None:
    """The device name comes in segments, whole."""
    name = node.object_dictionary[0x1008].default
    with node.sdo[0x1008].open("r", encoding="ascii") as file:
        checks.equal("device name in segments", file.read(), name)


def check_states(node: canopen.RemoteNode, checks: Checks) -> None:
    """The heartbeat has the state that was commanded."""
    node.sdo[0x1017].raw = 50
    for state in ("OPERATIONAL", "PRE-OPERATIONAL", "STOPPED", "PRE-OPERATIONAL"):
        node.nmt.state = state
        # One may have been on its way.
        node.nmt.wait_for_heartbeat(2)
        checks.equal(f"heartbeat of {state.lower()}", node.nmt.wait_for_heartbeat(2), state)
    node.sdo[0x1017].raw = 0


def check_transmit_pdo(node: canopen.RemoteNode, checks: Checks) -> None:
    """The first TPDO that is in force comes with SYNC, and carries what SDO reads."""
    node.tpdo.read()
    pdo = next(map_ for map_ in node.tpdo.values() if map_.enabled)
    pdo.trans_type = 1
    pdo.save()
    node.nmt.state = "OPERATIONAL"
    # When this is answered the command has been obeyed.
    node.sdo.upload(0x1000, 0)
    with pdo.receive_condition:
        pdo.is_received = False
        node.network.sync.transmit()
        pdo.receive_condition.wait(2)
    checks.that(f"{pdo.name} with SYNC", pdo.is_received, "nothing came")
    for variable in pdo:
        data = node.sdo.upload(variable.index, variable.subindex)
        checks.equal(f"{pdo.name} carries {variable.index:04X}:{variable.subindex:02X}", bytes(variable.data), data)


def check_receive_pdo(device: str, node: canopen.RemoteNode, checks: Checks) -> None:
    """What RPDO1 brings is read over SDO."""
    node.rpdo.read()
    for index, value in RPDO_VALUES[device].items():
        node.rpdo[1][f"{index:x}"].raw = value
    node.rpdo[1].transmit()
    for index, value in RPDO_VALUES[device].items():
        if node.object_dictionary[index].readable:
            checks.equal(f"RPDO1 sets {index:04X}", node.sdo[index].raw, value)
    node.sdo[0x6040].raw = 0


def check_lss(network: canopen.Network, node: canopen.RemoteNode, checks: Checks) -> None:
    """The LSS address is the identity, and selects the device."""
    identity = [node.sdo[0x1018][sub].raw for sub in range(1, 5)]
    network.lss.send_switch_state_global(network.lss.CONFIGURATION_STATE)
    found = [network.lss.inquire_lss_address(specifier) for specifier in (0x5A, 0x5B, 0x5C, 0x5D)]
    checks.equal("LSS identity", found, identity)
    network.lss.send_switch_state_global(network.lss.WAITING_STATE)
    checks.that("LSS switch selective", network.lss.send_switch_state_selective(*identity), "no answer")
    network.lss.send_switch_state_global(network.lss.WAITING_STATE)


def arguments(given: list[str] | None) -> argparse.Namespace:
    """What to check, and where."""
    parser = argparse.ArgumentParser(description="python-canopen as the master of a device.")
    parser.add_argument("device")
    parser.add_argument("--interface", default="socketcan", help="of python-can: socketcan, slcan, virtual")
    parser.add_argument("--channel", required=True, help="can0, /dev/ttyACM0, socket://host:port")
    parser.add_argument("--bitrate", type=int, help="in bit/s, for an adapter that sets it")
    parser.add_argument("--node", type=int, help="the node-ID; else that of the description")
    parser.add_argument("--eds", type=Path, help="another EDS than the one in fixtures/devices")
    return parser.parse_args(given)


def main(given: list[str] | None = None) -> int:
    """Makes every check that applies to the device."""
    options = arguments(given)
    device, checks = options.device, Checks()
    node_id = options.node or default_node(device)
    network = open_bus(options.interface, options.channel, options.bitrate)
    try:
        node = network.add_node(node_id, canopen.import_od(str(options.eds or default_eds(device)), node_id))
        check_reset(node, checks)
        check_dictionary(device, node, checks)
        check_string(node, checks)
        check_states(node, checks)
        check_transmit_pdo(node, checks)
        if device in RPDO_VALUES:
            check_receive_pdo(device, node, checks)
        if device in WITH_LSS:
            check_lss(network, node, checks)
        check_reset(node, checks)
    except (SdoCommunicationError, SdoAbortedError, NmtError, LssError) as error:
        checks.that("the rest", False, f"{type(error).__name__}: {error}")
    finally:
        network.disconnect()
    return checks.exit_code()


if __name__ == "__main__":
    sys.exit(main())
