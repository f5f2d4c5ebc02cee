# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a view with what it shows of the mirrors' surfaces: patterns, curvature, combs, joints, legends."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..options import current_options, mirrors_in, overrides_of, settings_of
from ..output import folder_to_publish, temporary_folder
from ..renderer.device.frame_buffers import frame_buffer
from ..renderer.device.overlays import matrices_of, matrices_of_pixels
from ..renderer.device.state import set_viewport
from ..renderer.device.textures import empty_texture, read_texture
from ..renderer.reflection import Diagnostic
from ..renderer.renderer import Renderer
from ..renderer.shading.diagnostic_legend import draw_layout, layout, layout_at_left
from ..renderer.surfaces.canvas import Canvas
from ..report.as_shown import save_as_shown
from ..report.display import display_transform, inverse_display_transform
from ..report.images import save_png
from ..scene.arrays import Float32Array
from ..scene.camera.film import on_film
from ..scene.camera.view import View
from ..scene.changes import Changes
from ..scene.extract import SceneReader
from .chosen import combs_of, diagnostic_of
from .joints import CheckedJoints
from .lines import draw_combs, draw_joints, joint_legend

LEGEND_HEIGHT, SMALLEST_LEGEND = 500.0, 0.75
"""Pixels of a picture whose legends are as in a viewport; they are larger in larger ones, down to what can be read"""


@dataclass(frozen=True, slots=True)
class SavedPicture:
    """What came of it."""

    size: tuple[int, int]
    warnings: tuple[str, ...]


def save_picture(
    path: Path,
    scene: bpy.types.Scene,
    depsgraph: bpy.types.Depsgraph,
    view: View,
    samples: int,
    checked: CheckedJoints | None = None,
) -> SavedPicture:
    """Write `view` of the scene as its settings show it, with the edges that were `checked`, as a PNG.

    The picture goes through the scene's view transform; what is drawn over it has the colors of its legend. Raises
    InputError where there is nothing to draw or the file cannot be written.
    """
    mirrors = mirrors_in(depsgraph)
    options = current_options()
    overrides = overrides_of(mirrors)
    arrays = SceneReader().read(depsgraph, scene, mirrors, Changes(everything=True), overrides)
    renderer = Renderer(arrays, settings_of(scene.curvrefl, samples), options.image_memory << 20)
    view = replace(view, lens=None)
    try:
        frame = renderer.render(view)
        shown = _as_shown(on_film(frame.color(), scene), scene)
        diagnostic = diagnostic_of(scene.curvrefl, options)
        if diagnostic is not None:
            shown = _over(shown, *_diagnosed(renderer, view, diagnostic))
        lines = _lines(renderer, scene, view, diagnostic, frame.reflection.methods, checked)
        shown = _over(shown, lines[..., :3], lines[..., 3:])
    finally:
        renderer.free()
    whole = np.ones((*shown.shape[:2], 4), np.float32)
    whole[..., :3] = inverse_display_transform(shown)
    with folder_to_publish(path.parent) as part:
        save_png(part / path.name, whole)
    return SavedPicture((view.width, view.height), frame.warnings)


def _as_shown(pixels: Float32Array, scene: bpy.types.Scene) -> Float32Array:
    """(h, w, 3) encoded as the scene's display shows a scene-linear picture."""
    with temporary_folder() as folder:
        path = folder / "picture.png"
        save_as_shown(path, pixels, scene)
        image: Any = bpy.data.images.load(str(path))
        try:
            width, height = image.size
            values = np.empty(width * height * image.channels, np.float32)
            image.pixels.foreach_get(values)
            return values.reshape(height, width, -1)[..., :3].copy()
        finally:
            bpy.data.images.remove(image)


def _diagnosed(renderer: Renderer, view: View, diagnostic: Diagnostic) -> tuple[Float32Array, Float32Array]:
    """(h, w, 3) encoded, times the coverage (h, w, 1)."""
    canvas = Canvas.of_size(view.width, view.height)
    reflection = renderer.reflect(view, solve=diagnostic.needs_solve, is_still=True)
    samples = renderer.settings.samples
    for index in range(samples):
        renderer.add_sub_frame(canvas, reflection, index, 1.0 / samples, mirrors_only=True, diagnostic=diagnostic)
    pixels = canvas.pixels()
    cover = pixels[..., 3:]
    straight = np.divide(pixels[..., :3], cover, out=np.zeros_like(pixels[..., :3]), where=cover > 0.0)
    return display_transform(straight) * cover, cover


def _lines(
    renderer: Renderer,
    scene: bpy.types.Scene,
    view: View,
    diagnostic: Diagnostic | None,
    methods: tuple[str, ...],
    checked: CheckedJoints | None,
) -> Float32Array:
    """(h, w, 4) combs, joints and legends, encoded, times their alpha."""
    width, height = view.width, view.height
    colors = current_options().colors
    combs = None
    if scene.curvrefl.comb_show:
        renderer.diagnostics.curvatures.prepare(renderer.mirrors)
        combs = renderer.diagnostics.combs.of(renderer.mirrors, combs_of(scene), renderer.placement.origin)
    legend = None
    if diagnostic is not None:
        legend = renderer.diagnostics.legend(diagnostic, methods)
    scale = max(height / LEGEND_HEIGHT, SMALLEST_LEGEND)
    texture = empty_texture(width, height)
    target = frame_buffer(texture)
    with target.bind():
        target.clear(color=(0.0, 0.0, 0.0, 0.0))
        set_viewport(0, 0, width, height)
        with matrices_of(view.world_to_view, view.view_to_clip):
            if combs is not None:
                draw_combs(combs, view.eye)
            if checked is not None:
                draw_joints(checked, colors, view.eye)
        with matrices_of_pixels(width, height):
            if legend is not None:
                draw_layout(layout(legend, width, 0.0, scale), scale)
            if checked is not None:
                draw_layout(layout_at_left(joint_legend(checked, colors), 0.0, 0.0, scale), scale)
    return read_texture(texture)


def _over(below: Float32Array, color: Float32Array, alpha: Float32Array) -> Float32Array:
    return below * (1.0 - alpha) + color
