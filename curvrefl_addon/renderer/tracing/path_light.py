# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that paths find at each of their vertices, added to a picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..cells.lookup import At
from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.shaders import Piece, build_shader, flags, named
from ..device.state import drawing_state, scissored, set_viewport
from ..indirect.gather import ASKS_EMITTERS, SKY_GATHERED, Gathering, SharedGather, features_of
from ..indirect.gather_shaders import shared_piece
from ..lighting.lighting import Features, Lighting
from ..paths.features import ALPHA, ROUGH
from ..programs.buffers import Buffers
from ..shading.features import FILM_TRANSPARENT, LAMPS, NO_QUADS, RayShadows, features_for, lighting_pieces, rays_of
from ..surfaces.canvas import Canvas
from ..surfaces.pixel_classes import CLASS
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.view_block import VIEW
from .path_classes import PathClass
from .path_vertices import PathVertices
from .step import Surroundings, bind_vertices, vertex_pieces


@dataclass(frozen=True, slots=True)
class PathLight:
    """What lights the vertices of one picture's paths."""

    around: Surroundings
    lighting: Lighting
    shadows: RayShadows | None
    film_transparent: bool
    has_base: bool
    """Surfaces from which paths go on have a base below their lobes, or shine"""
    gathers: Gathering | None = None
    """Rays find what other surfaces send to where paths stop; where they go on patches know it, and of the world"""

    def add(
        self,
        canvas: Canvas,
        weight: float,
        kind: PathClass,
        vertices: SurfaceBuffer | PathVertices,
        classes: Any,
        before: SurfaceBuffer | PathVertices | None = None,
        classes_before: Any = None,
        sub_frame: int = 0,
        shared: SharedGather | None = None,
    ) -> None:
        """Add the light of one class of vertices, times `weight`.

        `before`, `classes_before`: the vertices from which paths came here and their classes, None where these are what
        the eye sees. Others as for `step.follow`; `shared`: rays that pixels of
        surfaces where paths stop share.
        """
        is_shared = shared is not None and kind is PathClass.STOPS
        shader, rays, features = self._shader(kind, before is not None, is_shared)
        target = canvas.with_depth(classes)
        with drawing_state("EQUAL", blend="ADDITIVE_PREMULT"), target.bind(), scissored(self.around.window):
            set_viewport(0, 0, vertices.width, vertices.height)
            shader.bind()
            if rays is not None:
                rays.bind(shader)
            bind_vertices(shader, self.around, vertices)
            shader.uniform_block("view", self.around.view_uniforms)
            shader.uniform_float("weight", weight)
            shader.uniform_float("pixel_class", float(kind))
            if before is not None:
                assert isinstance(vertices, PathVertices)
                shader.uniform_sampler("before_position", before.position)
                if _shares_in_quads(kind, features):
                    shader.uniform_sampler("classes_before", classes_before)
                    shader.uniform_int("turn", sub_frame)
                shader.uniform_sampler("path_way", vertices.way)
                shader.uniform_sampler("path_throughput", vertices.throughput)
            self.lighting.bind(shader)
            if kind is PathClass.GOES_ON and self.gathers is not None and self.gathers.has_sky:
                assert self.gathers.irradiance is not None
                self.gathers.irradiance.bind(shader, At.ENDS_UNDER_SKY)
            if is_shared:
                assert shared is not None
                shared.bind(shader)
            full_screen_triangle().draw(shader)

    @property
    def lights_samples(self) -> bool:
        """Lobes are lit by samples of lamps as well as by what rays meet."""
        return ROUGH in self.around.features and bool(self.lighting.features & LAMPS)

    @property
    def has_bodies(self) -> bool:
        """Lamps may be met before surfaces."""
        return bool(self.lighting.features & LAMPS - {"LIGHTING_SUN"})

    def _shader(self, kind: PathClass, on_path: bool, is_shared: bool) -> tuple[Any, Any, Features]:
        """And the rays that it needs bound, if any, and the features of the lighting that it is for."""
        features = self.lighting.features
        needs_shadows = kind is PathClass.STOPS
        names: set[str] = set()
        if ROUGH in self.around.features:
            names.add("PATH_LIGHT")
        if kind is PathClass.GOES_ON:
            needs_shadows = self.has_base or self.lights_samples or ALPHA in self.around.features
            if self.has_base:
                names.add("PATHS_BASE")
            if self.lights_samples:
                names.add("PATH_LOBES")
        if needs_shadows:
            gathered = features_of(self.gathers)
            if kind is not PathClass.STOPS:
                gathered &= {SKY_GATHERED}
            features = features_for(self.lighting, self.shadows, is_seen=not on_path, gathered=gathered)
        if kind is PathClass.MISSES and self.film_transparent:
            names.add(FILM_TRANSPARENT)
        buffers = self.around.materials.buffers
        shader = _light_shader(kind, self.around.features, buffers, features, on_path, frozenset(names), is_shared)
        return shader, rays_of(features, self.shadows), features


_OF_QUADS = Piece(samplers={"classes_before": "DEPTH_2D"}, constants={"turn": "INT"})


def _shares_in_quads(kind: PathClass, lighting_features: Features) -> bool:
    """Whether pixels share the sky's shadows: where there are any, of surfaces that are lit as a whole."""
    is_lit = "LIGHTING_WORLD" in lighting_features and SKY_GATHERED not in lighting_features
    return kind is PathClass.STOPS and is_lit and NO_QUADS not in lighting_features


@gpu_cache
def _light_shader(
    kind: PathClass,
    features: Features,
    buffers: Buffers,
    lighting_features: Features,
    on_path: bool,
    names: Features,
    is_shared: bool,
) -> Any:
    way = Piece(samplers=named("FLOAT_2D", "before_position", "path_way", "path_throughput"), defines=flags("ON_PATH"))
    return build_shader(
        f"light of {kind.name} on paths",
        CLASS,
        VIEW,
        *vertex_pieces(features, buffers),
        *((way,) if on_path else ()),
        *((_OF_QUADS,) if _shares_in_quads(kind, lighting_features) else ()),
        *lighting_pieces(lighting_features),
        *((shared_piece(False, ASKS_EMITTERS in lighting_features),) if is_shared else ()),
        Piece(
            constants={"weight": "FLOAT"},
            outputs={"color": "VEC4"},
            defines=flags(f"LIGHTS_{kind.name}", *sorted(names)),
            fragment="paths/path_light.frag.glsl",
        ),
    )
