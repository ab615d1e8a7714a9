"""What a bake is asked arrives in its child process as it was."""

from dataclasses import fields, replace

import numpy as np
import pytest

from palpate.core.bake.request import BakeRequest
from palpate.core.bake.settings import BakeSettings
from palpate.core.errors import PalpateError
from palpate.core.mesh.surface import Surface
from palpate.core.stiffness.pins import PinBelow, PinNodes, PinWeights
from palpate.core.stiffness.regions import StiffRegion, TetScale


def alike(a, b):
    if isinstance(a, np.ndarray):
        return np.array_equal(a, b)
    if hasattr(a, "__dataclass_fields__"):
        return type(a) is type(b) and all(
            alike(getattr(a, field.name), getattr(b, field.name)) for field in fields(a)
        )
    return a == b


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"pins": PinBelow(0.3, 1)},
        {"pins": PinWeights(np.array([0.0, 1.0, 0.5, 1.0]))},
        {"pins": PinNodes(np.array([3, 1]))},
        {"stiffness": StiffRegion(np.array([0.0, 1.0, 0.5, 1.0]), 50.0)},
        {"stiffness": TetScale(np.linspace(1, 2, 7))},
        {"formulation": "linear", "form": "compressed", "tolerance": 0.006, "threads": 2},
    ],
)
def test_every_setting_arrives(tmp_path, changes):
    asked = replace(BakeSettings(poisson_ratio=0.41), **changes)
    corners = np.vstack([np.zeros(3), np.eye(3)])
    surface = Surface(corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    BakeRequest(surface, asked).write(tmp_path)
    arrived = BakeRequest.read(tmp_path)
    assert alike(arrived.settings, asked)
    assert alike(arrived.source, surface)


def test_tetrahedra_and_the_surface_of_their_pins_arrive(tmp_path, cube_mesh):
    mesh, fixed = cube_mesh
    surface = Surface(mesh.nodes, mesh.surface_triangles)
    BakeRequest(mesh, BakeSettings(pins=PinNodes(fixed)), surface).write(tmp_path)
    arrived = BakeRequest.read(tmp_path)
    assert alike(arrived.source, mesh)
    assert alike(arrived.surface, surface)


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"form": "sparse"}, "form"),
        ({"formulation": "cubic"}, "formulation"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"tolerance": np.nan}, "tolerance"),
        ({"threads": 0}, "threads"),
    ],
)
def test_settings_out_of_range_are_named(changes, word):
    with pytest.raises(PalpateError, match=word):
        replace(BakeSettings(), **changes).checked()
