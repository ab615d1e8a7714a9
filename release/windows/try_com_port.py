"""Press through a COM port of wine, kill the host in mid-press, and read what its guardian says.

    python release/windows/try_com_port.py /var/tmp/palpate-windows

After `make test-windows`, whose root and Python it takes. Ends with 1 if a force is the last word.
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil

from palpate.simulated.attack.real.guardians import words_of_the_link
from palpate.simulated.attack.real.overheard import Overheard
from palpate.simulated.attack.target import ABOVE, DEEP
from palpate.simulated.hand.options import SimulatedOptions
from palpate.simulated.simulated_process import SimulatedDevice

HERE = Path(__file__).resolve().parent
PORT = "COM5"
PATIENCE_SECONDS = 120.0
TAIL_SECONDS = 1.0


def main(arguments: list[str] | None = None) -> int:
    """Try once, and print what was said after the kill, by time."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("root", type=Path, help="made by make_root.sh")
    parser.add_argument("--python", default="Python313", help="(default: %(default)s)")
    options = parser.parse_args(arguments)
    with (
        SimulatedDevice(SimulatedOptions(rest=ABOVE)) as device,
        Overheard(device.port) as line,
        subprocess.Popen(_host(options.root, options.python, line.port)) as host,
    ):
        try:
            _press(device)
            killed = time.monotonic()
            for process in _processes():
                process.send_signal(signal.SIGKILL)
            time.sleep(TAIL_SECONDS)
        finally:
            host.terminate()
        words = [word for word in words_of_the_link(list(line.said)) if word.time > killed]
    for word in words:
        print(f"{1e3 * (word.time - killed):7.1f} ms  {'force' if word.pushes else 'zero'}")
    return int(not words or words[-1].pushes)


def _host(root: Path, python: str, port: str) -> list[str | Path]:
    """Let the COM port lead to a terminal; return the command of a host there."""
    link = root / "windows" / "prefix" / "dosdevices" / PORT.lower()
    link.unlink(missing_ok=True)
    link.symlink_to(os.path.realpath(port))
    program = f"/windows/{python}/python.exe"
    return [HERE / "enter.sh", root, "wine", program, HERE / "com_port_host.py", PORT, "600"]


def _press(device: SimulatedDevice) -> None:
    """Wait until a force is felt."""
    deadline = time.monotonic() + PATIENCE_SECONDS
    while not device.report()["hellos"]:
        _still(deadline, "no host says HELLO")
    device.move_hand(DEEP, 0.3)
    while not any(device.report()["felt_force"]):
        _still(deadline, "no force comes")


def _still(deadline: float, trouble: str) -> None:
    if time.monotonic() > deadline:
        sys.exit(f"try_com_port: {trouble} within {PATIENCE_SECONDS:g} s")


def _processes() -> list[psutil.Process]:
    """The host, as Linux sees it: not what started it."""
    return [
        process
        for process in psutil.process_iter(["cmdline"])
        if "python.exe" in " ".join((process.info["cmdline"] or [])[:1])
        and PORT in process.info["cmdline"]
    ]


if __name__ == "__main__":
    raise SystemExit(main())
