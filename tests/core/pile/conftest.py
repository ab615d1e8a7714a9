import pytest
from bodies.free_shapes import free_block


@pytest.fixture(scope="session")
def cube():
    """50 mm, 125 g."""
    return free_block((0.05, 0.05, 0.05), (5, 5, 5))
