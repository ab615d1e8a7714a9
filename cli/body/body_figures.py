"""The figures of a body that ``bake`` and ``info`` print."""

from __future__ import annotations

import numpy as np

from ...core.body.soft_body import SoftBody
from ...core.compliance.compression.compressed_compliance import CompressedCompliance
from ...core.compliance.dense import BYTES_PER_PAIR
from ...core.compliance.protocol import Compliance


def body_figures(body: SoftBody) -> dict[str, object]:
    """Sizes and identity of a body as plain values for JSON.

    ``compliance_bytes`` is what the compliance takes as it is stored; a dense one is float32, so
    the same table in float64, as in the paper's Table 1, takes twice that.
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
        "formulation": body.formulation,
        **_stiffness_range(body),
        "form": body.compliance.form,
        **_compression(body.compliance),
        "compliance_bytes": body.compliance.nbytes,
        "key": body.key,
    }


def _stiffness_range(body: SoftBody) -> dict[str, object]:
    """Smallest and largest factor on Young's modulus, where a body is not the same all over."""
    if body.young_scale is None:
        return {}
    return {"young_scale": [float(body.young_scale.min()), float(body.young_scale.max())]}


def _compression(compliance: Compliance) -> dict[str, object]:
    """What compressing was allowed to change, and what it did."""
    if not isinstance(compliance, CompressedCompliance):
        return {}
    return {
        "tolerance": compliance.tolerance,
        "column_error": float(compliance.column_error),
        "dense_bytes": BYTES_PER_PAIR * compliance.node_count**2,
    }
