"""Runs the tests of this folder against the installed extension, inside the `bpy` module.

They run in an environment that holds nothing but bpy and pytest (`make test-addon`), so that
scipy, pytetwild and palpate_servo can only come from the wheels inside the package. It is installed
once, the way a user does it, into a user folder that is thrown away:

    def test_something(palpate):                          # the installed package, as a module
        from bl_ext.user_default.palpate.core.bake.steps import BakeSettings
        bpy.ops.palpate...                                # the operators, synchronously

Every test begins with Blender's factory scene and the extension enabled.

`PALPATE_PACKAGE` names the zip; without it, the one that `make package` left in build/packages.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest
from hypothesis import settings

REPOSITORY = Path(__file__).resolve().parents[2]
MODULE = "bl_ext.user_default.palpate"

if importlib.util.find_spec("bpy") is None:
    raise pytest.UsageError("tests/addon needs Blender's module: run `make test-addon`")

# Blender reads its user folder when bpy is imported, so it must be chosen before any test does.
# Users have names with spaces and umlauts, and their temporary files lie below these too.
USER_FOLDER = Path(tempfile.mkdtemp(prefix="palpate-addon-tests of Jörg "))
os.environ["BLENDER_USER_RESOURCES"] = str(USER_FOLDER)
TEMPORARY_FILES = USER_FOLDER / "tmp"
TEMPORARY_FILES.mkdir()
tempfile.tempdir = str(TEMPORARY_FILES)
os.environ.update(dict.fromkeys(("TMPDIR", "TEMP", "TMP"), tempfile.tempdir))

import bpy  # noqa: E402 -- the environment comes first, see above
from soft_scene import mesh_state, part, soft_cube  # noqa: E402

# The same examples in every run, few of them: each opens and saves a file.
settings.register_profile("repeatable", derandomize=True, deadline=None, max_examples=12)
settings.register_profile("long", max_examples=250, deadline=None, database=None)
settings.load_profile("repeatable")


def pytest_report_header() -> str:
    """Say which Blender is tested."""
    return f"Blender {bpy.app.version_string}, package {package()}"


def pytest_unconfigure() -> None:
    """Throw the user folder away."""
    shutil.rmtree(USER_FOLDER, ignore_errors=True)


def package() -> Path:
    """Return the extension's zip that is to be tested."""
    chosen = os.environ.get("PALPATE_PACKAGE")
    built = sorted((REPOSITORY / "build" / "packages").glob("palpate-[0-9]*.zip"))
    if not chosen and not built:
        raise pytest.UsageError("there is no package to test: run `make package`")
    return Path(chosen) if chosen else built[-1]


@pytest.fixture(scope="session")
def installed() -> str:
    """Install and enable the package as a user would; return the extension's module name."""
    bpy.ops.extensions.package_install_files(
        filepath=str(package()), repo="user_default", enable_on_install=True
    )
    # The operator returns FINISHED for a missing or broken file too.
    assert MODULE in bpy.context.preferences.addons, "the package was not installed and enabled"
    return MODULE


@pytest.fixture
def palpate(installed: str) -> Iterator[ModuleType]:
    """Return the installed package, enabled, in Blender's factory scene."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=False)
    if installed not in bpy.context.preferences.addons:
        bpy.ops.preferences.addon_enable(module=installed)
    # What a point feels at a node is known exactly; tests of tools choose for themselves.
    bpy.context.scene.palpate.tip = "POINT"
    yield importlib.import_module(installed)
    if installed not in bpy.context.preferences.addons:
        # A test that disables the extension hands it back enabled.
        bpy.ops.preferences.addon_enable(module=installed)


@pytest.fixture
def states(palpate: ModuleType) -> ModuleType:
    """Return the events and states of a press."""
    return importlib.import_module(f"{MODULE}.operators.session.press_state")


@pytest.fixture
def sessions(palpate: ModuleType) -> Iterator[ModuleType]:
    """Return running presses; what a test leaves running is ended."""
    module = importlib.import_module(f"{MODULE}.operators.session.press_session")
    yield module
    module.give_way("")


@pytest.fixture
def thing(palpate: ModuleType) -> bpy.types.Object:
    """Return a soft cube, the active object."""
    return soft_cube()


@pytest.fixture
def before(thing: bpy.types.Object) -> object:
    """Return all that a press may change about the soft cube, as it was at first."""
    return mesh_state(thing)


@pytest.fixture
def silent_port() -> Iterator[str]:
    """A port with nobody behind it."""
    port = part("simulated.wire.ports").device_port("")
    yield port.path
    port.unplug()
