"""Material, pins and stored tetrahedra of the sample scenes, so that they open soft.

mouse-tets.npz is one answer of fTetWild, which gives another mesh each time: edge length and
tolerance below gave 1,690 to 1,780 nodes and 1,010 to 1,075 free surface nodes in five runs, where
the paper's mouse has 1,713 and 1,036. drumstick-tets.npz is another answer, for meat and
bone together: 1,896 nodes, 836 of them on the free surface; hare-tets.npz one for the hare: 1,933
nodes, 1,189 of them on the free surface. Arrays X (m), T, fixed as in the other stored meshes.
"""

from pathlib import Path

import bpy
import numpy as np
from installed import palpate
from numpy.typing import NDArray

HERE = Path(__file__).parent
# Edge length and tolerance with which fTetWild made them, as shares of the diagonal.
MOUSE_SIZE, DRUMSTICK_SIZE, HARE_SIZE = (0.058, 0.0037), (0.045, 0.003), (0.04, 0.0035)
TRIANGLES = 6000
Tets = tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]


def stored_tets(name: str) -> Tets:
    """Nodes, tetrahedra and pinned nodes of the mouse, the drumstick or the hare."""
    with np.load(HERE / f"{name}-tets.npz", allow_pickle=False) as stored:
        return stored["X"], stored["T"], stored["fixed"]


def cube_tets() -> Tets:
    """The paper's cube, Table 1, standing on the origin."""
    mesh, fixed = palpate("core.mesh.paper_cube").paper_cube()
    return mesh.nodes - np.array([0.025, 0.025, 0.0]), mesh.tets, fixed


def set_up(
    thing: bpy.types.Object, pinned: str, *, material: str, formulation: str = "SMOOTHED"
) -> None:
    """Fill in the panel: material by its preset, formulation and pin group."""
    settings = thing.palpate
    settings.material, settings.formulation = material, formulation
    settings.pin_mode, settings.pin_group = "GROUP", pinned


def set_stiff(thing: bpy.types.Object, group: str, factor: float) -> None:
    """Fill in the panel: what is stiffer, and how many times."""
    thing.palpate.stiff_group, thing.palpate.stiff_factor = group, factor


def set_mesh_size(thing: bpy.types.Object, size: tuple[float, float]) -> None:
    """What gives about the stored number of nodes when the object is made soft anew."""
    settings = thing.palpate
    settings.edge_length, settings.epsilon = size
    settings.decimate_above = TRIANGLES


def attach(thing: bpy.types.Object, tets: Tets) -> None:
    """Give an object these tetrahedra, as a bake would have, and let Rebuild Body do the rest."""
    scene = bpy.context.scene
    baked = thing.palpate
    if not baked.is_property_set("shape"):
        # As what is made soft anew begins.
        baked.shape = "ROTATION_STRAIN"
    for name, array in zip(palpate("operators.object.embedded_body").ARRAYS, tets, strict=True):
        kind = np.float64 if array.dtype.kind == "f" else np.int32
        baked[name] = array.astype(kind).ravel()
    surface = palpate("operators.scene.drawn_surface").read(thing, scene)
    rule = palpate("operators.pins.pin_group").pin_rule(thing)
    # The stored tetrahedra are equally stiff: Rebuild Body looks up the region that is set.
    baked.fingerprint = surface.fingerprint(rule, stiffness="").to_text()
    baked.body_key = "stored tetrahedra"
    bpy.context.view_layer.objects.active = thing
    if bpy.ops.palpate.rebuild_body() != {"FINISHED"}:
        raise RuntimeError(f"{thing.name}: Rebuild Body did not finish")
