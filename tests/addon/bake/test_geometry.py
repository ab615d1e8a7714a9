"""Frames, rays, drags and fingerprints: plain numbers in and out."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest
from soft_scene import part


@pytest.fixture
def rng():
    return np.random.default_rng(7)


@pytest.fixture
def frames(installed):
    return part("operators.scene.body_frame").BodyFrame


def matrix(linear, origin=(0.1, -0.2, 0.3)):
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = linear, origin
    return whole


def test_body_and_object_cover_the_same_place_under_any_matrix(frames, rng):
    """Scaled, sheared, mirrored: the drawn world point and the body's are one."""
    for _ in range(200):
        linear = rng.standard_normal((3, 3))
        local = rng.standard_normal((5, 3))
        frame = frames.of_matrix(matrix(linear), 0.01)
        world = local @ linear.T + [0.1, -0.2, 0.3]
        body = frame.body_from_local(local)
        assert np.allclose(frame.world_from_body(body), world, atol=1e-12)
        assert np.allclose(frame.body_from_world(world), body, atol=1e-12)
        assert np.allclose(frame.local_from_body(body), local, atol=1e-9)
        assert np.isclose(np.linalg.det(frame.rotation), 1.0)
        assert frame.mirrored == (np.linalg.det(linear) < 0)


def test_turning_and_moving_an_object_leaves_its_body(frames, rng):
    linear = rng.standard_normal((3, 3))
    turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    turn *= np.linalg.det(turn)
    before = frames.of_matrix(matrix(linear))
    after = frames.of_matrix(matrix(turn @ linear, (5.0, 6.0, 7.0)))
    assert np.allclose(before.metric, after.metric, atol=1e-12)


@pytest.mark.parametrize("scale", [(1.0, 0.0, 1.0), (np.nan, 1.0, 1.0)])
def test_a_transform_without_volume_is_refused_with_a_remedy(frames, scale):
    error = part("core.errors").PalpateError
    with pytest.raises(error, match="scale"):
        frames.of_matrix(matrix(np.diag(scale)))


def test_a_ray_meets_what_it_was_aimed_at_and_only_from_the_front(installed, rng):
    ray = part("operators.place.ray")
    triangles = np.array([[0, 1, 2]])
    fronts = 0
    for _ in range(500):
        nodes, origin = rng.standard_normal((3, 3)), rng.standard_normal(3)
        alpha = rng.dirichlet([1.0, 1.0, 1.0])
        toward = alpha @ nodes - origin
        distance = np.linalg.norm(toward)
        hit = ray.first_hit(origin, toward / distance, nodes, triangles)
        normal = np.cross(nodes[1] - nodes[0], nodes[2] - nodes[0])
        assert (hit is not None) == (normal @ toward < 0)
        if hit is not None:
            fronts += 1
            assert np.allclose(hit.alpha, alpha, atol=1e-6)
            assert np.isclose(hit.distance, distance)
    assert fronts > 100


def drag(normal, **more):
    module = part("operators.scene.probe_drag")
    view = module.View(np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]), 0.001)
    return module.ProbeDrag(
        point=np.zeros(3), normal=np.array(normal), view=view, size=0.1, start=(100, 100), **more
    )


def test_dragging_along_the_image_of_the_inward_normal_goes_in(installed):
    """A floor seen from the side: down is in, one millimetre a pixel."""
    assert np.allclose(drag([0.0, 0.0, 1.0]).dragged((100, 90)).target, [0.0, 0.0, -0.01])
    assert np.allclose(drag([1.0, 0.0, 0.0]).dragged((90, 100)).target, [-0.01, 0.0, 0.0])


def test_on_a_face_toward_the_viewer_dragging_down_goes_in_and_aside_slides(installed):
    facing = drag([0.0, -1.0, 0.0])
    assert np.allclose(facing.dragged((100, 90)).target, [0.0, 0.01, 0.0])
    assert np.allclose(facing.dragged((107, 100)).target, [0.007, 0.0, 0.0])


def test_wheel_and_pen_add_depth(installed):
    assert np.isclose(drag([0.0, 0.0, 1.0]).wheeled(3).depth, 0.003)
    assert np.isclose(drag([0.0, 0.0, 1.0]).dragged((100, 100), 0.5).depth, 0.005)
    assert np.isclose(drag([0.0, 0.0, 1.0], sensitivity=2.0).dragged((100, 90)).depth, 0.02)


def test_a_drag_goes_no_deeper_than_it_is_allowed_and_comes_back(installed):
    limited = drag([0.0, 0.0, 1.0], deepest=0.008)
    assert np.isclose(limited.dragged((100, 90)).depth, 0.008)
    assert np.isclose(limited.wheeled(20).depth, 0.008)
    assert np.allclose(limited.dragged((107, 60)).target, [0.007, 0.0, -0.008])
    assert np.isclose(limited.dragged((100, 95)).depth, 0.005)


@pytest.fixture
def prints(installed):
    return part("operators.scene.fingerprint")


def fingerprint(prints, local, body, corners=(0, 1, 2)):
    starts = np.arange(0, len(corners), 3)
    return prints.take(local, body, np.array(corners), starts)


def test_a_fingerprint_survives_rounding_and_storage_but_no_edit(prints, rng):
    local = rng.standard_normal((5000, 3))
    old = fingerprint(prints, local, local)
    assert prints.Fingerprint.from_text(old.to_text()) == old
    rounded = local * (1 + 1e-7 * rng.standard_normal((5000, 3)))
    assert prints.changed_body(old, fingerprint(prints, local, rounded)) == ""
    edited = local.copy()
    edited[1234, 0] += 0.01
    assert "edited" in prints.changed_body(old, fingerprint(prints, edited, edited))


def test_a_fingerprint_tells_scale_from_shape_from_topology(prints, rng):
    local = rng.standard_normal((50, 3))
    old = fingerprint(prints, local, local)
    assert "scale" in prints.changed_body(old, fingerprint(prints, local, 1.01 * local))
    assert "connected" in prints.changed_body(old, fingerprint(prints, local, local, (0, 2, 1)))
    assert "51 vertices" in prints.changed_body(
        old, fingerprint(prints, *(np.vstack([local, [[0, 0, 0]]]),) * 2)
    )


def test_a_fingerprint_of_before_there_were_stiff_regions_can_be_read(prints, rng):
    local = rng.standard_normal((50, 3))
    old = dataclasses.replace(fingerprint(prints, local, local), pins="below 0.1000")
    fields = json.loads(old.to_text())
    del fields["stiffness"]
    assert prints.Fingerprint.from_text(json.dumps(fields)) == old
