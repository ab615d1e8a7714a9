"""Fetch the wheels that a package bundles: unmodified from the index, by version and hash.

`release/wheels/cp311.txt` and its neighbours name them, one file for each Python of a Blender.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from platforms import Platform

LOCKS = Path(__file__).parent / "wheels"


class PackagingError(Exception):
    """A package cannot be made as asked; the message says why and what to do."""


def lock_file(python_version: str) -> Path:
    """Return the list of wheels for a Python version such as `3.11`.

    Raises PackagingError where there is none.
    """
    path = LOCKS / f"cp{python_version.replace('.', '')}.txt"
    if not path.is_file():
        known = ", ".join(sorted(lock.stem for lock in LOCKS.glob("cp*.txt")))
        message = f"no list of wheels for Python {python_version} (there are {known}): write {path}"
        raise PackagingError(message)
    return path


def pinned_names(python_version: str) -> list[str]:
    """Return how the file names of the wheels in a lock file begin: `scipy-1.17.1-`."""
    lines = lock_file(python_version).read_text(encoding="utf-8").splitlines()
    pins = [line.split()[0].split("==") for line in lines if "==" in line and line[0] != "#"]
    return [f"{name.replace('-', '_')}-{version}-" for name, version in pins]


def fetch(platform: Platform, python_version: str, cache: Path) -> list[Path]:
    """Return the wheels for one platform and Python version; download those not yet in `cache`."""
    into = cache / platform.name / lock_file(python_version).stem
    into.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check"]
    command += ["--no-deps", "--only-binary=:all:", "--require-hashes"]
    command += ["--implementation", "cp", "--python-version", python_version]
    for tag in platform.wheel_tags:
        command += ["--platform", tag]
    command += ["--dest", str(into), "--requirement", str(lock_file(python_version))]
    # pip keeps what lies in --dest already, after checking its hash.
    subprocess.run(command, check=True)
    return [_only(into, name) for name in pinned_names(python_version)]


def _only(folder: Path, name: str) -> Path:
    found = [path for path in folder.iterdir() if path.name.startswith(name)]
    if len(found) != 1:
        message = f"{folder} should hold one wheel {name}*, and holds {len(found)}: empty it"
        raise PackagingError(message)
    return found[0]
