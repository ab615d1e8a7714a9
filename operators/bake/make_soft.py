"""Make Soft: bake the selected mesh into a body that can be pressed."""

import bpy

from ...core.bake.steps import BakeReport
from ...core.body.soft_body import SoftBody
from ...core.errors import CancelledError, PalpateError
from ...core.sentence import Sentence
from ...core.softness.scales.for_size import material_for
from ...core.softness.scales.materials import MATERIALS
from ..lying.free_body import get_ready
from ..object import soft_object
from ..object.drawn_body import open_body
from ..reporting.acting import Acting
from ..reporting.translated import reported, shown
from ..reporting.wait_cursor import wait_cursor
from ..scene.drawn_surface import metres_per_unit
from ..scene.modal_progress import ModalProgress
from ..session import press_session
from . import bake_session, bake_words
from .bake_session import BakeSession

POLLS_PER_SECOND = 10
AS_SET = "AS_SET"


class BakingOperator(Acting):
    """Base of Make Soft and Rebuild Body: a bake in the background, or waited for."""

    rebuild = False
    _session: BakeSession
    _progress: ModalProgress

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        if bake_session.current() is not None:
            return "A bake is running; wait for it or cancel it"
        return press_session.refusal() or soft_object.refusal(context.object)

    def act(self, context: bpy.types.Context) -> None:
        body, report = bake_session.run(context.object, context.scene, rebuild=self.rebuild)
        self._tell(context.object.name, body, report)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if bpy.app.background:
            return self.execute(context)
        return self.guarded(lambda: self._start(context))

    def _start(self, context: bpy.types.Context) -> set[str]:
        thing = context.object
        # A large mesh takes a second to read.
        with wait_cursor(context):
            self._begin(thing, context.scene)
        self._progress = ModalProgress()
        self._progress.begin(self, context, 1 / POLLS_PER_SECOND)
        self._show(context)
        return {"RUNNING_MODAL"}

    def _begin(self, thing: bpy.types.Object, scene: bpy.types.Scene) -> None:
        self._session = bake_session.start(thing, scene, rebuild=self.rebuild, by_hand=True)
        if self._session.pins_told is not None:
            self.report({"INFO"}, reported(self._session.pins_told))

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        try:
            return self._follow(context, event)
        except PalpateError as problem:
            self._progress.end(context)
            level = "INFO" if isinstance(problem, CancelledError) else "ERROR"
            self.report({level}, reported(problem))
            return {"CANCELLED"}
        except BaseException:
            # A bug must not leave a child process, a timer and a status line.
            self.cancel(context)
            raise

    def _follow(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "ESC" and event.value == "PRESS":
            self._session.end()
        if event.type not in {"TIMER", "ESC"}:
            return {"PASS_THROUGH"}
        finished = self._session.poll()
        self._show(context, waiting=finished)
        if not finished or not self._session.can_commit:
            return {"PASS_THROUGH"}
        body, report = self._session.commit()
        self._progress.end(context)
        self._tell(self._session.handle.name, body, report)
        self._get_ready(context.scene)
        return {"FINISHED"}

    def _get_ready(self, scene: bpy.types.Scene) -> None:
        """Have the first touch wait for less."""
        thing = self._session.handle.find()
        if thing is None:
            return
        try:
            drawn = open_body(thing, scene)
        except PalpateError:
            # It was changed meanwhile: the panel says so, and who touches it.
            return
        get_ready(thing, drawn)

    def cancel(self, context: bpy.types.Context) -> None:
        """End with the operator: another file, or exit."""
        self._session.end()
        self._progress.end(context)

    def _show(self, context: bpy.types.Context, *, waiting: bool = False) -> None:
        progress = self._session.progress
        text = f"{shown(progress.text)}, {bake_words.how_far(progress)}"
        if waiting:
            text = shown(self._awaited)
        elif self._session.preview_off:
            text = f"{bake_words.previewed(self._session.preview_off)}   {text}"
        text = f"{self._session.handle.name}: {text}"
        self._progress.show(context, text, progress.share or 0.0)

    @property
    def _awaited(self) -> str:
        if self._session.awaits_mode:
            return bake_words.AWAITS_MODE
        if self._session.awaits_scene:
            return bake_words.AWAITS_SCENE
        return bake_words.AWAITS_PRESS

    def _tell(self, name: str, body: SoftBody, report: BakeReport) -> None:
        for warning in report.warnings:
            self.report({"WARNING"}, reported(warning))
        self.report(
            {"INFO"},
            reported(
                "{name} is soft: {nodes} nodes, {seconds:.1f} s",
                name=name,
                nodes=len(body.mesh.nodes),
                seconds=sum(report.seconds.values()),
            ),
        )


class PALPATE_OT_make_soft(BakingOperator, bpy.types.Operator):
    bl_idname = "palpate.make_soft"
    bl_label = "Make Soft"
    bl_description = (
        "Fill the mesh with tetrahedra and compute how it gives way; "
        "the mesh itself stays as it is. Escape cancels"
    )
    bl_options = {"UNDO"}

    material: bpy.props.EnumProperty(
        name="Material",
        description="What the object is made of",
        items=[
            (AS_SET, "As Set", "As the object's material is set"),
            *((key, one.name, "") for key, one in MATERIALS.items()),
        ],
        options={"SKIP_SAVE"},
    )

    def act(self, context: bpy.types.Context) -> None:
        self._choose(context.object)
        super().act(context)

    def _start(self, context: bpy.types.Context) -> set[str]:
        self._choose(context.object)
        self._tell_material(context.object, suit_to_size(context.object, context.scene))
        return super()._start(context)

    def _choose(self, thing: bpy.types.Object) -> None:
        if self.material != AS_SET:
            thing.palpate.material = self.material

    def _tell_material(self, thing: bpy.types.Object, size: float | None) -> None:
        if size is not None:
            self.report(
                {"INFO"},
                reported(
                    "{name} measures {size:.2g} m, which {material} suits. "
                    "Material chooses otherwise",
                    name=thing.name,
                    size=size,
                    material=Sentence(MATERIALS[thing.palpate.material].name),
                ),
            )


def suited(thing: bpy.types.Object, scene: bpy.types.Scene) -> str | None:
    """The material that Make Soft chooses by an object's size: where nobody has said what it is
    made of, and it has no body yet. None elsewhere.
    """
    settings = thing.palpate
    said = ("material", "young_modulus", "poisson_ratio")
    if settings.body_key or any(map(settings.is_property_set, said)):
        return None
    return material_for(metres_per_unit(scene) * float(thing.dimensions.length))


def suit_to_size(thing: bpy.types.Object, scene: bpy.types.Scene) -> float | None:
    """Choose the material of an object without a body by its size, where nobody has said what it is
    made of; returns the size, metres, or None where nothing was changed.
    """
    settings, suits = thing.palpate, suited(thing, scene)
    if suits is None or suits == settings.material:
        return None
    settings.material = suits
    return metres_per_unit(scene) * float(thing.dimensions.length)


classes = (PALPATE_OT_make_soft,)
