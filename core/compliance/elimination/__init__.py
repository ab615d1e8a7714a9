"""Sparse elimination of a body's stiffness for the compliance of its surface.

    block_matrix.py       the stiffness by node, and its graph
    vertex_cover.py       Koenig's theorem: the smallest set of nodes that covers all cut edges
    dissection.py         order of elimination, in groups of nodes (fronts) that form a tree
    symbolic.py           pivots, boundary and loads of each front
    postorder.py          order of the tree's fronts in which the least memory is held
    work.py               floating point operations, bytes at every moment, weights of progress
    upper_tiles.py        a front's Schur complement, its upper half in contiguous tiles
    extend_add.py         addition of a front's Schur complement to its parent
    passed_loads.py       loads that fronts pass on, in panels of columns
    numeric.py            Cholesky of the fronts, together with unit loads on the surface
    loose_body.py         detection of a body that is not held
    inverse.py            L = W^T W, written as the table of the compliance
    surface_columns.py    the same, single columns on demand
    plan.py               counts before any work
    cholesky.py           kept factors for solves, of many matrices of one pattern

With K = C C^T and E the unit loads on the surface, L = E^T K^-1 E = W^T W, where W = C^-1 E. W is
sparse: a front meets only loads from its own part of the body. So neither is C kept, nor is a dense
matrix of the surface's size ever factored.
"""
