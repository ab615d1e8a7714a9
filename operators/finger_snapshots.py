"""Each finger's part of a snapshot."""

from __future__ import annotations

from typing import Any

from ..core.servo_session import Snapshot

FingerSnapshot = Any


def fingers_of(snapshot: Snapshot) -> list[FingerSnapshot]:
    """The fingers, the first one first; a servo of one finger publishes it as the snapshot."""
    return getattr(snapshot, "fingers", [snapshot])
