"""Properties of an object: material, surface rendering, pins, baked body."""

import math
from collections.abc import Callable

import bpy

from ...core.softness.scales.materials import MATERIALS
from .scene import PalpateScene
from .shape import ShapeProperties

# Files hold the numbers of these items: add new ones at the end only.
CUSTOM = "CUSTOM"
# Custom came before all materials but the first seven.
CUSTOM_NUMBER = 7
MATERIAL_ITEMS = [
    *(
        (
            name,
            material.name,
            f"{material.young_modulus:,.0f} Pa, {material.poisson_ratio:g}; {material.basis}",
            number if number < CUSTOM_NUMBER else number + 1,
        )
        for number, (name, material) in enumerate(MATERIALS.items())
    ),
    (CUSTOM, "Custom", "Young's modulus and Poisson's ratio as set below", CUSTOM_NUMBER),
]
PIN_ITEMS = [
    ("BELOW", "Below Height", "Everything in the lowest part of the object, as it stands"),
    ("GROUP", "Vertex Group", "Vertices with a weight of 0.5 or more"),
]
FORMULATION_ITEMS = [
    (
        "AUTO",
        "Automatic",
        "Smoothed where linear tetrahedra would be too stiff, linear elsewhere",
    ),
    ("LINEAR", "Linear", "The paper's. Too stiff as Poisson's ratio comes near 0.5"),
    ("SMOOTHED", "Smoothed", "Right for rubber and silicone too. The bake takes longer"),
]
FORM_ITEMS = [
    ("AUTO", "Automatic", "Full while it is small, compressed where it would be large"),
    ("DENSE", "Full", "Every number is kept. Memory grows with the square of the surface"),
    ("COMPRESSED", "Compressed", "Takes a tenth of the memory or less, for large bodies"),
]


def _take_material(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    material = MATERIALS.get(settings.material)
    if material is not None:
        settings.young_modulus = material.young_modulus
        settings.poisson_ratio = material.poisson_ratio


def _leave_material(name: str) -> Callable[[bpy.types.PropertyGroup, bpy.types.Context], None]:
    """Update callback that sets Custom once the number ``name`` differs from the preset's."""

    def update(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
        material = MATERIALS.get(settings.material)
        if material is not None and not math.isclose(
            getattr(settings, name), getattr(material, name), rel_tol=1e-5
        ):
            settings.material = CUSTOM

    return update


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


class PalpateObject(ShapeProperties, bpy.types.PropertyGroup):
    """``object.palpate``. The tetrahedra are ID properties: nodes, tets, fixed and, with a stiff
    region, young_scale.
    """

    material: bpy.props.EnumProperty(
        name="Material",
        description="A usual soft material, as a start",
        items=MATERIAL_ITEMS,
        default="PLUSH",
        update=_take_material,
    )
    young_modulus: bpy.props.FloatProperty(
        name="Young's Modulus",
        description="Stiffness in pascal. Takes effect at once, without a new bake",
        default=1000.0,
        min=1.0,
        max=1e9,
        soft_max=1e6,
        precision=0,
        step=10000,
        update=_leave_material("young_modulus"),
    )
    poisson_ratio: bpy.props.FloatProperty(
        name="Poisson's Ratio",
        description="How much it bulges sideways: 0 like cork, near 0.5 like rubber or water. "
        "Needs Rebuild Body",
        default=0.3,
        min=0.0,
        max=0.499,
        precision=3,
        step=1,
        update=_leave_material("poisson_ratio"),
    )
    pin_mode: bpy.props.EnumProperty(
        name="Pin", description="Which part never moves", items=PIN_ITEMS, default="BELOW"
    )
    pin_fraction: bpy.props.FloatProperty(
        name="Height",
        description="Share of the object's height in world Z below which it is pinned",
        default=0.1,
        min=0.0,
        max=0.95,
        subtype="FACTOR",
    )
    pin_group: bpy.props.StringProperty(
        name="Group", description="Vertex group that is pinned", default="Pinned"
    )
    stiff_group: bpy.props.StringProperty(
        name="Group",
        description="Vertex group that is stiffer or softer than the material. A closed shell "
        "inside the mesh makes all that it encloses stiff: bone in flesh. Needs Rebuild Body",
    )
    stiff_factor: bpy.props.FloatProperty(
        name="Times as Stiff",
        description="Factor on Young's modulus where the group's weight is 1; halfway painted "
        "weights feel halfway",
        default=100.0,
        min=0.001,
        max=100_000.0,
        soft_min=0.01,
        soft_max=10_000.0,
        precision=2,
        step=1000,
    )
    formulation: bpy.props.EnumProperty(
        name="Formulation",
        description="How tetrahedra resist. Needs Rebuild Body",
        items=FORMULATION_ITEMS,
        default="AUTO",
    )
    form: bpy.props.EnumProperty(
        name="Compliance",
        description="How the computed response is kept. Needs Rebuild Body",
        items=FORM_ITEMS,
        default="AUTO",
    )
    compression_tolerance: bpy.props.FloatProperty(
        name="Largest Error",
        description="By how much compressing may change the shape under any touch. The force "
        "that is felt stays exact",
        default=0.1,
        min=0.001,
        max=5.0,
        precision=2,
        step=1,
        subtype="PERCENTAGE",
    )
    shading: bpy.props.BoolProperty(
        name="Smooth Facets",
        description="Feel the smooth surface that the facets stand for, instead of their edges",
        default=True,
    )
    static_friction: bpy.props.FloatProperty(
        name="Static Friction",
        description="How well the surface holds a resting finger: sideways force over pressing "
        "force. 0 is slippery, felt is about 0.5, rubber 1",
        default=0.0,
        min=0.0,
        max=5.0,
        soft_max=1.5,
        precision=2,
        step=5,
        update=_keep_order("static_friction"),
    )
    dynamic_friction: bpy.props.FloatProperty(
        name="Dynamic Friction",
        description="The same while the finger slides; never more than the static one",
        default=0.0,
        min=0.0,
        max=5.0,
        soft_max=1.5,
        precision=2,
        step=5,
        update=_keep_order("dynamic_friction"),
    )
    edge_length: bpy.props.FloatProperty(
        name="Edge Length",
        description="Wanted edge length of the tetrahedra, as a share of the object's diagonal. "
        "Half the length: about eight times the nodes",
        default=0.05,
        min=0.005,
        max=0.5,
        precision=3,
        step=0.5,
    )
    epsilon: bpy.props.FloatProperty(
        name="Tolerance",
        description="How far the body may stray from the mesh, as a share of the diagonal. "
        "Smaller takes longer",
        default=0.003,
        min=0.0001,
        max=0.05,
        precision=4,
        step=0.01,
    )
    decimate_above: bpy.props.IntProperty(
        name="Simplify Above",
        description="Denser meshes are simplified to this many triangles before the bake. "
        "What you see stays as dense as it is",
        default=6000,
        min=200,
        max=1_000_000,
    )
    time_limit: bpy.props.FloatProperty(
        name="Time Limit",
        description="Give up filling with tetrahedra after this many seconds",
        default=600.0,
        min=5.0,
        soft_max=3600.0,
        precision=0,
        step=1000,
    )

    # Results of the last bake, written by the operators only.
    body_key: bpy.props.StringProperty(name="Body Key", options={"HIDDEN"})
    body_file: bpy.props.StringProperty(name="Body File", options={"HIDDEN"})
    fingerprint: bpy.props.StringProperty(name="Fingerprint", options={"HIDDEN"})
    # 0 if unknown.
    baked_edge_length: bpy.props.FloatProperty(options={"HIDDEN"})
    baked_epsilon: bpy.props.FloatProperty(options={"HIDDEN"})
    baked_poisson_ratio: bpy.props.FloatProperty(precision=3, options={"HIDDEN"})
    # Of bodies in files from before there was a choice.
    baked_formulation: bpy.props.StringProperty(default="linear", options={"HIDDEN"})
    baked_form: bpy.props.StringProperty(default="dense", options={"HIDDEN"})
    # Of a compressed body, in percent: what was allowed, and what it is.
    baked_tolerance: bpy.props.FloatProperty(default=0.1, options={"HIDDEN"})
    column_error: bpy.props.FloatProperty(options={"HIDDEN"})
    node_count: bpy.props.IntProperty(options={"HIDDEN"})
    tet_count: bpy.props.IntProperty(options={"HIDDEN"})
    free_surface_count: bpy.props.IntProperty(options={"HIDDEN"})
    compliance_megabytes: bpy.props.FloatProperty(options={"HIDDEN"})
    bake_seconds: bpy.props.FloatProperty(options={"HIDDEN"})
    bake_warnings: bpy.props.StringProperty(options={"HIDDEN"})


classes = (PalpateObject, PalpateScene)


def register() -> None:
    """Add the properties to objects and scenes."""
    bpy.types.Object.palpate = bpy.props.PointerProperty(type=PalpateObject)
    bpy.types.Scene.palpate = bpy.props.PointerProperty(type=PalpateScene)


def unregister() -> None:
    """Remove the properties; files keep their values."""
    del bpy.types.Object.palpate
    del bpy.types.Scene.palpate
