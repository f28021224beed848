"""What our SocketCAN and serial links are built on, asked of the kernel this runs on. Needs vcan0 and vcan1."""

import os
import pty
import socket
import struct
import time
import tty

FRAME = struct.Struct("=IB3x8s")
SO_TIMESTAMPNS = 35
SO_RXQ_OVFL = 40


def open_bus(interface):
    bus = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
    bus.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
    bus.setsockopt(socket.SOL_SOCKET, SO_RXQ_OVFL, 1)
    bus.bind((interface,))
    bus.settimeout(5)
    return bus


def receive(bus):
    """One frame: identifier, data, {kind of ancillary datum: bytes}, flags."""
    frame, ancillary, flags, _ = bus.recvmsg(FRAME.size, 256)
    identifier, length, data = FRAME.unpack(frame)
    return identifier, data[:length], {kind: value for _, kind, value in ancillary}, flags


def stamp(ancillary):
    seconds, nanoseconds = struct.unpack("=qq", ancillary[SO_TIMESTAMPNS])
    return seconds * 1_000_000_000 + nanoseconds


def two_processes_exchange_frames_on_two_buses():
    for interface in ("vcan0", "vcan1"):
        client, server = open_bus(interface), open_bus(interface)
        child = os.fork()
        if child == 0:
            identifier, data, _, _ = receive(server)
            server.send(FRAME.pack(identifier - 0x80, 8, data[::-1]))
            os._exit(0)
        server.close()
        client.send(FRAME.pack(0x601, 8, b"01234567"))
        identifier, data, _, _ = receive(client)
        assert (identifier, data) == (0x581, b"76543210"), (hex(identifier), data)
        assert os.waitpid(child, 0)[1] == 0


def own_frame_comes_back_stamped_with_its_sending():
    bus = open_bus("vcan0")
    bus.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_RECV_OWN_MSGS, 1)
    before = time.time_ns()
    bus.send(FRAME.pack(0x123, 0, b""))
    after = time.time_ns()
    identifier, _, ancillary, flags = receive(bus)
    assert identifier == 0x123 and flags & socket.MSG_CONFIRM, (hex(identifier), flags)
    assert before <= stamp(ancillary) <= after, (before, stamp(ancillary), after)


def lost_frames_are_counted():
    sender, receiver = open_bus("vcan0"), open_bus("vcan0")
    sent = 5000
    for _ in range(sent):
        sender.send(FRAME.pack(0x123, 8, bytes(8)))
    received = 0
    receiver.setblocking(False)
    try:
        while True:
            receive(receiver)
            received += 1
    except BlockingIOError:
        pass
    # The count comes with the first frame that was queued after the loss.
    sender.send(FRAME.pack(0x123, 8, bytes(8)))
    _, _, ancillary, _ = receive(receiver)
    (lost,) = struct.unpack("=I", ancillary[SO_RXQ_OVFL])
    assert 0 < lost == sent - received, (sent, received, lost)


def pseudo_terminals_carry_bytes_unchanged():
    master, slave = pty.openpty()
    tty.setraw(slave)
    every = bytes(range(256))
    os.write(master, every)
    got = b""
    while len(got) < len(every):
        got += os.read(slave, 256)
    assert got == every, got


two_processes_exchange_frames_on_two_buses()
own_frame_comes_back_stamped_with_its_sending()
lost_frames_are_counted()
pseudo_terminals_carry_bytes_unchanged()
