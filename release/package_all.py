"""Make the packages of every platform, from one machine, and tell what is in them.

    python release/package_all.py --blender .venv-bpy-5.2.3 --output build/packages-all

The same commit and tools give the same bytes; `SHA256SUMS` beside the packages is there to compare.
"""

from __future__ import annotations

import argparse
import hashlib
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from blenders import blenders, pythons_on
from build_extension import Order, package_of
from bundled_wheels import PackagingError
from compile_servo import compiled
from platforms import PLATFORMS, Platform

HEADINGS = ("system", "Blender", "servo", "package", "seconds", "without")


@dataclass(frozen=True)
class Packaged:
    """One platform's package: sizes in bytes, wall time in seconds."""

    platform: Platform
    servo: Path
    package: Path
    seconds: float

    def row(self) -> tuple[str, ...]:
        """Return the columns of HEADINGS."""
        versions = [one.version for one in blenders() if self.platform.name in one.platforms]
        return (
            self.platform.name,
            ", ".join(versions),
            f"{self.servo.stat().st_size / 1e3:.0f} kB",
            f"{self.package.stat().st_size / 1e6:.1f} MB",
            f"{self.seconds:.0f}",
            ", ".join(sorted(self.platform.without)) or "-",
        )


def packaged(platform: Platform, blender: Path, output: Path) -> Packaged:
    """Compile the servo for a platform, and make and check its package.

    Raises
    ------
    PackagingError
        The package cannot be whole.
    """
    started = time.monotonic()
    servo = compiled(platform.name, output / "servo")
    order = Order(platform, tuple(pythons_on(platform.name)), blender, output)
    package = package_of(order, servo)
    return Packaged(platform, servo, package, time.monotonic() - started)


def sums(packages: list[Path]) -> str:
    """Return the lines that `sha256sum --check` reads."""
    return "".join(
        f"{hashlib.sha256(package.read_bytes()).hexdigest()}  {package.name}\n"
        for package in sorted(packages)
    )


def table(rows: list[tuple[str, ...]]) -> str:
    """Return rows as text in columns."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    )


def main(arguments: list[str] | None = None) -> int:
    """Make all packages; name those that could not be made, and return 2 then."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "platforms", nargs="*", choices=[[], *PLATFORMS], help="(default: all)", metavar="PLATFORM"
    )
    parser.add_argument("--blender", type=Path, required=True, help="a folder that holds bpy")
    parser.add_argument("--output", type=Path, required=True)
    options = parser.parse_args(arguments)
    made: list[Packaged] = []
    failed: list[str] = []
    for name in options.platforms or PLATFORMS:
        platform = PLATFORMS[name]
        try:
            made.append(packaged(platform, options.blender, options.output))
        except PackagingError as error:
            failed.append(f"package_all: {platform.name}: {error}")
        else:
            print(made[-1].package, flush=True)
    if made:
        text = sums([*options.output.glob("palpate-[0-9]*.zip")])
        (options.output / "SHA256SUMS").write_text(text, encoding="utf-8")
        print(table([HEADINGS, *(one.row() for one in made)]))
    for sentence in failed:
        print(sentence, file=sys.stderr)
    return 2 if failed else 0


if __name__ == "__main__":
    raise SystemExit(main())
