"""The same transfers with python-canopen:   python_canopen.py IFACE SECONDS

Prints expedited reads a second, then bytes a second of a segmented and of a block upload of 10,000 bytes.
"""

import sys
import time

import canopen

LARGE_SIZE = 10_000


def rate(transaction, seconds):
    """How often it can be done in a second."""
    transaction()
    done = 0
    begin = time.monotonic()
    while time.monotonic() - begin < seconds:
        transaction()
        done += 1
    return done / (time.monotonic() - begin)


def main():
    interface, seconds = sys.argv[1], float(sys.argv[2])
    network = canopen.Network()
    network.connect(interface="socketcan", channel=interface)
    sdo = network.add_node(1, canopen.ObjectDictionary()).sdo
    sdo.RESPONSE_TIMEOUT = 1

    def expedited():
        assert sdo.upload(0x1000, 0) == bytes([0x91, 0x01, 0x0F, 0x00])

    def large(block):
        with sdo.open(0x2000, 0, "rb", buffering=1024, block_transfer=block) as stream:
            assert len(stream.read()) == LARGE_SIZE

    print(f"python-canopen {rate(expedited, seconds):.0f}")
    print(f"python-canopen-segmented {rate(lambda: large(False), seconds) * LARGE_SIZE:.0f}")
    print(f"python-canopen-block {rate(lambda: large(True), seconds) * LARGE_SIZE:.0f}")
    network.disconnect()


main()
