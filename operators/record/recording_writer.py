"""Writing of a recording in a background thread.

Ten minutes of CSV take many seconds; meanwhile Space must still release a device.
"""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...core.errors import PalpateError
from ...core.record.recording import check_recording_path
from ..scene.viewport import redraw_views
from . import recording
from .recording import Kept

SECONDS_BETWEEN_LOOKS = 0.2


@dataclass(frozen=True, eq=False)
class Writing:
    """File being written, or written."""

    path: Path
    outcome: Future[None]

    @property
    def going_on(self) -> bool:
        """Whether it is still being written."""
        return not self.outcome.done()

    @property
    def problem(self) -> str:
        """Reason of a failure; empty if there is none so far."""
        problem = None if self.going_on else self.outcome.exception()
        if isinstance(problem, PalpateError):
            return problem.sentence
        return "" if problem is None else str(problem) or type(problem).__name__


_latest: Writing | None = None


def latest() -> Writing | None:
    """Latest file."""
    return _latest


def going_on() -> bool:
    """Whether a recording is being written now."""
    return _latest is not None and _latest.going_on


def begin(path: Path, kept: Kept) -> None:
    """Write a recording in the background; only while none is :func:`going_on`.

    Raises
    ------
    PalpateError
        The path cannot be written, or is neither CSV nor npz. Later errors are in
        :func:`latest`.
    """
    global _latest  # noqa: PLW0603  one file at a time
    check_recording_path(path)
    # Not a daemon: Python waits for it at exit, so that quitting Blender loses nothing.
    thread = ThreadPoolExecutor(1, "palpate-recording")
    _latest = Writing(path, thread.submit(recording.write, path, kept))
    thread.shutdown(wait=False)
    bpy.app.timers.register(_look, persistent=True)


def forget() -> None:
    """Forget the last file: there is another recording now."""
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
