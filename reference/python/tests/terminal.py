"""Pseudo-terminals in the place of serial lines."""

import os
import select
import threading
import tty
import unittest


def open_pseudo_terminal(test: unittest.TestCase) -> tuple[int, str]:
    """One without line editing, until the test ends: the file descriptor of one end, and the name of the other."""
    line, other = os.openpty()
    tty.setraw(other)
    for file in (line, other):
        # Held open, the other end reads as silence and not as an error before a device opens it.
        test.addCleanup(os.close, file)
    return line, os.ttyname(other)


def open_line(test: unittest.TestCase) -> tuple[str, str]:
    """Two pseudo-terminals joined: what one name is written is read from the other."""
    (one, one_name), (two, two_name) = open_pseudo_terminal(test), open_pseudo_terminal(test)
    ended, end = os.pipe()

    def relay() -> None:
        while ended not in (ready := select.select([one, two, ended], [], [])[0]):
            for file in ready:
                os.write(two if file == one else one, os.read(file, 256))

    thread = threading.Thread(target=relay)
    thread.start()
    test.addCleanup(os.close, ended)
    test.addCleanup(thread.join)
    test.addCleanup(os.close, end)
    return one_name, two_name
