# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Compare the open scene's reflections with Cycles and EEVEE."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from pathlib import Path
from typing import Any, Literal

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from ..curvrefl_addon.errors import InputError
from ..curvrefl_addon.optics.catalog import DEFAULT_COMPARED, METHODS
from ..curvrefl_addon.options import marked_mirrors
from ..curvrefl_addon.settings_table import LARGEST_SIDE, MOST_REFERENCE_SAMPLES
from .modal.steps import TakesSteps
from .paths import output_path

TEXT_NAME = "Curvrefl comparison"
_PEERS = (
    ("eevee", "EEVEE", "Blender's real-time engine"),
    ("cycles1", "Cycles, 1 Sample", "One path per pixel"),
    ("cycles8", "Cycles, 8 Samples", "Eight paths per pixel"),
    ("cycles64", "Cycles, 64 Samples", "Sixty-four paths per pixel"),
)


class CURVREFL_OT_compare_with_cycles(TakesSteps, bpy.types.Operator):
    """Render the camera's view by the chosen methods, by Cycles and by EEVEE, and report the errors and times"""

    bl_idname = "curvrefl.compare_with_cycles"
    bl_label = "Compare with Cycles"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    doing = "Comparing with Cycles"
    canceled = "Comparison canceled"

    reflectors: StringProperty(  # type: ignore[valid-type]
        name="Reflectors",
        description="Names of the mirrors, separated by commas; if empty the selected meshes, else all mirrors",
    )
    methods: EnumProperty(  # type: ignore[valid-type]
        name="Methods",
        description="What to compare",
        items=[(name, method.label, method.source) for name, method in METHODS.items()],
        options={"ENUM_FLAG"},
        default=set(DEFAULT_COMPARED),
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
        description="What the compared pictures are lit by",
        items=(
            ("direct", "Direct", "Lamps, emitters and the world, without bounces between diffuse surfaces"),
            ("full", "Full", "Cycles as the scene sets it"),
        ),
        default="full",
    )
    width: IntProperty(  # type: ignore[valid-type]
        name="Width", description="Of the compared pictures", default=640, min=1, max=LARGEST_SIDE, subtype="PIXEL"
    )
    height: IntProperty(  # type: ignore[valid-type]
        name="Height", description="Of the compared pictures", default=480, min=1, max=LARGEST_SIDE, subtype="PIXEL"
    )
    samples: IntProperty(  # type: ignore[valid-type]
        name="Samples", description="Of the reference in Cycles", default=128, min=1, max=MOST_REFERENCE_SAMPLES
    )
    every_setting: BoolProperty(  # type: ignore[valid-type]
        name="Every Setting",
        description="Measure each method at all values of the setting that trades speed for accuracy: a table of times "
        "and errors, and charts of it where matplotlib is installed, instead of pictures side by side",
        default=False,
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
        from ..curvrefl_addon.renderer.device.context import GpuUnavailableError
        from ..curvrefl_addon.report.compare import compare_open_scene
        from ..curvrefl_addon.report.cycles_reference import RenderCanceledError
        from ..curvrefl_addon.study.charts.chart import chart_open_scene

        scene, view_layer = context.scene, context.view_layer
        assert scene is not None and view_layer is not None
        try:
            output = output_path(self.output, "a folder for the report")
            measure = chart_open_scene if self.every_setting else compare_open_scene
            result = measure(scene, view_layer, self._reflector_names(context), self._comparison(), output)
        except (InputError, GpuUnavailableError, RenderCanceledError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self._show(context, result, output)
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> Any:
        from ..curvrefl_addon.report.compare import compare_steps
        from ..curvrefl_addon.study.charts.chart import open_scene_steps

        scene, view_layer = context.scene, context.view_layer
        assert scene is not None and view_layer is not None
        try:
            self._output = output_path(self.output, "a folder for the report")
            names = self._reflector_names(context)
            steps = open_scene_steps if self.every_setting else compare_steps
            taken = steps(scene, view_layer, names, self._comparison(), self._output)
        except InputError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return self.begin(context, taken)

    def finish(self, context: bpy.types.Context, result: Any) -> None:
        self._show(context, result, self._output)

    def _comparison(self) -> Any:
        from ..curvrefl_addon.report.compare import Comparison

        return Comparison(
            tuple(name for name in METHODS if name in self.methods),
            self.width,
            self.height,
            self.samples,
            self.light,
            tuple(name for name, *_ in _PEERS if name in self.peers),
        )

    def _show(self, context: bpy.types.Context, result: Any, output: Path) -> None:
        """`result`: of a comparison, or `Charts` with every setting."""
        from ..curvrefl_addon.report.table import format_table
        from ..curvrefl_addon.study.charts.chart_table import format_chart

        if self.every_setting:
            warnings = result.warnings
            _show_text(f"{format_chart(result)}\n\n{output / 'chart.csv'}\n")
        else:
            warnings = result.get("warnings", ())
            _show_pictures(context, result, output)
            _show_text(f"{format_table(result)}\n\n{output / 'report.html'}\n")
        for warning in warnings:
            self.report({"WARNING"}, warning)
        self.report({"INFO"}, f"The report is in {output} and in the text '{TEXT_NAME}'")

    def _reflector_names(self, context: bpy.types.Context) -> list[str]:
        names = [name.strip() for name in self.reflectors.split(",") if name.strip()]
        names = names or [obj.name for obj in context.selected_objects if obj.type == "MESH"]
        if not names and context.scene is not None:
            names = [mirror.name for mirror in marked_mirrors(context.scene)]
        if not names:
            raise InputError("No reflector: mark an object as a mirror, select a mesh, or name one.")
        return names


def _show_pictures(context: bpy.types.Context, report: dict[str, Any], output: Path) -> None:
    """Load the pictures of the report into images 'Curvrefl NAME', replacing those of the last time.

    Image editors that are open show the first method's.
    """
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

    shown = bpy.data.images[f"Curvrefl {next(iter(report['methods']))}"]
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR":
                area.spaces.active.image = shown


def _show_text(content: str) -> None:
    text = bpy.data.texts.get(TEXT_NAME) or bpy.data.texts.new(TEXT_NAME)
    text.clear()
    text.write(content)


CLASSES = (CURVREFL_OT_compare_with_cycles,)
