"""A rigid tool pressed on a soft body: which points it touches, with what force.

The readable reference of what the servo does a thousand times a second. The contact points are
those of :mod:`.contact_points`, fixed on the body; the law is that of :mod:`.tool_law`; here are
the choice of points, the history, and what is felt.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from .contact_points import ContactPoints, contact_points, spacing_on
from .errors import PalpateError
from .near_field import NearCorrection, near_correction, point_compliance
from .soft_body import SoftBody
from .surface import Surface
from .tool_friction import Rubbing, moved_anchors, settle_rubbing
from .tool_law import Candidates, Settled, along_normals, distances_in_body, settle
from .tools import Pose, Tool
from .winding_volume import is_inside

# Points at rest within this share of the tool's size are looked at from the start; others when
# they are found to have moved into the tool.
MARGIN = 0.1

# Share of the inner radius up to which a tool set on the body at rest needs no path from outside.
SHALLOW = 0.5

# A point counts as in the tool below this share of its size.
IN_TOOL = 1e-9

# Eigenvalues of the points' compliance below this share of the largest are rounding.
SINGULAR = 1e-12

# Rounds of adding points that moved into the tool.
MOST_ADDITIONS = 20

# Strides within which any tool is outside any body: a path this long leads out.
MOST_STRIDES = 2000


@dataclass(frozen=True, eq=False)
class Load:
    """Forces on nodes of a body, such as another finger's.

    ``nodes`` (k,) of the mesh, ``forces`` (k, 3) in newton.
    """

    nodes: NDArray[np.int64]
    forces: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ToolTouch:
    """A tool on a body.

    Attributes
    ----------
    body, tool : which.
    surface : all contact points of the body for this tool.
    correction : what their compliance is besides the mesh's; None for the mesh's alone.
    pose : where the tool is; behind the pose asked for where that was farther than it may go.
    young_modulus : pascal.
    points : int64 (p,), numbers of the contact points that are pressed.
    forces : float64 (p, 3), on the body, newton.
    pushes : float64 (p,), their part along the tool's normal, all > 0.
    normals : float64 (p, 3), outward from the tool, where the points have gone to.
    displacements : float64 (p, 3), of the points, metres.
    compliance : float64 (3p, 3p), of the points, m/N.
    anchors : float64 (p, 3), where on the tool each point sticks, in the tool's coordinates.
    friction : coefficient of friction.
    free : whether the tool has been outside since it was set down; until then it feels nothing.
    exact : whether the equilibrium was found within the bounds on the work.
    """

    body: SoftBody
    tool: Tool
    surface: ContactPoints
    correction: NearCorrection | None
    pose: Pose
    young_modulus: float
    points: NDArray[np.int64]
    forces: NDArray[np.float64]
    pushes: NDArray[np.float64]
    normals: NDArray[np.float64]
    displacements: NDArray[np.float64]
    compliance: NDArray[np.float64]
    anchors: NDArray[np.float64]
    friction: float = 0.0
    free: bool = True
    exact: bool = True

    @property
    def touching(self) -> bool:
        """Whether any point is pressed."""
        return bool(len(self.points))

    @property
    def places(self) -> NDArray[np.float64]:
        """Rest places of the pressed points, (p, 3), metres."""
        return self.surface.positions[self.points]

    @property
    def pressures(self) -> NDArray[np.float64]:
        """Push per share of the surface, (p,), pascal."""
        pressures: NDArray[np.float64] = self.pushes / self.surface.areas[self.points]
        return pressures

    @property
    def force(self) -> NDArray[np.float64]:
        """Force that the tool feels, (3,), newton."""
        # Nothing is 0, not -0.
        force: NDArray[np.float64] = 0.0 - self.forces.sum(axis=0)
        return force

    @property
    def torque(self) -> NDArray[np.float64]:
        """Torque that the tool feels about its reference point, (3,), newton metres."""
        arms = self.places + self.displacements - self.pose.position
        torque: NDArray[np.float64] = 0.0 - np.cross(arms, self.forces).sum(axis=0)
        return torque

    @property
    def energy(self) -> float:
        """Elastic energy that the points' own forces hold in the body, joule."""
        forces = self.forces.reshape(-1)
        return float(0.5 * forces @ self.compliance @ forces)

    @cached_property
    def stiffness(self) -> NDArray[np.float64]:
        """How the force resists a small move of the tool while the pressed points and their normals
        stay, (3, 3), N/m, symmetric, positive semidefinite.
        """
        if not self.touching:
            return np.zeros((3, 3))
        matrix = along_normals(self.compliance, self.normals)
        # More points than the mesh has freedom beneath them make the matrix singular.
        stiffness: NDArray[np.float64] = (
            self.normals.T @ np.linalg.pinv(matrix, rcond=SINGULAR, hermitian=True) @ self.normals
        )
        return 0.5 * (stiffness + stiffness.T)

    @cached_property
    def load(self) -> Load:
        """The forces on the nodes of the mesh, repeats summed; what (15) deforms the body by."""
        corners = self.body.mesh.surface_triangles[self.surface.triangles[self.points]]
        shares = self.surface.alphas[self.points][:, :, None] * self.forces[:, None]
        nodes, place = np.unique(corners, return_inverse=True)
        forces = np.zeros((len(nodes), 3))
        np.add.at(forces, place.reshape(-1), shares.reshape(-1, 3))
        carrying = forces.any(axis=1)
        return Load(nodes[carrying], forces[carrying])

    @property
    def nodes(self) -> NDArray[np.int64]:
        """Nodes of the mesh that carry force, (k,)."""
        return self.load.nodes

    @property
    def nodal_forces(self) -> NDArray[np.float64]:
        """Forces on these nodes, (k, 3), newton."""
        return self.load.forces


def press_tool(
    body: SoftBody,
    tool: Tool,
    pose: Pose,
    *,
    young_modulus: float | None = None,
    friction: float = 0.0,
    start: ToolTouch | None = None,
    outside: Load | None = None,
    surface: ContactPoints | None = None,
    correction: NearCorrection | None = None,
) -> ToolTouch:
    """Press a tool on a body, from where ``start`` left it or, without one, from outside.

    With ``start`` the tool goes straight to the pose in as many strides as that takes; without, it
    comes the way the body would push it out. Depths beyond the tool's radius are answered, though
    no linear body can be right there.

    Parameters
    ----------
    young_modulus : pascal; the body's own unless given.
    friction : coefficient of Coulomb friction. With it the force depends on the way there.
    start : an earlier touch by the same tool on the same body.
    outside : forces of other fingers, which move the surface too.
    surface, correction : contact points to use in place of :func:`surface_for`'s, with what their
        compliance is besides the mesh's. With ``start``, those of that touch.

    Raises
    ------
    PalpateError
        Young's modulus is not a positive number, or friction a negative one; ``start`` is of
        another body or tool.
    """
    if start is None:
        state = set_down(
            body,
            tool,
            pose,
            young_modulus=young_modulus,
            friction=friction,
            surface=surface,
            correction=correction,
        )
        # With friction the way matters: it is always gone.
        shallow = friction == 0.0 and _overlap(state, pose) <= SHALLOW * tool.inner_radius
        if shallow and not _is_within(state, pose):
            return _settled(replace(state, free=True), pose, outside)
        start = replace(state, pose=_way_out(state, pose), free=True)
    touch = replace(continued(start, body, tool, young_modulus), friction=friction)
    for _ in range(MOST_STRIDES):
        between, arrived = stride(tool, touch.pose, pose)
        touch = _settled(touch, between, outside)
        if arrived:
            return touch
    raise too_far(tool)


def too_far(tool: Tool) -> PalpateError:
    """What is wrong with a pose that is too many strides away."""
    return PalpateError(
        f"tool {tool.name}: the pose is more than {MOST_STRIDES} strides away; begin nearer"
    )


def set_down(
    body: SoftBody,
    tool: Tool,
    pose: Pose,
    *,
    young_modulus: float | None = None,
    friction: float = 0.0,
    surface: ContactPoints | None = None,
    correction: NearCorrection | None = None,
) -> ToolTouch:
    """A tool that appears at a pose. Inside the body it will feel nothing until it was outside."""
    modulus = body.young_modulus if young_modulus is None else young_modulus
    if not (np.isfinite(modulus) and modulus > 0.0):
        raise PalpateError(f"Young's modulus is {modulus} Pa; give a positive number")
    if not (np.isfinite(friction) and friction >= 0.0):
        raise PalpateError(f"friction coefficient is {friction}; give zero or more")
    placed: tuple[ContactPoints, NearCorrection | None]
    placed = _known_surface(body, tool) if surface is None else (surface, correction)
    none, vectors = np.empty(0), np.empty((0, 3))
    state = ToolTouch(
        body,
        tool,
        placed[0],
        placed[1],
        pose,
        modulus,
        np.empty(0, dtype=np.int64),
        vectors,
        none,
        vectors,
        vectors,
        np.empty((0, 0)),
        vectors,
        friction,
    )
    return replace(state, free=is_outside(state, pose))


def follow_tool(touch: ToolTouch, pose: Pose, *, outside: Load | None = None) -> ToolTouch:
    """One tick: the tool goes towards a pose by at most one stride, and feels the body there."""
    between, _ = stride(touch.tool, touch.pose, pose)
    return _settled(touch, between, outside)


def press_along(
    body: SoftBody,
    tool: Tool,
    poses: Iterable[Pose],
    *,
    young_modulus: float | None = None,
    friction: float = 0.0,
    outside: Load | None = None,
) -> list[ToolTouch]:
    """Follow a path, one tick a pose, from where the first one sets the tool down."""
    touches: list[ToolTouch] = []
    for pose in poses:
        last = touches[-1:] or [
            set_down(body, tool, pose, young_modulus=young_modulus, friction=friction)
        ]
        touches.append(follow_tool(last[0], pose, outside=outside))
    return touches


# Contact points take long to spread and are the same for every touch of a body by a tool.
_surfaces: WeakKeyDictionary[SoftBody, dict[float, tuple[ContactPoints, NearCorrection]]] = (
    WeakKeyDictionary()
)


def surface_for(body: SoftBody, tool: Tool) -> ContactPoints:
    """The contact points of a body for a tool; kept as long as the body lives."""
    return _known_surface(body, tool)[0]


def correction_for(body: SoftBody, tool: Tool) -> NearCorrection:
    """What the near field adds to the compliance between these points; kept as they are."""
    return _known_surface(body, tool)[1]


def _known_surface(body: SoftBody, tool: Tool) -> tuple[ContactPoints, NearCorrection]:
    known = _surfaces.setdefault(body, {})
    spacing = spacing_on(body, tool.spacing)
    if spacing not in known:
        points = contact_points(body, spacing)
        known[spacing] = points, near_correction(body, points)
    return known[spacing]


def continued(
    start: ToolTouch, body: SoftBody, tool: Tool, young_modulus: float | None
) -> ToolTouch:
    """The touch to go on from, its forces at the modulus asked for."""
    if start.body is not body or start.tool is not tool:
        raise PalpateError(
            f"tool {tool.name}: the touch to start from is of another body or tool; leave it out"
        )
    modulus = body.young_modulus if young_modulus is None else young_modulus
    ratio = modulus / start.young_modulus
    return replace(
        start, young_modulus=modulus, forces=start.forces * ratio, pushes=start.pushes * ratio
    )


def _settled(state: ToolTouch, pose: Pose, outside: Load | None) -> ToolTouch:
    """The touch with the tool at ``pose``, reached in one step from ``state``."""
    state = replace(state, pose=pose, free=state.free or is_outside(state, pose))
    if not state.free:
        return state
    moved = moved_by(state, np.arange(len(state.surface)), outside)
    chosen = looked_at(state, pose, moved)
    if not chosen.size:
        return state
    forces = np.zeros((len(chosen), 3))
    forces[np.searchsorted(chosen, state.points)] = state.forces
    for _ in range(MOST_ADDITIONS):
        candidates = _candidates(state, chosen, moved[chosen])
        rubbing = _rubbing(state, pose, chosen)
        if state.friction > 0.0:
            settled = settle_rubbing(candidates, state.tool, pose, forces, rubbing)
        else:
            settled = settle(candidates, state.tool, pose, forces)
        entered = points_entered(state, pose, chosen, settled, moved)
        if not entered.size:
            break
        grown = np.union1d(chosen, entered)
        forces = np.zeros((len(grown), 3))
        forces[np.searchsorted(grown, chosen)] = settled.forces
        chosen = grown
    anchors = moved_anchors(settled, candidates, rubbing)
    touch = touch_of(state, chosen, settled, candidates.compliance, anchors)
    return replace(touch, free=not has_lost(state, touch, moved))


def touch_of(
    state: ToolTouch,
    chosen: NDArray[np.int64],
    settled: Settled,
    compliance: NDArray[np.float64],
    anchors: NDArray[np.float64],
) -> ToolTouch:
    """The touch of which the points ``chosen`` (p,) have ``settled``; their compliance (3p, 3p) and
    anchors (p, 3), in the body's coordinates.
    """
    pressed = np.flatnonzero(settled.pushes > 0.0)
    own = (3 * pressed[:, None] + np.arange(3)).reshape(-1)
    return replace(
        state,
        points=chosen[pressed],
        forces=settled.forces[pressed],
        pushes=settled.pushes[pressed],
        normals=settled.normals[pressed],
        displacements=settled.displacements[pressed],
        compliance=compliance[np.ix_(own, own)],
        anchors=state.pose.to_tool(anchors[pressed]),
        exact=settled.exact,
    )


def has_lost(before: ToolTouch, touch: ToolTouch, moved: NDArray[np.float64]) -> bool:
    """Whether a tool lost the surface, which others have ``moved`` (P, 3), while in the body.

    It would come out at any side, so it is let go.
    """
    if touch.touching or not before.touching:
        return False
    return not is_outside(touch, back(touch, moved))


def _rubbing(state: ToolTouch, pose: Pose, chosen: NDArray[np.int64]) -> Rubbing:
    """Friction of the chosen points, their anchors moved along with the tool."""
    anchors = np.full((len(chosen), 3), np.nan)
    anchors[np.searchsorted(chosen, state.points)] = pose.to_body(state.anchors)
    return Rubbing(state.friction, anchors)


def looked_at(state: ToolTouch, pose: Pose, moved: NDArray[np.float64]) -> NDArray[np.int64]:
    """Points that may be touched: those in or near the tool, at rest or as others have moved them,
    (P, 3), and those pressed before.
    """
    tool, margin = state.tool, MARGIN * state.tool.size
    looked_at = state.points
    for places in (state.surface.positions, state.surface.positions + moved):
        within = np.flatnonzero(
            np.linalg.norm(places - pose.position, axis=1) < tool.reach + margin
        )
        distances, _ = distances_in_body(tool, pose, places[within])
        looked_at = np.union1d(within[distances < margin], looked_at)
    return looked_at


def back(state: ToolTouch, moved: NDArray[np.float64]) -> Pose:
    """The pose before the other fingers moved the place (P, 3) that is nearest to the tool."""
    places = state.surface.positions + moved
    distances, _ = distances_in_body(state.tool, state.pose, places)
    return Pose(state.pose.position - moved[distances.argmin()], state.pose.rotation)


def _candidates(
    state: ToolTouch, chosen: NDArray[np.int64], offsets: NDArray[np.float64]
) -> Candidates:
    return Candidates(
        state.surface.positions[chosen],
        state.surface.normals[chosen],
        _compliance(state, chosen, chosen),
        offsets,
    )


def _compliance(
    state: ToolTouch, rows: NDArray[np.int64], columns: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Displacements of points ``rows`` (k,) per force on points ``columns`` (l,), (3k, 3l), m/N."""
    blocks = point_compliance(state.body, state.surface, rows, columns, state.correction)
    matrix: NDArray[np.float64] = blocks.transpose(0, 2, 1, 3).reshape(3 * len(rows), -1)
    return matrix / state.young_modulus


def moved_by(
    state: ToolTouch, chosen: NDArray[np.int64], outside: Load | None
) -> NDArray[np.float64]:
    """Displacements (k, 3) of the chosen points under the forces of other fingers."""
    offsets = np.zeros((len(chosen), 3))
    if outside is None or not len(outside.nodes):
        return offsets
    body = state.body
    loaded = body.free_index(outside.nodes)
    held = loaded >= 0
    moved = body.compliance.apply(outside.forces[held] / state.young_modulus, loaded[held])
    # The last row stands for pinned nodes, which others do not move.
    moved = np.vstack([moved, np.zeros((1, 3))])
    corners = body.free_index(body.mesh.surface_triangles[state.surface.triangles[chosen]])
    at_points: NDArray[np.float64] = np.einsum(
        "pc,pcx->px", state.surface.alphas[chosen], moved[corners]
    )
    return at_points


def points_entered(
    state: ToolTouch,
    pose: Pose,
    chosen: NDArray[np.int64],
    settled: Settled,
    offsets: NDArray[np.float64],
) -> NDArray[np.int64]:
    """Points not looked at so far that have been moved into the tool, by others by ``offsets``."""
    surface, tool = state.surface, state.tool
    pressed = settled.pushes > 0.0
    farthest = float(np.linalg.norm(settled.displacements, axis=1).max(initial=0.0))
    farthest += float(np.linalg.norm(offsets, axis=1).max(initial=0.0))
    away = np.linalg.norm(surface.positions - pose.position, axis=1)
    others = np.setdiff1d(np.flatnonzero(away < tool.reach + farthest), chosen)
    rest, _ = distances_in_body(tool, pose, surface.positions[others])
    others = others[rest < farthest]
    if not others.size:
        return others
    moved = offsets[others]
    if pressed.any():
        response = _compliance(state, others, chosen[pressed])
        moved += (response @ settled.forces[pressed].reshape(-1)).reshape(-1, 3)
    distances, _ = distances_in_body(tool, pose, surface.positions[others] + moved)
    entered: NDArray[np.int64] = others[distances < -IN_TOOL * tool.size]
    return entered


def _overlap(state: ToolTouch, pose: Pose) -> float:
    """How deep, in metres, the body at rest lies in the tool."""
    distances, _ = distances_in_body(state.tool, pose, state.surface.positions)
    return -float(distances.min())


def is_outside(state: ToolTouch, pose: Pose) -> bool:
    """Whether the tool is clear of the body at rest: no point in it, nor it in the body."""
    return _overlap(state, pose) <= 0.0 and not _is_within(state, pose)


def _is_within(state: ToolTouch, pose: Pose) -> bool:
    """Whether the middle of the tool is in the body at rest."""
    middle = pose.position + pose.rotation @ state.tool.core.mean(axis=0)
    mesh = state.body.mesh
    return bool(is_inside(middle[None], Surface(mesh.nodes, mesh.surface_triangles))[0])


def _way_out(state: ToolTouch, pose: Pose) -> Pose:
    """The nearest pose outside the body in the direction in which the body would push the tool."""
    surface = state.surface
    distances, _ = distances_in_body(state.tool, pose, surface.positions)
    depths = np.maximum(-distances, 0.0) * surface.areas
    push = depths @ surface.normals
    length = float(np.linalg.norm(push))
    # Pushed alike from all sides: through the nearest one.
    nearest = int(distances.argmin())
    direction = push / length if length > 0.0 else surface.normals[nearest]
    for strides in range(1, MOST_STRIDES):
        away = pose.position + strides * state.tool.stride * direction
        if is_outside(state, Pose(away, pose.rotation)):
            return Pose(away, pose.rotation)
    raise PalpateError(
        f"tool {state.tool.name}: there is no way out of the body from where it is; begin outside"
    )


def stride(tool: Tool, start: Pose, goal: Pose) -> tuple[Pose, bool]:
    """The pose one stride from ``start`` towards ``goal``, and whether that is the goal.

    A turn counts as the way of the tool's farthest point.
    """
    way = goal.position - start.position
    turn = Rotation.from_matrix(goal.rotation @ start.rotation.T).as_rotvec()
    length = float(np.linalg.norm(way) + np.linalg.norm(turn) * tool.reach)
    if length <= tool.stride * (1.0 + 1e-12):
        return goal, True
    share = tool.stride / length
    turned = Rotation.from_rotvec(share * turn).as_matrix() @ start.rotation
    return Pose(start.position + share * way, turned), False
