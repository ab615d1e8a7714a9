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

    def runs(self, wheel_name: str) -> bool:
        """Tell from a wheel's file name whether it runs here; `any` runs everywhere."""
        tags = wheel_name.removesuffix(".whl").rsplit("-", 1)[1].split(".")
        return any(
            tag == "any" or (tag.startswith(self.systems) and tag.endswith(self.machines))
            for tag in tags
        )


PLATFORMS = {
    platform.name: platform
    for platform in (
        Platform(
            name="linux-x64",
            systems=("manylinux", "linux"),
            machines=("_x86_64",),
            wheel_tags=(
                "manylinux_2_28_x86_64",
                "manylinux_2_27_x86_64",
                "manylinux_2_17_x86_64",
                "manylinux2014_x86_64",
            ),
        ),
        Platform(
            name="windows-x64",
            systems=("win",),
            machines=("_amd64",),
            wheel_tags=("win_amd64",),
        ),
        # pytetwild 0.2.3 was built for macOS 15, so that is the oldest macOS that can bake.
        Platform(
            name="macos-arm64",
            systems=("macosx",),
            machines=("_arm64", "_universal2"),
            wheel_tags=("macosx_15_0_arm64", "macosx_14_0_arm64", "macosx_11_0_arm64"),
        ),
    )
}


def this_platform() -> str:
    """Return Blender's name for the machine this runs on, also when no package is made for it."""
    system = {"win32": "windows", "darwin": "macos"}.get(sys.platform, sys.platform)
    machine = platform.machine().lower()
    return f"{system}-{'x64' if machine in {'x86_64', 'amd64'} else machine}"
