"""Figures of a body, printed by ``bake`` and ``info``."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np

from ...core.body.soft_body import SoftBody
from ...core.compliance.compression.compressed_compliance import CompressedCompliance
from ...core.compliance.dense import BYTES_PER_PAIR
from ...core.compliance.protocol import Compliance


def body_figures(body: SoftBody) -> dict[str, object]:
    """Sizes and identity of a body as plain values for JSON.

    ``compliance_bytes`` are those of the stored compliance, float32 if dense; in float64, as in the
    paper's Table 1, twice that.
    """
    return {
        "nodes": len(body.mesh.nodes),
        "tets": len(body.mesh.tets),
        "surface_nodes": len(body.mesh.surface_nodes),
        "free_surface_nodes": body.compliance.node_count,
        "surface_triangles": len(body.mesh.surface_triangles),
        "fixed_nodes": len(body.fixed),
        "components": body.mesh.component_count,
        "volume_m3": body.mesh.volume,
        "extents_m": np.ptp(body.mesh.nodes, axis=0).tolist(),
        "poisson_ratio": body.poisson_ratio,
        "young_modulus": body.young_modulus,
        "law": body.law,
        **({} if body.density is None else {"density": body.density, "mass_kg": body.mass}),
        "formulation": body.formulation,
        **_stiffness_range(body),
        "form": body.compliance.form,
        **_compression(body.compliance),
        "compliance_bytes": body.compliance.nbytes,
        **({} if body.fit is None else {"fit": asdict(body.fit)}),
        "key": body.key,
    }


def _stiffness_range(body: SoftBody) -> dict[str, object]:
    """Smallest and largest factor on Young's modulus, where it varies."""
    if body.young_scale is None:
        return {}
    return {"young_scale": [float(body.young_scale.min()), float(body.young_scale.max())]}


def _compression(compliance: Compliance) -> dict[str, object]:
    """Allowed and actual error of the compression."""
    if not isinstance(compliance, CompressedCompliance):
        return {}
    return {
        "tolerance": compliance.tolerance,
        "column_error": float(compliance.column_error),
        "dense_bytes": BYTES_PER_PAIR * compliance.node_count**2,
    }
