import pytest
from bodies.free_shapes import free_block
from bodies.laid import Laid

from palpate.core.servo.session import native_body


@pytest.fixture(scope="session")
def laid():
    """50 mm, 125 g."""
    body = free_block((0.05, 0.05, 0.05), (4, 4, 4))
    return Laid(body, native_body(body, whole=True, may_move=True))
