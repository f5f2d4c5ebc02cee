# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""What a bug report needs of the device, in the clipboard."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from typing import Literal

import bpy


class CURVREFL_OT_copy_report(bpy.types.Operator):
    """Prove that this device computes what it should, and copy the outcome with device, driver and limits: the text
    that a bug report needs"""

    bl_idname = "curvrefl.copy_report"
    bl_label = "Copy Report"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        from ..curvrefl_addon.renderer.device.context import GpuUnavailableError, require_gpu
        from ..curvrefl_addon.renderer.proofs.report import device_report, summary
        from ..curvrefl_addon.viewport.device_run import prove_now

        try:
            require_gpu()
        except GpuUnavailableError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        proving = prove_now()
        assert context.window_manager is not None
        context.window_manager.clipboard = device_report(proving)
        self.report({"INFO"}, f"The report is in the clipboard: {summary(proving.verdict)}")
        return {"FINISHED"}


CLASSES = (CURVREFL_OT_copy_report,)
