"""Sparse elimination of a body's stiffness, made for one question: the compliance of its surface.

    block_matrix.py       the stiffness by node, and which nodes are coupled
    vertex_cover.py       Koenig's theorem: the smallest set of nodes that meets every cut coupling
    dissection.py         in which order nodes are eliminated, in groups (fronts) that form a tree
    symbolic.py           what each front will hold: pivots, boundary, loads
    work.py               floating point operations, bytes at every moment, weights of progress
    upper_tiles.py        a front's Schur complement, its upper half in contiguous tiles
    extend_add.py         how a front's Schur complement is added to its parent
    numeric.py            Cholesky of the fronts, with unit loads on the surface carried along
    loose_body.py         how it shows that a body is not held
    inverse.py            L = W^T W, written as the table of the compliance
    surface_columns.py    the same, single columns on demand
    plan.py               counts before any work
    cholesky.py           the factor kept, for solves inside the body, and of matrix after matrix

With K = C C^T and E the unit loads on the surface, W = C^-1 E answers everything: L = E^T K^-1 E =
W^T W. W is sparse by the tree of the dissection: a front meets only loads from its own part of the
body. So for the compliance neither the factor C is kept, nor is a surface-sized dense matrix ever
factored.
"""
