# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sphere (disk) map: all directions in the picture of one mirror ball (McGill COMP 557, lecture 18).

The ball is seen from far away along the axis from the mirror to the eye, so what lies behind the mirror is squeezed
into the rim, all of which stands for the one direction away from the eye. The map is drawn out of an environment cube,
and again when the axis changes.
"""

from __future__ import annotations

from typing import Any

from ...optics.environment import axis_frame
from ...scene.arrays import Float64Array
from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.shaders import FULL_SCREEN, Piece, build_shader, named
from ..device.state import drawing_state, set_viewport
from ..device.textures import empty_texture

_FRAME = ("environment_right", "environment_up", "environment_axis")


class SphereMap:
    """Disk maps of one axis, drawn out of cube maps."""

    def __init__(self, cube: Any, axis: Float64Array, resolution: int) -> None:
        """Draws the map of radiance.

        `axis` is a unit direction (3,), world space; a map is a picture of `resolution` x `resolution` texels that the
        disk just fits into.
        """
        self.axis = axis
        self.constants = {name: tuple(row) for name, row in zip(_FRAME, axis_frame(axis).tolist(), strict=True)}
        """Push constants of the lookup"""
        self.radiance = _draw(cube, self.constants, resolution, linear=True)
        self._resolution = resolution
        self._positions: Any = None

    def positions(self, cube: Any) -> Any:
        """The map of world positions and object_ids, drawn when first asked for."""
        if self._positions is None:
            self._positions = _draw(cube, self.constants, self._resolution, linear=False)
        return self._positions


def _draw(cube: Any, constants: dict[str, tuple[float, ...]], resolution: int, linear: bool) -> Any:
    texture = empty_texture(resolution, resolution, linear=linear)
    texture.extend_mode("EXTEND")
    shader = _map_shader()
    with drawing_state(), frame_buffer(texture).bind():
        set_viewport(0, 0, resolution, resolution)
        shader.bind()
        shader.uniform_float("map_size", float(resolution))
        for name, value in constants.items():
            shader.uniform_float(name, value)
        shader.uniform_sampler("environment", cube)
        full_screen_triangle().draw(shader)
    return texture


@gpu_cache
def _map_shader() -> Any:
    return build_shader(
        "sphere map",
        FULL_SCREEN,
        Piece(
            samplers={"environment": "FLOAT_CUBE"},
            constants={"map_size": "FLOAT", **named("VEC3", *_FRAME)},
            outputs={"color": "VEC4"},
            fragment="environments/environment_sphere_map.frag.glsl",
        ),
    )
