"""Progress of a bake as translated text."""

import math

from ...core.bake.job import JobProgress
from ...core.quantities import duration
from ..reporting.translated import shown

AWAITS_MODE = "The body is ready; leave Edit Mode to receive it"
AWAITS_SCENE = "The body is ready; show the object in its scene to receive it"
AWAITS_PRESS = "The body is ready and comes when pressing ends"


def how_far(progress: JobProgress) -> str:
    """Share and remaining time: ``62 %, 12 s left``; if unknown, ``96 %, 2 min so far``."""
    share = "" if progress.share is None else f"{100 * progress.share:.0f} %, "
    if progress.remaining is None:
        return share + shown("{time} so far", time=duration(progress.seconds))
    return share + shown("{time} left", time=duration(progress.remaining))


def previewed(off: float) -> str:
    """What can be done with a preview that is ``off`` by a share of the object's size."""
    # Never better than it is.
    return shown("Press it now: coarse preview, up to {off} % off", off=math.ceil(100 * off))
