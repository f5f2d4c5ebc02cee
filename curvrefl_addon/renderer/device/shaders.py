# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders out of pieces, each of which names what its GLSL needs. Slots are numbered here and nowhere else.

A `Piece` goes with some GLSL: its samplers, constants, defines. A shader lists the pieces that it is made of; what two
of them name alike is one. Constants that Python and GLSL share have their value in Python and go into a shader as
defines.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import gpu
import numpy as np

from ....gpu_shaders.loader import Part, Source, load
from ...pacing.pieces import OutOfTime, paced, piece_of_work
from .compile_log import captured_output, explain
from .context import gpu_cache
from .records import RECORD_FORMAT, ROW_BITS, records_are_images

MOST_GROUPS = 1 << 15
"""Of a dispatch along one axis"""
type Kinds = Mapping[str, str]
"""Blender's word for the type of each name: FLOAT_2D and the like for samplers, VEC3 and the like for values"""


class ShaderError(RuntimeError):
    """A shader does not compile; the message has the GLSL file and line, and the driver's words."""


@dataclass(frozen=True, slots=True)
class Image:
    """A texture that a compute shader writes."""

    format: str = "RGBA32F"
    kind: str = "FLOAT_2D"
    is_read: bool = False
    """As well as written"""


@dataclass(frozen=True, slots=True)
class Block:
    """A uniform block."""

    kind: str
    """Its type in GLSL"""
    typedef: str = ""
    """GLSL that defines the type, if it is a struct"""
    length: int = 0
    """Of an array; 0 for one that is none"""


@dataclass(frozen=True, slots=True)
class Piece:
    """What some GLSL needs; all by name."""

    samplers: Kinds = field(default_factory=dict)
    records: Kinds = field(default_factory=dict)
    """Record textures that drawing shaders read: set them by `set_records`"""
    images: Mapping[str, Image] = field(default_factory=dict)
    constants: Kinds = field(default_factory=dict)
    """Push constants, set for each draw"""
    blocks: Mapping[str, Block] = field(default_factory=dict)
    inputs: Kinds = field(default_factory=dict)
    """Vertex attributes"""
    smooth: Kinds = field(default_factory=dict)
    """Interpolated from the vertices"""
    flat: Kinds = field(default_factory=dict)
    """From the last vertex of a triangle"""
    outputs: Kinds = field(default_factory=dict)
    """Of the fragment shader, in the order of the frame buffer's colors"""
    defines: Mapping[str, str | int | float] = field(default_factory=dict)
    """Empty text for names that are only defined"""
    vertex: Part | None = None
    fragment: Part | None = None
    compute: Part | None = None
    writes_depth: bool = False
    group: int = 0
    """Invocations in a group of a compute shader"""


FULL_SCREEN = Piece(inputs={"pos": "VEC2"}, vertex="common/full_screen.vert.glsl")
"""The vertex shader of a `full_screen_triangle`"""


def named(kind: str, *names: str) -> dict[str, str]:
    """These names, all of one kind."""
    return dict.fromkeys(names, kind)


def flags(*names: str) -> dict[str, str]:
    """Defines without a value."""
    return dict.fromkeys(names, "")


def set_matrix(shader: Any, name: str, matrix: np.ndarray) -> None:
    """Set a constant MAT4 of a bound shader to an array (4, 4)."""
    from mathutils import Matrix

    shader.uniform_float(name, Matrix(matrix.tolist()))


@gpu_cache
def knows(shader: Any, constant: str) -> bool:
    """Whether a shader has a push constant: drivers drop those that do nothing in it."""
    try:
        shader.uniform_from_name(constant)
    except ValueError:
        return False
    return True


def compiled[Result](act: Callable[[], Result]) -> Generator[None, None, Result]:
    """`yield from compiled(act)`: what `act` returns, which is called anew until all of its shaders are there, one of
    which compiles in each slice."""
    while True:
        try:
            with paced(0.0):
                return act()
        except OutOfTime:
            yield


def build_shader(label: str, *pieces: Piece) -> Any:
    """Compile the shader of these pieces, whose GLSL follows in their order. `label`: a name for error messages.

    Not inside of a frame's drawing loop: keep what is built with `functools.cache`, which `clear_gpu_caches` empties.
    Raises ShaderError when it does not compile, ValueError when two pieces mean different things by one name,
    OutOfTime within `paced`.
    """
    with piece_of_work(f"the shader {label}"):
        return _built(label, pieces)


def _built(label: str, pieces: tuple[Piece, ...]) -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    # (Held until it is compiled.)
    interface = _add_declarations(info, label, pieces)
    sources = _add_sources(info, pieces)
    shader = failure = None
    with captured_output() as output:
        try:
            shader = gpu.shader.create_from_info(info)
        except Exception as error:  # (Blender raises no narrower one.)
            failure = error
    del interface
    output.write_rest()
    if failure is not None:
        # (Blender's own exception says no more than that; its traceback would be a second one for the user.)
        raise ShaderError(f"the shader {label} does not compile: {explain(output.errors, sources)}") from None
    return shader


def _add_declarations(info: Any, label: str, pieces: tuple[Piece, ...]) -> Any:
    """Everything but the GLSL itself; returns what has to live as long as `info`."""
    for name, value in {"ROW_BITS": ROW_BITS, **_joined(pieces, "defines")}.items():
        info.define(name, str(value))
    blocks = _joined(pieces, "blocks")
    if typedefs := "\n".join(dict.fromkeys(block.typedef for block in blocks.values() if block.typedef)):
        info.typedef_source(typedefs)
    for slot, (name, block) in enumerate(blocks.items()):
        info.uniform_buf(slot, block.kind, f"{name}[{block.length}]" if block.length else name)
    for name, kind in _joined(pieces, "constants").items():
        info.push_constant(kind, name)
    samplers, images, records = (_joined(pieces, what) for what in ("samplers", "images", "records"))
    if records_are_images():
        info.define("RECORD_IMAGES")
        for slot, (name, kind) in enumerate(records.items(), len(images)):
            info.image(slot, RECORD_FORMAT, kind, name, qualifiers={"READ"})
    else:
        samplers = {**samplers, **records}
    for slot, (name, kind) in enumerate(samplers.items()):
        info.sampler(slot, kind, name)
    for slot, (name, image) in enumerate(images.items()):
        info.image(slot, image.format, image.kind, name, qualifiers={"WRITE"} | ({"READ"} if image.is_read else set()))
    for slot, (name, kind) in enumerate(_joined(pieces, "inputs").items()):
        info.vertex_in(slot, kind, name)
    for slot, (name, kind) in enumerate(_joined(pieces, "outputs").items()):
        info.fragment_out(slot, kind, name)
    if any(piece.writes_depth for piece in pieces):
        info.depth_write("ANY")
    if group := max(piece.group for piece in pieces):
        info.local_group_size(group, 1)
    return _add_varyings(info, label, pieces)


def _add_varyings(info: Any, label: str, pieces: tuple[Piece, ...]) -> Any:
    smooth, flat = _joined(pieces, "smooth"), _joined(pieces, "flat")
    if not smooth and not flat:
        return None
    interface = gpu.types.GPUStageInterfaceInfo(f"curvrefl_{label.replace(' ', '_')}")
    for name, kind in smooth.items():
        interface.smooth(kind, name)
    for name, kind in flat.items():
        interface.flat(kind, name)
    info.vertex_out(interface)
    return interface


def _add_sources(info: Any, pieces: tuple[Piece, ...]) -> dict[str, Source]:
    """By stage."""
    sources = {}
    for stage, add in (
        ("vertex", info.vertex_source),
        ("fragment", info.fragment_source),
        ("compute", info.compute_source),
    ):
        if parts := [part for piece in pieces if (part := getattr(piece, stage)) is not None]:
            sources[stage] = load(*parts)
            add(sources[stage].text)
    return sources


def _joined(pieces: Iterable[Piece], what: str) -> dict[str, Any]:
    """One of the pieces' mappings, in order."""
    result: dict[str, Any] = {}
    for piece in pieces:
        for name, value in getattr(piece, what).items():
            if result.setdefault(name, value) != value:
                raise ValueError(f"{name} is both {result[name]} and {value} among a shader's {what}")
    return result


def dispatch(shader: Any, count: int, group: int) -> None:
    """Run a bound compute shader for at least `count` invocations in groups of (group, 1, 1).

    Drivers need not take more than 65,535 groups along an axis: invocation i is at (i % width, i / width), with the
    width of a row of groups (`invocation.glsl`).
    """
    groups = max(-(-count // group), 1)
    rows = -(-groups // MOST_GROUPS)
    gpu.compute.dispatch(shader, -(-groups // rows), rows, 1)


def uniform_block(struct: np.ndarray) -> Any:
    """GPUUniformBuf of a one-element numpy structured array (std140 by the caller; matrices transposed)."""
    assert struct.nbytes % 16 == 0, "std140 blocks are padded to vec4"
    return gpu.types.GPUUniformBuf(struct)
