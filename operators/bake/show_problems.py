"""Show Problems: select in Edit Mode what keeps a mesh from being filled, or fills it wrongly."""

from __future__ import annotations

from dataclasses import dataclass

import bmesh
import bpy
from mathutils.bvhtree import BVHTree

from ...core.sentence import Sentence
from ..object import soft_object
from ..reporting.acting import Acting
from ..reporting.translated import reported
from ..session import press_session
from . import bake_session


@dataclass(frozen=True)
class Problems:
    """Numbers of what is wrong with a mesh: edges of holes, edges of three faces or more, vertices
    without a face, and faces that pass through others.
    """

    open_edges: frozenset[int]
    crowded_edges: frozenset[int]
    loose_vertices: frozenset[int]
    crossing_faces: frozenset[int]

    @property
    def count(self) -> int:
        """How many in all."""
        kinds = (self.open_edges, self.crowded_edges, self.loose_vertices, self.crossing_faces)
        return sum(map(len, kinds))


def problems_of(shape: bmesh.types.BMesh) -> Problems:
    """What is wrong with a mesh."""
    return Problems(
        frozenset(edge.index for edge in shape.edges if len(edge.link_faces) == 1),
        frozenset(edge.index for edge in shape.edges if len(edge.link_faces) > 2),
        frozenset(vertex.index for vertex in shape.verts if not vertex.link_faces),
        _crossing(shape),
    )


def _crossing(shape: bmesh.types.BMesh) -> frozenset[int]:
    """Faces that pass through others; neighbours, which touch, do not count."""
    tree = BVHTree.FromBMesh(shape)
    corners = [frozenset(vertex.index for vertex in face.verts) for face in shape.faces]
    return frozenset(
        number
        for pair in tree.overlap(tree)
        if not corners[pair[0]] & corners[pair[1]]
        for number in pair
    )


class PALPATE_OT_show_problems(Acting, bpy.types.Operator):
    bl_idname = "palpate.show_problems"
    bl_label = "Show Problems"
    bl_description = (
        "Select in Edit Mode what makes a mesh hard to fill: edges of holes, edges of more than "
        "two faces, vertices without a face, faces that pass through others"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        if bake_session.current() is not None:
            return "A bake is running; wait for it or cancel it"
        return press_session.refusal() or soft_object.refusal(context.object)

    def act(self, context: bpy.types.Context) -> None:
        bpy.ops.object.mode_set(mode="EDIT")
        context.tool_settings.mesh_select_mode = (True, True, True)
        mesh = context.object.data
        shape = bmesh.from_edit_mesh(mesh)
        found = problems_of(shape)
        if not found.count:
            bpy.ops.object.mode_set(mode="OBJECT")
            self.report({"INFO"}, reported("No problem was found in {name}", name=mesh.name))
            return
        _select(shape, found)
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
        self.report({"INFO"}, reported(_said(found)))


def _select(shape: bmesh.types.BMesh, found: Problems) -> None:
    """Show and select what was found, and nothing else."""
    for kind in (shape.verts, shape.edges, shape.faces):
        kind.ensure_lookup_table()
        for element in kind:
            element.select_set(False)
    chosen = [shape.verts[number] for number in found.loose_vertices]
    chosen += [shape.edges[number] for number in found.open_edges | found.crowded_edges]
    chosen += [shape.faces[number] for number in found.crossing_faces]
    for element in chosen:
        element.hide_set(False)
        element.select_set(True)


def _said(found: Problems) -> Sentence:
    return Sentence(
        "Selected: {open} edges of holes, {crowded} edges of more than two faces, "
        "{loose} vertices without a face, {crossing} faces that pass through others",
        open=len(found.open_edges),
        crowded=len(found.crowded_edges),
        loose=len(found.loose_vertices),
        crossing=len(found.crossing_faces),
    )


classes = (PALPATE_OT_show_problems,)
