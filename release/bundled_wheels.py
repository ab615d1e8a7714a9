"""Fetch the wheels that a package bundles: unmodified from the index, by version and hash.

`release/wheels/cp311.txt` and its neighbours name them, one file for each Python of a Blender.
"""

from __future__ import annotations

import re
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


def pins(python_version: str) -> dict[str, str]:
    """Return the entries of a lock file, with their hashes, by `name==version`."""
    text = lock_file(python_version).read_text(encoding="utf-8")
    entries = [
        entry for entry in re.split(r"^(?=[a-z])", text, flags=re.MULTILINE) if "==" in entry
    ]
    return {entry.split()[0]: entry for entry in entries}


def pinned_for(platform: Platform, python_version: str) -> dict[str, str]:
    """Return the entries of a lock file that there are wheels of for a platform."""
    return {
        pin: entry
        for pin, entry in pins(python_version).items()
        if pin.split("==")[0] not in platform.without
    }


def beginning(pin: str) -> str:
    """Return how the file name of a pinned wheel begins: `scipy-1.17.1-` for `scipy==1.17.1`."""
    name, version = pin.split("==")
    return f"{name.replace('-', '_')}-{version}-"


def fetch(platform: Platform, python_version: str, cache: Path) -> list[Path]:
    """Return the wheels for one platform and Python version; download those not yet in `cache`.

    Raises PackagingError when the index does not have them, or others under their names.
    """
    into = cache / platform.name / lock_file(python_version).stem
    into.mkdir(parents=True, exist_ok=True)
    wanted = pinned_for(platform, python_version)
    requirements = into / "requirements.txt"
    requirements.write_text("".join(wanted.values()), encoding="utf-8")
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check"]
    command += ["--no-deps", "--only-binary=:all:", "--require-hashes"]
    command += ["--implementation", "cp", "--python-version", python_version]
    for tag in platform.wheel_tags:
        command += ["--platform", tag]
    command += ["--dest", str(into), "--requirement", str(requirements)]
    # pip keeps what lies in --dest already, after checking its hash.
    if subprocess.run(command, check=False).returncode != 0:
        message = f"wheels for {platform.name}, Python {python_version} cannot be had: see above"
        raise PackagingError(message)
    return [_only(into, beginning(pin)) for pin in wanted]


def _only(folder: Path, name: str) -> Path:
    found = [path for path in folder.iterdir() if path.name.startswith(name)]
    if len(found) != 1:
        message = f"{folder} should hold one wheel {name}*, and holds {len(found)}: empty it"
        raise PackagingError(message)
    return found[0]
