"""The plush mouse: what it is modelled as, and the stored tetrahedra that fill it."""

from pathlib import Path

import numpy as np
import pytest
from mouse_shape import Part, QuadMesh, mouse
from surface_net import surface_net

from palpate.core.mesh.decimate import decimate
from palpate.core.mesh.fit import measured_fit
from palpate.core.mesh.surface import Surface
from palpate.core.mesh.tet_mesh import TetMesh

SCENES = Path(__file__).resolve().parents[2] / "sample_scenes"
# Table 1 of the paper.
NODES, SURFACE_NODES, FREE_SURFACE_NODES, TETS = 1713, 1175, 1036, 6312


@pytest.fixture(scope="module")
def shape() -> QuadMesh:
    return mouse()


@pytest.fixture(scope="module")
def surface(shape: QuadMesh) -> Surface:
    triangles = np.concatenate([shape.quads[:, [0, 1, 2]], shape.quads[:, [0, 2, 3]]])
    return Surface.checked(shape.vertices, triangles)


@pytest.fixture(scope="module")
def stored() -> tuple[TetMesh, np.ndarray]:
    with np.load(SCENES / "mouse-tets.npz", allow_pickle=False) as file:
        return TetMesh.checked(file["X"], file["T"]), file["fixed"]


def test_every_part_is_closed_and_wound_outward(shape: QuadMesh, surface: Surface) -> None:
    assert surface.is_closed
    for part in Part:
        quads = shape.quads[shape.part == part]
        triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        assert Surface.checked(shape.vertices, triangles).signed_volume > 0


def test_the_mouse_is_about_120_mm_long_and_stands_on_the_table(shape: QuadMesh) -> None:
    body = shape.vertices[np.unique(shape.quads[shape.part == Part.PLUSH])]
    assert np.ptp(body[:, 0]) == pytest.approx(0.12, rel=0.05)
    assert shape.vertices[:, 2].min() == 0.0
    assert 5_000 <= len(shape.vertices) <= 10_000


def test_what_lies_on_the_table_is_pinned_and_nothing_else(shape: QuadMesh) -> None:
    height = shape.vertices[:, 2]
    assert np.array_equal(np.sort(shape.pinned), np.flatnonzero(height < 0.0015))
    assert 0.05 < len(shape.pinned) / len(height) < 0.15


def test_the_same_mouse_comes_out_each_time(shape: QuadMesh) -> None:
    again = mouse()
    assert np.array_equal(again.vertices, shape.vertices)
    assert np.array_equal(again.quads, shape.quads)


def test_stored_tetrahedra_have_the_papers_size(stored: tuple[TetMesh, np.ndarray]) -> None:
    mesh, fixed = stored
    free = len(np.setdiff1d(mesh.surface_nodes, fixed))
    counts = [len(mesh.nodes), len(mesh.surface_nodes), free, len(mesh.tets)]
    assert counts == pytest.approx([NODES, SURFACE_NODES, FREE_SURFACE_NODES, TETS], rel=0.15)
    assert mesh.component_count == 1


@pytest.mark.at_length
def test_stored_tetrahedra_fill_the_mouse(
    surface: Surface, stored: tuple[TetMesh, np.ndarray]
) -> None:
    mesh, fixed = stored
    fit = measured_fit(mesh, surface, decimate(surface.welded(), 6000))
    assert fit.volume_ratio == pytest.approx(1.0, abs=0.02)
    assert fit.body_to_input < 0.0015
    assert mesh.nodes[fixed, 2].max() < 0.003


@pytest.mark.parametrize("name", ["cube", "mouse"])
def test_scenes_are_small_compressed_files(name: str) -> None:
    content = (SCENES / f"{name}.blend").read_bytes()
    assert content[:4] == bytes.fromhex("28b52ffd")  # Zstandard
    assert len(content) < 1_000_000


def test_a_surface_net_lies_on_the_surface_it_was_made_for() -> None:
    low, high = np.full(3, -1.3), np.full(3, 1.3)
    vertices, quads = surface_net(lambda p: np.linalg.norm(p, axis=1) - 1.0, low, high, 0.2)
    assert np.linalg.norm(vertices, axis=1) == pytest.approx(1.0, abs=1e-6)
    assert len(vertices) - len(quads) == 2  # Euler: V - E + F = 2 with E = 2 F


def test_a_crevice_narrower_than_the_grid_is_refused() -> None:
    def two_balls(points: np.ndarray) -> np.ndarray:
        distances = [
            np.linalg.norm(points - np.array(centre), axis=1) - 1.0
            for centre in ((0.0, 0.0, 0.0), (1.45, 1.45, 0.0))
        ]
        return np.minimum(*distances)

    with pytest.raises(ValueError, match="more than two quads"):
        surface_net(two_balls, np.full(3, -1.3), np.full(3, 2.8), 0.23)
