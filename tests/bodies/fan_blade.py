"""A sharp body as machinists make them: flat and curved faces, steps, a notch, a slope."""

from __future__ import annotations

import numpy as np

from palpate.core.mesh.surface import Surface

# Along the blade, m; two sections close together make a step.
SECTIONS = (0.0, 0.02, 0.04, 0.0401, 0.06, 0.08, 0.0801, 0.1, 0.115, 0.13, 0.145, 0.16)


def fan_blade() -> Surface:
    """A closed surface of 92 triangles, 190 mm long across, of rectangular sections along x."""
    x = np.array(SECTIONS)
    arc = 0.03 * np.sqrt(np.clip(1 - ((x - 0.16) / 0.07) ** 2, 0, 1))
    back = np.where(x < 0.09, 0.06, 0.06 + arc)
    front = np.where((x > 0.04) & (x < 0.0801), 0.015, 0.0)
    top = np.where(x < 0.0801, 0.05, 0.05 - 0.3 * (x - 0.08))
    level = np.zeros_like(x)
    y, z = np.stack([front, front, back, back], axis=1), np.stack([level, top, top, level], axis=1)
    vertices = np.stack([np.repeat(x[:, None], 4, axis=1), y, z], axis=2).reshape(-1, 3)
    first = 4 * np.arange(len(x) - 1)[:, None] + np.arange(4)
    second = 4 * np.arange(len(x) - 1)[:, None] + np.roll(np.arange(4), -1)
    sides = [
        np.stack([first, first + 4, second], axis=2),
        np.stack([second, first + 4, second + 4], axis=2),
    ]
    last = len(vertices) - 4
    ends = [[0, 1, 2], [0, 2, 3], [last, last + 2, last + 1], [last, last + 3, last + 2]]
    triangles = np.concatenate([*(side.reshape(-1, 3) for side in sides), ends])
    return Surface.checked(vertices, triangles)
