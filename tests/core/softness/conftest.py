"""Blocks of any fineness, on their pinned base."""

import pytest
from bodies.soft_block import soft_block


@pytest.fixture(scope="session")
def coarse_block():
    """Edges of 10 mm, five times as long as an indenter is wide."""
    return soft_block((0.08, 0.08, 0.05), (8, 8, 5))


@pytest.fixture(scope="session")
def fine_block():
    return soft_block((0.08, 0.08, 0.05), (12, 12, 8))


@pytest.fixture(scope="session")
def shaken_blocks():
    """One block as two uneven meshes, the second one twice as fine."""
    return [
        soft_block((0.08, 0.08, 0.05), cells, jitter=0.25) for cells in ((6, 6, 4), (12, 12, 8))
    ]


@pytest.fixture(scope="session")
def layer():
    """10 mm of rubber on a rigid base, edges of 2 mm."""
    return soft_block((0.036, 0.036, 0.01), (18, 18, 5), poisson_ratio=0.49)


@pytest.fixture(scope="session")
def thin_block():
    """5 mm thick, and edges as long."""
    return soft_block((0.03, 0.03, 0.005), (6, 6, 2))
