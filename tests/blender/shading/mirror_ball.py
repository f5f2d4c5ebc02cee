# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Diagnostic views of a mirror ball whose surface buffers are made by closed-form ray casting."""

from __future__ import annotations

from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.diagnostics.colors import Color, DiagnosticColors, DiagnosticOptions, ramp_colors
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture, texture_2d
from curvrefl.curvrefl_addon.renderer.shading.curvature import CurvatureBuffer
from curvrefl.curvrefl_addon.renderer.shading.diagnostics import DiagnosticPass
from curvrefl.curvrefl_addon.renderer.surfaces.surface_buffer import SurfaceBuffer
from curvrefl.curvrefl_addon.renderer.surfaces.view_block import view_block
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.views import lines_of_sight, look_at

EYE = np.array([0.8, -4.0, 1.0])
VIEW = look_at(EYE, np.zeros(3), 160, 120, np.radians(36))
COLORS = DiagnosticColors()
PLAIN = DiagnosticOptions()
SECANT = ("secant_star",)


class Ball:
    """The unit ball about the origin as every pixel's center sees it. Arrays (h, w, ...)."""

    def __init__(self, view: View = VIEW) -> None:
        self.view = view
        origin, direction = lines_of_sight(view)
        along = (origin * direction).sum(-1)
        root = along**2 - (origin**2).sum(-1) + 1.0
        self.mask = root > 0
        distance = -along - np.sqrt(np.maximum(root, 0.0))
        self.point = np.where(self.mask[..., None], origin + distance[..., None] * direction, 0.0)
        self.ray = np.where(
            self.mask[..., None],
            direction - 2 * (direction * self.point).sum(-1, keepdims=True) * self.point,
            [0.0, 0.0, 1.0],
        )
        """This pixel's reflected ray"""

    def seen(self, number: np.ndarray | None = None) -> SurfaceBuffer:
        """Surface buffer with the mirror's `number` per pixel."""
        mirror = np.where(self.mask, 1.0 if number is None else number, 0.0)
        return filled(
            np.dstack([self.point, self.mask * 1.0]),
            np.dstack([self.point, np.zeros(self.mask.shape)]),
            np.dstack([np.ones(self.point.shape), mirror]),
        )

    def shows(self, position: np.ndarray, shown: np.ndarray, iterations: float | np.ndarray = 0.0) -> SurfaceBuffer:
        """Reflected surface buffer: `position` where `shown`, facing the mirror."""
        here = shown & self.mask
        return filled(
            np.dstack([np.where(here[..., None], position, 0.0), here * 7.0]),
            np.dstack([-self.ray, np.zeros(self.mask.shape)]),
            np.dstack([np.ones(self.point.shape), np.where(here, iterations, 0.0)]),
        )

    def curved(self, end: float = 2.0, radius: float = 1.0) -> CurvatureBuffer:
        """The tensor of a ball of some radius with this one's normals: (1 - n n) / radius."""
        tensor = (np.eye(3) - self.point[..., :, None] * self.point[..., None, :]) / radius
        diagonal = np.dstack([*(tensor[..., k, k] for k in range(3)), self.mask])
        across = np.dstack([tensor[..., 0, 1], tensor[..., 0, 2], tensor[..., 1, 2], np.zeros(self.mask.shape)])
        return CurvatureBuffer(texture_2d(diagonal), texture_2d(across), end)

    def inner(self, margin: float = 0.15) -> np.ndarray:
        """Pixels that are not near the rim."""
        facing = (self.point * unit(EYE - self.point)).sum(-1)
        return self.mask & (facing > margin)


def filled(position: np.ndarray, normal: np.ndarray, color: np.ndarray) -> SurfaceBuffer:
    height, width = position.shape[:2]
    buffer = SurfaceBuffer(width, height)
    buffer.position, buffer.normal, buffer.color = (texture_2d(array) for array in (position, normal, color))
    return buffer


def drawn(
    view: View,
    seen: SurfaceBuffer,
    reflected: Any,
    mode: str,
    options: DiagnosticOptions = PLAIN,
    methods: tuple[str, ...] = SECANT,
    parts: Any = (),
    weights: tuple[float, ...] = (1.0,),
    turns: np.ndarray | None = None,
    curved: CurvatureBuffer | None = None,
) -> np.ndarray:
    """(h, w, 4) picture of one view."""
    color = empty_texture(view.width, view.height)
    canvas = frame_buffer(color)
    with canvas.bind():
        canvas.clear(color=(0.0, 0.0, 0.0, 0.0))
    diagnostics = DiagnosticPass(COLORS)
    uniforms = view_block(view)
    if mode == "CURVATURE" and curved is None:
        curved = Ball(view).curved()
    for weight in weights:
        diagnostics.add(
            canvas, seen, reflected, uniforms, weight, mode, options, methods, parts, turns=turns, curved=curved
        )
    return read_texture(color)


def close_to(picture: np.ndarray, color: tuple[float, float, float]) -> np.ndarray:
    """(h, w) which pixels have a color, but for half precision."""
    return np.abs(picture[..., :3] - np.array(color)).max(-1) < 2e-3


def place_on_ramp(picture: np.ndarray, stops: tuple[Color, ...] = COLORS.ramp) -> np.ndarray:
    """(h, w) from 0 to 1: where on the ramp each pixel's color is; on a mirror it may be the background's, too."""
    fine = ramp_colors(stops, 2001)
    weights = np.array([0.2, 0.7, 0.1])
    place = np.interp(picture[..., :3] @ weights, fine @ weights, np.linspace(0.0, 1.0, 2001))
    known = np.abs(fine[np.rint(2000.0 * place).astype(int)] - picture[..., :3]).max(-1) < 5e-3
    assert (known | close_to(picture, COLORS.background) | (picture[..., 3] == 0.0)).all()
    return place
