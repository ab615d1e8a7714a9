"""Thrown down anyhow, a body comes to rest on the floor, and never gains energy on the way."""

import numpy as np
import pytest
from bodies.free_shapes import free_ball, free_block
from scipy.spatial.transform import Rotation

from palpate.core.contact.tool.pose import Pose
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor

BODIES = {
    "cube": lambda: free_block((0.05, 0.05, 0.05), (4, 4, 4), young_modulus=30_000.0),
    "bar": lambda: free_block((0.02, 0.03, 0.08), (2, 3, 8), young_modulus=100_000.0),
    "ball": lambda: free_ball(0.02, 6, young_modulus=30_000.0),
}


@pytest.fixture(scope="module", params=list(BODIES))
def thrown(request):
    return request.param, BODIES[request.param]()


def energy(body, rest, gravity):
    """Elastic and of its height, J."""
    return rest.elastic - body.mass * np.array(gravity) @ rest.centre


@pytest.mark.parametrize(
    "seed",
    [*range(2), *(pytest.param(seed, marks=pytest.mark.at_length) for seed in range(2, 11))],
)
def test_a_settling_body_never_gains_energy(thrown, seed):
    kind, body = thrown
    random = np.random.default_rng(seed)
    rotation = Rotation.random(random_state=random).as_matrix()
    lowest = (body.mesh.nodes @ rotation.T)[:, 2].min()
    placement = Pose.at([0.0, 0.0, 0.002 - lowest], rotation)
    settings = RestSettings(drag_time=float(random.uniform(0.02, 0.1)))
    # A smooth ball would turn for ever so slowly to where its mesh is softest.
    least = 0.05 if kind == "ball" else 0.0
    floor = Floor(friction=float(random.choice([least, 0.2, 0.8])))
    resting = Resting(body, [floor], placement=placement, settings=settings)
    size = np.linalg.norm(np.ptp(body.mesh.nodes, axis=0))
    scale = body.mass * 9.81 * size
    before = energy(body, resting.rest, settings.gravity)
    for _ in range(150):
        rest = resting.step(1e-3)
        now = energy(body, rest, settings.gravity)
        assert now <= before + 1e-5 * scale
        before = now
    rest = resting.settle()
    assert energy(body, rest, settings.gravity) <= before + 1e-5 * scale
    assert rest.surface()[:, 2].min() > -0.02 * size
    weight = body.mass * 9.81
    # A ball still creeps.
    left = 1e-5 if kind == "ball" else 1e-6
    np.testing.assert_allclose(rest.supports[0].force, [0.0, 0.0, -weight], atol=left * weight)
