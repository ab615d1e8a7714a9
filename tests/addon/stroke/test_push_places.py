"""Pushes act where they were asked: along the surface, and where no fingertip gets to."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
import pytest
from soft_scene import TOP, cube, mesh_object, moved, rest_places, soften

HALF, SLOT, FLOOR = 0.025, 0.004, -0.01


def test_a_push_goes_along_the_surface_and_the_dent_with_it(thing):
    for by in ((0.0, 0.0, 0.0), (0.012, 0.0, 0.0)):
        bpy.ops.palpate.stroke(motion="PUSH", place=TOP, radius=0.008, depth=0.003, by=by)
    top = rest_places(thing)[:, 2] > 0.02
    here, beside = (
        np.average(rest_places(thing)[top, 0], weights=np.abs(moved(thing, name)[top, 2]) ** 3)
        for name in ("Press 1", "Press 2")
    )
    # Its drawn vertices are few.
    assert here + 0.002 < beside


def test_a_pull_goes_along_the_surface_too(thing):
    by = (0.002, 0.0, 0.0)
    bpy.ops.palpate.stroke(motion="PUSH", place=TOP, radius=0.02, depth=-0.002, by=by)
    shift = moved(thing, "Press 1")
    assert shift[:, 0].max() > 0.001
    assert shift[:, 2].max() > 0.001


@pytest.fixture
def slotted(palpate) -> bpy.types.Object:
    """A block with a slot that is narrower than a fingertip."""
    shape = bmesh.new()
    outline = [
        (-HALF, -HALF),
        (HALF, -HALF),
        (HALF, HALF),
        (SLOT, HALF),
        (SLOT, FLOOR),
        (-SLOT, FLOOR),
        (-SLOT, HALF),
        (-HALF, HALF),
    ]
    face = shape.faces.new([shape.verts.new((x, -HALF, z)) for x, z in outline])
    extruded = bmesh.ops.extrude_face_region(shape, geom=[face])["geom"]
    moving = [one for one in extruded if isinstance(one, bmesh.types.BMVert)]
    bmesh.ops.translate(shape, verts=moving, vec=(0.0, 2.0 * HALF, 0.0))
    bmesh.ops.recalc_face_normals(shape, faces=shape.faces[:])
    bmesh.ops.triangulate(shape, faces=shape.faces[:])
    bmesh.ops.subdivide_edges(shape, edges=shape.edges[:], cuts=5, use_grid_fill=True)
    mesh = bpy.data.meshes.new("Slotted")
    shape.to_mesh(mesh)
    shape.free()
    vertices = [vertex.co[:] for vertex in mesh.vertices]
    thing = mesh_object(vertices, [polygon.vertices[:] for polygon in mesh.polygons], "Slotted")
    thing.palpate.edge_length = 0.07
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    return thing


def test_a_place_that_no_fingertip_gets_to_is_pushed_itself(slotted):
    bpy.ops.palpate.stroke(motion="PUSH", place=(0.0, 0.0, FLOOR), radius=0.01, depth=0.002)
    # The vertices are few, so that a finer mesh carries the dent.
    fine = slotted.palpate.carrier or slotted
    rest, shift = rest_places(fine), moved(slotted, "Press 1")
    floor = np.argmin(np.linalg.norm(rest - [0.0, 0.0, FLOOR], axis=1))
    assert shift[floor, 2] < -0.0015
    # The jaws close over it; a fingertip would press down their rims, which it met first.
    assert shift[rest[:, 2] > HALF - 0.001, 2].min() > -0.0015


@pytest.fixture
def ear(palpate) -> bpy.types.Object:
    """A strip that stands on its pins, thin across x."""
    edges = 0.004, 0.02, 0.06
    thing = cube()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=9)
    bpy.ops.object.mode_set(mode="OBJECT")
    for vertex in thing.data.vertices:
        vertex.co = [at * edge / 0.05 for at, edge in zip(vertex.co, edges, strict=True)]
    soften(thing, edges, "BELOW")
    return thing


@pytest.mark.parametrize("depth", [0.008, 0.014])
def test_an_ear_that_bends_out_of_the_way_is_taken_along(ear, depth):
    place = np.array([0.002, 0.01, 0.024])
    bpy.ops.palpate.stroke(motion="PUSH", place=place, radius=0.004, depth=depth)
    fine = ear.palpate.carrier or ear
    here = np.argmin(np.linalg.norm(rest_places(fine) - place, axis=1))
    # A fingertip slips past its edge, which springs back by half of the way.
    assert -moved(ear, "Press 1")[here, 0] > 0.9 * depth


def test_a_smaller_fingertip_gets_to_where_a_large_one_does_not(slotted):
    slotted.palpate.pin_mode = "NONE"
    bpy.ops.palpate.rebuild_body()
    bpy.ops.palpate.stroke(motion="PUSH", place=(0.0, 0.0, FLOOR), radius=0.01, depth=0.002)
    fine = slotted.palpate.carrier or slotted
    rest, shift = rest_places(fine), moved(slotted, "Press 1")
    floor = np.argmin(np.linalg.norm(rest - [0.0, 0.0, FLOOR], axis=1))
    rims = rest[:, 2] > HALF - 0.001
    # It goes down beside the rims, which the large one would meet first.
    assert shift[floor, 2] < shift[rims, 2].min() - 0.001
