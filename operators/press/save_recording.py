"""Save Recording: to CSV or npz; also during the press."""

from pathlib import Path

import bpy

from ...core.errors import PalpateError
from ...core.record.recording import SUFFIXES
from ..record import recording, recording_writer
from ..record.recording import Kept, Recorder
from ..reporting.acting import Acting
from ..reporting.translated import reported
from ..session import press_session

FORMAT_ITEMS = [
    (".csv", "CSV", "A table for spreadsheets and most other programs"),
    (".npz", "npz", "Arrays for numpy; smaller, and written at once"),
]
DEFAULT_NAME = "recording"
NOTHING = "Nothing is recorded yet; tick Record from Start under Device > Recording, and press"


def _recorder() -> Recorder | None:
    """Recorder of the running press, if it records or has recorded."""
    session = press_session.current()
    loop = session.loop if session is not None else None
    return loop.recorder if loop is not None and loop.recorder.wanted else None


def refusal_unrecorded() -> str:
    """Reason why there is no recording; empty if there is one, which is not copied."""
    return NOTHING if _recorder() is None and recording.last() is None else ""


def recorded() -> Kept:
    """Recording that can be saved now.

    Raises
    ------
    PalpateError
        There is none.
    """
    recorder = _recorder()
    kept = recording.last() if recorder is None else recorder.kept()
    if kept is None:
        raise PalpateError(NOTHING)
    return kept


class PALPATE_OT_save_recording(Acting, bpy.types.Operator):
    bl_idname = "palpate.save_recording"
    bl_label = "Save Recording..."
    bl_description = "Write the recorded ticks to a file, also while pressing goes on"

    filepath: bpy.props.StringProperty(
        subtype="FILE_PATH", options={"HIDDEN", "SKIP_SAVE", "PATH_SUPPORTS_BLEND_RELATIVE"}
    )
    filter_glob: bpy.props.StringProperty(default="*.csv;*.npz", options={"HIDDEN"})
    check_existing: bpy.props.BoolProperty(default=True, options={"HIDDEN"})
    suffix: bpy.props.EnumProperty(
        name="Format", description="How the file is written", items=FORMAT_ITEMS, default=".csv"
    )

    # With a file browser there is a window, which must not freeze.
    _in_window = False

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        reason = refusal_unrecorded()
        if not reason and recording_writer.going_on():
            reason = "A recording is being written; wait until it is done"
        return reason

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        beside = Path(bpy.data.filepath).parent if bpy.data.filepath else Path.home()
        self.filepath = str(beside / f"{DEFAULT_NAME}{self.suffix}")
        self._in_window = not bpy.app.background
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def check(self, context: bpy.types.Context) -> bool:
        """Adapt the file browser's name to the format."""
        path = Path(self.filepath)
        if path.suffix.lower() == self.suffix or not path.name:
            return False
        stem = path.stem if path.suffix.lower() in SUFFIXES else path.name
        self.filepath = str(path.with_name(stem + self.suffix))
        return True

    def act(self, context: bpy.types.Context) -> None:
        kept = recorded()
        path = Path(bpy.path.abspath(self.filepath))
        if self._in_window:
            recording_writer.begin(path, kept)
            return
        recording.write(path, kept)
        self.report(
            {"INFO"},
            reported(
                "{ticks:,} ticks ({seconds:.1f} s) saved to {path}",
                ticks=len(kept.samples),
                seconds=len(kept.samples) / kept.rate_hz,
                path=path,
            ),
        )


classes = (PALPATE_OT_save_recording,)
