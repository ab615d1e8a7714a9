"""Predicted cost of a bake, and figures of the last one."""

import bpy

from ...core.errors import PalpateError
from ...core.quantities import about, duration, length, memory, percent
from ...core.sentence import Sentence
from ...operators.bake.bake_prediction import Prediction
from ...operators.reporting.translated import shown
from .. import known_status
from .base import draw_box, draw_rows
from .sentence import say

FORM_NAMES = {"dense": "Full", "compressed": "Compressed"}
FORMULATION_NAMES = {"linear": "Linear", "smoothed": "Smoothed"}


def draw_summary(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw a line below Make Soft, an alert if memory would not suffice, or why it cannot be."""
    try:
        prediction = known_status.prediction(context.object, context.scene)
    except PalpateError as problem:
        say(layout, context, problem.sentence, "ERROR")
        layout.operator("palpate.show_problems", icon="VIEWZOOM")
        return
    if prediction is None:
        return
    cost = prediction.cost
    if prediction.fits:
        say(layout, context, "Takes about {time}", "TIME", time=duration(cost.seconds))
    else:
        _draw_alarm(layout, context, prediction)


def draw_prediction(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the predicted cost with the present settings."""
    prediction = _prediction(context)
    if prediction is None:
        return
    cost = prediction.cost
    rows = [
        ("Nodes", about(cost.nodes)),
        ("Free Surface Nodes", about(cost.free_surface_nodes)),
        ("Bake Time", duration(cost.seconds)),
        ("Peak Memory", memory(cost.peak_bytes)),
        ("File", memory(cost.file_bytes)),
        ("Compliance", shown(FORM_NAMES[cost.form])),
    ]
    box = draw_box(layout, "The Next Bake, About", rows)
    if not prediction.fits:
        _draw_alarm(box, context, prediction, boxed=True)


def draw_figures(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the figures of the last bake."""
    baked = context.object.palpate
    form = shown(FORM_NAMES.get(baked.baked_form, baked.baked_form))
    box = layout.column(align=True)
    rows = [
        ("Nodes", f"{baked.node_count:,}"),
        ("Tetrahedra", f"{baked.tet_count:,}"),
        ("Free Surface Nodes", f"{baked.free_surface_count:,}"),
        ("Formulation", shown(FORMULATION_NAMES.get(baked.baked_formulation, ""))),
        ("Compliance", form),
        ("Memory", memory(1e6 * baked.compliance_megabytes)),
    ]
    if baked.baked_form == "compressed":
        rows.append(("Uncompressed", memory(36.0 * baked.free_surface_count**2)))
        rows.append(("Largest Error", percent(baked.column_error / 100)))
    if baked.body_to_mesh or baked.mesh_to_body:
        rows.append(("Body to Mesh", length(baked.body_to_mesh)))
        rows.append(("Mesh to Body", length(baked.mesh_to_body)))
    rows.append(("Bake Time", f"{baked.bake_seconds:.1f} s"))
    draw_rows(box, rows)
    for warning in filter(None, baked.bake_warnings.split("\n")):
        say(layout, context, Sentence.of_line(warning), "ERROR")


def _prediction(context: bpy.types.Context) -> Prediction | None:
    try:
        return known_status.prediction(context.object, context.scene)
    except PalpateError:
        # Make Soft reports what cannot be baked, with the remedy.
        return None


def _draw_alarm(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    prediction: Prediction,
    *,
    boxed: bool = False,
) -> None:
    column = layout.column(align=True)
    column.alert = True
    figures = {
        "needed": memory(prediction.cost.peak_bytes),
        "available": memory(prediction.available),
    }
    say(
        column,
        context,
        "Takes {needed} of memory; {available} are free",
        "ERROR",
        boxed=boxed,
        **figures,
    )
    column = layout.column(align=True)
    if prediction.compressed_fits:
        column.operator("palpate.fit_memory", text="Compress It").by = "COMPRESSED"
    if prediction.edge_length is not None:
        text = shown("Use Edge Length {length}", length=f"{prediction.edge_length:g}")
        column.operator("palpate.fit_memory", text=text, translate=False).by = "COARSER"
