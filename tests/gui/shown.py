"""Ways to see what panel and view show, while a scenario plays."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import bpy

from bl_ext.user_default.palpate.addon.panels import sidebar


@contextmanager
def all_panels_open() -> Iterator[None]:
    """Have panels open that are closed at first; to be entered before they are first drawn."""
    closed = [cls for cls in sidebar.classes if "DEFAULT_CLOSED" in getattr(cls, "bl_options", ())]
    _register_anew(closed, set())
    try:
        yield
    finally:
        _register_anew(closed, {"DEFAULT_CLOSED"})


def _register_anew(changed: list[type], options: set[str]) -> None:
    for cls in reversed(sidebar.classes):
        bpy.utils.unregister_class(cls)
    for cls in changed:
        cls.bl_options = options
    for cls in sidebar.classes:
        bpy.utils.register_class(cls)


@contextmanager
def replaced(place: object, name: str, other: Callable[..., object]) -> Iterator[None]:
    """Another function in the place of one of the extension's."""
    original = getattr(place, name)
    setattr(place, name, other)
    try:
        yield
    finally:
        setattr(place, name, original)
