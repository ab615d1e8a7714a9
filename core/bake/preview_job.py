"""A preview baked in a thread of this process: starting another takes longer than the bake."""

from __future__ import annotations

import threading
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace

from ..body.soft_body import SoftBody
from ..errors import CancelledError, PalpateError
from ..mesh.surface import Surface
from .preview.preview import preview
from .settings import BakeSettings
from .steps import bake


@dataclass(frozen=True, eq=False)
class PreviewedBody:
    """Coarse body, and how far the surface lies from it at most, as a share of its diagonal."""

    body: SoftBody
    off: float


class PreviewJob:
    """Bake of a preview in the background: some tenths of a second of one core."""

    def __init__(self, surface: Surface, settings: BakeSettings) -> None:
        self._closed = threading.Event()
        worker = ThreadPoolExecutor(1, thread_name_prefix="palpate-preview")
        self._made: Future[PreviewedBody | None] = worker.submit(self._make, surface, settings)
        worker.shutdown(wait=False)

    @property
    def finished(self) -> bool:
        """Whether there is a result."""
        return self._made.done()

    def result(self) -> PreviewedBody | None:
        """The body; None where cells are too coarse for the surface and its pins, or it was closed.

        Waits until it is finished.
        """
        return self._made.result()

    def close(self) -> None:
        """Give the body up, if it is not there yet. Safe to repeat."""
        self._closed.set()

    def _make(self, surface: Surface, settings: BakeSettings) -> PreviewedBody | None:
        try:
            coarse = preview(surface, settings)
            # Other cores are left to the bake itself.
            alone = replace(coarse.settings, threads=1)
            body, _ = bake(coarse.mesh, alone, self._refuse_closed)
        except PalpateError:
            # The bake itself says what is wrong, if anything is.
            return None
        return PreviewedBody(body, coarse.off)

    def _refuse_closed(self, *_: object) -> None:
        if self._closed.is_set():
            raise CancelledError("bake: stopped, since nobody waits for the result any more")
