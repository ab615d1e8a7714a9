"""Cursor that asks to wait, while something takes a moment."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy


@contextmanager
def wait_cursor(context: bpy.types.Context) -> Iterator[None]:
    """Show it for as long as this takes, however that ends."""
    context.window.cursor_modal_set("WAIT")
    try:
        yield
    finally:
        context.window.cursor_modal_restore()
