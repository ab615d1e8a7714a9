"""The virtual durometer: closed forms on a half-space, blocks, layers, and what it warns of."""

from dataclasses import replace

import numpy as np
import pytest
from bodies.soft_block import soft_block
from scipy.spatial.transform import Rotation

from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.contact.near_field.half_space import own_displacement, surface_displacement
from palpate.core.errors import PalpateError
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.softness.durometer import block_reading, read_durometer
from palpate.core.softness.durometer_balance import balanced
from palpate.core.softness.durometer_points import Seat, rings
from palpate.core.softness.scales.durometer_type import TYPE_00, TYPE_A, TYPES
from palpate.core.softness.scales.indentation import indenter_force
from palpate.core.softness.scales.shore import Shore, shore_from_young, young_from_shore
from palpate.core.stiffness.assembly import assemble

RUBBER = 0.5
MIDDLE = (0.041, 0.0385, 0.05)


def half_space(kind):
    """A durometer on a half-space: Boussinesq's compliance at 1 Pa between its points."""
    ring = rings(kind)
    count = len(ring.tip)
    places = np.column_stack([ring.places, np.zeros(count)])
    normals = np.tile([0.0, 0.0, 1.0], (count, 1))
    i, j = np.nonzero(~np.eye(count, dtype=bool))
    compliance = np.diag(own_displacement(ring.areas, normals, RUBBER)[:, 2, 2])
    compliance[i, j] = surface_displacement(places[i] - places[j], normals[i], RUBBER)[:, 2, 2]
    radii, flat = np.linalg.norm(ring.places, axis=1), np.zeros(count)
    return compliance, Seat(None, None, radii, flat, ring.tip, thickness=1.0, overhang=0.0)


@pytest.mark.parametrize("reading", [10, 30, 50, 70, 90])
@pytest.mark.parametrize("kind", TYPES.values(), ids=TYPES)
def test_on_a_half_space_it_reads_what_the_closed_forms_say(kind, reading):
    young = young_from_shore(Shore(kind.name, reading))
    compliance, seat = half_space(kind)
    found = balanced(compliance / young, seat, kind, None)
    assert found.reading == pytest.approx(block_reading(kind, young, RUBBER), abs=0.6)
    assert found.pushes[seat.tip].sum() == pytest.approx(kind.force(found.reading), rel=1e-9)


@pytest.mark.parametrize("scale", TYPES)
def test_on_a_thick_block_relations_and_geometry_differ_by_at_most_five_points(scale):
    """Gent's flat punch and Hertz's paraboloid against the indenters as they are."""
    for reading in range(10, 91, 5):
        young = young_from_shore(Shore(scale, reading))
        assert abs(block_reading(TYPES[scale], young, RUBBER) - reading) < 5


def test_a_stand_presses_the_foot_in_as_a_flat_punch_and_holds_its_load():
    compliance, seat = half_space(TYPE_00)
    young = young_from_shore(Shore("00", 10))
    found = balanced(compliance / young, seat, TYPE_00, TYPE_00.load)
    assert found.pushes.sum() == pytest.approx(TYPE_00.load, rel=1e-4)
    punch = TYPE_00.load * 0.75 / (2 * young * TYPE_00.foot)
    assert found.foot_depth == pytest.approx(punch, rel=0.05)
    assert found.pushes[seat.tip].sum() == pytest.approx(TYPE_00.force(found.reading), rel=1e-6)
    assert found.reading > balanced(compliance / young, seat, TYPE_00, None).reading


@pytest.mark.parametrize(
    "reading",
    [
        pytest.param(one, marks=() if one in (10, 50, 90) else pytest.mark.at_length)
        for one in range(10, 91, 10)
    ],
)
@pytest.mark.parametrize("scale", TYPES)
def test_a_block_of_any_mesh_reads_as_a_half_space(coarse_block, fine_block, scale, reading):
    """Elements are 5 to 25 times as large as the part of the indenter that touches."""
    for body in (coarse_block, fine_block):
        young = young_from_shore(Shore(scale, reading), body.poisson_ratio)
        found = read_durometer(body, MIDDLE, scale, young_modulus=young)
        assert found.shore.value == pytest.approx(found.block.value, abs=0.8)
        assert not found.warnings


def test_where_it_stands_on_a_block_makes_no_difference(coarse_block, rng):
    young = young_from_shore(Shore("00", 40), coarse_block.poisson_ratio)
    places = np.column_stack([rng.uniform(0.035, 0.045, (5, 2)), np.full(5, 0.05)])
    values = [read_durometer(coarse_block, at, young_modulus=young).shore.value for at in places]
    assert np.ptp(values) < 0.1


@pytest.mark.parametrize(("height", "cells"), [(0.01, (18, 18, 5)), (0.006, (24, 24, 4))])
def test_a_layer_on_a_rigid_base_reads_as_its_closed_form_says(height, cells):
    """Dimitriadis et al. 2002, Biophysical Journal 82, 2798: a ball on a bonded layer, nu = 0.5."""
    layer = soft_block((0.036, 0.036, height), cells, 0.49)
    young = young_from_shore(Shore("00", 60), layer.poisson_ratio)
    found = read_durometer(layer, (0.0182, 0.0177, height), young_modulus=young)
    depth = np.linspace(1e-5, TYPE_00.travel, 5000)
    chi = np.sqrt(TYPE_00.shaft * depth) / height
    firmer = 1 + 1.133 * chi + 1.283 * chi**2 + 0.769 * chi**3 + 0.0975 * chi**4
    # Their ball is a paraboloid; ours is exact, so its force on a half-space takes its place.
    stiffness = young / (1 - layer.poisson_ratio**2)
    force = stiffness * np.array([indenter_force(TYPE_00, d) for d in depth]) * firmer
    readings = 100 * (1 - depth / TYPE_00.travel)
    expected = np.interp(0.0, force - TYPE_00.force(readings), readings)
    assert expected > found.block.value + 2
    assert found.shore.value == pytest.approx(expected, abs=1.5)


def test_a_body_turned_over_reads_the_same(coarse_block):
    turn = Rotation.from_rotvec([0.4, -1.1, 0.7]).as_matrix()
    mesh = TetMesh.checked(coarse_block.mesh.nodes @ turn.T, coarse_block.mesh.tets)
    K = assemble(mesh, coarse_block.poisson_ratio, formulation="smoothed")
    turned = replace(
        coarse_block, mesh=mesh, compliance=surface_compliance(mesh, K, coarse_block.fixed)
    )
    values = [
        read_durometer(body, at, young_modulus=2e5).shore.value
        for body, at in ((coarse_block, MIDDLE), (turned, turn @ MIDDLE))
    ]
    assert values[0] == pytest.approx(values[1], abs=0.1)


def test_softer_and_firmer_than_the_scale_it_stays_at_its_stops(coarse_block):
    soft = read_durometer(coarse_block, MIDDLE, young_modulus=1000.0)
    assert soft.shore.value == 0
    assert soft.tip_force < TYPE_00.force_at_zero
    assert any("softer than this durometer" in warning for warning in soft.warnings)
    assert read_durometer(coarse_block, MIDDLE, young_modulus=1e10).shore.value > 99.5


def test_what_speaks_against_a_reading_is_told(layer, thin_block, mouse):
    thick = read_durometer(layer, (0.018, 0.018, 0.01), young_modulus=30_000.0)
    assert any("% of the thickness" in warning for warning in thick.warnings)
    edge = read_durometer(layer, (0.001, 0.018, 0.01), "A", young_modulus=1e6)
    assert any("no surface under it" in warning for warning in edge.warnings)
    thin = read_durometer(thin_block, (0.015, 0.016, 0.005), "A")
    assert any("too long for 5.0 mm" in warning for warning in thin.warnings)
    assert any("5.0 mm thick" in warning for warning in thin.warnings)
    base = read_durometer(mouse, mouse.mesh.nodes[mouse.fixed[0]], young_modulus=1e5)
    assert any("pinned" in warning for warning in base.warnings)


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"scale": "D"}, "choose 00 or A"),
        ({"load": 0.0}, "load is 0.0"),
        ({"load": float("nan")}, "load is nan"),
        ({"young_modulus": -1.0}, "modulus is -1.0"),
        ({"at": (0, 0)}, "three finite numbers"),
        ({"at": (0, 0, float("inf"))}, "not finite"),
    ],
)
def test_what_cannot_be_read_is_refused(coarse_block, changed, reason):
    with pytest.raises(PalpateError, match=reason):
        read_durometer(coarse_block, **{"at": MIDDLE, **changed})


def test_the_reading_is_that_of_the_relation_within_what_docs_say(fine_block):
    """On a block: Young's modulus of Shore A 30, read by relation and by durometer."""
    young = young_from_shore(Shore("A", 30), fine_block.poisson_ratio)
    read = read_durometer(fine_block, MIDDLE, "A", young_modulus=young).shore
    told = shore_from_young(young, "A", fine_block.poisson_ratio)
    assert read.value == pytest.approx(told.value, abs=2)
    assert TYPE_A.force(told.value) == pytest.approx(2.8)
