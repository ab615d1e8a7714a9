"""Free body of an object, among what it rests on and what presses it."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from weakref import WeakKeyDictionary

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.body.soft_body import SoftBody
from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tool_dent import PressingTool
from ...core.contact.tool.tools import Tool
from ...core.contact.touches import ToolTouch
from ...core.errors import PalpateError
from ...core.rest.bearing_points import bearing_points, even_spacing
from ...core.rest.grip import Grip
from ...core.rest.rest import Rest
from ...core.rest.rest_settings import RestSettings
from ...core.rest.resting import Resting
from ...core.shape.firm_rest import FirmRest
from ...core.shape.shapes import is_felt
from ..object.drawn_body import DrawnBody
from ..scene.body_frame import BodyFrame
from ..shape.drawn_shape import kept_shape
from .placement import frame_at, placement_of
from .standing import HEAP, LANDING, limpness, refusal, scene_gravity
from .supports import Supports, supports_of

Array = NDArray[np.float64]

_worker = ThreadPoolExecutor(1, "palpate-ready")

# Of each body the one at other constants than its file tells: much is kept with that.
_chosen: WeakKeyDictionary[SoftBody, SoftBody] = WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class Lying:
    """A free body where it lies.

    Attributes
    ----------
    frame : of its object there.
    touches : of the tools, in the body's own axes.
    displacements : float64 (n, 3), of the free surface nodes, metres.
    moved : float32 (3 p,), of the drawn vertices, local units.
    rest : the same in the world.
    """

    frame: BodyFrame
    touches: tuple[ToolTouch, ...]
    displacements: Array
    moved: NDArray[np.float32]
    rest: Rest

    def in_world(self, pose: Pose) -> Pose:
        """Pose in the world of one in the body's own axes."""
        placement = self.rest.placement
        return Pose(placement.to_world(pose.position), placement.rotation @ pose.rotation)


@dataclass(frozen=True, eq=False)
class FreeBody:
    """Free body of an object; made by :func:`lie`.

    Attributes
    ----------
    drawn : the body, and its object as it was at first.
    supports : what it rests on.
    settings : of its motion.
    firm : its equilibrium, by its law.
    """

    drawn: DrawnBody
    supports: Supports
    settings: RestSettings
    firm: FirmRest[Resting]

    @property
    def resting(self) -> Resting:
        """The linear body that presses back as it does."""
        return self.firm.lying

    def touched_by(self, tools: Sequence[tuple[Tool | Grip, Pose]], placement: Pose) -> FreeBody:
        """The same body at a placement, pressed by tools or held by grips, with their poses in the
        world.

        Raises
        ------
        PalpateError
            Too many of them.
        """
        resting = Resting(
            self.resting.body,
            self.supports.all,
            tools,
            placement=placement,
            settings=self.settings,
        )
        resting.firm(self.resting.firmness)
        resting.come_in()
        return replace(self, firm=FirmRest(resting, self.firm.shapes))

    def settle(self) -> Lying:
        """Where it comes to rest.

        Raises
        ------
        PalpateError
            It does not.
        """
        self.firm.settle()
        return self.now()

    def come_down(self) -> Lying:
        """Where it comes to rest with nothing to hold it, also from high above.

        Raises
        ------
        PalpateError
            It does not.
        """
        self.drop(LANDING * self.drawn.size)
        return self.settle()

    def drop(self, height: float) -> None:
        """Leave out a long way down to a ``height``, metres, over what bears it: nothing happens
        there, and it would take as long as the way is.
        """
        placement = self.resting.rest.placement
        x, y, z = self.settings.gravity
        nodes = placement.to_world(self.drawn.surface_nodes)
        gap = self.supports.gap_beneath(nodes) if x == y == 0.0 and z < 0.0 else 0.0
        if max(self.drawn.size, height) < gap < np.inf:
            down = np.array([0.0, 0.0, height - gap])
            self.firm.forget()
            self.resting.place(replace(placement, position=placement.position + down))

    def now(self, bent: Array | None = None) -> Lying:
        """Where it is now; ``bent`` (n, 3) displaces its free surface nodes besides, metres."""
        (rest,), touches = self.firm.rests, self.resting.tool_touches()
        displacements = rest.displacements()
        if bent is not None:
            displacements = displacements + bent
        drawn = self.drawn
        pressing = [PressingTool(one.tool, one.pose, one.force) for one in touches]
        moved = drawn.drawn_displacement(displacements, pressing)
        frame = frame_at(drawn.frame, rest.placement)
        shown = self.supports.keep_out(drawn, frame, moved)
        return Lying(frame, touches, displacements, shown, rest)


def lie(
    thing: bpy.types.Object,
    drawn: DrawnBody,
    supports: Supports,
    tools: Sequence[tuple[Tool | Grip, Pose]] = (),
    placement: Pose | None = None,
    *,
    for_servo: bool = False,
    steady: bool = False,
) -> FreeBody:
    """A free body where its object is, or at a ``placement``; poses of tools are in the world. One
    ``for_servo`` is touched at no more points than the servo has time for; a hand keeps one
    ``steady``.

    Raises
    ------
    PalpateError
        Too many tools or colliders.
    """
    chosen = thing.palpate
    body = chosen_body(drawn.body, chosen.density)
    settings = RestSettings(
        young_modulus=chosen.young_modulus,
        friction=chosen.static_friction,
        gravity=scene_gravity(bpy.context.scene),
        spacing=even_spacing(body) if for_servo else None,
        steady=steady,
    )
    resting = Resting(
        body,
        supports.all,
        tools,
        placement=placement or placement_of(drawn.frame),
        settings=settings,
    )
    resting.come_in()
    shape = kept_shape(thing, drawn)
    shape.wait_for(drawn.body.mesh.surface_nodes[:1])
    return FreeBody(drawn, supports, settings, FirmRest(resting, [shape]))


def supports_under(
    thing: bpy.types.Object,
    drawn: DrawnBody,
    graph: bpy.types.Depsgraph,
    *,
    besides: Sequence[bpy.types.Object] | None = None,
) -> Supports:
    """What the free body of an object rests on, ``besides`` soft objects, on which alone it may.

    Raises
    ------
    PalpateError
        It is pinned or cannot move by itself, too soft to stand, or nothing bears it, with the
        remedy.
    """
    reason = refusal(thing)
    if reason is not None:
        raise reason
    if not drawn.body.is_free:
        raise PalpateError(
            "{name} is pinned, so it stays where it is; choose Pins: None and press Rebuild Body",
            name=thing.name,
        )
    places = placement_of(drawn.frame).to_world(drawn.surface_nodes)
    if limpness(thing, graph.scene, places) > HEAP:
        raise PalpateError(
            "{name} is too soft for its size: it would sink into a heap by its weight; choose a "
            "firmer or lighter Material, make it smaller, or choose other Pins",
            name=thing.name,
        )
    return supports_of(thing, drawn, graph, besides=besides)


def get_ready(thing: bpy.types.Object, drawn: DrawnBody) -> None:
    """Prepare in the background what the first touch of an object needs. Does not wait; what goes
    wrong is told by that touch, which tries again.
    """
    if drawn.body.is_free or is_felt(drawn.body):
        kept_shape(thing, drawn)
    if drawn.body.is_free:
        _worker.submit(bearing_points, chosen_body(drawn.body, thing.palpate.density))


def chosen_body(body: SoftBody, density: float, young_modulus: float | None = None) -> SoftBody:
    """The body of this density, kg/m3, and perhaps Young's modulus, Pa; the same one each time."""
    young = body.young_modulus if young_modulus is None else young_modulus
    wanted = density, young
    for one in (body, _chosen.get(body)):
        if one is not None and (one.density, one.young_modulus) == wanted:
            return one
    _chosen[body] = replace(body, density=density, young_modulus=young)
    return _chosen[body]
