"""Read a finished package back and list what is wrong with it, before a user's Blender does."""

from __future__ import annotations

import re
import tomllib
import zipfile
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from platforms import Platform

# What is imported at run time, by the beginning of its wheel's name.
NEEDED = (
    "scipy",
    "pytetwild",
    "fast_simplification",
    "coacd",
    "psutil",
    "pyserial",
    "threadpoolctl",
    "palpate_servo",
)


def runs_on(wheel_name: str, python_version: str) -> bool:
    """Tell from a wheel's file name whether it runs on a Python version such as `3.11`."""
    python_tags, abi_tag, _ = wheel_name.removesuffix(".whl").rsplit("-", 3)[1:]
    wanted = tuple(int(part) for part in python_version.split("."))
    for tag in python_tags.split("."):
        match = re.fullmatch(r"(?:cp|py)(\d)(\d*)", tag)
        if match is None:
            continue
        built_for = tuple(int(part) for part in match.groups() if part)
        if built_for == wanted[: len(built_for)] or (abi_tag == "abi3" and built_for <= wanted):
            return True
    return False


def needed_on(platform: Platform) -> list[str]:
    """Return what is imported on a platform: all that is needed, as far as there are wheels."""
    return [name for name in NEEDED if name.replace("_", "-") not in platform.without]


def faults(package: Path, platform: Platform, python_versions: Iterable[str]) -> list[str]:
    """Return one sentence for each fault of a package; none for a whole one."""
    with zipfile.ZipFile(package) as archive:
        names = archive.namelist()
        manifest = tomllib.loads(archive.read("blender_manifest.toml").decode("utf-8"))
    found = []
    listed = sorted(wheel.removeprefix("./") for wheel in manifest.get("wheels", []))
    packed = sorted(name for name in names if name.endswith(".whl"))
    if listed != packed:
        found.append(f"the manifest lists the wheels {listed}, the package holds {packed}")
    wheel_names = [name.rsplit("/", 1)[1] for name in packed]
    for version in python_versions:
        for module in needed_on(platform):
            fitting = [
                name
                for name in wheel_names
                if name.split("-")[0] == module and runs_on(name, version) and platform.runs(name)
            ]
            # Two wheels of one distribution may both fit (abi3): Blender then takes the newer.
            if not fitting:
                found.append(f"no wheel of {module} for Python {version} on {platform.name}")
    found += [f"{name} is for another platform" for name in wheel_names if not platform.runs(name)]
    found += [
        f"{name} must not be bundled: numpy is Blender's own"
        for name in wheel_names
        if name.startswith("numpy-")
    ]
    found += [
        f"{name} does not belong into the package"
        for name in names
        if name.split("/")[0]
        not in {"__init__.py", "LICENSE", "blender_manifest.toml", "wheels", "addon", "operators"}
        | {"core", "simulated", "cli"}
    ]
    return found
