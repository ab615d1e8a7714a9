"""The real-time thread of Palpate: god object, contact force, safety and device link.

SI units everywhere (m, N, Pa, s). Arrays that are handed in are copied, those of a Compliance
excepted; arrays that come out are new. Anything with three numbers (list, numpy array,
mathutils.Vector) serves as a vector.

Built for tests and benchmarks it also has `palpate_servo.harness`, which is told of in its own
docstrings (native/src/python/harness).
"""

from collections.abc import Mapping, Sequence
from typing import Any, Literal, Protocol, Self, TypeAlias, TypedDict, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Vector: TypeAlias = Sequence[float] | NDArray[np.floating[Any]]
_Matrix: TypeAlias = Sequence[_Vector] | NDArray[np.floating[Any]]

ContactMode: TypeAlias = Literal["paper", "consistent"]

class Lateness(TypedDict):
    """Time from the deadline to the waking, us; percentiles to 3 %."""

    p50: float
    p99: float
    p99_9: float
    max: float

class Busy(TypedDict):
    """Time that a tick took of its processor, us."""

    mean: float
    max: float

class TimingCounters(TypedDict):
    """How a thread kept its deadlines."""

    ticks: int
    missed: int
    """Whole periods that passed without a tick and were skipped."""
    late_ticks: int
    """Ticks more than 200 us after their deadline."""
    late_over_10_us: int
    late_over_50_us: int
    late_over_200_us: int
    late_over_1000_us: int
    lateness_us: Lateness
    histogram: list[tuple[float, int]]
    """(largest lateness in the bucket in us, ticks) for every bucket that holds any."""
    longest_gap_us: float
    busy_us: Busy
    """Spent working."""
    spun_us: Busy
    """Spent awake and waiting for the deadline; none by a BareTimer."""
    realtime: str
    """For instance "fifo 20", or "none: " and the reason."""

class StageTime(TypedDict):
    """Time spent in a stage of the tick, us; p99 to 3 %."""

    mean: float
    p99: float
    max: float

class DeviceGreeting(TypedDict):
    """What the device said in its HELLO."""

    name: str
    protocol: int
    axes: int
    max_force: float
    half_extents: list[float]
    rate_hz: int
    largest_damping: float
    """N s/m; 0 for none."""

class StateInterval(TypedDict):
    """Time between STATE messages, us."""

    mean: float
    """From one tick with new ones to the next; silence beyond 0.5 s is left out."""
    max: float
    device: float
    """From one to the next on the device's own clock, on average."""

class LinkCounters(TypedDict):
    """What happened on the serial link."""

    states: int
    forces: int
    lost: int
    duplicates: int
    out_of_order: int
    crc_errors: int
    cobs_errors: int
    oversize: int
    unknown: int
    orientations: int
    """ORIENTATION messages that came with their STATE."""
    orientations_unpaired: int
    """Whose STATE did not come, or was not used."""
    orientations_refused: int
    """That hold no unit quaternion."""
    orientations_lost: int
    """STATE messages without, of a device that has told one."""
    hellos: int
    device_faults: int
    unsent: int
    reopened: int
    forces_in_flight: int
    """FORCE messages of which no STATE has told that they were taken; 0 in protocol 1."""
    round_trip_ms: float | None
    """From a FORCE to the STATE that tells that it was taken, averaged; None in protocol 1."""
    state_age_ms: float | None
    guarded: bool
    """Time since the last STATE; None while there was none."""
    state_interval_us: StateInterval
    bursts: int
    """Pauses of more than 3.5 ms that ended with STATE messages made all along: held back."""
    burst_ms: float
    """Mean length of these pauses, ms."""
    burst_states: int
    """STATE messages that came in bursts."""
    last_fault: tuple[int, int] | None
    device: DeviceGreeting | None

class ProxyCounters(TypedDict):
    """How hard the god object worked."""

    most_steps: int
    rescues: int

class FingerCounters(TypedDict):
    """What one finger has counted."""

    faults: dict[str, int]
    link: LinkCounters
    proxy: ProxyCounters

class ServoCounters(TimingCounters):
    """Timing, faults and link of a servo; faults, link and proxy are those of finger 0."""

    fingers: list[FingerCounters]
    """Of all fingers, by number."""

    rate_hz: int
    stages_us: dict[str, StageTime]
    """By stage, in the order of the tick: "read" (settings, device), "proxy" (god object),
    "contact" (force), "write" (what limits the force, and the device). Over all ticks, also those
    in which a stage had nothing to do.
    """
    faults: dict[str, int]
    """Times each fault began: nan, too fast, stale, deaf, unplugged, wrong protocol, device fault,
    suspended, internal error."""
    link: LinkCounters
    samples_lost: int
    proxy: ProxyCounters

@final
class Compliance:
    """The inverse stiffness of the free surface nodes at unit modulus, in either form.

    Its large arrays are not copied: they are made read-only, kept alive and read in place. They
    must be contiguous, and nobody may write to them by views made before. A body takes copies of
    what the servo's thread needs of them.
    """

    @staticmethod
    def dense(table: NDArray[np.floating[Any]]) -> Compliance:
        """Take table (n, 3, 3n), float32 or float64: ``table[j, c]`` moves all nodes for 1 N on
        node j along axis c.

        Raises TypeError for another type, ValueError for another shape.
        """

    @staticmethod
    def compressed(arrays: Mapping[str, NDArray[np.generic]]) -> Compliance:
        """Take what `CompressedCompliance.arrays` of core gives.

        Raises KeyError for a missing array, TypeError for one of another type, ValueError when they
        do not belong together.
        """

    @property
    def form(self) -> str:
        """``dense`` or ``compressed``."""

    @property
    def node_count(self) -> int: ...
    def block(self, i: int, j: int) -> NDArray[np.float64]:
        """L_ij (3, 3): displacement of node i per force on node j."""

    def apply(self, nodal_forces: ArrayLike, nodes: ArrayLike) -> NDArray[np.float64]:
        """Displacements (n, 3) of all nodes under forces (k, 3) on nodes (k,) (15).

        The compressed form is summed in float32, its L_ii in float64.
        """

@final
class Body:
    """A soft body's rest surface and contact stiffness; immutable."""

    def __init__(
        self,
        nodes: ArrayLike,
        triangles: ArrayLike,
        contact_blocks: ArrayLike,
        compliance: Compliance | None = None,
        free_nodes: ArrayLike | None = None,
        *,
        whole: bool = False,
    ) -> None:
        """Take nodes (s, 3) in m, triangles (m, 3) counter-clockwise seen from outside, and
        contact_blocks (s, 3, 3), `L_aa^-1` at unit modulus (9).

        With a compliance, snapshots also tell where the touched point of the surface is. free_nodes
        (n,) are the numbers of the nodes that it counts, in its order (all unless given); the
        others are pinned. Contacts that reach over more than one triangle need a whole body, which
        keeps the compliance and reads it in the tick: it must not lie in a mapped file.

        Raises ValueError when a number is not finite, an index is out of range, a triangle has no
        area, the surface is open or turned inside out, or the compliance is of other nodes.
        """

    @property
    def node_count(self) -> int: ...
    def contact(
        self,
        triangle: int,
        alpha: _Vector,
        displacement: _Vector,
        young_modulus: float,
        mode: ContactMode = "consistent",
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Nodal forces (3, 3) and force on the finger (3,), N: equations (11) to (14), or the force
        of least energy that moves the contact point by exactly the displacement (consistent).

        Without a compliance both modes are the paper's. ValueError for another mode.
        """

    def surface_displacement(
        self, triangle: int, alpha: _Vector, nodal_forces: _Matrix, young_modulus: float
    ) -> NDArray[np.float64] | None:
        """How far the point at area coordinates alpha moves under forces (3, 3) on the nodes of its
        triangle, m (15); None without a compliance.
        """

    def closest_point(
        self, p: _Vector
    ) -> tuple[int, NDArray[np.float64], NDArray[np.float64], float]:
        """Triangle, area coordinates, nearest surface point and signed distance (inside < 0)."""

class FingerSnapshot:
    """One finger in one tick, whole: all values belong together."""

    @property
    def probe(self) -> NDArray[np.float64]:
        """Where the finger is, m, body coordinates."""

    @property
    def proxy(self) -> NDArray[np.float64]:
        """Contact point that makes the force, m; the probe itself while free. Of a tool it is the
        reference point, which may be behind the probe.
        """

    @property
    def orientation(self) -> NDArray[np.float64]:
        """How its tool is turned, (3, 3), tool to body."""

    @property
    def sticking(self) -> bool:
        """Whether friction holds the contact point where it is."""

    @property
    def triangle(self) -> NDArray[np.int64]:
        """Surface-local node numbers of the touched triangle, -1 while free."""

    @property
    def triangle_index(self) -> int:
        """Touched triangle, -1 while free."""

    @property
    def alpha(self) -> NDArray[np.float64]:
        """Area coordinates; exact zeros on edges and nodes, all zero while free."""

    @property
    def contact_force(self) -> NDArray[np.float64]:
        """(14), N, before coupling and safety, body axes."""

    @property
    def output_force(self) -> NDArray[np.float64]:
        """N, after safety, body axes."""

    @property
    def torque(self) -> NDArray[np.float64]:
        """On a tool about its reference point, N m, before safety; zero on a point."""

    @property
    def surface_point(self) -> NDArray[np.float64] | None:
        """Where the touched point of the surface is now, m: the contact point plus the displacement
        that all fingers' forces cause there (15). None while free, for a tool, and for a body
        without a compliance.
        """

    @property
    def touching(self) -> bool: ...
    @property
    def state(self) -> str:
        """One of STATES."""

    @property
    def fault(self) -> str:
        """Name of the fault while the state is "fault" (or "internal error" when stopped)."""

    @property
    def reason(self) -> str:
        """Why it waits, ramps, is disabled or stopped, or empty."""

    @property
    def limited(self) -> str:
        """Which limiter shortens the force now, one of LIMITERS, or empty."""

    @property
    def buttons(self) -> int: ...
    @property
    def nodes(self) -> NDArray[np.int64]:
        """Surface-local numbers (k,) of the nodes that carry forces; none while free."""

    @property
    def points(self) -> NDArray[np.float64]:
        """Where the surface's points that a tool presses are now, m (p, 3); none for a point."""

    @property
    def point_forces(self) -> NDArray[np.float64]:
        """On the body at these points, N (p, 3)."""

    @property
    def pressures(self) -> NDArray[np.float64]:
        """There, Pa (p,)."""

    @property
    def nodal_forces(self) -> NDArray[np.float64]:
        """On these nodes, N, (k, 3): (12), (13) for a point."""

@final
class Snapshot(FingerSnapshot):
    """All fingers in one tick, whole; itself that of finger 0."""

    @property
    def tick(self) -> int: ...
    @property
    def time(self) -> float:
        """Since the start, s."""

    @property
    def body(self) -> int:
        """How often set_body had exchanged the body since the start: to which one the triangles
        belong.
        """

    @property
    def firmness(self) -> float:
        """Factor by which forces are other than those of a linear body at the same places."""

    @property
    def held(self) -> float:
        """Elastic energy of a linear body at the same places, at unit modulus, J/Pa."""

    @property
    def placement(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Position, m, and rotation of the body's frame after the tick; of one that is held those
        of the world.
        """

    def seen_from_body(self) -> Snapshot:
        """The same with places and directions in the body's own axes, wherever it is: forces on
        fingers too.
        """

    @property
    def others(self) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """The same of each other body that it presses, in the order of their pile."""

    @property
    def other_loads(self) -> list[tuple[NDArray[np.int64], NDArray[np.float64]]]:
        """Of each of these nodes (k,) of the surface and forces on them (k, 3), N in its own axes,
        under which it looks as it does.
        """

    @property
    def remembered_nodes(self) -> NDArray[np.int64]:
        """Nodes (k,) of the surface that remember a force, where the body gives way with time."""

    @property
    def remembered_forces(self) -> NDArray[np.float64]:
        """Forces (k, 3), N, that would hold the body as it is, were it elastic with its modulus in
        the end: those of this tick are among them.
        """

    @property
    def borne_nodes(self) -> NDArray[np.int64]:
        """Nodes (k,) of the surface on which supports of a body press that nobody holds, one as
        often as supports press on it.
        """

    @property
    def borne_forces(self) -> NDArray[np.float64]:
        """Forces (k, 3) of the supports on these, N, in the body's own axes."""

    @property
    def fingers(self) -> list[FingerSnapshot]:
        """All fingers, by number."""

    @property
    def nodal_forces(self) -> NDArray[np.float64]:
        """On the nodes of the touched triangle, N, (3, 3): (12), (13); zero for a tool."""

@final
class Tool:
    """A rigid tool: the convex hull of core points, grown by a ball."""

    def __init__(self, core: ArrayLike, radius: float) -> None:
        """Take core points (k, 3), 1 <= k <= 64, in the tool's own frame, m; radius m.

        Raises ValueError for other numbers of points, numbers that are not finite, no radius.
        """

    @staticmethod
    def endless(reach: float) -> Tool:
        """All that is below z = 0 of its frame; displacements on it are found to some millionths
        of its reach, m.
        """

    @property
    def stride(self) -> float:
        """How far the tool moves in one tick at most, m."""

    def distance(self, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Signed distances (p,), negative inside, and outward unit normals (p, 3), tool's frame."""

@final
class ToolSurface:
    """The contact points of a body, with the compliance between them; immutable."""

    def __init__(
        self,
        body: Body,
        positions: ArrayLike,
        normals: ArrayLike,
        triangles: ArrayLike,
        alphas: ArrayLike,
        areas: ArrayLike,
        near: dict[str, object] | None = None,
    ) -> None:
        """Take points at rest (P, 3) in m, unit outward normals (P, 3), the triangle of each (P,),
        area coordinates in it (P, 3), shares of the surface (P,) in m^2.

        near: what the mesh is too coarse for, as `core.near_field.NearCorrection.arrays` names it:
        for each node of the surface normals (s, 3), edges (s,), softness (s,), excess (s,), regular
        (s, 3, 3), slopes (3 s, 3, 3), far_nodes (s, 3), far_weights (s, 3); for each point shares
        (P,), softness_of_points (P,), own (P, 3, 3), lifts (m P, 3), m for each; believed and short
        (two numbers each) and poisson_ratio.

        Raises ValueError for a body that is not whole, or arrays that do not fit.
        """

PointTarget: TypeAlias = tuple[int, _Vector, _Vector]
"""Triangle, area coordinates there, and how far from that place, m."""
PoseTarget: TypeAlias = tuple[_Vector, _Matrix]
"""Position, m, and rotation of a tool."""
LaidTool: TypeAlias = tuple[ToolSurface, Tool, _Vector, _Matrix, float]
"""Contact points, shape, position and rotation in the world, coefficient of friction."""

LaidPoint: TypeAlias = tuple[int, _Vector, float | None, _Vector]
"""Triangle, area coordinates there, friction (None: it holds the place), goal in the world, m."""

class SettledPoint(TypedDict):
    """What a point came to."""

    force: NDArray[np.float64]
    """Felt by the finger, (3,), N."""
    triangle: int
    alpha: NDArray[np.float64]
    """Area coordinates of its place there, (3,)."""
    nodes: NDArray[np.int64]
    """Surface nodes of the triangle, (3,)."""
    nodal_forces: NDArray[np.float64]
    """On these nodes by the linear relation, (3, 3), N: what is drawn."""

class SettledTool(TypedDict):
    """What a tool came to. Of p pressed points and k nodes that carry force."""

    force: NDArray[np.float64]
    """On the tool, (3,), N."""
    torque: NDArray[np.float64]
    """On the tool about its reference point, (3,), N m."""
    stiffness: NDArray[np.float64]
    """How the force resists a small move of the tool, (3, 3), N/m."""
    exact: bool
    """The equilibrium was found, of all points near: there are some 200 for all tools together."""
    free: bool
    """It did not lose the surface while in the body."""
    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    points: NDArray[np.int64]
    """Numbers of the pressed contact points, (p,), in no order."""
    areas: NDArray[np.float64]
    """Their shares of the surface, (p,), m^2."""
    pushes: NDArray[np.float64]
    """Along the tool's normals, (p,), N."""
    pressures: NDArray[np.float64]
    """(p,), Pa."""
    places: NDArray[np.float64]
    """At rest, (p, 3), m."""
    point_forces: NDArray[np.float64]
    """On the body, (p, 3), N."""
    normals: NDArray[np.float64]
    """Outward from the tool where the points have gone to, (p, 3)."""
    displacements: NDArray[np.float64]
    """(p, 3), m."""
    nodes: NDArray[np.int64]
    """Surface nodes that carry force, (k,)."""
    nodal_forces: NDArray[np.float64]
    """On these nodes, (k, 3), N."""

class RestTouch(TypedDict):
    """What a tool, point or support of a body feels that nobody holds, in the body's frame; as of
    SettledTool. A point presses no contact points.
    """

    force: NDArray[np.float64]
    torque: NDArray[np.float64]
    free: bool
    areas: NDArray[np.float64]
    pushes: NDArray[np.float64]
    places: NDArray[np.float64]
    displacements: NDArray[np.float64]
    nodes: NDArray[np.int64]
    nodal_forces: NDArray[np.float64]

@final
class Prop:
    """A body that nobody holds, laid down in the world on supports; immutable."""

    def __init__(
        self,
        body: Body,
        *,
        mass: float,
        centre: _Vector,
        inertia: _Matrix,
        drag_time: float,
        is_steady: bool,
        gravity: _Vector,
        supports: Sequence[LaidTool],
        position: _Vector,
        rotation: _Matrix,
    ) -> None:
        """Lay a whole body down with its frame so posed.

        mass, kg; centre of mass, m, and inertia about it, kg m^2, at rest; under a force its speed
        is that over the mass times drag_time, s; is_steady, whether a hand keeps it from sliding
        and turning; gravity, m/s^2. Supports: contact points on the
        body, shape, position, rotation, coefficient of friction.

        Raises ValueError for more supports than MOST_SUPPORTS, one for another body, a body that
        is not whole, and numbers that cannot be.
        """

@final
class PropAmong:
    """A body that nobody holds, among others that it presses: as a Pile lays it; immutable."""

class PileContacts(TypedDict):
    """Contacts of a pile that press, an entry of each array for one of them."""

    body: NDArray[np.int64]
    """Number of the body whose contact point it is."""
    point: NDArray[np.int64]
    """Number of that contact point."""
    obstacle: NDArray[np.int64]
    """Number of the rigid tool that it meets; -1 for another body."""
    other: NDArray[np.int64]
    """Number of the other body that it meets; -1 for a rigid tool."""
    push: NDArray[np.float64]
    """Normal force, N."""
    force: NDArray[np.float64]
    """On the point's body, (c, 3), N, in the world."""
    place: NDArray[np.float64]
    """Where the point is, (c, 3), m, in the world."""
    shared_contact: NDArray[np.int64]
    """Contacts with another body, one entry for each of its points that carries a share."""
    shared_point: NDArray[np.int64]
    """That point."""
    share: NDArray[np.float64]
    """Its share."""

FreeMember: TypeAlias = tuple[float, _Vector, _Matrix, float, bool]
"""Mass, centre of mass, moments of inertia about it, drag time, whether a hand keeps it from
sliding and turning."""
Member: TypeAlias = tuple[
    ToolSurface, ToolSurface | None, float, FreeMember | None, _Vector, _Matrix
]
"""A body of a pile: contact points, those of hands if they are others, Young's modulus, how it
moves if it does, its placement."""
RigidTool: TypeAlias = tuple[Tool, _Vector, _Matrix, float, bool]
"""A tool, its pose in the world, the coefficient of friction, whether a hand leads it."""

@final
class Pile:
    """Soft bodies that press each other and rigid tools, without a clock."""

    def __init__(
        self,
        bodies: Sequence[Member],
        obstacles: Sequence[RigidTool],
        *,
        gravity: _Vector,
        friction: float,
    ) -> None:
        """Begin with bodies where they are; ``friction`` is that between them.

        Raises ValueError for numbers that cannot be.
        """

    @property
    def time(self) -> float:
        """Of all ticks, s."""

    def position(self, body: int) -> NDArray[np.float64]:
        """Of a body's frame in the world, (3,), m."""

    def rotation(self, body: int) -> NDArray[np.float64]:
        """Takes directions of a body to those of the world, (3, 3)."""

    def set_young_modulus(self, body: int, young_modulus: float) -> None:
        """Have a body be as firm from the next tick on, Pa."""

    def elastic(self, body: int) -> float:
        """The elastic energy in a body, J."""

    def contacts(self) -> PileContacts:
        """All contacts that press."""

    def laid(self) -> PropAmong:
        """The first body among the others as they lie, for a servo, which goes on from here.

        Raises ValueError for more bodies than a servo takes.
        """

    def lead(self, obstacle: int, position: _Vector, rotation: _Matrix) -> None:
        """Where a rigid tool goes from the next tick on, by a stride in each."""

    def tick(self, dt: float) -> None:
        """Go on by dt s.

        Raises RuntimeError where a force is no number.
        """

    def settle(self) -> None:
        """Go on until all rests.

        Raises RuntimeError where it does not.
        """

    def settle_on(self, ticks: int) -> bool:
        """Go on with that by so many ticks at most: whether all rests. Errors as of settle."""

@final
class MovedSurface:
    """The surface of a body, moved, and where it is within the body itself."""

    def __init__(self, body: Body) -> None: ...
    def folds(
        self, places: NDArray[np.float64], deepest: float
    ) -> tuple[
        NDArray[np.int64],
        NDArray[np.int64],
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
    ]:
        """Nodes (k,) that are within the body by deepest m at most where all are moved to places
        (n, 3); triangles (k,) over them, area coordinates (k, 3) there, outward normals (k, 3) and
        depths (k,), m.

        Raises ValueError for other than finite places of all nodes.
        """

    def turns(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Rotations of the nodes, (3 n, 3), their rows one after the other, from where they are at
        rest to places (n, 3): nearest to the mean of those of the triangles around each.

        Raises ValueError for other than finite places of all nodes.
        """

@final
class Resting:
    """A body that nobody holds, pressed by fingers, without a clock.

    Poses are those in the world; what touches() tells is in the body's frame.
    """

    def __init__(
        self, prop: Prop, *, young_modulus: float, fingers: Sequence[LaidTool | LaidPoint]
    ) -> None:
        """Begin with a prop as it was laid down.

        Raises ValueError for more fingers than MAX_FINGERS, one for another body, and numbers that
        cannot be.
        """

    @property
    def position(self) -> NDArray[np.float64]:
        """Of the body's frame in the world, (3,), m."""

    @property
    def rotation(self) -> NDArray[np.float64]:
        """Takes directions of the body to those of the world, (3, 3)."""

    @property
    def elastic(self) -> float:
        """The elastic energy in the body, J."""

    @property
    def time(self) -> float:
        """Of all ticks, s."""

    def set_young_modulus(self, young_modulus: float) -> None:
        """Have the body be as firm from the next tick on, Pa."""

    def laid(self) -> Prop:
        """The body with its supports as they are now, for a servo that goes on from here."""

    def place(self, position: _Vector, rotation: _Matrix) -> None:
        """Lay the body elsewhere; all that touches it is set down anew."""

    def lead(self, number: int, position: _Vector, rotation: _Matrix) -> None:
        """Where a finger goes from the next tick on, a tool by a stride in each."""

    def lead_support(self, number: int, position: _Vector, rotation: _Matrix) -> None:
        """Where a support is from the next tick on."""

    def tick(self, dt: float, *, hurried: bool = False) -> None:
        """Go on by dt s, hurried by as much work as the servo's tick may take at most.

        Raises RuntimeError where a force is no number.
        """

    def come_in(self) -> None:
        """What overlaps the body where it lies comes in from outside, while the body stays there.

        Raises RuntimeError where a force is no number.
        """

    def settle(self) -> None:
        """Tick until nothing changes any more. Raises RuntimeError where the body does not rest."""

    def settle_on(self, ticks: int) -> bool:
        """Go on with that by so many ticks at most: whether it rests. Errors as of settle."""

    def touches(self) -> list[RestTouch]:
        """What each finger feels, and then each support."""

@final
class ContactEngine:
    """Fingers on a body without a clock: the servo's own contact, stepped until it is settled.

    What it holds is kept from call to call: frames of an animation, or one depth after the other,
    go on from where they were.
    """

    def __init__(
        self,
        body: Body,
        tips: Sequence[tuple[ToolSurface, Tool] | None],
        *,
        young_modulus: float,
        friction: float = 0.0,
        mode: ContactMode = "consistent",
    ) -> None:
        """Take a tip for each finger, a tool or None for a point. Nothing is touched yet.

        Tools that share one ToolSurface feel each other's near field. friction is of tools: points
        stick to the place that they are given.

        Raises ValueError for more fingers than MAX_FINGERS, several on a body that is not whole, a
        tool for another body, and numbers that cannot be.
        """

    young_modulus: float
    """Pa; may be set from call to call."""

    def settle(
        self, targets: Sequence[PointTarget | PoseTarget]
    ) -> list[SettledPoint | SettledTool]:
        """Lead all fingers to their targets together, and step until nothing changes any more.

        Tools go in equal steps of at most a stride; with friction each step of the way is settled,
        else its end. The first targets are come to from outside of the body, on the way on which it
        pushes the tool out.

        Raises ValueError for targets that are none or cannot be come to, RuntimeError where the
        forces do not settle, and FloatingPointError where one is no number; all name the finger.
        """

@final
class Pointer:
    """A finger without motors, led by `Servo.set_target`."""

    def __init__(self, position: _Vector) -> None:
        """Set down at a position, m, body coordinates; ValueError unless finite."""

@final
class LinkDevice:
    """A device that speaks the link on a serial port."""

    def __init__(
        self,
        port: str,
        *,
        baud: int | None = None,
        rotation: _Matrix = ...,
        translation: _Vector = ...,
        scale: float = 1.0,
    ) -> None:
        """p_body = scale * rotation @ p_device + translation; the default is the identity.

        ValueError for a rotation that is not orthonormal, or a scale that is not more than 0. The
        port is opened by `Servo.start` and `Servo.add`.
        """

@final
class HaplyDevice:
    """A Haply 2DIY, whose handle must be in its rest pose when the servo opens it, unless its board
    has been in use by Palpate since it was plugged in; docs/haply.md tells why.

    The device's plane is the frame's x and y axes: x to the user's right, y away from the user,
    from the middle of the workspace. A force normal to it is not felt.
    """

    def __init__(
        self,
        port: str,
        *,
        model: str = "2diy-3.1",
        angles: tuple[float, float] | None = None,
        recalibrate: bool = False,
        baud: int | None = None,
        rotation: _Matrix = ...,
        translation: _Vector = ...,
        scale: float = 1.0,
    ) -> None:
        """Model is one of "2diy-3.1", "2diy-3.0", "2diy-2", "kit". angles (degrees, arm 1 and arm
        2) are those of the rest pose, if it is another than the makers'. With angles or recalibrate
        the handle counts as resting when it is opened. The frame is as of a `LinkDevice`.

        ValueError as there, and for a model or angles without sense.
        """

class _Coupling(Protocol):
    @property
    def stiffness(self) -> float: ...
    @property
    def damping(self) -> float: ...
    @property
    def passivity_control(self) -> bool: ...

class _Frame(Protocol):
    @property
    def rotation(self) -> NDArray[np.float64]: ...
    @property
    def translation(self) -> NDArray[np.float64]: ...
    @property
    def scale(self) -> float: ...

class ServoSettings(Protocol):
    """What a servo may be told at any time: `palpate.core.servo.settings.Settings`, which says what
    each is, or whatever else has these attributes.
    """

    @property
    def young_modulus(self) -> float: ...
    @property
    def enabled(self) -> bool: ...
    @property
    def max_force(self) -> float | None: ...
    @property
    def shading(self) -> bool: ...
    @property
    def static_friction(self) -> float: ...
    @property
    def dynamic_friction(self) -> float: ...
    @property
    def mode(self) -> ContactMode: ...
    @property
    def relaxation(self) -> Sequence[tuple[float, float]]: ...
    @property
    def coupling(self) -> _Coupling | None: ...
    @property
    def frames(self) -> Sequence[_Frame | None]: ...
    @property
    def orientations(self) -> Sequence[_Matrix]: ...

@final
class Servo:
    """A native thread between fingers, each led by a device or a pointer, and a body."""

    def __init__(
        self,
        body: Body,
        settings: ServoSettings,
        *,
        rate_hz: int = 1000,
        max_force: float = 3.0,
        max_slew: float = 1000.0,
        ramp_seconds: float = 0.25,
        max_speed: float = 2.0,
        glide_speed: float = 0.5,
        record_seconds: float = 10.0,
    ) -> None:
        """Prepare a servo; ValueError for settings that cannot be, a rate beyond 100 to 8000 Hz or
        limits without sense.

        max_force N, max_slew N/s, ramp_seconds 0.05 to 3600, max_speed (device) and glide_speed
        (pointer) m/s. record_seconds, 0 to 60, is how long samples() keeps what is not read: its
        memory, 144 bytes a tick and finger, is taken at the start. On a body without a compliance
        both modes are the paper's.
        """

    def set(self, settings: ServoSettings) -> None:
        """Take over settings with the next tick; ValueError, and nothing changed, for one that
        cannot be.
        """

    def set_firmness(self, energies: Sequence[float], shares: Sequence[float]) -> None:
        """Force as so many times the linear one where that holds such elastic energies, J/Pa: 1 at
        none, straight between over the depth (the root), beyond the last as there; faded in.
        Nothing for a linear body. At most 32, ascending and above zero; ValueError for others.
        """

    def start(self, device: Pointer | LinkDevice | HaplyDevice) -> None:
        """Start with this device as finger 0, beside those that were added.

        Raises OSError when its port cannot be opened, RuntimeError while the servo runs.
        """

    def add(self, device: Pointer | LinkDevice | HaplyDevice) -> int:
        """Another finger beside that of the next start; its number: 1, 2, ...

        The fingers feel each other through the body, which must be a whole one. Raises ValueError
        for another body, for more than MAX_FINGERS, RuntimeError while the servo runs, OSError when
        its port cannot be opened.
        """

    @property
    def finger_count(self) -> int:
        """Fingers that are in use, or will be after the next start."""

    def set_target(self, position: _Vector, restart: bool = False, finger: int = 0) -> None:
        """Lead a pointer's probe; with restart it is lifted off and set down there.

        RuntimeError unless that finger is a pointer.
        """

    def set_tool(self, tool: tuple[ToolSurface, Tool] | None, finger: int = 0) -> None:
        """Give a finger a tool, also while the servo runs, or make it a point again (None).

        A tool is its shape, and the contact points that it meets. Inside the body it feels nothing
        until it was outside. Returns when the thread uses it. ValueError for contact points on
        another Body than that of the servo.
        """

    def lay(self, prop: Prop | PropAmong | None) -> None:
        """Lay the body down as one that nobody holds, also while the servo runs, or have it held
        again (None): zero force in that tick, then a ramp; all that touches it is set down anew.

        Its contact is always consistent; among others only tools feel it. Returns when the thread
        uses it. ValueError for a prop of another Body than that of the servo.
        """

    def set_body(self, body: Body, settings: ServoSettings) -> None:
        """Touch another body with its settings, also while the servo runs: zero force in that tick,
        then a ramp. ValueError if there is more than one finger and the body is not whole.

        The probe is set down anew: inside of the new body nothing is felt until it was outside. A
        finger with a tool waits until that is set again, made for the new body, which is held.
        Returns when the thread uses the new body and the old one is freed.
        """

    def snapshot(self) -> Snapshot:
        """The newest tick; state "stopped" before the start and after the end."""

    def samples(self) -> NDArray[np.void]:
        """All recorded ticks since the last call: tick, time, probe, proxy, surface, force, output,
        state, finger. A row for each finger of each tick.

        surface is the surface_point of snapshots, not a number where that is None; state is an
        index into STATES.
        """

    def start_recording(self, seconds: float = 600.0) -> int:
        """Record every tick for so long, beside samples(), instead of what was recorded before.

        Before the start: from the first tick on; first add the fingers. Returns the memory that it
        takes at most, bytes (144 a tick and finger: 86 MB for ten minutes of one at 1 kHz), asked
        for as the recording grows.

        Raises ValueError for a time without sense, RuntimeError while a recording is on.
        """

    def stop_recording(self) -> None:
        """End the recording, which stays until the next one or start; idempotent."""

    def recording(self) -> NDArray[np.void]:
        """All ticks recorded so far, as in samples(); a copy, also while recording."""

    @property
    def recording_lost(self) -> int:
        """Ticks missing in the recording because its ring (10 s) or the memory was full."""

    @property
    def is_recording(self) -> bool:
        """Whether ticks are being recorded: started, not stopped, and the time not yet over."""

    def counters(self) -> ServoCounters: ...
    def stop(self) -> None:
        """Send zero force and end the thread; nothing happens the second time."""

    @property
    def running(self) -> bool: ...
    def __enter__(self) -> Self: ...
    def __exit__(self, kind: object, value: object, trace: object, /) -> None: ...

class DeviceCoupling(TypedDict):
    """Keywords of `palpate.core.servo.settings.Coupling`."""

    stiffness: float
    damping: float
    passivity_control: bool

def closest_points(
    nodes: ArrayLike, triangles: ArrayLike, points: ArrayLike
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """The triangle (p,) of a surface nearest to each of points (p, 3), and the area coordinates
    (p, 3) of the nearest place there, exactly zero off an edge or a corner; by all cores.

    ValueError for a number that is not finite, a triangle without area or of nodes that are not
    there.
    """

def polygons_on_line(
    places: NDArray[np.float32],
    corners: NDArray[np.int32],
    starts: NDArray[np.int32],
    origin: _Vector,
    direction: _Vector,
) -> NDArray[np.int64]:
    """Numbers (k,) of all polygons that a line goes through, before its origin (3,) and behind it:
    of a mesh of vertices (p, 3), the vertices of the corners of all polygons, and the first corner
    of each. Polygons may be bent or have notches; between two at an edge no line slips through.

    One pass over all of them: for a mesh that has changed since it was asked last. ValueError for a
    number that is not finite, no direction, or polygons that do not fit.
    """

def nearest_polygon(
    places: NDArray[np.float32],
    corners: NDArray[np.int32],
    starts: NDArray[np.int32],
    point: _Vector,
) -> int | None:
    """Number of the polygon nearest to a point (3,), as of :func:`polygons_on_line`; None where
    there is none. A bent one counts as flat.
    """

@final
class CubicPlaces:
    """Places in triangles that are cubic Bezier patches.

    Each of p places has the number of its patch and area coordinates there (p, 3). ValueError for a
    number that is not one of ``patches``.
    """

    def __new__(cls, patch: ArrayLike, alpha: ArrayLike, patches: int) -> Self: ...
    def write(self, patches: ArrayLike, moved: NDArray[np.float32]) -> None:
        """Write the vectors at all places into ``moved`` (p, 3), by all cores, of control vectors
        (patches, 10, 3): of each patch's corners; beside them, towards another corner (01, 02, 10,
        12, 20, 21); in its middle. ValueError for arrays of another shape.
        """

@final
class Relaxation:
    """A body of 1 Pa on its f free nodes, relaxed under forces; see `native/src/solid/`.

    ``terms`` of its strain energy: where the entries of each domain begin, their nodes, gradients
    (q, 3), and Lame's first parameter and shear modulus times volume, of each domain. The factors
    of the stiffness and of the warp's Poisson equation as `CholeskyFactor.flat` makes them.
    ``law``: None for rubber; else shares and exponents, at most three, of what stretches cost and
    of what volumes do (none: as of rubber), and whether what is pulled goes on as a parabola.
    ``springs``: a symmetric matrix (f, f) by rows. ``motions``: of a body that nothing holds rigid
    ones, orthonormal by mass, the loads of inertia against them, each (f, 3), and how loose each
    is, zero; displacements have none of them, and forces are made to balance. ValueError for
    arrays that do not fit together. All vectors are (f, 3).
    """

    def __new__(
        cls,
        terms: Sequence[tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike, ArrayLike]],
        stiffness: tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike, ArrayLike],
        poisson: tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike, ArrayLike],
        *,
        law: tuple[Sequence[tuple[float, float]], Sequence[tuple[float, float]], bool]
        | None = None,
        springs: tuple[ArrayLike, ArrayLike, ArrayLike] | None = None,
        motions: tuple[Sequence[ArrayLike], Sequence[ArrayLike], Sequence[float]] | None = None,
    ) -> Self: ...
    def another(self) -> Relaxation:
        """The same body, for another thread."""

    def warped(self, linear: ArrayLike) -> NDArray[np.float64]:
        """Linear displacements in rotation-strain coordinates."""

    def pulled_back(self, linear: ArrayLike, forces: ArrayLike) -> NDArray[np.float64]:
        """The transposed derivative of the warp there, of nodal forces."""

    def energy_and_forces(self, displacements: ArrayLike) -> tuple[float, NDArray[np.float64]]:
        """Strain energy, and the forces that hold the nodes there."""

    def relaxed(
        self,
        linear: ArrayLike | None,
        forces: ArrayLike,
        steps: int,
        turning: ArrayLike | None = None,
    ) -> NDArray[np.float64]:
        """Displacements after so many steps from the linear ones of a load: ``forces`` that keep
        their directions and ``turning`` ones that work on the linear displacements. These are
        found in single precision where they are None, for which steps make up.
        """

    def led(
        self,
        linear: ArrayLike,
        patterns: Sequence[ArrayLike],
        moved: Sequence[ArrayLike],
        wanted: ArrayLike,
        response: ArrayLike,
        close: float,
        most_steps: int,
        goes_on: bool = False,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], list[float], float, int]:
        """The body at rest where forces of k ``patterns`` have done the work ``wanted`` (k,) on it.

        ``moved``: the linear displacement under each; ``response`` (k, k): how much of each a way
        takes, linearly. From ``linear``, the linear displacement of the ways or, where it
        ``goes_on``, one near the last rest. Linear and warped displacements, of how much of each
        pattern the forces are, by what share of the load's work it is not at rest or not where it
        is led, by energy (``close`` is enough), and steps.
        """

    def kept_out(
        self,
        linear: ArrayLike,
        tools: Sequence[tuple[Tool, ArrayLike, ArrayLike]],
        places: tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike, ArrayLike, ArrayLike],
        compliance: ArrayLike,
        work: float,
        close: float,
        most_steps: int,
        dead: ArrayLike | None = None,
        loose: tuple[Sequence[ArrayLike], Sequence[ArrayLike], Sequence[float]] | None = None,
        holds: tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike, ArrayLike] | None = None,
        gives: bool = False,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], float, int]:
        """The body at rest beside rigid ``tools``, with the position and the rotation of each, that
        press p ``places`` of its surface and never pull one.

        Places: three free nodes of each (3p,), the same among the m nodes whose ``compliance``
        (m * m, 3, 3) is given, area coordinates (p, 3), none of what is pinned, where they are at
        rest (p, 3), force over depth while one is within (p,), and which tool (p,). From ``linear``
        displacements. Linear and warped displacements, forces (p, 3) on the places, by what share
        of ``work`` it is not at rest or places are still within (``close`` is enough), and steps.
        Forces ``dead`` press it besides; ``loose``: rigid motions as of the body, along some of
        which it goes as it is pressed. ``compliance`` has these in it. ``holds``: of each place the
        displacement it is held at (p, 3), the tool's normal (p, 3), across which it is, Coulomb's
        coefficient (p,), 0 of smooth tools, and what is believed to push (p,) and to hold it aside
        (p, 3) before that is found. ``gives``: places stay on springs, and so far within.
        """

def device_coupling(rate_hz: int = 1000, *, encoder_step: float = 0.0) -> DeviceCoupling:
    """The coupling for devices with motors of which nothing but the encoders' step at the handle
    (m) is known: see docs/stability.md. ValueError for a rate or a step without sense.
    """

def haply_encoder_step(model: str) -> float:
    """The farthest that two successive encoder readings of a 2DIY lie apart, m; ValueError for a
    model that is not known.
    """

def stop_all() -> None:
    """Stop every servo that still runs; registered with atexit."""

MAX_FINGERS: int
"""Fingers of a servo at most."""
MOST_BODIES: int
"""Bodies in a servo that press each other at most."""
MOST_SUPPORTS: int
"""Supports that can bear a body."""
STATES: tuple[str, ...]
"""Names of the states, in the order of their numbers in samples()."""
FAULTS: tuple[str, ...]
"""Names of the faults, the keys of counters()["faults"]."""
REASONS: tuple[str, ...]
"""All that Snapshot.reason may say, the empty one excepted."""
LIMITERS: tuple[str, ...]
"""All that Snapshot.limited may say, the empty one excepted."""
__version__: str
