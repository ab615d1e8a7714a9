"""Request to the bake's child process, as files in a folder."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..mesh.surface import Surface
from ..mesh.tet_mesh import TetMesh
from ..stiffness.pins import NoPins, PinBelow, PinCore, PinNodes, Pins, PinWeights
from ..stiffness.regions import StiffRegion, TetScale
from .settings import BakeSettings

ARRAYS_FILE = "request.npz"
SETTINGS_FILE = "request.json"


@dataclass(frozen=True, eq=False)
class BakeRequest:
    """Arguments of :func:`palpate.core.bake.steps.bake`."""

    source: Surface | TetMesh
    settings: BakeSettings
    surface: Surface | None = None

    def write(self, folder: Path) -> None:
        """Store the request in ``folder``."""
        arrays: dict[str, np.ndarray] = {}
        if isinstance(self.source, TetMesh):
            arrays |= {"nodes": self.source.nodes, "tets": self.source.tets}
        surface = self.source if isinstance(self.source, Surface) else self.surface
        if surface is not None:
            arrays |= {"vertices": surface.vertices, "triangles": surface.triangles}
        settings = self.settings
        plain = {
            name: getattr(settings, name)
            for name in settings.__dataclass_fields__
            if name not in {"pins", "stiffness"}
        }
        match settings.pins:
            case PinBelow(fraction, axis):
                plain["pin_below"] = [fraction, axis]
            case PinCore(share, up):
                plain["pin_core"] = [share, *up]
            case PinWeights(weights):
                arrays["pin_weights"] = weights
            case PinNodes(nodes):
                arrays["pin_nodes"] = nodes
            case NoPins():
                pass
        match settings.stiffness:
            case StiffRegion(weights, factor):
                arrays["stiff_weights"] = weights
                plain["stiff_factor"] = factor
            case TetScale(values):
                arrays["tet_scale"] = values
        np.savez(folder / ARRAYS_FILE, allow_pickle=False, **arrays)
        (folder / SETTINGS_FILE).write_text(json.dumps(plain), encoding="utf-8")

    @classmethod
    def read(cls, folder: Path) -> BakeRequest:
        """Read a request stored by :meth:`write`."""
        plain = json.loads((folder / SETTINGS_FILE).read_text(encoding="utf-8"))
        with np.load(folder / ARRAYS_FILE, allow_pickle=False) as file:
            arrays = dict(file)
        pins: Pins
        if "pin_below" in plain:
            fraction, axis = plain.pop("pin_below")
            pins = PinBelow(fraction, axis)
        elif "pin_core" in plain:
            share, x, y, z = plain.pop("pin_core")
            pins = PinCore(share, (x, y, z))
        elif "pin_weights" in arrays:
            pins = PinWeights(arrays["pin_weights"])
        elif "pin_nodes" in arrays:
            pins = PinNodes(arrays["pin_nodes"])
        else:
            pins = NoPins()
        stiffness: StiffRegion | TetScale | None = None
        if "stiff_weights" in arrays:
            stiffness = StiffRegion(arrays["stiff_weights"], plain.pop("stiff_factor"))
        elif "tet_scale" in arrays:
            stiffness = TetScale(arrays["tet_scale"])
        settings = BakeSettings(pins=pins, stiffness=stiffness, **plain)
        surface = Surface(arrays["vertices"], arrays["triangles"]) if "vertices" in arrays else None
        if "nodes" in arrays:
            return cls(TetMesh.checked(arrays["nodes"], arrays["tets"]), settings, surface)
        if surface is None:
            raise ValueError("a bake request holds neither a surface nor tetrahedra")
        return cls(surface, settings)
