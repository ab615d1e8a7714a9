"""The rules of the house: which room may import which, and how much a room and a file may hold."""

from __future__ import annotations

# layer: which layers it may import besides itself
LAYERS = {
    "__init__": {"addon", "operators"},
    "addon": {"operators", "simulated", "core"},
    "operators": {"simulated", "core"},
    "cli": {"simulated", "core"},
    "simulated": {"core"},
    "core": set(),
}

# A file imports from its own room and from rooms before it here. Each word is a folder or a single
# file; the longest that fits a file is its room.
ROOMS_OF_PYTHON = """
core/sentence.py core/errors.py core/progress.py core/quantities.py
core/machine
core/files/windows core/files
core/mesh/formats core/mesh
core/law
core/stiffness
core/compliance/ordering core/compliance/free_body core/compliance/elimination
core/compliance/compression core/compliance
core/body
core/contact/near_field core/contact/tool core/contact
core/rest
core/pile
core/fold
core/grip
core/shape/solid core/shape/paper core/shape/lattice core/shape/rotation_strain core/shape
core/bake/settings.py core/bake/cost core/bake/preview core/bake
core/servo/link core/servo
core/record
core/imprint
core/softness/scales core/softness
core
simulated/wire simulated/hand simulated/board simulated
simulated/attack/table.py simulated/attack/target.py
simulated/attack/virtual simulated/attack/real/line simulated/attack/real simulated/attack/port
simulated/attack
operators/reporting
operators/scene
operators/layer
operators/kept
operators/place
operators/carrier
operators/pins
operators/object
operators/traction
operators/imprint
operators/played
operators/tool
operators/device
operators/record
operators/shape
operators/lying operators/lying/pressed
operators/session
operators/rest
operators/bake
operators/press
operators/stroke/answer operators/stroke
operators/animation/frames operators/animation
operators/softness
operators
addon/translations addon/known_status.py
addon/properties
addon/overlay
addon/inspection
addon/panels
addon/toolbar
addon
cli/body cli/scene cli/rest cli/press cli/softness cli/bake cli
""".split()  # noqa: SIM905 - a level of the house is a line

ROOMS_OF_RUST = """
algebra
body/compliance body
fold
drawn
clock
guardian
device/serial device device/link device/haply
control
creep
contact
proxy
tool
fingers
engine
rest
pile
servo
solid
harness
python/vectors.rs python/servo/settings.rs python/body python/device python/tool python/rest
python/pile.rs python/fold.rs python/servo python/harness python
lib.rs
""".split()  # noqa: SIM905 - a level of the house is a line

MOST_FILES = 12
MOST_LINES = 300
MOST_LINES_OF_TESTS = 400

# What does not keep the rules yet, by what a violation begins with: shorter with every change,
# until it is empty.
KNOWN: tuple[str, ...] = ()
