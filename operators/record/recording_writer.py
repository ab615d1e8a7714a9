"""A recording on its way to a file, in a thread of its own.

Ten minutes of CSV take many seconds. Meanwhile the window must go on: Space has to let a device go.
"""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...core.errors import PalpateError
from ...core.servo.recording import check_recording_path
from ..scene.viewport import redraw_views
from . import recording
from .recording import Kept

SECONDS_BETWEEN_LOOKS = 0.2


@dataclass(frozen=True, eq=False)
class Writing:
    """A file that is being written, or was."""

    path: Path
    outcome: Future[None]

    @property
    def going_on(self) -> bool:
        """Whether it is not done yet."""
        return not self.outcome.done()

    @property
    def problem(self) -> str:
        """Why there is no file; empty if there is one, or may be soon."""
        problem = None if self.going_on else self.outcome.exception()
        if isinstance(problem, PalpateError):
            return problem.sentence
        return "" if problem is None else str(problem) or type(problem).__name__


_latest: Writing | None = None


def latest() -> Writing | None:
    """What was written last, or is being written."""
    return _latest


def going_on() -> bool:
    """Whether a recording is being written."""
    return _latest is not None and _latest.going_on


def begin(path: Path, kept: Kept) -> None:
    """Write a recording while Blender goes on; only while none is :func:`going_on`.

    Raises
    ------
    PalpateError
        The path cannot be written, or is neither CSV nor npz. What goes wrong later is told by
        :func:`latest`.
    """
    global _latest  # noqa: PLW0603  one file at a time
    check_recording_path(path)
    # Python waits for this thread before it ends, so that quitting Blender loses nothing.
    thread = ThreadPoolExecutor(1, "palpate-recording")
    _latest = Writing(path, thread.submit(recording.write, path, kept))
    thread.shutdown(wait=False)
    bpy.app.timers.register(_look, persistent=True)


def forget() -> None:
    """Tell no more of the last file: there is another recording now."""
    global _latest  # noqa: PLW0603  see begin
    if not going_on():
        _latest = None


def unregister() -> None:
    """Wait for the file."""
    if _latest is not None:
        _latest.outcome.exception()
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)


def _look() -> float | None:
    redraw_views()
    return SECONDS_BETWEEN_LOOKS if going_on() else None
