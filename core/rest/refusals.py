"""What the native engine of resting bodies refuses, told as the product's own errors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from ..contact.tool.pose import Pose
from ..errors import PalpateError


class RestlessError(PalpateError):
    """The body goes on moving, or its forces are no numbers."""


class SwallowedError(PalpateError):
    """A tool or support is wholly within the body, which does not feel it."""


@contextmanager
def rest_errors(*kinds: type[Exception]) -> Iterator[None]:
    """Errors of these kinds from the native engine become one that a user can read.

    Raises
    ------
    RestlessError
        In place of a RuntimeError, with its text: the engine finds no rest.
    PalpateError
        In place of an error of another of the kinds, with its text.
    """
    try:
        yield
    except kinds as problem:
        told = PalpateError("rest: {problem}", problem=problem)
        if isinstance(problem, RuntimeError):
            raise RestlessError(told.sentence) from problem
        raise told from problem


def one_goal_each(goals: Sequence[Pose], tools: Sequence[object]) -> None:
    """Check that each tool has its goal.

    Raises
    ------
    PalpateError
        More goals than tools, or fewer.
    """
    if len(goals) != len(tools):
        raise PalpateError(
            "{goals} goals for {tools} tools; give one for each",
            goals=len(goals),
            tools=len(tools),
        )
