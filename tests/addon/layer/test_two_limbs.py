"""Fingers on two limbs that are posed differently: each one is in a local frame of its own.

Referee: the same fingers on the same body at rest.
"""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from mathutils import Matrix
from pressed_scene import collection
from soft_scene import (
    begin,
    empty,
    hide_layers,
    mesh_object,
    moved,
    part,
    rest_places,
    select,
    soften,
    unbraked,
    wait,
)

# Half the length of a bar, and its half width, m.
LONG, WIDE = 0.1, 0.025
# Where the limbs are touched, beside the nodes, and how deep.
PLACES = np.array([[-0.081, 0.003, WIDE], [0.078, 0.002, WIDE]])
DEPTH = 0.003
# How far each limb is turned about Y.
ANGLES = (0.6, -0.9)


def grid(steps: int, count: int):
    """Vertices and faces of a bar along X, its four sides and two ends."""
    rings = np.linspace(-LONG, LONG, steps + 1)
    corners = [(-WIDE, -WIDE), (WIDE, -WIDE), (WIDE, WIDE), (-WIDE, WIDE)]
    around = []
    for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1], strict=True):
        around += [(a + t * (c - a), b + t * (d - b)) for t in np.arange(count) / count]
    size = len(around)
    places = [(x, y, z) for x in rings for y, z in around]
    faces = [
        (
            n * size + k,
            n * size + (k + 1) % size,
            (n + 1) * size + (k + 1) % size,
            (n + 1) * size + k,
        )
        for n in range(steps)
        for k in range(size)
    ]
    last = len(places) - size
    return places, [*faces, tuple(reversed(range(size))), tuple(range(last, last + size))]


@pytest.fixture
def bar(palpate):
    thing = mesh_object(*grid(24, 4), "Bar")
    thing.palpate.pin_mode, thing.palpate.bake_from = "CORE", "BASE"
    armature = bpy.data.objects.new("Armature", bpy.data.armatures.new("Armature"))
    bpy.context.collection.objects.link(armature)
    select(armature)
    bpy.ops.object.mode_set(mode="EDIT")
    for name, end in (("Left", -LONG), ("Right", LONG)):
        bone = armature.data.edit_bones.new(name)
        bone.head, bone.tail = (0.0, 0.0, 0.0), (end, 0.0, 0.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    for name, side in (("Left", -1.0), ("Right", 1.0)):
        group = thing.vertex_groups.new(name=name)
        for vertex in thing.data.vertices:
            group.add(
                [vertex.index], float(np.clip(0.5 + 30 * side * vertex.co.x, 0, 1)), "REPLACE"
            )
    thing.modifiers.new("Pose", "ARMATURE").object = armature
    select(thing)
    soften(thing, (2 * LONG, 2 * WIDE, 2 * WIDE), "CORE")
    # It is where it stays at once; what is seen of others comes there from picture to picture.
    thing.palpate.shape = "LINEAR"
    return thing


def pose(thing, angles):
    """Turn both limbs about Y; their rotations (3, 3)."""
    bones = thing.modifiers["Pose"].object.pose.bones
    turns = [Matrix.Rotation(angle, 4, "Y") for angle in angles]
    for name, turn in zip(("Left", "Right"), turns, strict=True):
        bones[name].matrix = turn @ bones[name].bone.matrix_local
    bpy.context.view_layer.update()
    return [np.array(turn)[:3, :3] for turn in turns]


def lead(leaders, turns, height):
    for leader, turn, place in zip(leaders, turns, PLACES, strict=True):
        leader.location = turn @ (place + np.array([0.0, 0.0, height]))
    bpy.context.view_layer.update()


def held(sessions, states, thing, turns):
    """Forces (2, 3) in the limbs' axes, and the dent (p, 3), of two Empties that press."""
    chosen = bpy.context.scene.palpate
    leaders = [empty("One"), empty("Two")]
    chosen.source, chosen.second = "EMPTY", "EMPTY"
    chosen.source_empty, chosen.second_empty = leaders
    lead(leaders, turns, 0.01)
    select(thing)
    session = begin(sessions, states, thing, "EMPTY")
    session.tick()
    lead(leaders, turns, -DEPTH)

    def there():
        shots = session.snapshot.fingers
        return all(
            one.touching and np.linalg.norm(one.probe - place - [0, 0, -DEPTH]) < 2e-5
            for one, place in zip(shots, PLACES, strict=True)
        )

    wait(session, there)
    wait(session, lambda: all(map(unbraked, session.snapshot.fingers)))
    told = part("addon.overlay.reading").readings(session)
    forces = np.array([turn.T @ one.force_vector for turn, one in zip(turns, told, strict=True)])
    contacts = np.array([turn.T @ one.contact for turn, one in zip(turns, told, strict=True)])
    session.post(states.Keep())
    dent = moved(thing, session.kept_name).copy()
    hide_layers(thing)
    for leader in leaders:
        bpy.data.objects.remove(leader)
    return forces, contacts, dent


def test_each_finger_feels_the_limb_that_it_touches(sessions, states, bar):
    straight, at, dent = held(sessions, states, bar, pose(bar, (0.0, 0.0)))
    assert (straight[:, 2] > 0.9 * np.linalg.norm(straight, axis=1)).all()
    forces, places, bent = held(sessions, states, bar, pose(bar, ANGLES))
    np.testing.assert_allclose(forces, straight, atol=0.05 * np.linalg.norm(straight))
    np.testing.assert_allclose(places, at, atol=1e-4)
    assert np.linalg.norm(bent - dent) < 0.1 * np.linalg.norm(dent)


@pytest.mark.parametrize("bake", [True, pytest.param(False, marks=pytest.mark.at_length)])
def test_each_presser_meets_the_limb_that_it_is_at(bar, bake):
    scene, dents = bpy.context.scene, []
    scene.frame_start = scene.frame_end = 1
    balls = [empty("One"), empty("Two")]
    for ball in balls:
        ball.empty_display_size = 0.01
    bar.palpate.pressers = collection("Balls", *balls)
    for angles in ((0.0, 0.0), ANGLES):
        lead(balls, pose(bar, angles), 0.01 - DEPTH)
        select(bar)
        name = "Palpate Pressers"
        if bake:
            assert bpy.ops.palpate.press_frames(current_only=True) == {"FINISHED"}
            name = part("operators.layer.layers").layers_of(bar)[-1].name
        else:
            graph = bpy.context.evaluated_depsgraph_get()
            part("operators.animation.live_pressers").follow(bar, graph)
        dents.append(moved(bar, name).copy())
        hide_layers(bar)
        part("operators.animation.live_pressers").end(bar)
    straight, bent = dents
    ends = rest_places(bar)[:, 0] < 0.0
    for limb in (ends, ~ends):
        assert straight[limb, 2].min() < -5e-4
    # A ball comes to rest a hair aside in another pose.
    assert np.linalg.norm(bent - straight) < 0.1 * np.linalg.norm(straight)
