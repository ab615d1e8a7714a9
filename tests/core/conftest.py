"""Bodies for the tests of core, and the same examples in every run."""

from bodies.shared import (  # noqa: F401
    body,
    cube,
    cube_mesh,
    mouse,
    mouse_mesh,
    rng,
    solved_displacements,
)
from hypothesis import settings

# For all that is drawn: the same examples in every run, so that a red test means a changed program,
# and no limit of time, which a busy machine would break.
settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.register_profile("long", max_examples=20_000, deadline=None, database=None)
settings.load_profile("repeatable")
