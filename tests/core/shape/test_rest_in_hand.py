"""A body pressed while somebody looks on: as firm as it is found in the background meanwhile."""

import time

import numpy as np
import pytest
from bodies.free_shapes import free_block

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor
from palpate.core.shape.firm_rest import FirmRest
from palpate.core.shape.shapes import shape

RADIUS, DEPTH = 0.014, 0.011
START = np.array([0.024, 0.026, 0.05 + RADIUS + 1e-4])
GOAL = Pose.at(START - np.array([0.0, 0.0, DEPTH]))
MOST_SECONDS = 60.0


@pytest.fixture(scope="module")
def real():
    """A cube and its shape."""
    body = free_block((0.05, 0.05, 0.05), (6, 6, 6), young_modulus=30_000.0)
    made = shape(body, "real")
    made.wait_for(np.zeros(0, dtype=np.int64))
    yield body, made
    made.close()


def pressed(real, *, in_hand):
    (body, made_of), settings = real, RestSettings(steady=True)
    lying = Resting(body, [Floor()], [(sphere(RADIUS), Pose.at(START))], settings=settings)
    made = FirmRest(lying, [made_of], in_hand)
    made.settle()
    made.lead([GOAL])
    return made


def test_on_its_way_it_becomes_as_firm_as_at_rest(real):
    alone = pressed(real, in_hand=False)
    (rest,) = alone.settle()
    firm = alone.lying.firmness[0]
    assert firm > 1.03
    made = pressed(real, in_hand=True)
    end = time.monotonic() + MOST_SECONDS
    while abs(made.lying.firmness[0] / firm - 1.0) > 0.01:
        made.hurry(4e-3)
        assert made.rests[0].deformed is not None
        assert time.monotonic() < end, "waited in vain for the firmness"
    force = made.lying.rest.tools[0].force[2]
    assert force == pytest.approx(rest.tools[0].force[2], rel=0.05)
    (ended,) = made.settle()
    made.close()
    assert ended.tools[0].force[2] == pytest.approx(rest.tools[0].force[2], rel=0.03)
    size = np.abs(rest.displacements()).max()
    # A foot that a hand keeps from sliding is where little work leaves it.
    np.testing.assert_allclose(ended.surface(), rest.surface(), atol=0.08 * size)
