"""The folder that the preferences name for bodies of files not yet saved."""

import bpy
import pytest
from soft_scene import locate, part, soft_cube


@pytest.fixture
def preferences(palpate):
    chosen = part("operators.scene.package_preferences").preferences()
    yield chosen
    chosen.body_folder = ""


def test_bodies_of_unsaved_files_are_kept_there(preferences, tmp_path):
    preferences.body_folder = str(tmp_path / "bodies")
    assert locate(soft_cube()).parent == tmp_path / "bodies"


@pytest.mark.filterwarnings("ignore:.*does not support blend relative")
def test_a_folder_beside_the_file_is_named_in_full(preferences, tmp_path):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    preferences.body_folder = "//bodies"
    assert preferences.body_folder == str(tmp_path / "bodies")


@pytest.mark.filterwarnings("ignore:.*does not support blend relative")
def test_beside_an_unsaved_file_is_nowhere(preferences):
    store = part("operators.object.body_store")
    usual = store.folder_for_new_files()
    preferences.body_folder = "//bodies"
    assert preferences.body_folder == ""
    assert store.folder_for_new_files() == usual
