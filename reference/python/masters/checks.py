"""One line for each check, and whether all were good."""


class Checks:
    """Prints `ok NAME` or `FAILED NAME: what came` as each check is made."""

    def __init__(self) -> None:
        self.made = 0
        self.failed = 0

    def equal(self, name: str, found: object, expected: object) -> None:
        """`found` must be `expected`."""
        self.that(name, found == expected, f"{found!r} instead of {expected!r}")

    def that(self, name: str, good: bool, otherwise: str) -> None:
        """`otherwise` says what came instead."""
        self.made += 1
        self.failed += not good
        print(f"ok {name}" if good else f"FAILED {name}: {otherwise}", flush=True)

    def exit_code(self) -> int:
        """0 when checks were made and all were good."""
        return 0 if self.made and not self.failed else 1
