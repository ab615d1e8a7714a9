"""Progress of a bake as translated text."""

from ...core.bake.job import JobProgress
from ...core.quantities import duration
from ..reporting.translated import shown

WAITING = "The body is ready; leave Edit Mode to receive it"


def how_far(progress: JobProgress) -> str:
    """Share and remaining time: ``62 %, 12 s left``; elapsed time if unknown."""
    share = "" if progress.share is None else f"{100 * progress.share:.0f} %, "
    if progress.remaining is None:
        return f"{share}{duration(progress.seconds)}"
    return share + shown("{time} left", time=duration(progress.remaining))
