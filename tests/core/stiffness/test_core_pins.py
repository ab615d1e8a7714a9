"""Pins of the core: deep inside, one core a piece, and nothing leans on a slender foot."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from palpate.core.bake.request import BakeRequest
from palpate.core.bake.settings import BakeSettings
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.assembly import assemble
from palpate.core.stiffness.held_pins import pins_checked
from palpate.core.stiffness.pins import PinBelow, PinCore, Pins, pinned_nodes

CELLS = 10


def block_on_a_foot() -> TetMesh:
    """A block of 1 x 1 x 0.7 m on a foot of 0.2 x 0.2 x 0.3 m."""
    cube, _ = paper_cube(1.0, CELLS)
    middle = cube.nodes[cube.tets].mean(axis=1)
    foot = np.abs(middle[:, :2] - cube.nodes.mean(axis=0)[:2]).max(axis=1) < 0.1
    return of_tets(cube, (middle[:, 2] > 0.3) | foot)


def of_tets(mesh: TetMesh, chosen: NDArray[np.bool_]) -> TetMesh:
    used, tets = np.unique(mesh.tets[chosen], return_inverse=True)
    return TetMesh.checked(mesh.nodes[used], tets.reshape(-1, 4))


def test_the_core_lies_deep_and_leaves_the_surface_free() -> None:
    mesh, _ = paper_cube(1.0, CELLS)
    core = pinned_nodes(PinCore(), mesh, None)
    depth = np.minimum(mesh.nodes - mesh.nodes.min(axis=0), mesh.nodes.max(axis=0) - mesh.nodes)
    assert np.array_equal(core, np.flatnonzero(depth.min(axis=1) >= 0.25 - 1e-9))


def test_a_shell_is_held_by_what_it_stands_on() -> None:
    cube, _ = paper_cube(1.0, CELLS)
    flat = TetMesh.checked(cube.nodes * [1.0, 0.05, 1.0], cube.tets)
    low = flat.nodes[pinned_nodes(PinCore(), flat, None)]
    assert low[:, 2].max() <= flat.nodes[:, 2].min() + 0.1 + 1e-9
    aside = flat.nodes[pinned_nodes(PinCore(up=(1.0, 0.0, 0.0)), flat, None)]
    assert aside[:, 0].max() <= flat.nodes[:, 0].min() + 0.1 + 1e-9


@pytest.mark.parametrize("thickness", [0.1, 1.0])
def test_every_piece_is_held_also_without_nodes_inside(thickness: float) -> None:
    cube, _ = paper_cube(1.0, CELLS)
    middle = cube.nodes[cube.tets].mean(axis=1)
    # Between the two lies a layer of cells that are left out; the lower one has nodes inside only
    # where it is thick.
    low = middle[:, 2] < min(thickness, 0.6)
    mesh = of_tets(cube, low | (middle[:, 2] > 0.7))
    assert mesh.component_count == 2
    core = pinned_nodes(PinCore(), mesh, None)
    assert np.array_equal(pins_checked(mesh, core), core)


def test_a_block_on_a_slender_foot_does_not_lean() -> None:
    mesh = block_on_a_foot()
    leaning, held = (largest_over_touched(mesh, pins) for pins in (PinBelow(0.0), PinCore()))
    assert leaning > 1.5
    assert held == 1.0


def largest_over_touched(mesh: TetMesh, pins: Pins) -> float:
    """Largest displacement over that of the pushed node, at the foot of a side of the block."""
    compliance = surface_compliance(mesh, assemble(mesh, 0.3), pinned_nodes(pins, mesh, None))
    places = mesh.nodes[compliance.free_surface]
    touched = np.argmin(np.linalg.norm(places - [places[:, 0].max(), 0.5, 0.4], axis=1))
    moved = compliance.apply(np.array([[-1.0, 0.0, 0.0]]), np.array([touched]))
    return float(np.linalg.norm(moved, axis=1).max() / np.linalg.norm(moved[touched]))


def test_a_child_process_is_asked_for_the_core(tmp_path: Path) -> None:
    mesh, _ = paper_cube(1.0, 2)
    BakeRequest(mesh, BakeSettings(pins=PinCore(0.4, (0.0, 1.0, 0.0)))).write(tmp_path)
    assert BakeRequest.read(tmp_path).settings.pins == PinCore(0.4, (0.0, 1.0, 0.0))
