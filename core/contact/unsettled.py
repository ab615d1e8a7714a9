"""Forces of a press that come to no rest."""

from __future__ import annotations

from ..errors import PalpateError


class UnsettledError(PalpateError):
    """Forces go on changing."""


class NotANumberError(PalpateError):
    """A force came out as no number."""
