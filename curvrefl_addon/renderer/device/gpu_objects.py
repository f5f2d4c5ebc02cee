# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Thin helpers over Blender's `gpu` module: textures from numpy, read-back, uniform blocks, full-screen passes.

Nothing here is created at import. Blender 5.2's traps that these helpers steer round: cube maps are filled face by
face (uploading one fills all faces with the first on OpenGL), read-back of a cube goes through a frame buffer,
matrices are transposed in uniform blocks, buffers must be contiguous float32, sampling is linear unless told.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

import gpu
import numpy as np

from ....gpu_shaders.loader import load
from ...scene.arrays import Float32Array
from .probe import headless_gpu_fails

TEXTURE_WIDTH = 2048
"""Width of the 2D textures that hold per-vertex records (there are no storage buffers)."""

MOST_GROUPS = 1 << 15


class GpuUnavailableError(RuntimeError):
    """No GL context can be had; the message says how to get one."""


def require_gpu() -> None:
    """Make sure that a GPU context is there, also in background.

    Raises GpuUnavailableError with one sentence for the user.
    """
    import bpy

    if not bpy.app.background:
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


def buffer_of(array: np.ndarray) -> Any:
    """Zero-copy `gpu.types.Buffer` of a float array; keep the array alive while it is used."""
    flat = np.ascontiguousarray(array, np.float32).ravel()
    return gpu.types.Buffer("FLOAT", flat.size, flat)


def texture_2d(array: np.ndarray, fmt: str = "RGBA32F", linear: bool = False, repeat: bool = False) -> Any:
    """Texture of a (height, width, channels) float array, row 0 at t = 0."""
    height, width = array.shape[:2]
    texture = gpu.types.GPUTexture((width, height), format=fmt, data=buffer_of(array))
    texture.filter_mode(linear)
    texture.extend_mode("REPEAT" if repeat else "EXTEND")
    return texture


def record_texture(records: np.ndarray) -> Any:
    """RGBA32F texture, TEXTURE_WIDTH wide, of (n, 4) records; record i is at (i % width, i / width)."""
    count = padded_count(len(records))
    if count != len(records):
        padded = np.empty((count, 4), np.float32)
        padded[: len(records)] = records
        padded[len(records) :] = 0.0
        records = padded
    return texture_2d(records.reshape(-1, TEXTURE_WIDTH, 4))


def padded_count(count: int) -> int:
    """Records in the whole rows that hold so many, at least one row."""
    return max(-(-count // TEXTURE_WIDTH), 1) * TEXTURE_WIDTH


def empty_record_texture(count: int) -> Any:
    """As `record_texture`, unfilled, to be written by a compute shader."""
    rows = max(-(-count // TEXTURE_WIDTH), 1)
    texture = gpu.types.GPUTexture((TEXTURE_WIDTH, rows), format="RGBA32F")
    texture.filter_mode(False)
    return texture


def empty_index_texture(count: int) -> Any:
    """R32UI texture, TEXTURE_WIDTH wide, of so many numbers, to be written by a compute shader."""
    return gpu.types.GPUTexture((TEXTURE_WIDTH, max(-(-count // TEXTURE_WIDTH), 1)), format="R32UI")


def dispatch(shader: Any, count: int, group: int) -> None:
    """Run a bound compute shader for at least `count` invocations in groups of (group, 1, 1).

    Drivers need not take more than 65,535 groups along an axis: invocation i is at (i % width, i / width), with the
    width of a row of groups (`invocation.glsl`).
    """
    groups = max(-(-count // group), 1)
    rows = -(-groups // MOST_GROUPS)
    gpu.compute.dispatch(shader, -(-groups // rows), rows, 1)


def read_texture(texture: Any, channels: int = 4) -> Float32Array:
    """(height, width, channels) float32 copy; waits for the GPU."""
    buffer = texture.read()
    buffer.dimensions = texture.width * texture.height * channels
    return np.array(buffer, np.float32).reshape(texture.height, texture.width, channels)


def read_records(texture: Any, count: int) -> Float32Array:
    """(count, 4) records of a record texture; waits for the GPU."""
    return read_texture(texture).reshape(-1, 4)[:count]


def uniform_block(struct: np.ndarray) -> Any:
    """GPUUniformBuf of a one-element numpy structured array (std140 by the caller; matrices transposed)."""
    assert struct.nbytes % 16 == 0, "std140 blocks are padded to vec4"
    return gpu.types.GPUUniformBuf(struct)


@cache
def full_screen_triangle() -> Any:
    """Batch with one attribute `pos` (vec2) that covers the whole target."""
    layout = gpu.types.GPUVertFormat()
    layout.attr_add(id="pos", comp_type="F32", len=2, fetch_mode="FLOAT")
    vertices = gpu.types.GPUVertBuf(format=layout, len=3)
    vertices.attr_fill("pos", np.array([[-1, -1], [3, -1], [-1, 3]], np.float32))
    return gpu.types.GPUBatch(type="TRIS", buf=vertices)


def indexed_batch(triangles: np.ndarray) -> Any:
    """Attribute-less batch of (n, 3) indices; the vertex shader fetches its record by gl_VertexID."""
    vertices = gpu.types.GPUVertBuf(format=gpu.types.GPUVertFormat(), len=int(triangles.max()) + 1)
    elements = gpu.types.GPUIndexBuf(type="TRIS", seq=np.ascontiguousarray(triangles, np.int32))
    return gpu.types.GPUBatch(type="TRIS", buf=vertices, elem=elements)


@contextmanager
def drawing_state(depth_test: str = "NONE", depth_write: bool = False, blend: str = "NONE") -> Iterator[None]:
    """Set the fixed-function state and put Blender's default back, also after an error."""
    gpu.state.depth_test_set(depth_test)
    gpu.state.depth_mask_set(depth_write)
    gpu.state.blend_set(blend)
    gpu.state.face_culling_set("NONE")
    try:
        yield
    finally:
        gpu.state.depth_test_set("NONE")
        gpu.state.depth_mask_set(False)
        gpu.state.blend_set("NONE")
        gpu.state.face_culling_set("NONE")


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


@cache
def cube_copy_shader() -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.vertex_in(0, "VEC2", "pos")
    info.fragment_out(0, "VEC4", "color")
    info.push_constant("INT", "face")
    info.sampler(0, "FLOAT_2D_ARRAY", "source")
    info.vertex_source(load("common/full_screen.vert.glsl"))
    info.fragment_source(load("bake/cube_copy.frag.glsl"))
    return gpu.shader.create_from_info(info)


def cube_texture(faces: np.ndarray, fmt: str = "RGBA32F", linear: bool = True) -> Any:
    """Cube map of (6, n, n, 4) faces in GL order (+X, -X, +Y, -Y, +Z, -Z), row 0 at t = 0."""
    size = faces.shape[1]
    source = gpu.types.GPUTexture((size, size), layers=6, format="RGBA32F", data=buffer_of(faces))
    cube = gpu.types.GPUTexture(size, is_cubemap=True, format=fmt)
    cube.filter_mode(linear)
    shader = cube_copy_shader()
    with drawing_state():
        for face in range(6):
            target = gpu.types.GPUFrameBuffer(color_slots=({"texture": cube, "layer": face},))
            with target.bind():
                gpu.state.viewport_set(0, 0, size, size)
                shader.bind()
                shader.uniform_int("face", face)
                shader.uniform_sampler("source", source)
                full_screen_triangle().draw(shader)
    return cube


def read_cube(cube: Any) -> Float32Array:
    """(6, n, n, 4) faces of a colour cube map; waits for the GPU."""
    size = cube.width
    faces = np.empty((6, size, size, 4), np.float32)
    for face in range(6):
        target = gpu.types.GPUFrameBuffer(color_slots=({"texture": cube, "layer": face},))
        with target.bind():
            buffer = target.read_color(0, 0, size, size, 4, 0, "FLOAT")
        buffer.dimensions = size * size * 4
        faces[face] = np.array(buffer, np.float32).reshape(size, size, 4)
    return faces
