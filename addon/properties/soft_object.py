"""Properties of an object: material, surface rendering, pins, baked body."""

from collections.abc import Callable

import bpy

from ...operators.animation import live_pressers
from ...operators.traction import layer_traction
from .kinds import choice, chosen_collection, number, result, span, switch, text
from .material import MaterialProperties
from .rest import RestProperties
from .scene import PalpateScene
from .shape import ShapeProperties

FRICTIONS = span(0.0, 5.0, soft_max=1.5, precision=2, step=5)
PIN_ITEMS = [
    ("BELOW", "Below Height", "Everything in the lowest part of the object, as it stands"),
    ("GROUP", "Vertex Group", "Vertices with a weight of 0.5 or more"),
    (
        "CORE",
        "Core",
        "What lies deep inside, as a skeleton: all of the surface gives way, and nothing leans",
    ),
    ("NONE", "None", "Nothing: the object rests on what is under it, slides, rolls and tips over"),
]
# Files hold the numbers of these items: give no number twice.
FORMULATION_ITEMS = [
    ("SMOOTHED", "Smoothed", "Right for every material", "", 2),
    ("LINEAR", "Linear", "The paper's. Too stiff, most of all near a ratio of 0.5", "", 1),
]
# Held by older files only, and as good as Smoothed; no panel offers it.
FORMER_FORMULATION = ("AUTO", "Automatic", "Smoothed", "", 0)
FORM_ITEMS = [
    ("AUTO", "Automatic", "Full while it is small, compressed where it would be large"),
    ("DENSE", "Full", "Every number is kept. Memory grows with the square of the surface"),
    ("COMPRESSED", "Compressed", "Takes a tenth of the memory or less, for large bodies"),
]


def _press_anew(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    live_pressers.look_again()
    live_pressers.press_again(settings.id_data, context.evaluated_depsgraph_get())


def _tell_forces(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    layer_traction.follow(settings.id_data)
    live_pressers.press_again(settings.id_data, context.evaluated_depsgraph_get())


def _keep_order(changed: str) -> Callable[[bpy.types.PropertyGroup, bpy.types.Context], None]:
    """Update callback that keeps dynamic friction at most as large as static friction."""

    def update(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
        if settings.dynamic_friction <= settings.static_friction:
            return
        if changed == "static_friction":
            settings.dynamic_friction = settings.static_friction
        else:
            settings.static_friction = settings.dynamic_friction

    return update


class PalpateObject(MaterialProperties, ShapeProperties, RestProperties, bpy.types.PropertyGroup):
    """``object.palpate``. The tetrahedra are ID properties: nodes, tets, fixed and, with a stiff
    region, young_scale.
    """

    bake_from: choice(
        "Bake From",
        "What is filled and felt",
        (
            (
                "AUTO",
                "As Seen",
                "The mesh with the modifiers before an Armature, where these make vertices",
            ),
            ("BASE", "Base Mesh", "The mesh's own vertices, whatever modifiers make of them"),
        ),
        "AUTO",
    )
    carrier: bpy.props.PointerProperty(
        name="Carrier",
        description="Hidden object whose vertices are those that the layers move",
        type=bpy.types.Object,
    )
    pin_mode: choice("Pin", "Which part never moves", PIN_ITEMS, "BELOW")
    pin_fraction: number(
        "Height",
        "Share of the object's height in world Z below which it is pinned",
        0.1,
        span(0.0, 0.95, subtype="FACTOR"),
    )
    pin_group: text("Group", "Vertex group that is pinned", "Pinned")
    stiff_group: text(
        "Group",
        "Vertex group that is stiffer or softer than the material. A closed shell "
        "inside the mesh makes all that it encloses stiff: bone in flesh. Needs Rebuild Body",
    )
    stiff_factor: number(
        "Times as Stiff",
        "Factor on Young's modulus where the group's weight is 1; halfway painted "
        "weights feel halfway",
        100.0,
        span(0.001, 100_000.0, soft_min=0.01, soft_max=10_000.0, precision=2, step=1000),
    )
    formulation: choice(
        "Formulation",
        "How tetrahedra resist. Needs Rebuild Body",
        [*FORMULATION_ITEMS, FORMER_FORMULATION],
        "SMOOTHED",
    )
    form: choice(
        "Compliance", "How the computed response is kept. Needs Rebuild Body", FORM_ITEMS, "AUTO"
    )
    compression_tolerance: number(
        "Largest Error",
        "By how much compressing may change the shape under any touch. The force "
        "that is felt stays exact",
        0.1,
        span(0.001, 5.0, precision=2, step=1, subtype="PERCENTAGE"),
    )
    shading: switch(
        "Smooth Facets",
        "Feel the smooth surface that the facets stand for, instead of their edges",
        on=True,
    )
    static_friction: number(
        "Static Friction",
        "How well the surface holds a resting finger: sideways force over pressing "
        "force. 0 is slippery, felt is about 0.5, rubber 1",
        0.0,
        FRICTIONS,
        update=_keep_order("static_friction"),
    )
    dynamic_friction: number(
        "Dynamic Friction",
        "The same while the finger slides; never more than the static one",
        0.0,
        FRICTIONS,
        update=_keep_order("dynamic_friction"),
    )
    pressers: chosen_collection(
        "Pressers",
        "Objects of this collection press while the animation plays: meshes by their convex hulls, "
        "Empties as spheres of their size",
        update=_press_anew,
    )
    yield_depth: number(
        "Yield Depth",
        "What is pressed farther than this stays, as in clay. 0 is elastic: all springs back, and "
        "only what is kept stays",
        0.0,
        span(0.0, soft_max=1.0, precision=4, step=0.1, subtype="DISTANCE", unit="LENGTH"),
    )
    forget_time: number(
        "Forget Time",
        "Seconds in which an imprint fades to about a third, as in memory foam; 0 for never",
        0.0,
        span(
            0.0, soft_max=60.0, precision=2, step=10, subtype="TIME_ABSOLUTE", unit="TIME_ABSOLUTE"
        ),
    )
    force_attributes: switch(
        "Force Attributes",
        "Give shaders and geometry nodes the attributes palpate_pressure, palpate_normal, "
        "palpate_traction and palpate_displacement of all layers. Drawing takes a little longer",
        update=_tell_forces,
    )
    edge_length: number(
        "Edge Length",
        "Wanted edge length of the tetrahedra, as a share of the object's diagonal. "
        "Half the length: about eight times the nodes",
        0.05,
        span(0.005, 0.5, precision=3, step=0.5),
    )
    epsilon: number(
        "Tolerance",
        "How far the body may stray from the mesh, as a share of the diagonal. "
        "Smaller takes longer",
        0.003,
        span(0.0001, 0.05, precision=4, step=0.01),
    )
    decimate_above: number(
        "Simplify Above",
        "Denser meshes are simplified to this many triangles before the bake. "
        "What you see stays as dense as it is",
        6000,
        span(200, 1_000_000),
    )
    time_limit: number(
        "Time Limit",
        "Give up filling with tetrahedra after this many seconds",
        600.0,
        span(5.0, soft_max=3600.0, precision=0, step=1000),
    )

    # Results of the last bake, written by the operators only.
    body_key: result("", name="Body Key")
    body_file: result("", name="Body File")
    fingerprint: result("", name="Fingerprint")
    # 0 if unknown.
    baked_edge_length: result(0.0)
    baked_epsilon: result(0.0)
    baked_poisson_ratio: result(0.0, precision=3)
    # Of bodies in files from before there was a choice.
    baked_formulation: result("linear")
    baked_form: result("dense")
    # Of a compressed body, in percent: what was allowed, and what it is.
    baked_tolerance: result(0.1)
    column_error: result(0.0)
    node_count: result(0)
    # 0 in files from before it was told.
    pinned_count: result(0)
    tet_count: result(0)
    free_surface_count: result(0)
    compliance_megabytes: result(0.0)
    # Largest distances of the body's surface from the drawn mesh and back, m; 0 if unknown.
    body_to_mesh: result(0.0)
    mesh_to_body: result(0.0)
    # Of a preview: how far the drawn mesh lies from it at most, as a share of its size; else 0.
    preview_off: result(0.0)
    bake_seconds: result(0.0)
    bake_warnings: result("")


classes = (PalpateObject, PalpateScene)


def register() -> None:
    """Add the properties to objects and scenes."""
    bpy.types.Object.palpate = bpy.props.PointerProperty(type=PalpateObject)
    bpy.types.Scene.palpate = bpy.props.PointerProperty(type=PalpateScene)


def unregister() -> None:
    """Remove the properties; files keep their values."""
    del bpy.types.Object.palpate
    del bpy.types.Scene.palpate
