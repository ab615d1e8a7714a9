"""A stand-in for a panel's layout that writes down what is drawn into it."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import bpy

# The sidebar as it is at first, unscaled pixels; and where it has been made as narrow as it goes.
USUAL_WIDTH, NARROW_WIDTH = 280, 160


@dataclass
class Written:
    """All that a panel drew: lines of text, names of properties and operators, shares of bars;
    ``boxed`` are the lines that stand in a box.
    """

    lines: list[str] = field(default_factory=list)
    icons: list[str] = field(default_factory=list)
    properties: list[str] = field(default_factory=list)
    operators: list[str] = field(default_factory=list)
    bars: list[tuple[float, str]] = field(default_factory=list)
    boxed: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        """The lines as one text."""
        return " ".join(self.lines)


class RecordedLayout:
    """What panels use of `bpy.types.UILayout`."""

    def __init__(self, written: Written | None = None, *, boxed: bool = False) -> None:
        self.written = Written() if written is None else written
        self.is_boxed = boxed

    def _part(self, **_: Any) -> RecordedLayout:
        return RecordedLayout(self.written, boxed=self.is_boxed)

    row = column = split = _part

    def box(self) -> RecordedLayout:
        """A part with a frame."""
        return RecordedLayout(self.written, boxed=True)

    def label(self, *, text: str = "", icon: str = "NONE", translate: bool = True) -> None:
        """A line, translated as Blender does it."""
        self.written.lines.append(bpy.app.translations.pgettext_iface(text) if translate else text)
        self.written.boxed += self.written.lines[-1:] if self.is_boxed else []
        self.written.icons.append(icon)

    def prop(self, data: Any, name: str, **_: Any) -> None:
        """A property; fails where there is none of this name, but for custom ones."""
        assert name.startswith("[") or name in data.bl_rna.properties, name
        self.written.properties.append(name)

    def prop_enum(self, data: Any, name: str, value: str, **_: Any) -> None:
        """A button for one value; fails where there is none of this name."""
        assert value in data.bl_rna.properties[name].enum_items
        self.prop(data, name)

    def prop_menu_enum(self, data: Any, name: str, *, text: str, **_: Any) -> None:
        """A menu with a text of its own."""
        self.prop(data, name)
        self.written.lines.append(text)

    def prop_search(self, data: Any, name: str, place: Any, names: str, **_: Any) -> None:
        """A property with a list to choose from."""
        assert hasattr(place, names)
        self.prop(data, name)

    def operator(self, name: str, **_: Any) -> SimpleNamespace:
        """A button; fails where there is no such operator."""
        module, _, function = name.partition(".")
        assert getattr(getattr(bpy.ops, module), function).get_rna_type(), name
        self.written.operators.append(name)
        return SimpleNamespace()

    def progress(self, *, factor: float, text: str, **_: Any) -> None:
        """A bar."""
        self.written.bars.append((factor, text))


def drawn(panel: type, thing: bpy.types.Object, width: int = USUAL_WIDTH) -> Written:
    """What a panel of the extension shows for an object."""
    layout = RecordedLayout()
    context = SimpleNamespace(
        object=thing,
        scene=bpy.context.scene,
        # Without a window Blender has no scale.
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
        region=SimpleNamespace(width=width),
    )
    panel.draw(SimpleNamespace(layout=layout), context)
    return layout.written
