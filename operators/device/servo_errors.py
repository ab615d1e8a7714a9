"""Errors of the servo, told to users."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from ...core.errors import PalpateError


@contextmanager
def servo_errors() -> Iterator[None]:
    """Raise the servo's errors as PalpateError with a remedy."""
    try:
        yield
    except OSError as problem:
        # Has its own remedy.
        raise PalpateError("device: {problem}", problem=problem) from problem
    except (ValueError, OverflowError) as problem:
        raise PalpateError(
            "servo: {problem}; set it back and press again", problem=problem
        ) from problem
    except RuntimeError as problem:
        raise PalpateError(
            "servo: {problem}; leave with Escape and press again", problem=problem
        ) from problem
