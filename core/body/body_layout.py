"""What the arrays of a body file may be: told by their heads, before any of them is read."""

from __future__ import annotations

from collections.abc import Mapping

from ..compliance.compression.checked_arrays import LAYOUT, PREFIX
from ..compliance.mapped import CHECKSUM_BYTES
from ..errors import PalpateError
from ..files.npz_members import ArrayHead

TABLE = "compliance"
HEAD = ("format", "version", "checksum")
NEEDED = (
    "key",
    "nodes",
    "tets",
    "surface_triangles",
    "fixed",
    "poisson_ratio",
    "formulation",
    "young_modulus",
    "form",
    "free_surface",
)
NEEDED_BY_FORM = {
    "dense": (TABLE, "compliance_diagonal", "compliance_checksums"),
    "compressed": ("tolerance", *(PREFIX + name for name in LAYOUT)),
}
OPTIONAL = ("young_scale", "fit", "density", "law")
TEXTS = ("format", "key", "checksum", "formulation", "form", "law")
MOST_BYTES_OF_TEXT = 1_000
FIGURES_OF_FIT = 11
# A compressed compliance larger than this many dense ones, with room for padding, is none.
MOST_DENSE_SIZES, PADDING_BYTES = 2, 16_000_000


def refuse_wrong_layout(heads: Mapping[str, ArrayHead], form: str) -> None:
    """Refuse arrays that no body of this form has, or that do not belong to as many nodes.

    Raises
    ------
    PalpateError
        Names the array.
    """
    needed = (*HEAD, *NEEDED, *NEEDED_BY_FORM[form])
    missing = [name for name in needed if name not in heads]
    if missing:
        raise PalpateError("damaged ({missing} missing)", missing=", ".join(missing))
    unknown = sorted(heads.keys() - {*needed, *OPTIONAL})
    if unknown:
        raise PalpateError("'{name}' is no array of a body of this form", name=unknown[0])
    for name, shapes in _shapes(heads).items():
        kind, shape = shapes
        if name in heads and not (heads[name].dtype.kind in kind and heads[name].shape == shape):
            raise PalpateError(
                "'{name}' is {held} of the shape {shape}, which does not belong to its mesh",
                name=name,
                held=heads[name].dtype,
                shape=heads[name].shape,
            )
    nodes, free = heads["nodes"].shape[0], heads["free_surface"].shape[0]
    most = (
        ("nodes", 4 * heads["tets"].shape[0]),
        ("surface_triangles", 4 * heads["tets"].shape[0]),
        ("fixed", nodes),
        ("free_surface", nodes),
    )
    for name, count in most:
        if heads[name].shape[0] > count:
            raise PalpateError(
                "'{name}' has {held} rows, more than a body of its tetrahedra can have",
                name=name,
                held=heads[name].shape[0],
            )
    packed = sum(head.nbytes for name, head in heads.items() if name.startswith(PREFIX))
    if packed > MOST_DENSE_SIZES * 36 * free**2 + PADDING_BYTES:
        raise PalpateError("its compressed compliance is larger than a dense one")


def refuse_no_text(heads: Mapping[str, ArrayHead]) -> None:
    """Refuse texts that are something else, or long: they are read to tell what a file is.

    Raises
    ------
    PalpateError
        Names the array.
    """
    for name in (*TEXTS, "version"):
        head = heads.get(name)
        if head is not None and (head.shape != () or head.nbytes > MOST_BYTES_OF_TEXT):
            raise PalpateError("'{name}' is no single word of a body file", name=name)


def _shapes(heads: Mapping[str, ArrayHead]) -> dict[str, tuple[str, tuple[int, ...]]]:
    """Kind of number and shape of each array, from the counts of nodes and tetrahedra."""

    def rows(name: str) -> int:
        return next(iter(heads[name].shape), 0)

    free, tets = rows("free_surface"), rows("tets")
    return {
        "nodes": ("f", (rows("nodes"), 3)),
        "tets": ("i", (tets, 4)),
        "surface_triangles": ("i", (rows("surface_triangles"), 3)),
        "fixed": ("i", (rows("fixed"),)),
        "free_surface": ("i", (free,)),
        "young_scale": ("fi", (tets,)),
        "fit": ("f", (FIGURES_OF_FIT,)),
        "poisson_ratio": ("fi", ()),
        "young_modulus": ("fi", ()),
        "density": ("fi", ()),
        "tolerance": ("fi", ()),
        TABLE: ("f", (free, 3, 3 * free)),
        "compliance_diagonal": ("f", (free, 3, 3)),
        "compliance_checksums": ("u", (free, CHECKSUM_BYTES)),
    }
