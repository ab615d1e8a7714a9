"""The platforms that packages are made for, in Blender's words and in those of wheel file names."""

from __future__ import annotations

import platform
import sys
from dataclasses import dataclass


@dataclass(frozen=True)
class Platform:
    """One platform: Blender's name for it, and how the platform tags of its wheels look."""

    name: str
    systems: tuple[str, ...]
    machines: tuple[str, ...]
    wheel_tags: tuple[str, ...]
    """What pip is asked for; the newest is the oldest system that every bundled wheel runs on."""
    without: frozenset[str] = frozenset()
    """Distributions that nobody builds for it; Palpate says what cannot be done there."""

    def runs(self, wheel_name: str) -> bool:
        """Tell from a wheel's file name whether it runs here; `any` runs everywhere."""
        tags = wheel_name.removesuffix(".whl").rsplit("-", 1)[1].split(".")
        return any(
            tag == "any" or (tag.startswith(self.systems) and tag.endswith(self.machines))
            for tag in tags
        )


def _linux(name: str, machine: str, without: frozenset[str] = frozenset()) -> Platform:
    """Blender's own baseline, glibc 2.28, and what is older."""
    tags = (*(f"manylinux_2_{minor}" for minor in (28, 27, 17)), "manylinux2014")
    return Platform(
        name=name,
        systems=("manylinux", "linux"),
        machines=(f"_{machine}",),
        wheel_tags=tuple(f"{tag}_{machine}" for tag in tags),
        without=without,
    )


PLATFORMS = {
    platform.name: platform
    for platform in (
        _linux("linux-x64", "x86_64"),
        _linux("linux-arm64", "aarch64", without=frozenset({"pytetwild"})),
        Platform(
            name="windows-x64",
            systems=("win",),
            machines=("_amd64",),
            wheel_tags=("win_amd64",),
        ),
        Platform(
            name="windows-arm64",
            systems=("win",),
            machines=("_arm64",),
            wheel_tags=("win_arm64",),
            without=frozenset({"pytetwild", "fast-simplification", "coacd"}),
        ),
        # Of scipy the wheels for older systems, with OpenBLAS: those for macOS 14 and later use
        # Accelerate, whose threads cannot be set. pytetwild's is tagged macOS 15, which Blender
        # does not look at: what it needs is in docs/releasing.md.
        Platform(
            name="macos-arm64",
            systems=("macosx",),
            machines=("_arm64", "_universal2"),
            wheel_tags=("macosx_15_0_arm64", "macosx_12_0_arm64", "macosx_11_0_arm64"),
        ),
        Platform(
            name="macos-x64",
            systems=("macosx",),
            machines=("_x86_64", "_universal2"),
            wheel_tags=("macosx_15_0_x86_64", "macosx_10_15_x86_64"),
            without=frozenset({"coacd"}),
        ),
    )
}


def this_platform() -> str:
    """Return Blender's name for the machine this runs on, also when no package is made for it."""
    system = {"win32": "windows", "darwin": "macos"}.get(sys.platform, sys.platform)
    machine = platform.machine().lower()
    known = {"x86_64": "x64", "amd64": "x64", "aarch64": "arm64"}
    return f"{system}-{known.get(machine, machine)}"
