"""Bodies that tests share: the paper's cube and a stored plush mouse."""

from pathlib import Path

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from palpate.core.contact.equations import consistent_forces, triangle_forces
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.assembly import assemble

from .baked_body import baked_body

MESHES = Path(__file__).resolve().parents[1] / "meshes"


def free_triangles(body):
    """Numbers of the surface's triangles without a pinned corner."""
    return np.flatnonzero(~np.isin(body.mesh.surface_triangles, body.fixed).any(axis=1))


def highest_place(body):
    """The highest node about over the body's middle, (3,)."""
    nodes = body.mesh.nodes[body.mesh.surface_nodes]
    aside = np.linalg.norm((nodes - nodes.mean(axis=0))[:, :2], axis=1)
    return nodes[np.where(aside < aside.min() + 0.01, nodes[:, 2], -np.inf).argmax()]


def nodal_forces_of(body, triangle, alpha, u, mode="consistent"):
    """Forces (3, 3) of one contact on its triangle's nodes, by the equations of core.contact."""
    local = body.mesh.surface_local_triangles[triangle]
    if mode == "paper":
        return triangle_forces(body.young_modulus * body.contact_blocks[local], alpha, u)
    return body.young_modulus * consistent_forces(body.surface_blocks(local, local), alpha, u)


@pytest.fixture(scope="session")
def cube_mesh():
    return paper_cube()


@pytest.fixture(scope="session")
def mouse_mesh():
    with np.load(MESHES / "mouse-1.7k.npz") as file:
        return TetMesh.checked(file["X"], file["T"]), file["fixed"]


@pytest.fixture(scope="session")
def cube(cube_mesh):
    return baked_body(*cube_mesh, 0.49, 10_000.0)


@pytest.fixture(scope="session")
def mouse(mouse_mesh):
    return baked_body(*mouse_mesh, 0.3, 1_000.0)


@pytest.fixture(scope="session", params=["cube", "mouse"])
def body(request):
    return request.getfixturevalue(request.param)


@pytest.fixture
def rng():
    return np.random.default_rng(1999)


@pytest.fixture(scope="session")
def solved_displacements():
    """The referee of every touch: a sparse solve of the whole body."""

    def solve(body, nodal_forces):
        """Displacements (N, 3) by a sparse solve of the whole body at its own modulus."""
        K = assemble(body.mesh, body.poisson_ratio, body.young_modulus).tocsc()
        free = np.setdiff1d(np.arange(len(body.mesh.nodes)), body.fixed)
        dofs = (3 * free[:, None] + np.arange(3)).ravel()
        u = np.zeros(3 * len(body.mesh.nodes))
        u[dofs] = spsolve(K[dofs][:, dofs], nodal_forces.ravel()[dofs])
        return u.reshape(-1, 3)

    return solve
