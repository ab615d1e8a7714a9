"""The map of softness: a disc's closed form, the mesh's texture, colours and files."""

import io

import numpy as np
import pytest
from plyfile import PlyData

from palpate.core.errors import PalpateError
from palpate.core.softness.coloured_ply import write_ply
from palpate.core.softness.ramp import legend, ramp
from palpate.core.softness.softness_map import SoftnessMap, softness_map


def top(body):
    """Surface nodes in the middle of a block's top."""
    x, y, z = body.mesh.nodes[body.mesh.surface_nodes].T
    return (z > 0.0499) & (np.abs(x - 0.04) < 0.02) & (np.abs(y - 0.04) < 0.02)


def test_a_pad_on_a_block_is_as_firm_as_an_even_pressure_on_a_half_space(shaken_blocks):
    """Johnson, Contact Mechanics, 3.4: mean displacement 16 (1 - nu^2) F / (3 pi^2 a E); the block
    ends 50 mm below, which makes it firmer by a few percent.
    """
    body = shaken_blocks[1]
    found = softness_map(body, pad_radius=0.005, young_modulus=2e5).stiffness[top(body)].mean()
    expected = 3 * np.pi**2 / 16 * 0.005 * 2e5 / (1 - 0.45**2)
    assert expected < found < 1.08 * expected


def test_a_pad_does_not_feel_the_mesh_and_a_bare_node_does(shaken_blocks):
    pads, bare = (
        [softness_map(body, pad_radius=radius).stiffness[top(body)] for body in shaken_blocks]
        for radius in (0.005, 0.0)
    )
    assert pads[0].mean() == pytest.approx(pads[1].mean(), rel=0.01)
    assert max(values.std() / values.mean() for values in pads) < 0.02
    # Twice as fine a mesh is half as firm at a bare node.
    assert bare[1].mean() < 0.55 * bare[0].mean()
    assert min(values.std() / values.mean() for values in bare) > 0.04


def test_a_bare_node_is_the_diagonal_block(cube):
    found = softness_map(cube, pad_radius=0.0)
    node = np.flatnonzero(
        np.all(np.isclose(cube.mesh.nodes[cube.mesh.surface_nodes], [0.025, 0.025, 0.05]), axis=1)
    )[0]
    at = np.searchsorted(cube.compliance.free_surface, cube.mesh.surface_nodes[node])
    normal = cube.compliance.block(at, at)[2, 2]
    assert found.stiffness[node] == pytest.approx(cube.young_modulus / normal, rel=1e-5)


def test_pinned_places_are_as_firm_as_the_firmest_free_one(mouse):
    found = softness_map(mouse)
    pinned = np.isin(mouse.mesh.surface_nodes, mouse.fixed)
    assert np.all(found.stiffness[pinned] == found.stiffness[~pinned].max())
    assert np.all(found.stiffness > 0)


def test_the_modulus_is_only_a_factor(mouse):
    soft, firm = (softness_map(mouse, young_modulus=E).stiffness for E in (1e3, 7e3))
    np.testing.assert_allclose(7 * soft, firm, rtol=1e-12)


def test_thin_parts_are_softer_than_the_trunk(mouse):
    """The tail's end and the ears give way more than the back."""
    found = softness_map(mouse).stiffness
    x, _, z = mouse.mesh.nodes[mouse.mesh.surface_nodes].T
    assert np.median(found[x < -0.085]) < 0.5 * np.median(found[(np.abs(x) < 0.03) & (z > 0.02)])


def test_shares_are_even_on_a_scale_of_ratios_and_stay_within():
    found = SoftnessMap(np.geomspace(1.0, 100.0, 1001), 0.0)
    shares = found.shares()
    assert shares.min() == 0
    assert shares.max() == 1
    assert shares[500] == pytest.approx(0.5)
    even = SoftnessMap(np.full(4, 3.0), 0.0)
    assert even.shares().tolist() == [0.5] * 4


def test_colours_get_lighter_all_the_way_for_everybody():
    """Relative luminance (sRGB, IEC 61966-2-1), and the same without red-green difference."""
    colours = ramp(np.linspace(0, 1, 101))
    assert colours.min() >= 0
    assert colours.max() <= 1
    linear = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    assert np.all(np.diff(linear @ [0.2126, 0.7152, 0.0722]) > 0)
    # A deuteranope sees red and green through one cone: their mean still grows.
    assert np.all(np.diff(linear[:, 0] + linear[:, 1]) > 0)


def test_the_legend_begins_and_ends_with_the_span():
    rows = legend(10.0, 1000.0, 3)
    assert [value for value, _ in rows] == pytest.approx([10, 100, 1000])
    np.testing.assert_allclose(rows[-1][1], ramp([1.0])[0])


def test_a_ply_holds_surface_colours_and_numbers(cube):
    found = softness_map(cube)
    file = io.BytesIO()
    write_ply(file, cube, found)
    read = PlyData.read(io.BytesIO(file.getvalue()))
    np.testing.assert_allclose(read["vertex"]["stiffness"], found.stiffness, rtol=1e-6)
    assert len(read["face"].data) == len(cube.mesh.surface_triangles)
    lightest = np.argmax(read["vertex"]["red"])
    assert found.stiffness[lightest] >= found.span[1] * (1 - 1e-9)
    assert "N/m" in read.comments[0]


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"pad_radius": -1.0}, "softness map: pad radius is -1.0"),
        ({"pad_radius": float("nan")}, "softness map: pad radius is nan"),
        ({"young_modulus": 0.0}, "Young's modulus is 0.0 Pa"),
    ],
)
def test_what_makes_no_map_is_refused(cube, changed, reason):
    with pytest.raises(PalpateError, match=reason):
        softness_map(cube, **changed)
