"""Record of its body on an object, known without the body file."""

from __future__ import annotations

import bpy

from ...core.body.soft_body import SoftBody
from ...core.compliance.compression.compressed_compliance import CompressedCompliance
from ..scene.fingerprint import Fingerprint
from . import embedded_body


def record(
    thing: bpy.types.Object, body: SoftBody, file_name: str, fingerprint: Fingerprint
) -> None:
    """Make ``body``, stored under ``file_name``, the object's: tetrahedra, key and figures."""
    baked, compliance = thing.palpate, body.compliance
    if not baked.body_key and not baked.is_property_set("shape"):
        # The property's own default is what files from before have, which keep it.
        baked.shape = "ROTATION_STRAIN"
    embedded_body.embed(thing, body)
    baked.preview_off = 0.0
    baked.body_key = body.key
    baked.body_file = file_name
    baked.fingerprint = fingerprint.to_text()
    baked.baked_poisson_ratio = body.poisson_ratio
    baked.baked_formulation = body.formulation
    baked.baked_form = compliance.form
    if isinstance(compliance, CompressedCompliance):
        baked.baked_tolerance = 100 * compliance.tolerance
        baked.column_error = 100 * float(compliance.column_error)
    baked.node_count = len(body.mesh.nodes)
    baked.pinned_count = len(body.fixed)
    baked.tet_count = len(body.mesh.tets)
    baked.free_surface_count = compliance.node_count
    baked.compliance_megabytes = compliance.nbytes / 1e6
    if body.fit is not None:
        baked.body_to_mesh = body.fit.body_to_input
        baked.mesh_to_body = body.fit.input_to_body
