"""What modal operators leave in Blender's bars and timers: nothing, however they end."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from soft_scene import part


class Bars:
    """Stand-in for a workspace or an area with the text that it shows."""

    def __init__(self, name="", kind="VIEW_3D"):
        self.name, self.type, self.text = name, kind, None

    def status_text_set(self, text):
        self.text = text

    header_text_set = status_text_set

    def tag_redraw(self):
        pass


class Manager:
    """Stand-in for the window manager."""

    def __init__(self, *areas):
        self.timers, self.operators = [], []
        self.windows = [SimpleNamespace(screen=SimpleNamespace(areas=areas))]

    def event_timer_add(self, seconds, **_):
        self.timers.append(seconds)
        return seconds

    def event_timer_remove(self, timer):
        self.timers.remove(timer)

    def modal_handler_add(self, operator):
        self.operators.append(operator)


class Operator:
    """Stand-in for a modal operator, which ends as it is told to."""

    def __init__(self, stay):
        self.stay = stay

    def cancel(self, context):
        self.stay.end(context)


@pytest.fixture
def module(palpate, monkeypatch):
    found = part("operators.scene.modal_stay")
    monkeypatch.setattr(found, "redraw_views", lambda: None)
    return found


@pytest.fixture
def spaces(module, monkeypatch):
    """Two workspaces."""
    both = {name: Bars(name) for name in ("Layout", "Shading")}
    data = SimpleNamespace(workspaces=both)
    monkeypatch.setattr(module, "bpy", SimpleNamespace(data=data))
    return both


def begun(module, context, seconds=0.1):
    stay = module.ModalStay()
    stay.begin(Operator(stay), context, seconds)
    return stay


def context_in(workspace, area):
    return SimpleNamespace(
        window_manager=Manager(area), window=None, workspace=workspace, area=area
    )


def test_words_go_from_every_workspace_that_was_turned_to(module, spaces):
    context = context_in(spaces["Layout"], Bars())
    stay = begun(module, context)
    stay.say(context, "5 s left")
    context.workspace = spaces["Shading"]
    stay.say(context, "4 s left")
    stay.head(context, "3 mm")
    assert context.area.text == "3 mm"
    context.workspace = None
    stay.end(context)
    assert [space.text for space in spaces.values()] == [None, None]
    assert context.area.text is None
    assert context.window_manager.timers == []


def test_what_runs_is_ended_when_the_extension_is_switched_off(module, spaces):
    context = context_in(spaces["Layout"], Bars())
    for seconds in (0.1, 0.0):
        begun(module, context, seconds).say(context, "goes on")
    assert len(context.window_manager.operators) == 2
    module.end_all(context)
    assert spaces["Layout"].text is None
    assert context.window_manager.timers == []
    assert module._stays == []
