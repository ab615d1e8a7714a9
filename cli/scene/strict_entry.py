"""JSON read strictly: each key known and given once, each number finite, each entry named."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from pathlib import Path

from ...core.errors import PalpateError

MOST_BYTES = 1_000_000
# Metres, degrees and m/s2 beyond this are mistakes of units.
LARGEST = 1e6
LONGEST_NAME = 60


class Entry:
    """An object of a JSON file, whose keys are taken one by one; ``close`` refuses what is left.

    ``where`` names it in messages.
    """

    def __init__(self, where: str, given: object, known: Sequence[str]) -> None:
        if not isinstance(given, dict):
            raise PalpateError(f"{where}: this is no object; write {{...}} with {_listed(known)}")
        for key in given:
            if key not in known:
                raise PalpateError(
                    f"{where}: the key '{_short(key)}' is unknown; known are {_listed(known)}"
                )
        self.where = where
        self._given = given

    def has(self, key: str) -> bool:
        """Whether a key is given."""
        return key in self._given

    def number(self, key: str, usual: float) -> float:
        """A finite number."""
        value = self._given.get(key, usual)
        if not _is_number(value):
            raise self.problem(key, f"give a number from -{LARGEST:g} to {LARGEST:g}")
        return float(value)

    def vector(self, key: str, usual: Sequence[float]) -> tuple[float, float, float]:
        """Three finite numbers."""
        value = self._given.get(key, usual)
        if (
            not isinstance(value, list | tuple)
            or len(value) != 3
            or not all(map(_is_number, value))
        ):
            raise self.problem(key, f"give three numbers, each from -{LARGEST:g} to {LARGEST:g}")
        x, y, z = map(float, value)
        return x, y, z

    def text(self, key: str) -> str:
        """Words that must be there."""
        value = self._given.get(key)
        if not isinstance(value, str) or not value:
            raise self.problem(key, "give text in quotes")
        return value

    def name(self, usual: str) -> str:
        """Its name, short, of letters, digits, blanks, - and _."""
        value = self._given.get("name", usual)
        if (
            not isinstance(value, str)
            or not 0 < len(value) <= LONGEST_NAME
            or not all(one.isalnum() or one in " -_" for one in value)
        ):
            raise self.problem(
                "name", f"give 1 to {LONGEST_NAME} letters, digits, blanks, hyphens, underscores"
            )
        return value

    def entries(self, key: str, known: Sequence[str], *, most: int, least: int = 0) -> list[Entry]:
        """A list of objects with these keys."""
        value = self._given.get(key, [])
        if not isinstance(value, list) or not least <= len(value) <= most:
            raise self.problem(key, f"give a list of {least} to {most} in [...]")
        return [
            Entry(f"{self.where}, {key} number {number}", one, known)
            for number, one in enumerate(value, start=1)
        ]

    def problem(self, key: str, remedy: str) -> PalpateError:
        """What is wrong with the value of a key."""
        if key not in self._given:
            return PalpateError(f"{self.where}: '{key}' is missing; {remedy}")
        return PalpateError(f"{self.where}: '{key}' is {_short(self._given[key])}; {remedy}")


def read_entry(path: Path, known: Sequence[str]) -> Entry:
    """The object that a JSON file is.

    Raises
    ------
    PalpateError
        The file is large, no JSON, has a key twice, or anything but an object.
    OSError
        It cannot be read.
    """
    with path.open("rb") as file:
        content = file.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise PalpateError(
            f"{path}: is larger than {MOST_BYTES:,} bytes, as no scene is; give a scene file"
        )
    try:
        given = json.loads(
            content.decode("utf-8-sig"),
            object_pairs_hook=_once(path),
            parse_constant=_refusing(path),
        )
    except (ValueError, RecursionError) as problem:
        raise PalpateError(f"{path}: is no scene file ({problem}); write JSON") from problem
    return Entry(str(path), given, known)


def _once(path: Path) -> Callable[[list[tuple[str, object]]], dict[str, object]]:
    def once(pairs: list[tuple[str, object]]) -> dict[str, object]:
        made: dict[str, object] = {}
        for key, value in pairs:
            if key in made:
                raise PalpateError(f"{path}: the key '{_short(key)}' is given twice; keep one")
            made[key] = value
        return made

    return once


def _refusing(path: Path) -> Callable[[str], object]:
    def refuse(word: str) -> object:
        raise PalpateError(f"{path}: {word} is no number of JSON; give a finite one")

    return refuse


def _is_number(value: object) -> bool:
    # An integer of hundreds of digits has no float; compared as it is, it is only too large.
    return (
        isinstance(value, int | float)
        and not isinstance(value, bool)
        and -LARGEST <= value <= LARGEST
        and math.isfinite(value)
    )


def _short(value: object) -> str:
    words = value if isinstance(value, str) else json.dumps(value)
    return words if len(words) <= LONGEST_NAME else words[:LONGEST_NAME] + "..."


def _listed(words: Sequence[str]) -> str:
    return ", ".join(words)
