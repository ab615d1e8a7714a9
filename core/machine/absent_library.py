"""Libraries that not every system has a build of, such as fTetWild's on ARM."""

from __future__ import annotations

import importlib
from types import ModuleType

from ..errors import PalpateError


def library(module: str, name: str) -> ModuleType:
    """A module that is needed for baking alone.

    Raises
    ------
    PalpateError
        It is not there, or the system is too old for it. What can be done without stands in it.
    """
    try:
        return importlib.import_module(module)
    except ImportError as problem:
        raise PalpateError(
            "bake: {name} cannot be loaded on this system ({reason}); make the object soft on "
            "another computer, such as one with Windows or Linux and an x64 processor, and open "
            "its .blend file here: it brings what is needed to press and to rebuild the body",
            name=name,
            reason=problem,
        ) from problem
