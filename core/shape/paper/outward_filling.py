"""A table filled around the touched place, and outward from there, while nobody waits for it.

One thread of Python does it, in small slices. It keeps away from frames: while they are being
drawn it rests between slices, except for what the touched place itself lacks.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...errors import PalpateError

# A frame drawn this long ago means that others may be on their way.
FRAMES_EXPECTED_SECONDS = 0.1
# Of each span of time while frames are drawn, the share in which the table is filled.
SHARE_BESIDE_FRAMES = 0.3


class OutwardFilling:
    """Fills what is asked for first, then the nearest places that are still empty."""

    def __init__(
        self,
        positions: NDArray[np.float64],
        is_filled: NDArray[np.bool_],
        fill: Callable[[NDArray[np.int64]], None],
        at_once: int,
        most: int | None = None,
    ) -> None:
        """Begin with nothing to do.

        Parameters
        ----------
        positions : (n, 3), of the places that are filled, metres.
        is_filled : bool (n,), kept up to date by ``fill``.
        fill : called in the thread with the numbers (k,) of places that are empty.
        at_once : largest k.
        most : places that are filled, beyond which only those asked for are; None for all.
        """
        self._positions = positions
        self._is_filled = is_filled
        self._fill = fill
        self._at_once = at_once
        self._most = len(positions) if most is None else most
        self._changed = threading.Condition()
        self._wish: NDArray[np.int64] = np.zeros(0, dtype=np.int64)
        self._is_closed = False
        self._last_frame = -np.inf
        self._problem: BaseException | None = None
        self._thread: threading.Thread | None = None

    @property
    def problem(self) -> BaseException | None:
        """Error that ended the thread, if any."""
        return self._problem

    def around(self, places: NDArray[np.int64]) -> None:
        """Fill these places next, and then outward from them. Returns at once.

        Called for every frame, so it also tells that frames are being drawn.
        """
        with self._changed:
            self._last_frame = time.monotonic()
            if np.array_equal(places, self._wish):
                return
            self._wish = places.copy()
            self._changed.notify_all()
        self._begin()

    def wait_for(self, places: NDArray[np.int64]) -> None:
        """Return when these places are filled.

        Raises
        ------
        PalpateError
            It was closed before they were.
        Exception
            Whatever ended the filling.
        """
        self.around(places)
        with self._changed:
            self._last_frame = -np.inf

            def is_there() -> bool:
                return bool(self._is_filled[places].all())

            self._changed.wait_for(lambda: self._is_closed or self._problem or is_there())
            if self._problem is not None:
                raise self._problem
            if not is_there():
                raise PalpateError("large deformation: its table was closed meanwhile; ask again")

    def close(self, patience: float | None = None) -> None:
        """End after the slice that is under way, waiting for it at most so many seconds.

        What it fills after that is as good, but nobody may come back for it. Safe to call twice.
        """
        with self._changed:
            self._is_closed = True
            self._changed.notify_all()
        if self._thread is not None:
            self._thread.join(patience)

    def _begin(self) -> None:
        if self._thread is None and not self._is_closed:
            # A daemon: a program that ends without closing does not wait for a whole table.
            self._thread = threading.Thread(target=self._run, name="palpate-table", daemon=True)
            self._thread.start()

    def _run(self) -> None:
        try:
            while (next_places := self._next()) is not None:
                began = time.monotonic()
                self._fill(next_places)
                self._tell()
                self._give_way(time.monotonic() - began)
        except Exception as problem:  # noqa: BLE001 - raised again where it is waited for
            self._problem = problem
            self._tell()

    def _tell(self) -> None:
        with self._changed:
            self._changed.notify_all()

    def _next(self) -> NDArray[np.int64] | None:
        """The places of the next slice; None when it is closed."""
        with self._changed:
            while not self._is_closed:
                wish = self._wish
                missing = wish[~self._is_filled[wish]]
                if missing.size:
                    return missing[: self._at_once]
                empty = np.flatnonzero(~self._is_filled)
                if wish.size and empty.size > len(self._positions) - self._most:
                    middle = self._positions[wish].mean(axis=0)
                    distances = np.linalg.norm(self._positions[empty] - middle, axis=1)
                    return empty[np.argsort(distances, kind="stable")[: self._at_once]]
                self._changed.wait()
        return None

    def _give_way(self, worked: float) -> None:
        """Rest while frames are drawn and the touched place lacks nothing."""
        rest = worked * (1.0 / SHARE_BESIDE_FRAMES - 1.0)
        with self._changed:
            self._changed.wait_for(
                lambda: (
                    self._is_closed
                    or time.monotonic() - self._last_frame > FRAMES_EXPECTED_SECONDS
                    or not self._is_filled[self._wish].all()
                ),
                timeout=rest,
            )
