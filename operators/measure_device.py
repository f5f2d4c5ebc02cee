# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Find out what this device is fast at, for the method Automatic, or forget it."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from collections.abc import Callable
from typing import Literal

import bpy


class CURVREFL_OT_measure_device(bpy.types.Operator):
    """Measure what rays, reflection points and triangles cost on this device, which takes about two seconds, and keep
    it: Automatic chooses by it"""

    bl_idname = "curvrefl.measure_device"
    bl_label = "Measure This Device"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    def execute(self, _context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        from ..curvrefl_addon.viewport import device_run

        return _answer(self, device_run.measure_now)


class CURVREFL_OT_forget_device(bpy.types.Operator):
    """Forget what was measured of this device: Automatic chooses by the costs that come with the extension"""

    bl_idname = "curvrefl.forget_device"
    bl_label = "Forget This Device"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    def execute(self, _context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        from ..curvrefl_addon.viewport import device_run

        return _answer(self, device_run.forget_device)


def _answer(operator: bpy.types.Operator, act: Callable[[], str]) -> set[Literal["CANCELLED", "FINISHED"]]:
    from ..curvrefl_addon.renderer.device.context import GpuUnavailableError

    try:
        problem = act()
    except GpuUnavailableError as error:
        operator.report({"ERROR"}, str(error))
        return {"CANCELLED"}
    if problem:
        operator.report({"WARNING"}, problem)
    return {"FINISHED"}


CLASSES = (CURVREFL_OT_measure_device, CURVREFL_OT_forget_device)
