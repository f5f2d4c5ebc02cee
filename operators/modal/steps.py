# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""An operator that takes steps in a window, which is drawn in between, until Escape."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

import bpy

from ...curvrefl_addon.errors import InputError

TICK = 0.05
"""Seconds between two steps"""


class TakesSteps:
    """Of an operator: `begin` has steps taken, each of which has a `label` and the share `done` of all.

    Closing the steps has to put the scene back.
    """

    doing = "Working"
    """What the window says it does"""
    canceled = "Canceled"
    """What is reported after Escape"""

    def begin(self, context: bpy.types.Context, steps: Generator[Any, None, Any]) -> Any:
        """Go on in the window; what an operator returns then."""
        operator: Any = self
        manager = context.window_manager
        self._steps = steps
        self._timer = manager.event_timer_add(TICK, window=context.window)
        self._area = context.area
        self._is_announced = True
        manager.progress_begin(0, 100)
        manager.modal_handler_add(operator)
        self._announce(context, "Starting", 0.0)
        return {"RUNNING_MODAL"}

    def finish(self, context: bpy.types.Context, result: Any) -> None:
        """All steps are taken, and this is what they have returned."""
        raise NotImplementedError

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> Any:
        if event.type == "ESC" and event.value == "PRESS":
            # (the release may belong to a press before the start)
            return self._stop(context, self.canceled)
        if event.type != "TIMER":
            # The scene must not change meanwhile.
            return {"RUNNING_MODAL"}
        if not self._is_announced:
            # Blender draws between two timer events: what comes next is on screen before it blocks.
            self._is_announced = True
            return {"RUNNING_MODAL"}
        return self._take_step(context)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender itself ends the operator: the window closes."""
        self._steps.close()
        self._clear(context)

    def _take_step(self, context: bpy.types.Context) -> Any:
        from ...curvrefl_addon.renderer.device.context import GpuUnavailableError
        from ...curvrefl_addon.report.cycles_reference import RenderCanceledError

        try:
            step = next(self._steps)
        except StopIteration as end:
            self._clear(context)
            self.finish(context, end.value)
            return {"FINISHED"}
        except RenderCanceledError:
            return self._stop(context, self.canceled)
        except (InputError, GpuUnavailableError) as error:
            return self._stop(context, str(error), "ERROR")
        except BaseException:
            self._clear(context)
            raise
        self._announce(context, step.label, step.done)
        self._is_announced = False
        return {"RUNNING_MODAL"}

    def _stop(self, context: bpy.types.Context, message: str, kind: Any = "INFO") -> Any:
        """End before all steps are taken."""
        operator: Any = self
        self._steps.close()
        self._clear(context)
        operator.report({kind}, message)
        return {"CANCELLED"}

    def _announce(self, context: bpy.types.Context, label: str, done: float) -> None:
        context.window_manager.progress_update(100.0 * done)
        text = f"{self.doing}, {100.0 * done:.0f} %: {label} (Escape to cancel)"
        context.workspace.status_text_set(text)
        if self._area is not None:
            self._area.header_text_set(text)

    def _clear(self, context: bpy.types.Context) -> None:
        manager = context.window_manager
        manager.event_timer_remove(self._timer)
        manager.progress_end()
        context.workspace.status_text_set(None)
        if self._area is not None:
            self._area.header_text_set(None)
