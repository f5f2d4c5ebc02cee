# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass of what the eye sees directly."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ...scene.camera.view import View
from ..device.context import gpu_cache
from ..device.shaders import Piece, build_shader, flags, named
from ..device.state import drawing_state, hide_faces, scissored, set_viewport
from ..geometry.chunk import CHUNK, Batches, Chunk
from .materials import NO_SCALARS, OF_PATHS, PLAIN, RELIEF, TEXTURED, WITH_SCALARS, Materials
from .surface_buffer import SURFACE_OUTPUTS, SurfaceBuffer
from .view_block import VIEW
from .windows import Window

type Depths = tuple[float, float, float]
"""Distances from the eye's plane where a view begins and ends, and the one that has the depth 1"""
LINEAR_DEPTH = Piece(constants={"depths": "VEC3"}, defines=flags("LINEAR_DEPTH"), writes_depth=True)
FOLLOWED = Piece(defines=flags("FOLLOWED"))
"""Rays go on from the surface: shading normals must not send them into the facet that they are on"""
ENDLESS = 3e38


def depths_of(view: View) -> Depths | None:
    """Of a view with linear depths; None of any other, which needs no such pass."""
    if not view.linear_depth:
        return None
    near, far = view.clip_range
    return (near, min(far, ENDLESS), view.linear_depth)


def draw_primary(
    target: SurfaceBuffer,
    seen: Sequence[tuple[Chunk, Batches]],
    materials: Materials,
    view_uniforms: Any,
    window: Window | None = None,
    hidden_faces: Callable[[Chunk], str] = lambda _chunk: "NONE",
    is_followed: Callable[[Chunk], bool] = lambda _chunk: False,
    depths: Depths | None = None,
    mirrored: bool = False,
    has_paths: bool = False,
    has_scalars: bool = False,
) -> None:
    """Fill `target` with what the eye sees directly, in `window` alone if given: nothing elsewhere.

    `hidden_faces` says which side of a chunk's triangles need not be drawn: 'BACK', 'FRONT' or 'NONE'. Of a mirror that
    `is_followed`, which rays go on from, the normals are those of its bumps and normal maps and send no ray into the
    surface; else they are those of the smooth surface. `depths`: what `depths_of` says of the view; `mirrored` whether
    left and right are swapped in it. `has_paths`: paths go on from here; `has_scalars`: some by what images say.
    """

    def kind_of(chunk: Chunk, material: int) -> tuple[str, bool]:
        scalars = has_scalars and materials.has_scalars(material)
        if materials.has_relief(material) and is_followed(chunk):
            return "RELIEF", scalars
        return ("PLAIN" if materials.is_plain(material) and not scalars else "TEXTURED"), scalars

    frame_buffer = target.with_scalars()[1] if has_scalars else target.frame_buffer
    kinds = [(kind, False) for kind in ("PLAIN", "TEXTURED", "RELIEF")]
    if has_scalars:
        kinds += [(kind, True) for kind in ("TEXTURED", "RELIEF")]

    with drawing_state("LESS_EQUAL", depth_write=True, mirrored=mirrored), frame_buffer.bind():
        set_viewport(0, 0, target.width, target.height)
        frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
        with scissored(window):
            for kind, scalars in kinds:
                for chunk, batches in seen:
                    chosen = [item for item in batches if kind_of(chunk, item[0]) == (kind, scalars)]
                    if not chosen:
                        continue
                    writes = "" if not has_scalars else ("WITH" if scalars else "NO")
                    shader = _primary_shader(kind, is_followed(chunk), depths is not None, has_paths, writes)
                    shader.bind()
                    if depths is not None:
                        shader.uniform_float("depths", depths)
                    shader.uniform_block("view", view_uniforms)
                    shader.uniform_sampler("positions", chunk.positions)
                    shader.uniform_sampler("corners", chunk.corners)
                    hide_faces(hidden_faces(chunk))
                    for material, batch in chosen:
                        materials.bind(shader, material, is_textured=kind != "PLAIN")
                        if kind == "RELIEF":
                            materials.bind_relief(shader, material)
                        if scalars:
                            materials.bind_scalars(shader, material)
                        if has_paths:
                            materials.bind_for_paths(shader, material)
                        batch.draw(shader)


@gpu_cache
def _primary_shader(
    kind: str, is_followed: bool, has_linear_depth: bool, has_paths: bool = False, scalars: str = ""
) -> Any:
    """For batches of one kind: PLAIN, TEXTURED or RELIEF. `scalars`: 'WITH' an image of them, 'NO' image, or ''."""
    return build_shader(
        f"primary {kind}",
        VIEW,
        CHUNK,
        PLAIN if kind == "PLAIN" else TEXTURED,
        *((RELIEF,) if kind == "RELIEF" else ()),
        *((FOLLOWED,) if is_followed else ()),
        *((LINEAR_DEPTH,) if has_linear_depth else ()),
        SURFACE_OUTPUTS,
        *((OF_PATHS,) if has_paths else ()),
        *((WITH_SCALARS if scalars == "WITH" else NO_SCALARS,) if scalars else ()),
        Piece(
            smooth=named("VEC3", "world_position", "world_normal"),
            flat={"ids": "VEC2"},
            vertex="surfaces/primary.vert.glsl",
            fragment="surfaces/primary.frag.glsl",
        ),
    )
