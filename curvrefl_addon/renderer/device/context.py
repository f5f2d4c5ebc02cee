# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The GPU itself: whether there is one, what it is called and what it can hold, and who draws with it.

A shader holds its constants between two draws, and a batch belongs to the context that drew it last. In a window
Blender renders in a thread and a context of its own while the viewports draw in the main thread: each has its own.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import cache, wraps
from typing import Any

import gpu

from .probe import headless_gpu_fails


class GpuUnavailableError(RuntimeError):
    """No GL context can be had; the message says how to get one."""


def require_gpu() -> None:
    """Make sure that a GPU context is there, also in background.

    Raises GpuUnavailableError with one sentence for the user.
    """
    import bpy

    if not bpy.app.background:
        # (Blender asks for them itself. What has them and gets them wrong goes another way: `device/ways`.)
        if not gpu.capabilities.compute_shader_support_get():
            raise GpuUnavailableError("the graphics driver has no compute shaders: update it")
        return
    reason = _why_no_headless_gpu()
    if not reason:
        try:
            gpu.init()
        except SystemError as error:
            reason = str(error)
    if reason:
        raise GpuUnavailableError(
            f"no OpenGL 4.3 context could be made ({reason}): install a GPU driver with EGL or Mesa's software "
            "renderer (Debian: libgl1 libegl1 libgl1-mesa-dri)"
        )


@cache
def _why_no_headless_gpu() -> str:
    """Asked once: later the context is there, or will not come."""
    return headless_gpu_fails()


def gpu_cache(make: Callable[..., Any]) -> Callable[..., Any]:
    """`functools.cache` for shaders and batches; one render at a time may run beside the main thread."""
    of_main, of_render = cache(make), cache(make)

    @wraps(make)
    def kept(*arguments: Any) -> Any:
        return (of_main if threading.current_thread() is threading.main_thread() else of_render)(*arguments)

    def clear() -> None:
        of_main.cache_clear()
        of_render.cache_clear()

    kept.cache_clear = clear  # type: ignore[attr-defined]
    kept.caches = (of_main, of_render)  # type: ignore[attr-defined]
    return kept


def renderer_name() -> str:
    """What the driver calls the GPU."""
    return gpu.platform.renderer_get()


def backend_name() -> str:
    """The graphics interface that Blender uses: OPENGL, VULKAN or METAL."""
    return gpu.platform.backend_type_get()


def is_software_opengl() -> bool:
    """Whether the processor draws, by Mesa's OpenGL."""
    return backend_name() == "OPENGL" and renderer_name().startswith(("llvmpipe", "softpipe"))


def platform_facts() -> dict[str, str]:
    """Of GPU, driver, and the graphics interface that Blender uses."""
    return {
        "renderer": renderer_name(),
        "vendor": gpu.platform.vendor_get(),
        "version": gpu.platform.version_get(),
        "backend": backend_name(),
        "kind": gpu.platform.device_type_get(),
    }


def device_limits() -> dict[str, int]:
    """Greatest numbers of what passes use, by what they are called in a report."""
    capabilities = gpu.capabilities
    return {
        "texels along a side": capabilities.max_texture_size_get(),
        "layers": capabilities.max_texture_layers_get(),
        "textures": capabilities.max_textures_get(),
        "textures of a fragment": capabilities.max_textures_frag_get(),
        "images": capabilities.max_images_get(),
        "groups of a dispatch": capabilities.max_work_group_count_get(0),
        "invocations of a group": capabilities.max_work_group_size_get(0),
    }


def most_texels() -> int:
    """Greatest width and height of a texture."""
    return gpu.capabilities.max_texture_size_get()
