"""Objects for the tests of the installed extension, and what they look like from outside."""

from __future__ import annotations

import importlib
import os
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import bpy
import numpy as np
import pytest
from numpy.typing import NDArray

# All tests run below a folder with an umlaut.
opens_usd = pytest.mark.skipif(
    os.name == "nt" and bpy.app.version < (5, 0),
    reason="the USD of Blender 4.5 as a module opens no path beyond ASCII on Windows",
)

MODULE = "bl_ext.user_default.palpate"
MESHES = Path(__file__).resolve().parents[1] / "meshes"
# Few tetrahedra: a bake takes about a second, most of it the child process.
COARSE = 0.2
# The middle of a soft cube's top, and a place 5 mm inside.
TOP, DEEP = (0.0, 0.0, 0.02501), (0.0, 0.0, 0.02)
BESIDE, DEPTH = (0.002, 0.001, 0.02501), 0.004
_bodies: dict[tuple[tuple[float, float, float], str], Any] = {}


def part(name: str) -> ModuleType:
    """A module of the installed extension, such as `operators.session.press_state`."""
    return importlib.import_module(f"{MODULE}.{name}")


def select(thing: bpy.types.Object) -> bpy.types.Object:
    """Make an object the active one."""
    bpy.context.view_layer.objects.active = thing
    bpy.context.view_layer.update()
    return thing


def cube(edge: float = 0.05) -> bpy.types.Object:
    """A cube of this edge at the origin, its scale applied, settings for a quick bake; its eight
    vertices alone are drawn.
    """
    bpy.ops.mesh.primitive_cube_add(size=edge)
    thing = bpy.context.object
    thing.palpate.bake_from = "BASE"
    thing.palpate.edge_length = COARSE
    return select(thing)


def mesh_object(vertices: Any, faces: Any, name: str = "Thing") -> bpy.types.Object:
    """An object made of vertices and polygons."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(thing)
    thing.palpate.edge_length = COARSE
    return select(thing)


def soft_cube(edge: float = 0.05, pins: str = "BELOW") -> bpy.types.Object:
    """A cube with the body of stored tetrahedra, as Make Soft leaves it: the same in every run,
    which those of fTetWild are not.
    """
    thing = cube(edge)
    # Of which the figures of tests are, as of objects from before Real was what Make Soft chooses.
    thing.palpate.shape = "LINEAR"
    if pins != "BELOW":
        thing.palpate.pin_mode = pins
    soften(thing, (edge, edge, edge), pins)
    return thing


def soften(thing: bpy.types.Object, edges: tuple[float, float, float], pins: str) -> None:
    """Give a box at the origin, ``edges`` long, the body of the stored cube stretched so."""
    # As of objects from before smoothed elements were what Make Soft bakes.
    thing.palpate.formulation = "LINEAR"
    drawn = part("operators.scene.drawn_surface").read(thing, bpy.context.scene)
    if (edges, pins) not in _bodies:
        settings = part("operators.bake.bake_prediction").all_settings_of(thing, drawn)
        _bodies[edges, pins] = _baked(edges, settings, drawn.surface())
    body = _bodies[edges, pins]
    file = part("operators.object.body_store").place_for(thing, body.key)
    file.parent.mkdir(exist_ok=True)
    part("core.body.body_file").save(body, file)
    rule = part("operators.pins.pin_group").pin_rule(thing)
    fingerprint = drawn.fingerprint(rule, part("operators.pins.stiff_region").stiff_rule(thing))
    part("operators.object.baked_record").record(thing, body, file.name, fingerprint)
    thing.palpate.baked_edge_length = thing.palpate.edge_length
    thing.palpate.baked_epsilon = thing.palpate.epsilon


def _baked(edges: tuple[float, float, float], settings: Any, surface: Any) -> Any:
    """The body of a box with these edges at the origin, with settings of a bake."""
    with np.load(MESHES / "cube-500.npz") as stored:
        mesh = part("core.mesh.tet_mesh").TetMesh.checked(
            np.array(edges) * stored["X"], stored["T"]
        )
    return part("core.bake.steps").bake(mesh, settings, surface=surface)[0]


def press_down(thing: bpy.types.Object, top: float = 0.025, depth: float = 0.005) -> None:
    """Press the middle of the top of a cube at the origin and keep the shape."""
    select(thing)
    assert bpy.ops.palpate.press(at=(0.0, 0.0, top), by=(0.0, 0.0, -depth)) == {"FINISHED"}


def begin(
    sessions: ModuleType,
    states: ModuleType,
    thing: bpy.types.Object,
    source: str = "POINTER",
    *,
    pinch: bool = False,
) -> Any:
    """A running press, without the operator that listens to events."""
    return sessions.begin(thing, bpy.context.scene, states.Source[source], pinch=pinch)


def press_in(session: Any, states: ModuleType) -> None:
    """Touch the middle of the cube's top and go in, until the finger rests there."""
    session.post(states.SetDown(TOP))
    session.post(states.Move(DEEP))
    wait(session, lambda: session.snapshot.touching and session.snapshot.probe[2] < DEEP[2] + 1e-9)
    wait(session, lambda: unbraked(session.snapshot))


def unbraked(shot: Any) -> bool:
    """Whether the force is that of the nodes alone, without what brakes a moving finger."""
    return np.allclose(shot.contact_force, -shot.nodal_forces.sum(axis=0), rtol=1e-12, atol=0.0)


def wait(session: Any, condition: Callable[[], bool], seconds: float = 60.0) -> None:
    """Tick a running press, as Blender's timer does, until a condition holds."""
    end = time.monotonic() + seconds
    while True:
        session.tick()
        if condition():
            return
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.005)


def lead(session: Any, states: ModuleType, start: Sequence[float], by: Sequence[float]) -> None:
    """Set the finger down and lead it by a way, and wait until all is at rest."""
    at_rest(session, set_off(session, states, start, by))


def set_off(
    session: Any, states: ModuleType, start: Sequence[float], by: Sequence[float]
) -> tuple[float, ...]:
    """Set the finger down and have it go a way; where to."""
    session.post(states.SetDown(start, 0))
    session.tick()
    end = tuple(np.add(start, by))
    session.post(states.Move(end, 0))
    return end


def at_rest(session: Any, end: tuple[float, ...]) -> None:
    """Wait until the finger is there and nothing moves."""
    before: list[Any] = []

    def is_quiet():
        place, _ = session.loop.servo.snapshot().placement
        finger = session.loop.servo.snapshot().fingers[0]
        before.append(np.concatenate([place, finger.contact_force]))
        arrived = np.allclose(finger.probe, end, atol=1e-6)
        return arrived and len(before) > 20 and np.ptp(before[-20:], axis=0).max() < 1e-5

    wait(session, is_quiet)


def begin_pressed(sessions: ModuleType, states: ModuleType, thing: bpy.types.Object) -> Any:
    """A running press 4 mm into the cube's top, beside its middle, drawn and let go."""
    session = begin(sessions, states, thing)
    x, y, z = BESIDE
    session.post(states.SetDown(BESIDE))
    session.post(states.Move((x, y, z - DEPTH)))
    session.post(states.Moment.RELEASE)
    wait(session, lambda: session.seen.displacements is not None and depth(session) > 0.99 * DEPTH)
    return session


def depth(session: Any) -> float:
    """How deep the first finger is, metres."""
    finger = session.snapshot.fingers[0]
    return float(np.linalg.norm(finger.probe - finger.proxy))


def empty(name: str = "Empty", at: tuple[float, ...] = (0.0, 0.0, 0.1)) -> bpy.types.Object:
    """An Empty at a place."""
    thing = bpy.data.objects.new(name, None)
    bpy.context.collection.objects.link(thing)
    thing.location = at
    bpy.context.view_layer.update()
    return thing


def status(thing: bpy.types.Object) -> Any:
    """How an object's body fits it now."""
    return part("operators.object.soft_object").body_status(thing, bpy.context.scene)


def pose_by_bone(thing: bpy.types.Object, angle: float) -> bpy.types.Object:
    """Turn a whole object by a bone along Z, about X, radians; returns the armature."""
    armature = bpy.data.objects.new("Armature", bpy.data.armatures.new("Armature"))
    bpy.context.collection.objects.link(armature)
    armature.matrix_world = thing.matrix_world
    select(armature)
    bpy.ops.object.mode_set(mode="EDIT")
    bone = armature.data.edit_bones.new("Bone")
    bone.head, bone.tail = (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    group = thing.vertex_groups.new(name="Bone")
    group.add(range(len(thing.data.vertices)), 1.0, "REPLACE")
    modifier = thing.modifiers.new("Pose", "ARMATURE")
    modifier.object = armature
    armature.pose.bones["Bone"].rotation_mode = "XYZ"
    armature.pose.bones["Bone"].rotation_euler.x = angle
    select(thing)
    return armature


def locate(thing: bpy.types.Object) -> Any:
    """The path of an object's body file, None where it is missing."""
    return part("operators.object.body_store").locate(thing)


def body_of(thing: bpy.types.Object) -> Any:
    """The body in an object's body file."""
    return part("operators.object.body_store").load(thing)


def error_of(operator: Any, **arguments: Any) -> str:
    """The message with which an operator refuses."""
    try:
        operator(**arguments)
    except RuntimeError as refusal:
        return str(refusal)
    raise AssertionError("the operator did not refuse")


def mesh_state(thing: bpy.types.Object) -> dict[str, Any]:
    """Every coordinate, bit for bit, of the mesh and its shape keys, the active key, its vector
    attributes and all modifiers.
    """
    mesh = thing.data
    state: dict[str, Any] = {"mesh": _bytes(mesh.vertices), "active": thing.active_shape_key_index}
    vectors = [one.name for one in mesh.attributes if one.data_type == "FLOAT_VECTOR"]
    state["attributes"] = sorted(vectors)
    state["modifiers"] = [one.name for one in thing.modifiers if one.type == "NODES"]
    layers = part("operators.layer.layers")
    for layer in layers.layers_of(thing):
        state["layer", layer.name] = layers.displacement(thing, layer).tobytes()
    state["only"] = thing.show_only_shape_key
    state["marks"] = sorted(mesh.shape_keys.keys()) if mesh.shape_keys else None
    for key in mesh.shape_keys.key_blocks if mesh.shape_keys else ():
        state[key.name] = (_bytes(key.points), key.value, key.mute, key.relative_key.name)
    return state


def lying_state(thing: bpy.types.Object) -> tuple[Any, ...]:
    """The same with where an object lies, and whether that is remembered."""
    return mesh_state(thing), np.array(thing.matrix_world).tolist(), thing.palpate.is_laid


def key_names(thing: bpy.types.Object) -> list[str]:
    """Names of its shape keys."""
    return thing.data.shape_keys.key_blocks.keys() if thing.data.shape_keys else []


def key_coordinates(thing: bpy.types.Object, name: str) -> NDArray[np.float32]:
    """Coordinates (p, 3) of a shape key, local units."""
    points = thing.data.shape_keys.key_blocks[name].points
    return _flat(points).reshape(-1, 3)


def layer_names(thing: bpy.types.Object) -> list[str]:
    """Names of its layers, in their order."""
    return [layer.name for layer in part("operators.layer.layers").layers_of(thing)]


def hide_layers(thing: bpy.types.Object) -> None:
    """Let the next press find the object as it was."""
    for layer in part("operators.layer.layers").layers_of(thing):
        layer.show_viewport = False
    bpy.context.view_layer.update()


def moved(thing: bpy.types.Object, name: str) -> NDArray[np.float32]:
    """Displacements (p, 3) of a layer, local units."""
    return part("operators.layer.layers").displacement(thing, thing.modifiers[name])


def rest_places(thing: bpy.types.Object) -> NDArray[np.float32]:
    """Vertices (p, 3) of the base mesh, local units."""
    return _flat(thing.data.vertices).reshape(-1, 3)


def seen_places(thing: bpy.types.Object) -> NDArray[np.float32]:
    """Vertices (p, 3) as Blender evaluates them for the view, local units."""
    bpy.context.view_layer.update()
    graph = bpy.context.evaluated_depsgraph_get()
    return _flat(thing.evaluated_get(graph).data.vertices).reshape(-1, 3)


def sag(thing: bpy.types.Object) -> NDArray[np.float32]:
    """How far each vertex is displaced, (p, 3), local units."""
    bpy.context.view_layer.update()
    return seen_places(thing) - rest_places(thing)


def world_extents(thing: bpy.types.Object) -> NDArray[np.float64]:
    """Size of the mesh along the world's axes."""
    corners = np.array([thing.matrix_world @ vertex.co for vertex in thing.data.vertices])
    extents: NDArray[np.float64] = np.ptp(corners, axis=0)
    return extents


def _bytes(points: Any) -> bytes:
    return _flat(points).tobytes()


def _flat(points: Any) -> NDArray[np.float32]:
    flat = np.empty(3 * len(points), dtype=np.float32)
    points.foreach_get("co", flat)
    return flat


def said_by(act: str, given: dict[str, object]) -> str:
    """The message with which an operator refuses, empty where it does not."""
    try:
        getattr(bpy.ops.palpate, act)(**given)
    except RuntimeError as refusal:
        return str(refusal)
    return ""
