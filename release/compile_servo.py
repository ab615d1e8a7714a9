"""Compile `palpate_servo` for platforms by name, and check what can be seen of the wheels.

    python release/compile_servo.py linux-x64 windows-x64 --output build/servo-of-systems

Without a platform, all of them.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from bundled_wheels import PackagingError
from servo_wheel.checking import faults
from servo_wheel.compiling import compile_wheel
from servo_wheel.target import TARGETS

REPOSITORY = Path(__file__).resolve().parent.parent
# Cargo's own place, where each target has a folder of its own.
WORK = REPOSITORY / "native" / "target"


def compiled(platform: str, output: Path, work: Path = WORK, features: str = "python") -> Path:
    """Return the checked wheel of one platform, in the folder `output`.

    Raises
    ------
    PackagingError
        It does not compile, or the wheel is not sound.
    """
    wheel = compile_wheel(TARGETS[platform], REPOSITORY, work, output, features)
    wrong = faults(wheel, TARGETS[platform])
    if wrong:
        raise PackagingError(f"{wheel.name} is not sound: " + "; ".join(wrong))
    return wheel


def main(arguments: list[str] | None = None) -> int:
    """Compile for the platforms that are named, or for all."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("platforms", nargs="*", metavar="PLATFORM", help=", ".join(TARGETS))
    parser.add_argument("--output", type=Path, default=REPOSITORY / "build" / "servo-of-systems")
    parser.add_argument("--work", type=Path, default=WORK)
    parser.add_argument("--features", default="python", help="python,harness for tests")
    options = parser.parse_args(arguments)
    unknown = [name for name in options.platforms if name not in TARGETS]
    if unknown:
        parser.error(f"no platform {', '.join(unknown)}; there are {', '.join(TARGETS)}")
    try:
        for name in options.platforms or TARGETS:
            wheel = compiled(name, options.output, options.work, options.features)
            print(f"{wheel} ({wheel.stat().st_size / 1e3:.0f} kB)")
    except PackagingError as error:
        print(f"compile_servo: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
