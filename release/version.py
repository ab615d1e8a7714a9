"""Tell Palpate's version, or set it in all its places at once.

python release/version.py          # prints it; fails where a place says another
python release/version.py 0.2.0
"""

from __future__ import annotations

import argparse
import re
import sys
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
NUMBERS = re.compile(r"\d+\.\d+\.\d+")


class VersionError(Exception):
    """Places that cannot be read, or do not agree; the message names them."""


@dataclass(frozen=True)
class Place:
    """A file that says the version, where its pattern's one group is."""

    file: str
    pattern: str = r'^version = "(.+)"$'

    def version(self, repository: Path) -> str:
        """Return what this place says; raises VersionError where it says nothing."""
        found = self._found(repository)
        return found[1]

    def set(self, repository: Path, version: str) -> None:
        """Say another version here."""
        start, end = self._found(repository).span(1)
        text = self._text(repository)
        # As it is, also where Git has put the line ends of Windows.
        (repository / self.file).write_bytes((text[:start] + version + text[end:]).encode())

    def _found(self, repository: Path) -> re.Match[str]:
        found = re.search(self.pattern, self._text(repository), re.MULTILINE)
        if found is None:
            raise VersionError(f"{self.file}: there is no version in it")
        return found

    def _text(self, repository: Path) -> str:
        return (repository / self.file).read_bytes().decode()


# Blender reads the first, cargo the second and third, pip the last.
PLACES = (
    Place("blender_manifest.toml"),
    Place("native/Cargo.toml"),
    Place("native/Cargo.lock", r'^name = "palpate_servo"\nversion = "(.+)"$'),
    Place("pyproject.toml"),
)
CHANGES = Place("CHANGELOG.md", r"^## (.+)$")
"""Says it where changes are told; written by hand."""


def version(repository: Path = REPOSITORY) -> str:
    """Return the version.

    Raises
    ------
    VersionError
        Not every place says the same, or the changes of this version are not told.
    """
    said = {place.file: place.version(repository) for place in (*PLACES, CHANGES)}
    if len({*said.values()}) > 1:
        each = ", ".join(f"{file}: {one}" for file, one in said.items())
        raise VersionError(f"not every place says the same version: {each}")
    return said[PLACES[0].file]


def set_version(wanted: str, repository: Path = REPOSITORY) -> None:
    """Say a version such as 0.2.0 in all places but the list of changes.

    Raises
    ------
    VersionError
        It is none, or a place has none to set.
    """
    if not NUMBERS.fullmatch(wanted):
        raise VersionError(f"{wanted}: a version is three numbers, such as 0.2.0")
    for place in PLACES:
        place.set(repository, wanted)


def main(arguments: list[str] | None = None, repository: Path = REPOSITORY) -> int:
    """Command line of this file; 2 where not all places agree."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("wanted", nargs="?", metavar="X.Y.Z", help="(default: tell it)")
    options = parser.parse_args(arguments)
    try:
        if options.wanted:
            set_version(options.wanted, repository)
        print(version(repository))
    except VersionError as error:
        print(f"version: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
