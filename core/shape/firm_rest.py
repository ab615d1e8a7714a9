"""Bodies that nobody holds, as firm and as their materials' laws have them.

A body of a law presses back as a linear one does whose Young's modulus is G times as large
(:mod:`.rotation_strain.firmness`), wherever it is pressed: by what bears it and by what presses it
together. So bodies come to rest as linear ones; what they are under there tells G; and with that
they come to rest again, until G stays.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..body.soft_body import SoftBody
from ..contact.tool.pose import Pose
from ..rest.rest import Rest
from .found_behind import FoundBehind
from .rest_looks import firmness_begun, loads_of, look_at, shown
from .shapes import LinearShape, Shape

# Firmness stays where it changes by less than this share; by so much where it is drawn for somebody
# who waits; looks until it does, at most.
STAYS, STAYS_IN_HAND, MOST_LOOKS = 2e-3, 0.02, 5
# Ticks of one part of coming to rest, and between two looks.
TICKS, BETWEEN = 1000, 200


class Rests(Protocol):
    """One linear body that nobody holds (:class:`..rest.resting.Resting`), or several
    (:class:`..pile.pile.Pile`).
    """

    @property
    def bodies(self) -> tuple[SoftBody, ...]:
        """They, in their order."""
        ...

    @property
    def firmness(self) -> tuple[float, ...]:
        """How many times as firm as its material each is."""
        ...

    @property
    def rests(self) -> tuple[Rest, ...]:
        """Where each is now."""
        ...

    def firm(self, firmness: Sequence[float]) -> None:
        """Have each be so many times as firm as its material, from the next tick on."""
        ...

    def lead(self, goals: Sequence[Pose]) -> None:
        """Have the tools go to their goals from the next tick on."""

    def move_support(self, number: int, pose: Pose) -> None:
        """Have a support be elsewhere from the next tick on."""

    def hurry(self, seconds: float) -> None:
        """Go on by a tick, with as much work as there is time for while somebody waits."""

    def settle_on(self, ticks: int) -> bool:
        """Go on with coming to rest by so many ticks at most; whether all rest."""
        ...


Array = NDArray[np.float64]
Lying = TypeVar("Lying", bound=Rests)


@dataclass(eq=False)
class FirmRest(Generic[Lying]):
    """Bodies that come to rest by their laws.

    Attributes
    ----------
    lying : the linear ones.
    shapes : of each.
    in_hand : whether somebody leads what presses them and looks on: on the way they are drawn as
        they are found in the background meanwhile, which is not the same each time.
    """

    lying: Lying
    shapes: Sequence[Shape]
    in_hand: bool = False
    # Looks that are left.
    _looks: int = field(default=MOST_LOOKS, init=False)
    _changes: tuple[float, ...] = field(default=(), init=False)
    _known: tuple[Rest, ...] | None = field(default=None, init=False)
    # Of bodies in hand: what looks for them in the background, and how firm it found them last.
    _behind: dict[int, FoundBehind] = field(default_factory=dict, init=False)
    _heard: dict[int, float] = field(default_factory=dict, init=False)

    def __post_init__(self) -> None:
        """As firm as each was when it was looked at last."""
        pairs = zip(self.lying.bodies, self.shapes, self.lying.firmness, strict=True)
        self.lying.firm([firmness_begun(*one) for one in pairs])

    def settle(self) -> tuple[Rest, ...]:
        """Where they come to rest.

        Raises
        ------
        PalpateError
            One does not come to rest, or a shape cannot be computed.
        """
        while not self.settle_on(TICKS):
            pass
        return self.rests

    def settle_on(self, ticks: int) -> bool:
        """Go on with that by so many ticks at most; whether all rest.

        Raises
        ------
        PalpateError
            As of :meth:`settle`.
        """
        self._known = None
        # Between the first look and the last it begins from where it rested, and need not quite.
        is_first, is_last = self._looks == MOST_LOOKS, self._looks == 0
        is_between = not (is_first or is_last)
        rests = self.lying.settle_on(min(ticks, BETWEEN) if is_between else ticks)
        if not (rests or is_between):
            return False
        before, found = self.lying.firmness, self._found()
        changes = tuple(now / last - 1.0 for last, now in zip(before, found, strict=True))
        enough = STAYS_IN_HAND if self.in_hand else STAYS
        stays = is_last or max(map(abs, changes)) <= enough
        if stays and rests:
            self._looks, self._changes = MOST_LOOKS, ()
            return True
        turns = any(now * last < 0.0 for now, last in zip(changes, self._changes, strict=False))
        self._looks, self._changes = 0 if stays else self._looks - 1, changes
        # To and fro between two: what softens sags, and what sags softens.
        share = 0.5 if turns else 1.0
        pairs = zip(before, found, strict=True)
        self.lying.firm([last + share * (now - last) for last, now in pairs])
        return False

    def look(self) -> None:
        """Find how firm they are where they are now, and how they look; they are so from the next
        tick on.

        Raises
        ------
        PalpateError
            A shape cannot be computed.
        """
        self.lying.firm(self._found())

    def _found(self) -> tuple[float, ...]:
        """How firm they are found to be where they are now; how they look is known then."""
        every = list(zip(self.lying.rests, self.shapes, self.lying.firmness, strict=True))
        found = [look_at(*one) for one in every]
        self._known = tuple(
            one.of(rest, times) for one, (rest, _, times) in zip(found, every, strict=True)
        )
        return tuple(one.firmness for one in found)

    def forget(self) -> None:
        """They are moved on: what was found is no more where they are."""
        self._known, self._looks, self._changes = None, MOST_LOOKS, ()

    def lead(self, goals: Sequence[Pose]) -> None:
        """Have the tools go to their goals from the next tick on."""
        self.forget()
        self.lying.lead(goals)

    def move_support(self, number: int, pose: Pose) -> None:
        """Have a support be elsewhere from the next tick on."""
        self.forget()
        self.lying.move_support(number, pose)

    def hurry(self, seconds: float) -> None:
        """Go on by a tick, as firm as they were found to be.

        Raises
        ------
        PalpateError
            A force is no number.
        """
        self.forget()
        if self._heard:
            now = enumerate(self.lying.firmness)
            self.lying.firm([self._heard.get(number, times) for number, times in now])
        self.lying.hurry(seconds)

    @property
    def rests(self) -> tuple[Rest, ...]:
        """Where each is now, as its law has it: at rest where that was looked for, and on the way
        as near to that as a picture has time for.
        """
        if self._known is not None:
            return self._known
        lying = self.lying
        every = zip(lying.rests, self.shapes, lying.firmness, strict=True)
        if self.in_hand:
            return tuple(self._found_behind(number, *one) for number, one in enumerate(every))
        return tuple(shown(*one) for one in every)

    def _found_behind(self, number: int, rest: Rest, shape: Shape, times: float) -> Rest:
        loads = loads_of(rest, times)
        if isinstance(shape, LinearShape) or not loads:
            return rest
        if number not in self._behind:
            self._behind[number] = FoundBehind(rest.body, shape, rest.young_modulus / times)
        found = self._behind[number].now(loads)
        if found.share != 1.0:
            self._heard[number] = found.share
        return replace(rest, deformed=found.displacements)

    def close(self) -> None:
        """End what goes on in the background; does not wait."""
        for one in self._behind.values():
            one.close()


def settle_firmly(lying: Rests, shapes: Sequence[Shape]) -> tuple[Rest, ...]:
    """Where bodies come to rest by their laws, with all that is needed for it; waits for it.

    Raises
    ------
    PalpateError
        One does not come to rest, or a shape cannot be computed.
    """
    for body, shape in zip(lying.bodies, shapes, strict=True):
        shape.wait_for(body.mesh.surface_nodes[:1])
    return FirmRest(lying, shapes).settle()
