# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Compare the open scene's reflections with Cycles and EEVEE."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from pathlib import Path
from typing import Literal

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from ..curvrefl_addon.errors import InputError
from ..curvrefl_addon.optics.catalogue import METHODS

TEXT_NAME = "Curvrefl comparison"
_PEERS = (("eevee", "EEVEE", ""), ("cycles1", "Cycles, 1 Sample", ""), ("cycles8", "Cycles, 8 Samples", ""))


class CURVREFL_OT_compare_with_cycles(bpy.types.Operator):
    """Render the camera's view by the chosen methods, by Cycles and by EEVEE, and report the errors and times"""

    bl_idname = "curvrefl.compare_with_cycles"
    bl_label = "Compare with Cycles"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    reflectors: StringProperty(  # type: ignore[valid-type]
        name="Reflectors", description="Names of the mirrors, separated by commas; the selected meshes if empty"
    )
    methods: EnumProperty(  # type: ignore[valid-type]
        name="Methods",
        description="What to compare",
        items=[(name, method.label, method.source) for name, method in METHODS.items()],
        options={"ENUM_FLAG"},
        default=set(METHODS),
    )
    peers: EnumProperty(  # type: ignore[valid-type]
        name="Peers",
        description="Blender's own fast renderings to measure alike",
        items=_PEERS,
        options={"ENUM_FLAG"},
        default={"eevee"},
    )
    light: EnumProperty(  # type: ignore[valid-type]
        name="Light",
        items=(
            ("direct", "Direct", "Lamps, emitters and the world, without bounces between diffuse surfaces"),
            ("full", "Full", "Cycles as the scene sets it"),
        ),
        default="direct",
    )
    width: IntProperty(name="Width", default=640, min=1, max=8192, subtype="PIXEL")  # type: ignore[valid-type]
    height: IntProperty(name="Height", default=480, min=1, max=8192, subtype="PIXEL")  # type: ignore[valid-type]
    samples: IntProperty(  # type: ignore[valid-type]
        name="Samples", description="Of the reference in Cycles", default=128, min=1, max=65536
    )
    output: StringProperty(  # type: ignore[valid-type]
        name="Output", description="Folder of the report", subtype="DIR_PATH", default="//curvrefl_comparison"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.scene is None or context.scene.camera is None:
            cls.poll_message_set("The scene has no active camera")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        from ..curvrefl_addon.report.compare import Comparison, compare_open_scene
        from ..curvrefl_addon.report.table import format_table

        scene, view_layer = context.scene, context.view_layer
        assert scene is not None and view_layer is not None
        try:
            output = self._output_folder()
            report = compare_open_scene(
                scene,
                view_layer,
                self._reflector_names(context),
                Comparison(
                    tuple(name for name in METHODS if name in self.methods),
                    self.width,
                    self.height,
                    self.samples,
                    self.light,
                    tuple(name for name, *_ in _PEERS if name in self.peers),
                ),
                output,
            )
        except InputError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        _show_pictures(report, output)
        _show_text(f"{format_table(report)}\n\n{output / 'report.html'}\n")
        for warning in report.get("warnings", ()):
            self.report({"WARNING"}, warning)
        self.report({"INFO"}, f"The report is in {output} and in the text '{TEXT_NAME}'")
        return {"FINISHED"}

    def _reflector_names(self, context: bpy.types.Context) -> list[str]:
        names = [name.strip() for name in self.reflectors.split(",") if name.strip()]
        names = names or [obj.name for obj in context.selected_objects if obj.type == "MESH"]
        if not names:
            raise InputError("No reflector: select a mesh object or name one.")
        return names

    def _output_folder(self) -> Path:
        if not self.output:
            raise InputError("Choose a folder for the report.")
        if self.output.startswith("//") and not bpy.data.filepath:
            raise InputError("Save the file first, or choose a folder for the report that does not depend on it.")
        return Path(bpy.path.abspath(self.output))


def _show_pictures(report: dict, output: Path) -> None:
    """Load the pictures of the report into images 'Curvrefl NAME', replacing those of the last time."""
    methods = [name for method in report["methods"] for name in (method, f"{method}_error")]
    for name in ("reference", *methods, *report["peers"]):
        title = f"Curvrefl {name}"
        image = bpy.data.images.get(title)
        if image is None:
            image = bpy.data.images.load(str(output / f"{name}.png"))
            image.name = title
        else:
            image.filepath = str(output / f"{name}.png")
            image.reload()


def _show_text(content: str) -> None:
    text = bpy.data.texts.get(TEXT_NAME) or bpy.data.texts.new(TEXT_NAME)
    text.clear()
    text.write(content)


CLASSES = (CURVREFL_OT_compare_with_cycles,)
