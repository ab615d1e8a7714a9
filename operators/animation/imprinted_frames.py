"""Frames with what stays of those before: an imprint depends on all that came earlier."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from ...core.imprint.yielding import Yielding
from ..imprint.surface_imprint import SurfaceImprint
from ..object.drawn_body import DrawnBody
from .pressed_frames import PressedFrame


def imprinted(
    pressed: Iterable[PressedFrame], law: Yielding, drawn: DrawnBody, frames_per_second: float
) -> Iterator[PressedFrame]:
    """The frames of a body that yields, in their order.

    Tools meet the surface at rest, and press it by forces of the elastic body: an imprint changes
    what is seen, not what is felt.
    """
    imprint = SurfaceImprint(drawn.frame)
    for here in pressed:
        moved = np.zeros_like(drawn.rest) if here.moved is None else here.moved
        seen = imprint.seen(law, moved, here.frame / frames_per_second)
        yield replace(here, moved=seen if seen.any() else None)
