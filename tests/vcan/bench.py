"""Devices as processes on the buses of this kernel, and a bench file for them."""

from __future__ import annotations

import contextlib
import os
import pathlib
import signal
import subprocess
import time
from collections.abc import Iterator
from dataclasses import dataclass, field

ROOT = pathlib.Path(__file__).resolve().parents[2]
FIELDPROOF = os.environ.get("FIELDPROOF", str(ROOT / "target/release/fieldproof"))

# How long a device may take until it is on its bus, and how long to end, in seconds.
START_SECONDS = 30
END_SECONDS = 20

# What the scheduler of a busy machine does to every instant; the bus itself is a thousand times better.
UNCERTAINTY = "10ms"

# What our devices offer; a bench must not promise more.
ALL_STIMULI = ["power", "process-value", "condition", "setting"]
WITHOUT_CONDITIONS = ["liaomiao-encoder", "teco-inverter", "teco-jn5-cm-can"]


@dataclass
class Device:
    """A device process and how a bench names it."""

    name: str
    """Its name on the bench."""
    kind: str
    """Which device it is."""
    command: list[str]
    """What runs it; it prints `ready` once it is on the bus."""
    ports: dict[str, str]
    """The tester's links, by role."""
    node: int | None = None
    address: int | None = None
    control: pathlib.Path | None = None
    """The socket that takes stimuli."""
    permits: list[str] = field(
        default_factory=lambda: ["writes", "persists", "readdresses", "moves", "resets", "disturbs-bus"]
    )

    def on_bench(self) -> str:
        """Its entry in a bench file."""
        ports = ", ".join(f'{role}: "{link}"' for role, link in self.ports.items())
        lines = [f"  - name: {self.name}", f"    device: {self.kind}", f"    ports: {{{ports}}}"]
        if self.node is not None:
            lines.append(f"    node: {self.node}")
        if self.address is not None:
            lines.append(f"    address: {self.address}")
        if self.control is not None:
            offered = [it for it in ALL_STIMULI if it != "condition" or self.kind not in WITHOUT_CONDITIONS]
            lines.append(f"    stimuli: [{', '.join(offered)}]")
            lines.append(f'    stimulus-command: ["{FIELDPROOF}", stimulate, "{self.control}"]')
        lines.append(f"    permits: [{', '.join(self.permits)}]")
        return "\n".join(lines) + "\n"


def bench_file(devices: list[Device]) -> str:
    """A bench of these devices."""
    return "language: 1\nbench: processes\ndevices:\n" + "".join(it.on_bench() for it in devices)


def served(
    name: str, kind: str, interface: str, folder: pathlib.Path, node: int | None = None, fault: str | None = None
) -> Device:
    """A reference device of ours on a CAN interface, with a door for stimuli."""
    control = folder / f"{name}.control"
    command = [FIELDPROOF, "serve", kind, "--on", f"socketcan:{interface}", "--control", str(control)]
    if node is not None:
        command += ["--node", str(node)]
    if fault is not None:
        command += ["--fault", fault]
    link = f"socketcan:{interface}?uncertainty={UNCERTAINTY}"
    return Device(name, kind, command, {"can": link}, node=node, control=control)


@contextlib.contextmanager
def running(device: Device, folder: pathlib.Path) -> Iterator[subprocess.Popen[str]]:
    """Runs a device until the end of the block, where it must end well."""
    log_path = folder / f"{device.name}.log"
    with log_path.open("w", encoding="utf-8") as log:
        process = subprocess.Popen(device.command, stdout=log, stderr=log, text=True)
        try:
            wait_until_ready(process, log_path)
            yield process
            if process.poll() is not None:
                raise AssertionError(f"{device.name} ended early:\n{log_path.read_text()}")
            process.send_signal(signal.SIGINT)
            code = process.wait(END_SECONDS)
            if code != 0:
                raise AssertionError(f"{device.name} ended with {code}:\n{log_path.read_text()}")
        finally:
            process.kill()
            process.wait()


def wait_until_ready(process: subprocess.Popen[str], log_path: pathlib.Path) -> None:
    """Waits for the line that says that the device is on its bus."""
    deadline = time.monotonic() + START_SECONDS
    while not any(line.startswith("ready") for line in log_path.read_text().splitlines()):
        if process.poll() is not None or time.monotonic() > deadline:
            raise AssertionError(f"{process.args} did not start:\n{log_path.read_text()}")
        time.sleep(0.05)
