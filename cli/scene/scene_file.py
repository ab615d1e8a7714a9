"""Scene file: bodies where they are, what they rest on, and tools, as JSON.

docs/free-bodies.md has the format.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path, PureWindowsPath

import numpy as np
from scipy.spatial.transform import Rotation

from ...core.body import body_file
from ...core.body.soft_body import SoftBody
from ...core.contact.place import nearest_place
from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.errors import PalpateError
from ...core.pile.pile import MOST_BODIES, Pile
from ...core.pile.pile_settings import USUAL_PILE, PileSettings
from ...core.rest.support import Floor, Support
from ..body.tool_option import HULL, tool_from
from .strict_entry import Entry, read_entry

SUFFIX = ".json"
# Of supports, and of tools.
MOST_OBSTACLES = 16
MOST_FRICTION = 100.0

PLACED = ("position", "rotation")
OF_SCENE = ("gravity", "friction", "bodies", "supports", "tools")
OF_BODY = ("name", "file", *PLACED)
OF_SUPPORT = ("name", "floor", "tool", *PLACED, "friction")
OF_TOOL = ("name", "tool", *PLACED, "by")

Led = tuple[Tool, Pose]


@dataclass(frozen=True, eq=False)
class Scene:
    """What a scene file tells; of each body, support and tool its name, too.

    ``ways`` are those that tools go when they press, (3,) each, metres.
    """

    body_names: tuple[str, ...]
    bodies: tuple[tuple[SoftBody, Pose], ...]
    support_names: tuple[str, ...]
    supports: tuple[Floor | Support, ...]
    tool_names: tuple[str, ...]
    tools: tuple[Led, ...]
    ways: tuple[tuple[float, float, float], ...]
    settings: PileSettings

    def untouched(self, fingertips: Sequence[Tool] = ()) -> Pile:
        """The bodies as the file places them, without its tools; ``fingertips`` of a servo will
        press them.
        """
        return Pile(self.bodies, self.supports, fingertips=fingertips, settings=self.settings)

    def pile(self, placements: Sequence[Pose] | None = None, more: Sequence[Led] = ()) -> Pile:
        """The bodies as the file places them, or elsewhere; pressed by more tools than its own."""
        places = [place for _, place in self.bodies] if placements is None else placements
        laid = [(body, place) for (body, _), place in zip(self.bodies, places, strict=True)]
        return Pile(laid, self.supports, [*self.tools, *more], settings=self.settings)


def is_scene(path: Path) -> bool:
    """Whether a file is meant as a scene, not as a body."""
    return path.suffix.lower() == SUFFIX


def read_scene(path: Path) -> Scene:
    """The scene of a file, with the bodies that it names.

    Raises
    ------
    PalpateError
        Whatever the file tells that makes no scene: the entry, the reason, the remedy.
    OSError
        The file, or one that it names, cannot be read.
    """
    given = read_entry(path, OF_SCENE)
    named = _Named()
    bodies = given.entries("bodies", OF_BODY, least=1, most=MOST_BODIES)
    supports = given.entries("supports", OF_SUPPORT, most=MOST_OBSTACLES)
    tools = given.entries("tools", OF_TOOL, most=MOST_OBSTACLES)
    settings = PileSettings(
        friction=_friction(given, USUAL_PILE.friction),
        gravity=given.vector("gravity", USUAL_PILE.gravity),
    )
    # All that is cheap to check before bodies are loaded.
    body_names = tuple(named.take(one, f"body {n}") for n, one in enumerate(bodies, 1))
    support_names = tuple(named.take(one, _kind(one, n)) for n, one in enumerate(supports, 1))
    tool_names = tuple(named.take(one, f"tool {n}") for n, one in enumerate(tools, 1))
    borne = tuple(_support(one, path.parent) for one in supports)
    led = tuple((_tool(one, path.parent), _pose(one)) for one in tools)
    ways = tuple(one.vector("by", (0.0, 0.0, 0.0)) for one in tools)
    places = [(_beside(one, one.text("file"), path.parent), _pose(one)) for one in bodies]
    loaded = {file: body_file.load(file) for file in dict.fromkeys(file for file, _ in places)}
    laid = tuple((loaded[file], place) for file, place in places)
    rigid = [(one.tool, one.pose) for one in borne if isinstance(one, Support)]
    entries = [one for one in supports if not one.has("floor")]
    for entry, obstacle in zip([*entries, *tools], [*rigid, *led], strict=True):
        for name, one in zip(body_names, laid, strict=True):
            if _is_swallowed(obstacle, one):
                raise PalpateError(
                    f"{entry.where}: it is within '{name}', which does not feel it; begin outside"
                )
    return Scene(body_names, laid, support_names, borne, tool_names, led, ways, settings)


def _is_swallowed(obstacle: Led, laid: tuple[SoftBody, Pose]) -> bool:
    """Whether a tool's middle is within a body, whose surface may then not meet it at all."""
    (tool, pose), (body, placement) = obstacle, laid
    middle = placement.to_tool(pose.to_world(tool.core.mean(axis=0)))
    place = nearest_place(body, middle)
    return float((middle - place.position) @ place.axis) > 0.0


class _Named:
    """Names that are taken already."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def take(self, entry: Entry, usual: str) -> str:
        name = entry.name(usual)
        # File systems may not tell capitals.
        if name.casefold() in self._taken:
            raise PalpateError(
                f"{entry.where}: the name '{name}' is taken already; give it another"
            )
        self._taken.add(name.casefold())
        return name


def _kind(entry: Entry, number: int) -> str:
    return f"floor {number}" if entry.has("floor") else f"support {number}"


def _support(entry: Entry, folder: Path) -> Floor | Support:
    if entry.has("floor") == entry.has("tool"):
        raise PalpateError(
            f"{entry.where}: it must be either a floor or a tool; give 'floor' with its height, or "
            "'tool' with its position"
        )
    friction = _friction(entry, Floor.friction)
    if not entry.has("floor"):
        return Support(_tool(entry, folder), _pose(entry), friction)
    for key in PLACED:
        if entry.has(key):
            raise PalpateError(f"{entry.where}: a floor is level and has no end; leave '{key}' out")
    return Floor(entry.number("floor", 0.0), friction)


def _friction(entry: Entry, usual: float) -> float:
    friction = entry.number("friction", usual)
    if not 0.0 <= friction <= MOST_FRICTION:
        raise entry.problem("friction", f"give a coefficient from 0 to {MOST_FRICTION:g}")
    return friction


def _tool(entry: Entry, folder: Path) -> Tool:
    words = entry.text("tool")
    if words.startswith(HULL):
        words = f"{HULL}{_beside(entry, words.removeprefix(HULL), folder)}"
    try:
        return tool_from(words)
    except PalpateError as problem:
        raise PalpateError(f"{entry.where}: {problem}") from problem


def _pose(entry: Entry) -> Pose:
    """Position in metres; rotation about an axis by as many degrees as it is long."""
    turn = np.radians(entry.vector("rotation", (0.0, 0.0, 0.0)))
    position = entry.vector("position", (0.0, 0.0, 0.0))
    return Pose.at(position, Rotation.from_rotvec(turn).as_matrix())


def _beside(entry: Entry, words: str, folder: Path) -> Path:
    """File in the scene's folder or below it: whoever sends a scene names no other."""
    remedy = "put the file beside the scene, or in a folder there, and give the way from it"
    # Drives and roots are read as Windows does, so that a scene is refused alike on every system.
    if "\0" in words or "\\" in words or PureWindowsPath(words).anchor:
        raise PalpateError(f"{entry.where}: '{words[:80]!r}' is no file beside the scene; {remedy}")
    file = folder / words
    if not file.resolve().is_relative_to(folder.resolve()):
        raise PalpateError(f"{entry.where}: '{words[:80]}' leads out of the folder; {remedy}")
    if not file.is_file():
        raise PalpateError(f"{entry.where}: there is no file '{words[:80]}'; {remedy}")
    return file
