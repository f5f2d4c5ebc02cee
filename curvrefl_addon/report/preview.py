# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole pictures of the camera's view with the reflections in it, frame after frame, through the view transform."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import TracebackType
from typing import Self

import bpy

from ..options import current_options, overrides_of, settings_of
from ..renderer.renderer import Renderer
from ..scene.arrays import Float32Array
from ..scene.camera.film import on_film, rendered_size
from ..scene.extract import SceneReader
from ..scene.opened.blend_file import find_reflectors
from ..scene.opened.render_depsgraph import read_render_moments


class PreviewRenderer:
    """Renders the open scene at its present frame, again and again; a context manager, which frees at its end."""

    def __init__(self, mirrors: Sequence[str], samples: int, may_be_hidden: bool = False) -> None:
        """`mirrors`: names of objects, which `may_be_hidden` in some frames."""
        self._may_be_hidden = may_be_hidden
        self._mirrors = tuple(mirrors)
        self._samples = samples
        self._reader = SceneReader()
        self._renderer: Renderer | None = None
        self.warnings: tuple[str, ...] = ()
        """What the last picture does not show, one sentence each"""

    def render(self, scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> Float32Array:
        """(h, w, 4) scene-linear picture at the size of the scene's renders.

        Raises InputError for what the user can change: camera, mirrors.
        """
        width, height = rendered_size(scene.render)
        # Whatever a new frame changes is found by reading all; meshes that stay the same are not uploaded again.
        overrides = overrides_of(find_reflectors(scene, self._mirrors))
        settings = replace(settings_of(scene.curvrefl, self._samples), film_transparent=scene.render.film_transparent)
        still, moments, untold = read_render_moments(
            scene,
            view_layer,
            self._mirrors,
            width,
            height,
            settings.samples,
            reader=self._reader,
            overrides=overrides,
            may_be_hidden=self._may_be_hidden,
        )
        if self._renderer is None:
            self._renderer = Renderer(still.scene, settings, current_options().image_memory << 20)
        else:
            self._renderer.update(still.scene, is_fresh=True)
        frame = self._renderer.render(still.view, moments=moments)
        self.warnings = (*frame.warnings, *untold)
        return on_film(frame.color(), scene)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self._renderer is not None:
            self._renderer.free()
            self._renderer = None
