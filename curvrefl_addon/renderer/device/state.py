# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The fixed-function state, which is Blender's too: whatever is set is put back."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import gpu


@contextmanager
def drawing_state(
    depth_test: str = "NONE", depth_write: bool = False, blend: str = "NONE", mirrored: bool = False
) -> Iterator[None]:
    """Set the fixed-function state and put Blender's default back, also after an error.

    In a `mirrored` picture triangles run the other way round: what is a front face stays one.
    """
    gpu.state.depth_test_set(depth_test)
    gpu.state.depth_mask_set(depth_write)
    gpu.state.blend_set(blend)
    gpu.state.face_culling_set("NONE")
    gpu.state.front_facing_set(mirrored)
    try:
        yield
    finally:
        gpu.state.depth_test_set("NONE")
        gpu.state.depth_mask_set(False)
        gpu.state.blend_set("NONE")
        gpu.state.face_culling_set("NONE")
        gpu.state.front_facing_set(False)


@contextmanager
def kept_state() -> Iterator[None]:
    """Have the state that Blender's handlers may have set as it was, also after an error: blending, depth, viewport."""
    blend, depth_test = gpu.state.blend_get(), gpu.state.depth_test_get()
    depth_write, window = gpu.state.depth_mask_get(), gpu.state.viewport_get()
    try:
        yield
    finally:
        gpu.state.blend_set(blend)
        gpu.state.depth_test_set(depth_test)
        gpu.state.depth_mask_set(depth_write)
        gpu.state.viewport_set(*window)


@contextmanager
def scissored(window: tuple[int, int, int, int] | None) -> Iterator[None]:
    """Draw only inside the window (x, y, width, height) of the frame buffer that is bound now, or all of it.

    The scissor belongs to the frame buffer: set before it is bound it would be another one's.
    """
    if window is None:
        yield
        return
    gpu.state.scissor_set(*window)
    gpu.state.scissor_test_set(True)
    try:
        yield
    finally:
        gpu.state.scissor_test_set(False)


@contextmanager
def blended(blend: str) -> Iterator[None]:
    """Blend so, and then as by default: where nothing else of the state is ours to set."""
    gpu.state.blend_set(blend)
    try:
        yield
    finally:
        gpu.state.blend_set("NONE")


@contextmanager
def points_sized_by_shader() -> Iterator[None]:
    """Let vertex shaders say how large points are."""
    gpu.state.program_point_size_set(True)
    try:
        yield
    finally:
        gpu.state.program_point_size_set(False)


def set_viewport(x: int, y: int, width: int, height: int) -> None:
    """Draw to these pixels of the frame buffer that is bound now."""
    gpu.state.viewport_set(x, y, width, height)


def viewport() -> tuple[int, int, int, int]:
    """x, y, width and height of the pixels that are drawn to now."""
    return gpu.state.viewport_get()


def hide_faces(side: str) -> None:
    """Leave out a side of triangles: 'BACK', 'FRONT' or 'NONE'; inside of `drawing_state`."""
    gpu.state.face_culling_set(side)


def write_depth_again() -> None:
    """What Blender's own handlers before and after ours take for granted."""
    gpu.state.depth_mask_set(True)
