# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension itself: disabled, or failed by its shaders, the GPU or its memory."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any
from unittest.mock import patch

import bpy
import gpu
from scripted import EXTENSION, extension
from situations.opened_file import CAUSED, SAMPLES, Steps, drawn, redraws, seen, situation


@situation
def disabled_while_drawing() -> Steps:
    before = drawn()
    bpy.context.scene.curvrefl.samples = 64
    yield lambda: drawn() > before
    bpy.ops.preferences.addon_disable(module=EXTENSION)
    try:
        seen["handlers after disable"] = [
            f"{name}: {function.__module__}"
            for name in dir(bpy.app.handlers)
            if isinstance(functions := getattr(bpy.app.handlers, name), list)
            for function in functions
            if EXTENSION in function.__module__
        ]
        seen["switch after disable"] = hasattr(bpy.context.window_manager, "curvrefl_enabled")
        yield from redraws()
    finally:
        bpy.ops.preferences.addon_enable(module=EXTENSION)
    seen["switch when enabled again"] = bpy.context.window_manager.curvrefl_enabled
    bpy.context.scene.curvrefl.samples = SAMPLES
    yield CAUSED


def fresh_shaders() -> None:
    """As in a new Blender: nothing compiled, no file read."""
    bpy.context.window_manager.curvrefl_enabled = False
    extension("curvrefl_addon.gpu_caches").clear_gpu_caches()
    for module in [module for name, module in sys.modules.items() if name.startswith(EXTENSION)]:
        for value in list(vars(module).values()):
            if callable(clear := getattr(value, "cache_clear", None)):
                clear()


@situation
def shader_compile_failure() -> Steps:
    fresh_shaders()
    installed = Path(extension("gpu_shaders.loader").__file__).parent
    sources = {path: path.read_bytes() for path in installed.rglob("*.glsl")}
    assert sources
    try:
        for path in sources:
            path.write_text("This is not a shader.\n", encoding="utf-8")
        bpy.context.window_manager.curvrefl_enabled = True
        yield CAUSED
    finally:
        for path, source in sources.items():
            path.write_bytes(source)
    fresh_shaders()


def failing(*_arguments: Any, **_named: Any) -> None:
    raise SystemError("GPU error")


@situation
def no_compute_support() -> Steps:
    bpy.context.window_manager.curvrefl_enabled = False
    with (
        patch.object(gpu.compute, "dispatch", failing),
        patch.object(gpu.capabilities, "compute_shader_support_get", lambda: False),
    ):
        bpy.context.window_manager.curvrefl_enabled = True
        yield CAUSED


@situation
def gpu_memory_exhausted() -> Steps:
    bpy.context.window_manager.curvrefl_enabled = False
    texture = gpu.types.GPUTexture
    calls = 0

    def exhausted(*arguments: Any, **named: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls > 4:
            # Blender's own words
            raise RuntimeError("gpu.texture.new(...) failed with ''")
        return texture(*arguments, **named)

    with patch.object(gpu.types, "GPUTexture", exhausted):
        bpy.context.window_manager.curvrefl_enabled = True
        yield CAUSED
