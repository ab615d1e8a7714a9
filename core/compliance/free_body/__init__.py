"""Bodies without pins: what their compliance owes to inertia.

A free body that is loaded rests only where its loads balance. Where they do not, its weight and
inertia make up the rest: loads on all nodes in proportion to their mass. With M the masses of the
nodes and R^ the six rigid motions, orthonormal in M, P = 1 - R^ R^^T M takes all rigid motion out
of displacements, and P^T makes any loads balance. Any hold that is statically determinate gives
displacements L_h of balanced loads that are right up to a rigid motion, so

    L_f = P L_h P^T = L_h - B R^^T - R^ B^T,   B = G - 1/2 R^ H,   G = L_h M R^,   H = R^^T M G

does not depend on it. L_f is symmetric and positive semidefinite. Weight alone moves nothing in it:
P^T M R^ = 0; what sags is a body whose weight something carries.

    density.py            what a body weighs
    inertia.py            masses of the nodes, centre, moments, rigid motions
    hold.py               six springs at three nodes
    carried_loads.py      G and H, beside the elimination
    rigid_part.py         B R^^T + R^ B^T, for some rows and columns
"""
