"""Examples in docstrings give what they say, and the entry points of the package have one."""

from __future__ import annotations

import doctest
import importlib
from operator import attrgetter
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
ENTRY_POINTS = (
    "core.mesh.tet_mesh:TetMesh.checked",
    "core.stiffness.assembly:assemble",
    "core.compliance.surface_compliance:surface_compliance",
    "core.bake.steps:bake",
    "core.body.body_file:save",
    "core.contact.single_press:touch_nearest",
    "core.shape.shapes:shape",
    "core.softness.durometer:read_durometer",
    "core.softness.scales.shore:young_from_shore",
    "core.servo.session:servo_on",
)
WITH_EXAMPLES = sorted(
    path.relative_to(REPOSITORY).with_suffix("").as_posix().replace("/", ".")
    for room in ("core", "simulated", "cli")
    for path in (REPOSITORY / room).rglob("*.py")
    if ">>> " in path.read_text(encoding="utf-8")
)


@pytest.mark.parametrize("name", ENTRY_POINTS)
def test_every_entry_point_has_an_example(name):
    module, _, function = name.partition(":")
    text = attrgetter(function)(importlib.import_module(f"palpate.{module}")).__doc__
    assert doctest.DocTestParser().get_examples(text)


@pytest.mark.parametrize("module", WITH_EXAMPLES)
def test_examples_give_what_they_say(module):
    results = doctest.testmod(importlib.import_module(f"palpate.{module}"))
    assert results.attempted
    assert not results.failed
