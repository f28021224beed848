"""Functions called later, in one thread."""

import heapq
import itertools
import logging
import threading
import time
from collections.abc import Callable, Hashable

logger = logging.getLogger(__name__)


class Timers:
    """Each key has at most one call outstanding; a new one takes the place of the old.

    Calls are made under `lock`, the one that received frames are handled under, so nothing of a node runs twice at once.
    """

    def __init__(self, lock: threading.RLock) -> None:
        self._lock = lock
        self._wake = threading.Condition()
        self._queue: list[tuple[float, int, Hashable, Callable[[float], None]]] = []
        self._current: dict[Hashable, int] = {}
        self._tickets = itertools.count()
        self._ended = False
        self._thread = threading.Thread(target=self._run, name="timers", daemon=True)
        self._thread.start()

    def call_at(self, key: Hashable, instant: float, function: Callable[[float], None]) -> None:
        """Calls `function(instant)` at `instant`, in seconds of `time.monotonic()`."""
        with self._wake:
            ticket = next(self._tickets)
            self._current[key] = ticket
            heapq.heappush(self._queue, (instant, ticket, key, function))
            self._wake.notify()

    def cancel(self, key: Hashable) -> None:
        """The outstanding call of `key` is not made."""
        with self._wake:
            self._current.pop(key, None)

    def pending(self, key: Hashable) -> bool:
        """Whether a call of `key` is outstanding."""
        with self._wake:
            return key in self._current

    def end(self) -> None:
        """No call is made any more."""
        with self._wake:
            self._ended = True
            self._wake.notify()
        self._thread.join()

    def _next(self) -> tuple[float, int, Hashable, Callable[[float], None]] | None:
        """Waits for the call that is due next; None at the end."""
        with self._wake:
            while not self._ended:
                if not self._queue:
                    self._wake.wait()
                    continue
                left = self._queue[0][0] - time.monotonic()
                if left <= 0:
                    return heapq.heappop(self._queue)
                self._wake.wait(left)
        return None

    def _run(self) -> None:
        while (due := self._next()) is not None:
            instant, ticket, key, function = due
            # The lock first: who holds it may be about to cancel this call.
            with self._lock:
                with self._wake:
                    if self._current.get(key) != ticket:
                        continue
                    del self._current[key]
                try:
                    function(instant)
                # A bus that does not take a frame shall not end the timers; the receiving thread sees when it is gone.
                except Exception:
                    logger.exception("%s", key)
