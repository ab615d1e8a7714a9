"""Fingers that may only push: what their forces have to fulfil, written out.

They minimise 1/2 F.C F - F.u with each force in its cone: what is left of the displacement,
C F - u, is then in the dual cone, across the force.
"""

import numpy as np

NARROWEST = 1.0


def cone_of(own, push):
    """Axis (3,) and tangent of the half angle: twice as wide as the force alone needs."""
    size = np.linalg.norm(push)
    if size == 0.0:
        return np.zeros(3), NARROWEST
    axis = push / size
    alone = np.linalg.solve(own, axis)
    along = alone @ axis
    return axis, max(NARROWEST, 2.0 * np.linalg.norm(alone - along * axis) / along)


def onto_cone(force, axis, width):
    """The nearest force in a cone; zero for no axis."""
    along = force @ axis
    sideways = force - along * axis
    across = np.linalg.norm(sideways)
    if not axis.any() or along <= -width * across:
        return np.zeros(3)
    if across <= width * along:
        return force
    length = (along + width * across) / (1.0 + width**2)
    return length * (axis + width * sideways / across)


def yielded(compliance):
    """Share of what each finger yields alone that it yields while the others are held."""
    count = len(compliance)
    held = np.linalg.inv(compliance.transpose(0, 2, 1, 3).reshape(3 * count, 3 * count))
    blocks = held.reshape(count, 3, count, 3)
    return [3.0 / np.trace(compliance[p, p] @ blocks[p, :, p]) for p in range(count)]


def assert_least(compliance, asked, pushes, forces, small):
    """The conditions, to a share ``small``; whether each finger is held, slides or is let go."""
    left = np.einsum("pqij,qj->pi", compliance, forces) - asked
    kinds, scale = [], np.abs(forces).max()
    for p, (force, w) in enumerate(zip(forces, left, strict=True)):
        axis, width = cone_of(compliance[p, p], pushes[p])
        near = small * np.abs(asked).max()
        np.testing.assert_allclose(onto_cone(force, axis, width), force, atol=small * scale)
        if axis.any():
            np.testing.assert_allclose(onto_cone(w, axis, 1.0 / width), w, atol=near)
        assert abs(force @ w) <= near * scale
        held = np.abs(w).max() <= near
        kinds.append("held" if held else "slides" if force.any() else "let go")
    return kinds
