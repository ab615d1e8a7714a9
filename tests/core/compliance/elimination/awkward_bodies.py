"""Bodies that are awkward to eliminate, and the referee: dense or refined sparse solves."""

import itertools

import numpy as np
from scipy.sparse.linalg import splu

from palpate.core.mesh.tet_mesh import TetMesh


def block_of_cubes(x, y, z, edge=0.01, origin=(0.0, 0.0, 0.0)):
    """x by y by z cubes, six tetrahedra each."""
    places = np.array(list(itertools.product(range(x + 1), range(y + 1), range(z + 1))))
    step = np.array([(y + 1) * (z + 1), z + 1, 1])
    paths = [
        np.cumsum([np.zeros(3, int), *(np.eye(3, dtype=int)[axis] for axis in axes)], axis=0) @ step
        for axes in itertools.permutations(range(3))
    ]
    corners = np.array(list(itertools.product(range(x), range(y), range(z)))) @ step
    tets = (corners[:, None, None] + np.array(paths)).reshape(-1, 4)
    return oriented(places * edge + np.asarray(origin), tets)


def oriented(nodes, tets):
    """A mesh with every tetrahedron wound the right way."""
    edges = nodes[tets[:, 1:]] - nodes[tets[:, :1]]
    inverted = np.linalg.det(edges) < 0
    tets = tets.copy()
    tets[inverted] = tets[inverted][:, [0, 1, 3, 2]]
    return TetMesh.checked(nodes, tets)


def joined(*meshes):
    """One mesh; nodes at the same place become one."""
    offsets = np.cumsum([0] + [len(mesh.nodes) for mesh in meshes[:-1]])
    nodes = np.vstack([mesh.nodes for mesh in meshes])
    tets = np.vstack([mesh.tets + offset for mesh, offset in zip(meshes, offsets, strict=True)])
    _, first, number = np.unique(np.round(nodes, 9), axis=0, return_index=True, return_inverse=True)
    return oriented(nodes[first], number.ravel()[tets])


def inverse_at(stiffness, fixed, wanted):
    """Columns of the inverse for ``wanted`` nodes (k,) and rows for the same, refined, (3k, 3k)."""
    count = stiffness.shape[0] // 3
    free = np.setdiff1d(np.arange(count), fixed)
    freedoms = (3 * free[:, None] + np.arange(3)).ravel()
    inner = stiffness[freedoms][:, freedoms].tocsc()
    place = (3 * np.searchsorted(free, wanted)[:, None] + np.arange(3)).ravel()
    loads = np.zeros((len(freedoms), len(place)))
    loads[place, np.arange(len(place))] = 1.0
    factor = splu(inner)
    solution = factor.solve(loads)
    for _ in range(2):
        solution += factor.solve(loads - inner @ solution)
    return solution[place]


def largest_column_error(found, true):
    """The largest relative error, by its 2-norm, of any column."""
    return float((np.linalg.norm(found - true, axis=0) / np.linalg.norm(true, axis=0)).max())
