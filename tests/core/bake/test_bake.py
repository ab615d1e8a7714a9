"""The bake with a real fTetWild, in its child process. Small meshes: a second each."""

import sys
import tempfile
import time
from dataclasses import replace

import numpy as np
import psutil
import pytest
import trimesh

from palpate.core.bake.job import BakeJob, run_bake
from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.body import body_file
from palpate.core.body.body_key import body_key
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.errors import PalpateError
from palpate.core.mesh.ftetwild_log import stage
from palpate.core.mesh.surface import Surface
from palpate.core.stiffness.assembly import assemble
from palpate.core.stiffness.pins import PinBelow, PinNodes, PinWeights
from palpate.core.stiffness.regions import TetScale

COARSE = BakeSettings(edge_length=0.12, epsilon=0.01, pins=PinBelow(0.2))


@pytest.fixture(scope="module")
def ball():
    return trimesh.creation.icosphere(subdivisions=2, radius=0.05)


def surface_of(mesh):
    return Surface.checked(mesh.vertices, mesh.faces)


@pytest.fixture
def temporary(tmp_path, monkeypatch):
    """A folder for temporary files of its own, so that leftovers are seen."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


def children():
    return psutil.Process().children()


def bodies():
    """Meshes as artists have them, and whether each is worth a warning."""
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.05)
    beside = ball.copy()
    beside.apply_translation([0.04, 0, 0])
    # Vertices that coincide make one closed piece of these two, which passes through itself.
    entwined = ball.copy()
    entwined.apply_translation([0.05, 0, 0])
    apart = ball.copy()
    apart.apply_translation([0.2, 0, 0])
    holed = ball.copy()
    holed.update_faces(holed.triangles_center[:, 2] < 0.045)
    inward = ball.copy()
    inward.invert()
    soup = trimesh.Trimesh(
        ball.triangles.reshape(-1, 3), np.arange(3 * len(ball.faces)).reshape(-1, 3), process=False
    )
    return {
        "ball": (ball, 1),
        "seams": (soup, 1),
        "overlapping": (trimesh.util.concatenate([ball, beside]), 1),
        "entwined": (trimesh.util.concatenate([ball, entwined]), 1),
        "apart": (trimesh.util.concatenate([ball, apart]), 2),
        "open": (holed, 1),
        "inward": (inward, 1),
        "dense": (trimesh.creation.icosphere(subdivisions=5, radius=0.05), 1),
    }


# Of those that differ little from another, one each is made each time.
RARELY_MADE = ("seams", "entwined", "apart", "dense", "overlapping")


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.at_length) if name in RARELY_MADE else name
        for name in bodies()
    ],
)
def test_what_artists_have_becomes_a_body(name, tmp_path, temporary):
    mesh, pieces = bodies()[name]
    target = tmp_path / "body.npz"
    body, report = run_bake(surface_of(mesh), COARSE, target)
    assert body.mesh.component_count == pieces
    assert report.fit is not None
    assert report.fit.volume_ratio == pytest.approx(1, abs=0.1)
    assert report.fit.input_to_body < 0.02 * np.linalg.norm(np.ptp(mesh.vertices, axis=0))
    assert body_file.load(target).compliance.node_count == body.compliance.node_count
    assert not list(temporary.iterdir())


def test_an_open_sheet_is_refused_with_a_remedy(tmp_path, temporary, ball):
    bowl = ball.copy()
    bowl.update_faces(bowl.triangles_center[:, 2] < -0.045)
    with pytest.raises(PalpateError, match="open sheet that encloses no volume"):
        run_bake(surface_of(bowl), COARSE, tmp_path / "body.npz")
    assert [path.name for path in tmp_path.iterdir()] == ["temporary"]
    assert not list(temporary.iterdir())


def test_a_part_without_pins_is_refused(tmp_path, temporary, ball):
    above = ball.copy()
    above.apply_translation([0, 0, 0.2])
    both = trimesh.util.concatenate([ball, above])
    with pytest.raises(PalpateError, match="pins: piece") as refused:
        run_bake(surface_of(both), COARSE, tmp_path / "body.npz")
    # Its parts came along from the other process, so that Blender can translate them.
    assert refused.value.sentence.values["where"].template == "piece {number} of the body"
    assert not list(temporary.iterdir())


def test_painted_pins_hold_the_painted_side(tmp_path, ball):
    surface = surface_of(ball)
    weights = (surface.vertices[:, 0] > 0.02).astype(float)
    settings = BakeSettings(edge_length=0.12, epsilon=0.01, pins=PinWeights(weights))
    body, _ = run_bake(surface, settings, tmp_path / "body.npz")
    assert len(body.fixed)
    assert (body.mesh.nodes[body.fixed, 0] > 0.01).all()


def test_painted_pins_that_reach_no_node_are_refused(tmp_path, ball):
    settings = BakeSettings(
        edge_length=0.12, epsilon=0.01, pins=PinWeights(np.zeros(len(ball.vertices)))
    )
    with pytest.raises(PalpateError, match="pin group"):
        run_bake(surface_of(ball), settings, tmp_path / "body.npz")


def test_given_tetrahedra_are_baked_as_they_are(tmp_path, cube_mesh, cube):
    mesh, fixed = cube_mesh
    settings = BakeSettings(poisson_ratio=0.49, pins=PinNodes(fixed), formulation="linear")
    body, report = run_bake(mesh, settings, tmp_path / "body.npz")
    assert report.fit is None
    largest = np.abs(cube.compliance.table).max()
    np.testing.assert_allclose(
        body.compliance.table, cube.compliance.table, rtol=1e-6, atol=1e-7 * largest
    )


def test_formulation_and_stiffer_tetrahedra_are_baked_in(tmp_path, cube_mesh):
    mesh, fixed = cube_mesh
    scale = np.where(mesh.nodes[mesh.tets].mean(axis=1)[:, 2] > 0.025, 10.0, 1.0)
    settings = BakeSettings(poisson_ratio=0.49, pins=PinNodes(fixed), stiffness=TetScale(scale))
    body, _ = bake(mesh, settings)
    assert body.formulation == "smoothed"
    stiffness = assemble(mesh, 0.49, formulation="smoothed", young_scale=scale)
    wanted = surface_compliance(mesh, stiffness, fixed)
    np.testing.assert_array_equal(body.compliance.table, wanted.table)
    assert body.key == body_key(mesh, fixed, 0.49, "smoothed", scale)


def test_a_scale_of_one_everywhere_is_none(cube_mesh):
    mesh, fixed = cube_mesh
    settings = BakeSettings(pins=PinNodes(fixed), stiffness=TetScale(np.ones(len(mesh.tets))))
    body, _ = bake(mesh, settings)
    assert body.young_scale is None
    assert body.key == body_key(mesh, fixed, 0.3, "smoothed")


def test_a_job_tells_a_share_that_never_falls_and_a_time_that_remains(tmp_path, ball):
    told = []
    settings = replace(COARSE, edge_length=0.06, form="compressed", tolerance=2e-4)
    body, report = run_bake(surface_of(ball), settings, tmp_path / "body.npz", told.append)
    shares = [progress.share for progress in told if progress.share is not None]
    assert shares == sorted(shares)
    unknown = {progress.step for progress in told if progress.share is None}
    assert unknown <= {"start", "tetrahedralize"}
    assert all(progress.remaining is None or progress.remaining >= 0 for progress in told)
    assert body.compliance.form == "compressed"
    assert set(report.seconds) == {"tetrahedralize", "check", "stiffness", "plan", "compliance"}


def test_a_job_can_be_stopped_while_it_computes(tmp_path, temporary, mouse_mesh):
    mesh, fixed = mouse_mesh
    before = children()
    settings = BakeSettings(pins=PinNodes(fixed), form="compressed", tolerance=1e-4)
    job = BakeJob(mesh, settings)
    while job.poll().step not in {"compliance", "compress"}:
        assert not job.finished
        time.sleep(0.005)
    job.close()
    assert children() == before
    assert not list(temporary.iterdir())


def test_cancelling_leaves_no_process_no_file_no_folder(tmp_path, temporary):
    dense = trimesh.creation.icosphere(subdivisions=5, radius=0.05)
    settings = BakeSettings(edge_length=0.01, epsilon=0.0005, decimate_above=100_000)
    before = children()
    job = BakeJob(surface_of(dense), settings)
    while job.poll().step != "tetrahedralize":
        assert not job.finished
        time.sleep(0.01)
    assert len(children()) == len(before) + 1
    job.close()
    assert children() == before
    assert [path.name for path in tmp_path.iterdir()] == ["temporary"]
    assert not list(temporary.iterdir())
    job.close()


def test_an_exception_in_the_caller_stops_the_child(tmp_path, temporary, ball):
    before = children()

    def stop(_progress):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_bake(surface_of(ball), COARSE, tmp_path / "body.npz", stop)
    assert children() == before
    assert not list(temporary.iterdir())


def test_a_bake_that_takes_too_long_is_given_up(tmp_path, temporary):
    dense = trimesh.creation.icosphere(subdivisions=5, radius=0.05)
    settings = BakeSettings(
        edge_length=0.005, epsilon=0.0002, decimate_above=100_000, time_limit=1.0
    )
    with pytest.raises(PalpateError, match="not done within 1 s"):
        run_bake(surface_of(dense), settings, tmp_path / "body.npz")
    assert not list(temporary.iterdir())


def test_a_crashed_child_is_reported(tmp_path, temporary, ball):
    job = BakeJob(surface_of(ball), COARSE, python=(sys.executable, "-c", "import os; os.abort()"))
    with pytest.raises(PalpateError, match="ended unexpectedly"):
        job.result(tmp_path / "body.npz")
    assert not list(temporary.iterdir())


def test_a_crash_over_a_mesh_too_thin_for_its_tolerance_is_explained(tmp_path, temporary):
    plate = trimesh.creation.box((0.1, 0.1, 0.0006))
    abort = (sys.executable, "-c", "import os; os.abort()")
    job = BakeJob(surface_of(plate), BakeSettings(), python=abort)
    with pytest.raises(PalpateError, match="µm thick, too thin for a tolerance"):
        job.result(tmp_path / "body.npz")
    assert not list(temporary.iterdir())


def test_a_python_that_cannot_start_is_reported(temporary, ball):
    with pytest.raises(PalpateError, match="cannot be started"):
        BakeJob(surface_of(ball), COARSE, python=("no-such-python",))
    assert not list(temporary.iterdir())


@pytest.mark.parametrize(
    "changes",
    [{"edge_length": 0}, {"epsilon": -1}, {"edge_length": np.nan}, {"poisson_ratio": 0.5},
     {"young_modulus": 0}, {"time_limit": 0}, {"pins": PinBelow(1.5)}],
)  # fmt: skip
def test_settings_out_of_range_are_refused(tmp_path, ball, changes):
    settings = BakeSettings(**{"edge_length": 0.12, "epsilon": 0.01, **changes})
    with pytest.raises(PalpateError):
        run_bake(surface_of(ball), settings, tmp_path / "body.npz")
    assert not list(tmp_path.iterdir())


def test_the_log_of_ftetwild_tells_how_far_it_is():
    assert stage("") == "reading the mesh"
    assert stage("Starting tetrahedralization...\ncollapsing 0.2\n") == "simplifying the surface"
    improving = "initializing...\n//// pass 0 ////\nmax_energy = 202.2\n//// pass 1 ////\n"
    assert stage(improving) == "improving tetrahedra, pass 2"
    assert stage(improving + "//// postprocessing ////") == "finishing"
