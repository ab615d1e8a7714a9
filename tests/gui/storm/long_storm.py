"""A storm of as many events as asked for, with its seed."""

from __future__ import annotations

from stage import Stage, Wait
from storm.random_events import storm


def random_events_leave_the_meshes_and_nothing_running(stage: Stage) -> Wait:
    seed, count = map(int, stage.arguments)
    yield from storm(stage, seed, count)
