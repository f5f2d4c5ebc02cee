# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass of what the eye sees directly."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ...scene.camera.view import View
from ...scene.programs.program import Shape
from ..device.context import gpu_cache
from ..device.shaders import Piece, build_shader, flags, named
from ..device.state import drawing_state, hide_faces, scissored, set_viewport
from ..geometry.chunk import CHUNK, Batches, Chunk
from ..programs.buffers import fills
from ..programs.programs import Surroundings
from .materials import DRAWN, OF_PATHS, PLAIN, Materials, forward_pieces
from .surface_buffer import SURFACE_OUTPUTS, SurfaceBuffer
from .view_block import VIEW
from .windows import Window

type Depths = tuple[float, float, float]
"""Distances from the eye's plane where a view begins and ends, and the one that has the depth 1"""
LINEAR_DEPTH = Piece(constants={"depths": "VEC3"}, defines=flags("LINEAR_DEPTH"), writes_depth=True)
FOLLOWED = Piece(defines=flags("FOLLOWED"))
"""Rays go on from the surface: shading normals must not send them into the facet that they are on"""
SMOOTH = Piece(defines=flags("SMOOTH"))
"""Normals are the mesh's"""
ENDLESS = 3e38


def depths_of(view: View) -> Depths | None:
    """Of a view with linear depths; None of any other, which needs no such pass."""
    if not view.linear_depth:
        return None
    near, far = view.clip_range
    return (near, min(far, ENDLESS), view.linear_depth)


@dataclass(frozen=True, slots=True)
class _Kind:
    """Of a batch's shader."""

    shape: Shape | None
    """Of its material's program"""
    is_followed: bool
    is_smooth: bool
    has_linear_depth: bool
    has_paths: bool
    around: Surroundings | None
    """None where the scene has no programs"""


def draw_primary(
    target: SurfaceBuffer,
    seen: Sequence[tuple[Chunk, Batches]],
    materials: Materials,
    view_uniforms: Any,
    window: Window | None = None,
    hidden_faces: Callable[[Chunk], str] = lambda _chunk: "NONE",
    is_followed: Callable[[Chunk], bool] = lambda _chunk: False,
    is_smooth: Callable[[Chunk], bool] = lambda _chunk: False,
    depths: Depths | None = None,
    mirrored: bool = False,
    has_paths: bool = False,
    sub_frame: int = 0,
) -> None:
    """Fill `target` with what the eye sees directly, in `window` alone if given: nothing elsewhere.

    `hidden_faces` says which side of a chunk's triangles need not be drawn: 'BACK', 'FRONT' or 'NONE'. The normals of
    a mirror that `is_followed`, which rays go on from, send no ray into the surface. Those of what `is_smooth` are the
    mesh's own, without bumps. `depths`: what `depths_of` says of the view; `mirrored` whether left and right are
    swapped in it. `has_paths`: paths go on from here; `sub_frame`: its number.
    """
    groups: dict[_Kind, list[tuple[Chunk, Batches]]] = {}
    for chunk, batches in seen:
        for shape, chosen in materials.by_shape(batches).items():
            smooth = shape is not None and is_smooth(chunk)
            kind = _Kind(shape, is_followed(chunk), smooth, depths is not None, has_paths, materials.around)
            groups.setdefault(kind, []).append((chunk, chosen))
    with drawing_state("LESS_EQUAL", depth_write=True, mirrored=mirrored):
        with target.frame_buffer.bind():
            target.frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
        with target.target(materials.buffers).bind(), scissored(window):
            set_viewport(0, 0, target.width, target.height)
            # (Plain ones first.)
            for kind in sorted(groups, key=lambda kind: kind.shape is not None):
                shader = _primary_shader(kind)
                shader.bind()
                if depths is not None:
                    shader.uniform_float("depths", depths)
                shader.uniform_block("view", view_uniforms)
                if kind.shape is not None:
                    materials.bind_program(shader, kind.shape, (sub_frame, 0))
                for chunk, batches in groups[kind]:
                    materials.bind_triangles(shader, chunk, kind.shape)
                    hide_faces(hidden_faces(chunk))
                    for material, batch in batches:
                        materials.bind(shader, material)
                        if has_paths:
                            materials.bind_for_paths(shader, material)
                        batch.draw(shader)


@gpu_cache
def _primary_shader(kind: _Kind) -> Any:
    return build_shader(
        "primary" if kind.shape is None else "primary of a program",
        VIEW,
        CHUNK,
        *(() if kind.shape is None or kind.around is None else forward_pieces(kind.shape, kind.around)),
        PLAIN if kind.shape is None else DRAWN,
        *((FOLLOWED,) if kind.is_followed else ()),
        *((SMOOTH,) if kind.is_smooth else ()),
        *((LINEAR_DEPTH,) if kind.has_linear_depth else ()),
        SURFACE_OUTPUTS,
        *(() if kind.around is None else (fills(kind.around.buffers),)),
        *((OF_PATHS,) if kind.has_paths else ()),
        Piece(
            smooth=named("VEC3", "world_position", "world_normal"),
            flat={"ids": "VEC2"},
            vertex="surfaces/primary.vert.glsl",
            fragment="surfaces/primary.frag.glsl",
        ),
    )
