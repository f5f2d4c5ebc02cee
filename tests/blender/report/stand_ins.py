# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Renderers that are right or wrong by construction, and a comparison of one of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.report.compare import compare_blend
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.report.geometry_reference import render_geometry
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.camera.shutter import Moment
from curvrefl.curvrefl_addon.scene.camera.view import View

WIDTH, HEIGHT, SAMPLES = 64, 48, 4
SOLVE = {
    "vertices": 8,
    "reflected": 5,
    "hidden": 3,
    "unconverged": 0,
    "iterations": {"mean": 4.5, "p99": 9.0, "max": 11.0},
}


class CyclesFrame:
    """What Cycles itself shows, as a renderer's frame: by construction without error."""

    warnings = ("A warning <of the renderer>.",)
    solve = SOLVE

    def __init__(self, scene: SceneArrays, frame_ms: float) -> None:
        blender_scene, view_layer = bpy.context.scene, bpy.context.view_layer
        ids = {instance.object_name: instance.object_id for instance in scene.instances}
        self._geometry = render_geometry(blender_scene, view_layer, WIDTH, HEIGHT, ids, scene.reflectors)
        self._color = render_reference(blender_scene, view_layer, WIDTH, HEIGHT, SAMPLES).pixels
        self.choice = self.convergence = None
        self.bounced_light = ""
        self.times_ms = {"bake": 7.0, "solve": 1.0, "draw": frame_ms - 1.0, "frame": frame_ms}

    def color(self) -> np.ndarray:
        return self._color

    def mask(self) -> np.ndarray:
        return self._geometry.mask

    def reflected_position(self) -> np.ndarray:
        return self._geometry.reflected_position

    def reflected_object(self) -> np.ndarray:
        return self._geometry.reflected_object


class CyclesRenderer:
    """Stands in for the renderer; its frames take 1000 (shaders compile), then 30, 10, 20 ms."""

    frame_type: type[CyclesFrame] = CyclesFrame
    freed = 0

    def __init__(self, scene: SceneArrays, _method: str) -> None:
        self._scene = scene
        self._times = iter((1000.0, 30.0, 10.0, 20.0))

    def settle(self) -> None:
        pass

    def render(self, view: View, *, moments: Sequence[Moment] = ()) -> CyclesFrame:
        assert not moments
        assert (view.width, view.height) == (WIDTH, HEIGHT)
        return self.frame_type(self._scene, next(self._times))

    def free(self) -> None:
        type(self).freed += 1


class BlackFrame(CyclesFrame):
    """Sees the reflector and shows a black background straight up in it."""

    warnings = ()

    def color(self) -> np.ndarray:
        return np.zeros_like(self._color)

    def reflected_position(self) -> np.ndarray:
        up = np.zeros_like(self._geometry.reflected_position)
        up[..., 2] = 1.0
        return up

    def reflected_object(self) -> np.ndarray:
        return np.zeros_like(self._geometry.reflected_object)


class BlackRenderer(CyclesRenderer):
    frame_type = BlackFrame


class FailingRenderer(CyclesRenderer):
    def render(self, view: View, *, moments: Sequence[Moment] = ()) -> CyclesFrame:
        assert not moments
        raise RuntimeError("the renderer broke down")


def run(
    blend: Path, output: Path, make_renderer: Callable[..., Any] = CyclesRenderer, **changes: Any
) -> dict[str, Any]:
    arguments: dict[str, Any] = {
        "reflector_names": ["ball"],
        "methods": ["secant_star"],
        "width": WIDTH,
        "height": HEIGHT,
        "samples": SAMPLES,
        "light": "direct",
        "peers": ["cycles1"],
    }
    return compare_blend(blend, output=output, make_renderer=make_renderer, **{**arguments, **changes})


class PickyRenderer(CyclesRenderer):
    """Refuses the reflector for some methods."""

    refused = ("secant_uv", "planar")

    def __init__(self, scene: SceneArrays, method: str) -> None:
        if method in self.refused:
            raise InputError(f"Not by {method}.")
        super().__init__(scene, method)
