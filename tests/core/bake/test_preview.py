"""Coarse bodies that are made in a moment: near to the surface, whole, and held as the fine one."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from palpate.core.bake import preview_job
from palpate.core.bake.preview.lattice import lattice
from palpate.core.bake.preview.preview import preview
from palpate.core.bake.preview_job import PreviewJob
from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.errors import PalpateError
from palpate.core.mesh.surface import Surface
from palpate.core.mesh.tet_mesh import pieces
from palpate.core.stiffness.pins import PinBelow, PinNodes, PinWeights


def box(low, high):
    """A box of twelve triangles, wound outward."""
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    triangles = [[q[a], q[b], q[c]] for q in quads for a, b, c in ((0, 1, 2), (0, 2, 3))]
    return Surface.checked(low + corners * (high - low), np.array(triangles))


def ball(radius=0.05, rings=24):
    """A ball of longitudes and latitudes."""
    polar = np.linspace(0, np.pi, rings + 1)
    round_ = np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False)
    t, p = (axis.ravel() for axis in np.meshgrid(polar, round_, indexing="ij"))
    places = radius * np.column_stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)])
    i, j = (axis.ravel() for axis in np.meshgrid(range(rings), range(2 * rings), indexing="ij"))
    at = [(i + a) * 2 * rings + (j + b) % (2 * rings) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    first, second = np.column_stack(at[:3]), np.column_stack([at[0], *at[2:]])
    triangles = np.concatenate([first[i < rings - 1], second[i > 0]])
    return Surface.checked(places, triangles).welded()


def test_a_box_is_filled():
    mesh = lattice(box([0.0, 0.0, 0.0], [0.05, 0.04, 0.03]))
    assert mesh.volume == pytest.approx(0.05 * 0.04 * 0.03, rel=0.005)


def test_a_ball_is_filled_nearly():
    mesh, surface = lattice(ball()), ball()
    assert mesh.volume == pytest.approx(4 / 3 * np.pi * 0.05**3, rel=0.08)
    away = np.abs(np.linalg.norm(mesh.nodes[mesh.surface_nodes], axis=1) - 0.05)
    assert away.max() < surface.diagonal / 16


def test_triangles_without_area_change_nothing():
    whole = box([0.0, 0.0, 0.0], [0.05, 0.04, 0.03])
    middle = 0.5 * (whole.vertices[0] + whole.vertices[1])
    vertices = np.vstack([whole.vertices, middle, whole.vertices[0]])
    flat = np.array([[0, 8, 1], [0, 9, 3], [2, 2, 3]])
    surface = Surface.checked(vertices, np.concatenate([flat, whole.triangles]))
    np.testing.assert_allclose(lattice(surface).nodes, lattice(whole).nodes, atol=1e-12)
    assert preview(surface, BakeSettings(pins=PinBelow(0.1))).off == pytest.approx(0.01)


@pytest.mark.parametrize("thickness", [0.05, 0.004, 0.0004])
def test_thin_parts_are_filled_in_one_piece(thickness):
    mesh = lattice(box([0.0, 0.0, 0.0], [0.1, 0.1, thickness]))
    assert len(np.unique(pieces(mesh.tets, len(mesh.nodes)))) == 1
    assert mesh.volume > 0.0


def test_a_surface_with_a_hole_and_another_across_it_is_filled():
    one, two = box([0, 0, 0], [0.05, 0.05, 0.05]), box([0.02, 0.02, 0.02], [0.1, 0.04, 0.04])
    both = Surface.checked(
        np.concatenate([one.vertices, two.vertices]),
        # A triangle of each is missing.
        np.concatenate([one.triangles[1:], two.triangles[1:] + len(one.vertices)]),
    )
    whole = lattice(two)
    assert lattice(both).volume > whole.volume


def test_what_it_says_it_is_off_is_the_farthest_vertex():
    surface = ball()
    coarse = preview(surface, BakeSettings(pins=PinBelow(0.2)))
    nodes = coarse.mesh.nodes[coarse.mesh.surface_nodes]
    nearest = np.linalg.norm(surface.vertices[:, None] - nodes[None], axis=2).min(axis=1)
    # A vertex is nearer to a triangle than to its corners.
    assert 0.0 < coarse.off <= max(0.01, nearest.max() / surface.diagonal)


def test_painted_pins_hold_the_nodes_near_them():
    surface = ball()
    low = surface.vertices[:, 2] < -0.02
    coarse = preview(surface, BakeSettings(pins=PinWeights(low.astype(float))))
    assert isinstance(coarse.settings.pins, PinNodes)
    assert coarse.mesh.nodes[coarse.settings.pins.nodes, 2].max() < -0.005
    body, _ = bake(coarse.mesh, coarse.settings)
    assert np.array_equal(body.fixed, coarse.settings.pins.nodes)


def test_pins_that_hold_nothing_are_refused():
    surface = ball()
    with pytest.raises(PalpateError, match="pins"):
        preview(surface, BakeSettings(pins=PinWeights(np.zeros(len(surface.vertices)))))


def test_a_job_makes_the_body_of_a_preview():
    settings = BakeSettings(pins=PinBelow(0.2))
    made = PreviewJob(ball(), settings).result()
    coarse = preview(ball(), settings)
    assert made.off == coarse.off
    assert made.body.key == bake(coarse.mesh, coarse.settings)[0].key


def test_a_job_of_what_no_lattice_can_be_made_of_has_no_body():
    nothing_held = BakeSettings(pins=PinWeights(np.zeros(len(ball().vertices))))
    assert PreviewJob(ball(), nothing_held).result() is None


def test_a_job_that_is_closed_has_no_body(monkeypatch):
    begun, go_on = threading.Event(), threading.Event()

    def waiting(*_):
        begun.set()
        go_on.wait()
        return preview(ball(), BakeSettings())

    monkeypatch.setattr(preview_job, "preview", waiting)
    job = PreviewJob(ball(), BakeSettings())
    begun.wait()
    assert not job.finished
    job.close()
    go_on.set()
    assert job.result() is None
    assert job.finished
