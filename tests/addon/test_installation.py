"""The package installs like any extension and brings along all that it imports."""

from __future__ import annotations

import importlib
import pkgutil
import sys
from pathlib import Path

import bpy
import pytest

MODULE = "bl_ext.user_default.palpate"
BUNDLED = ["scipy", "pytetwild", "fast_simplification", "coacd", "serial", "palpate_servo"]


@pytest.mark.parametrize("name", BUNDLED)
def test_import_comes_from_the_wheel_inside_the_package(name, palpate):
    if name == "coacd":
        # As the process that takes meshes apart: its library asks Windows for an OpenMP.
        child = importlib.import_module(f"{MODULE}.core.contact.tool.decomposition_child")
        child.load_openmp()
    module = importlib.import_module(name)
    user_folder = Path(bpy.utils.resource_path("USER"))
    assert Path(module.__file__).is_relative_to(user_folder)


def test_every_module_of_the_package_can_be_imported(palpate):
    """With nothing but Blender, its Python and the wheels inside the package."""
    names = [
        module.name for module in pkgutil.walk_packages(palpate.__path__, f"{palpate.__name__}.")
    ]
    assert f"{MODULE}.cli.main" in names
    assert len(names) > 300
    for name in names:
        importlib.import_module(name)


def test_the_command_line_works_in_the_package(palpate, capsys):
    main = importlib.import_module(f"{MODULE}.cli.main").main
    assert main(["shore", "00-30"]) == 0
    assert "young" in capsys.readouterr().out.lower()


def test_the_servo_brings_nothing_that_only_tests_need(palpate):
    assert not hasattr(importlib.import_module("palpate_servo"), "harness")


def test_numpy_is_blenders_own(palpate):
    numpy = importlib.import_module("numpy")
    assert not Path(numpy.__file__).is_relative_to(Path(bpy.utils.resource_path("USER")))


def test_code_comes_from_the_installed_package(palpate):
    user_folder = Path(bpy.utils.resource_path("USER"))
    assert Path(palpate.__file__).is_relative_to(user_folder)
    # pytest itself imports the root's empty door under the name of the checkout's folder, which may
    # be `palpate`; what lies behind that door must not come from there.
    checkout = [
        name for name in sys.modules if name.startswith(("palpate.core", "palpate.operators"))
    ]
    assert not checkout, "a test imported the checkout instead of the installation"


def _registered():
    """Return the names of all classes and operators that Blender knows of Palpate."""
    classes = {
        name
        for name in dir(bpy.types)
        if getattr(getattr(bpy.types, name), "__module__", "").startswith(MODULE)
    }
    return classes | {f"palpate.{name}" for name in dir(bpy.ops.palpate)}


def test_disabling_takes_everything_out_and_enabling_brings_it_back(palpate):
    before = _registered()
    assert before, "nothing of Palpate is registered"
    bpy.ops.preferences.addon_disable(module=palpate.__name__)
    assert _registered() == set()
    bpy.ops.preferences.addon_enable(module=palpate.__name__)
    assert _registered() == before
