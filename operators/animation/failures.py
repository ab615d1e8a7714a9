"""Objects that do not follow their pressers: why, and until when that is not tried again."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError


@dataclass(frozen=True, eq=False)
class Attempt:
    """What following depends on, besides geometry: all that is ``known`` of the object, and
    ``places`` (k, 4, 4), its own and those of its pressers.
    """

    known: tuple[object, ...]
    places: NDArray[np.float32]

    def repeats(self, earlier: Attempt) -> bool:
        """Whether it comes to the same as an earlier one, which may depend on fewer places."""
        places = self.places[: len(earlier.places)]
        return self.known == earlier.known and np.array_equal(places, earlier.places)


# By the objects: what was attempted last, and why it failed.
_failures: dict[int, tuple[Attempt, str]] = {}


def reason(thing: bpy.types.Object) -> str:
    """Why an object does not follow its pressers; empty where it does."""
    failure = _failures.get(thing.session_uid)
    return "" if failure is None else failure[1]


def is_known(thing: bpy.types.Object, attempt: Attempt) -> bool:
    """Whether an attempt has failed already."""
    failure = _failures.get(thing.session_uid)
    return failure is not None and attempt.repeats(failure[0])


def remember(thing: bpy.types.Object, attempt: Attempt, problem: Exception, *, aloud: bool) -> None:
    """Remember a failure for the panel: a handler has no report. The console tells it, ``aloud``,
    where there may be no panel.
    """
    sentence = problem.sentence if isinstance(problem, PalpateError) else str(problem)
    if aloud and sentence != reason(thing):
        print(f"palpate: {thing.name}: {problem}")  # noqa: T201
    _failures[thing.session_uid] = attempt, sentence


def forget(thing: bpy.types.Object) -> None:
    """Try again. Safe where nothing failed."""
    _failures.pop(thing.session_uid, None)


def forget_all() -> None:
    """The same for all objects."""
    _failures.clear()
