"""Bodies for the tests of the command line."""

from bodies.shared import (  # noqa: F401
    body,
    cube,
    cube_mesh,
    mouse,
    mouse_mesh,
    rng,
    solved_displacements,
)
