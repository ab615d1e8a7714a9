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
        prepare: Callable[[], None] | None = None,
        complete: Callable[[NDArray[np.int64]], None] | None = None,
    ) -> None:
        """Begin with nothing to do.

        Parameters
        ----------
        positions : (n, 3), of the places that are filled, metres.
        is_filled : bool (n,), kept up to date by ``fill``.
        fill : called in the thread with the numbers (k,) of places that are empty.
        at_once : largest k.
        prepare : called in the thread first of all, at once.
        complete : called in the thread with the touched places, once all of them are filled.
        """
        self._positions = positions
        self._is_filled = is_filled
        self._fill = fill
        self._at_once = at_once
        self._prepare = prepare
        self._complete = complete
        self._changed = threading.Condition()
        self._wish: NDArray[np.int64] = np.zeros(0, dtype=np.int64)
        self._is_complete = True
        self._is_closed = False
        self._last_frame = -np.inf
        self._problem: BaseException | None = None
        self._is_prepared = prepare is None
        self._thread: threading.Thread | None = None
        if prepare is not None:
            self._begin()

    @property
    def problem(self) -> BaseException | None:
        """What ended the thread, if anything did."""
        return self._problem

    @property
    def is_prepared(self) -> bool:
        """Whether what comes first is done."""
        return self._is_prepared

    def around(self, places: NDArray[np.int64]) -> None:
        """Fill these places next, and then outward from them. Returns at once.

        Called for every frame, so it also tells that frames are being drawn.
        """
        with self._changed:
            self._last_frame = time.monotonic()
            if np.array_equal(places, self._wish):
                return
            self._wish = places.copy()
            self._is_complete = self._complete is None
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
        self._wait(places, is_touched=True)

    def finish(self) -> None:
        """Return when everything is filled; errors as for :meth:`wait_for`."""
        everything = np.arange(len(self._positions))
        if not len(self._wish):
            self.around(everything[:1])
        self._wait(everything)

    def _wait(self, places: NDArray[np.int64], *, is_touched: bool = False) -> None:
        with self._changed:
            self._last_frame = -np.inf

            def is_there() -> bool:
                filled = bool(self._is_filled[places].all())
                return filled and (self._is_complete or not is_touched)

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
            if self._prepare is not None:
                self._prepare()
                self._is_prepared = True
                self._tell()
            while (next_places := self._next()) is not None:
                began = time.monotonic()
                if self._is_filled[next_places].all():
                    self._complete_touched(next_places)
                else:
                    self._fill(next_places)
                self._tell()
                self._give_way(time.monotonic() - began)
        except Exception as problem:  # noqa: BLE001 - raised again where it is waited for
            self._problem = problem
            self._tell()

    def _complete_touched(self, places: NDArray[np.int64]) -> None:
        if self._complete is not None:
            self._complete(places)
        with self._changed:
            self._is_complete |= np.array_equal(places, self._wish)

    def _tell(self) -> None:
        with self._changed:
            self._changed.notify_all()

    def _next(self) -> NDArray[np.int64] | None:
        """The places of the next slice, or touched ones to complete; None when there is none."""
        with self._changed:
            while not self._is_closed:
                wish = self._wish
                missing = wish[~self._is_filled[wish]]
                if missing.size:
                    return missing[: self._at_once]
                if not self._is_complete:
                    return wish
                empty = np.flatnonzero(~self._is_filled)
                if wish.size and empty.size:
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
