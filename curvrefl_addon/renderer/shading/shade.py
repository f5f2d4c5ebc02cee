# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shade pass: surface buffers in, scene-linear radiance out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ...scene.arrays import Float64Array, SceneArrays
from ..device.batches import full_screen_triangle
from ..device.shaders import knows
from ..device.state import drawing_state, scissored, set_viewport
from ..indirect.gather import (
    Gathering,
    GatherPicture,
    SharedGather,
    Source,
    features_of,
)
from ..lighting.lamps import reach_into
from ..lighting.lighting import Features, Lighting
from ..paths.features import has_base
from ..programs.buffers import NONE, MaterialBuffers
from ..rays.paths import PATH_DEPTH, Bounce, PathBuffer
from ..rays.ray_scene import RayScene
from ..surfaces.by_size import BySize
from ..surfaces.canvas import Canvas
from ..surfaces.materials import Materials
from ..surfaces.pixel_classes import CLASS_COUNT, PixelClass, PixelClasses
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.windows import Window
from .features import FILM_TRANSPARENT, LAMPS, WHOLE_PATHS, RayShadows, features_for, rays_of
from .lookup import Environment
from .shade_shaders import (
    PATH,
    REFLECTED,
    SEEN,
    WHOLE_PATH,
    environment_shader,
    front_shader,
    path_shader,
    shade_shader,
    whole_path_shader,
)

MOST_SIZES = 4
"""Sizes of pictures whose targets are kept"""


class ShadePass:
    """Lights surface buffers of one scene."""

    def __init__(self, scene: SceneArrays, lighting: Lighting, materials: Materials) -> None:
        self._lighting = lighting
        self._materials = materials
        self._classes = BySize(PixelClasses, MOST_SIZES)
        self.follow(scene)

    def follow(self, scene: SceneArrays) -> None:
        """Know another state of the scene."""
        self.mirror_bounces = scene.mirror_bounces
        """See `SceneArrays`"""
        bodies = [light for light in scene.lights if light.radius > 0.0 or light.kind == "AREA"]
        self._has_bodies = {
            True: any(light.visible_camera for light in bodies),
            False: any(light.visible_glossy for light in bodies),
        }
        """Lamps that the camera sees, and those that mirrors do"""
        mirrors = [
            scene.materials[index]
            for instance in scene.instances
            if instance.object_id in scene.reflectors
            for index in instance.materials
        ]
        self._has_base = any(has_base(material) for material in mirrors)
        self._seen_bodies = [light for light in bodies if light.visible_glossy]
        self._mirrors_need_passes = bool(
            self._has_base or self._materials.links or any(material.program is not None for material in mirrors)
        )

    def lights_ends_alone(self, low: Float64Array, high: Float64Array) -> bool:
        """Whether of rays from mirror to mirror only their ends are to be lit; all mirrors are in the box (3,), (3,).

        Mirrors need no pass of their own then, and no ray meets a lamp on its way between two of them.
        """
        return not (self._mirrors_need_passes or reach_into(self._seen_bodies, low, high))

    def add(
        self,
        canvas: Canvas,
        seen: SurfaceBuffer,
        reflected: SurfaceBuffer | Sequence[Environment] | None,
        view_uniforms: Any,
        weight: float,
        mirrors: Window | None = None,
        later: Iterator[Bounce] | None = None,
        shadows: RayShadows | None = None,
        chosen: Any = None,
        with_others: bool = True,
        film_transparent: bool = False,
        by_camera: bool = True,
        shown_apart: Canvas | None = None,
        gathers: Gathering | None = None,
        most_hits: int = 1,
    ) -> None:
        """Add the lit picture of `seen`, times `weight`, to a picture of its size.

        `reflected` is the reflected scene's surface buffer, or for each mirror the environment that stands for it; None
        where mirrors show the background alone. With `mirrors`, a window that holds all of them, no other pixel is
        touched. With `later`, `reflected` is a PathBuffer, and these are the bounces after it. With `shadows`, these
        take the place of maps. `chosen`: record texture by mirrors' numbers, 1 of those that are lit, None for
        all; `with_others`: what is no mirror is, too. With `film_transparent` the eye itself sees no world.
        `by_camera`: what sees all this is the camera, else a mirror. `shown_apart`: gets what mirrors show, with a
        weight of 1, in place of the picture. `gathers`: rays find the light that surfaces send to each other, in place
        of the light of patches. `most_hits`: what `reflected` was followed with, where it is a PathBuffer.
        """
        mirrors_only = mirrors is not None or not with_others
        if mirrors is not None and (mirrors[2] <= 0 or mirrors[3] <= 0):
            return
        classes = self._classes.of(seen.width, seen.height)
        tells_mirrors = later is not None or most_hits > 1
        classes.sort(seen, reflected if isinstance(reflected, SurfaceBuffer) else None, mirrors, tells_mirrors, chosen)
        shared = None if gathers is None or mirrors_only else gathers.shared(seen)
        shown_rays = None if gathers is None else self._share_shown(gathers, classes.depth, seen, reflected, mirrors)
        shown, strength = (canvas, weight) if shown_apart is None else (shown_apart, 1.0)
        with drawing_state("EQUAL", blend="ADDITIVE_PREMULT"):
            with shown.with_depth(classes.depth).bind(), scissored(mirrors):
                set_viewport(0, 0, seen.width, seen.height)
                self._add_shown(
                    seen,
                    reflected,
                    view_uniforms,
                    strength,
                    shadows,
                    features_of(gathers),
                    shown_rays,
                    most_hits,
                    tells_mirrors,
                )
            with canvas.with_depth(classes.depth).bind(), scissored(mirrors):
                set_viewport(0, 0, seen.width, seen.height)
                if not mirrors_only:
                    self._add_others(
                        seen, view_uniforms, weight, shadows, film_transparent, by_camera, features_of(gathers), shared
                    )
                self._add_front(seen, view_uniforms, weight, mirrors_only, shadows, by_camera)
        gathered = None
        for bounce in later or ():
            if gathers is not None and gathered is None:
                gathered = gathers.picture(seen.width, seen.height, mirrors)
            self._add_path(shown, bounce, view_uniforms, strength, shadows, features_of(gathers))
            if gathers is not None and gathered is not None and not bounce.ends:
                self._gather_later(gathers, gathered, bounce)
        if gathers is not None and gathered is not None:
            gathered.add(gathers, canvas, weight)

    def _share_shown(
        self,
        by: Gathering,
        classes: Any,
        seen: SurfaceBuffer,
        reflected: SurfaceBuffer | Sequence[Environment] | None,
        window: Window | None,
    ) -> SharedGather | None:
        """Rays of what mirrors show first."""
        if not isinstance(reflected, SurfaceBuffer) or self.mirror_bounces == 0:
            return None
        picture = by.picture(seen.width, seen.height, window)
        shown = (reflected.position, reflected.normal, reflected.color)
        mirrors = (seen.position, seen.normal, seen.color)
        kind = (classes, PixelClass.MIRROR_OF_SURFACE / CLASS_COUNT)
        return picture.share(by, Source.SHOWN, shown, reflected.made, mirrors, kind)

    @staticmethod
    def _gather_later(by: Gathering, gathered: GatherPicture, bounce: Bounce) -> None:
        path = bounce.path
        surface = (path.position, path.normal, path.color)
        others = (path.direction, path.throughput)
        gathered.follow(by, Source.LATER, surface, path.made, others, (path.depth, PATH_DEPTH), bounce.goes_on)

    def _add_others(
        self,
        seen: SurfaceBuffer,
        view_uniforms: Any,
        weight: float,
        shadows: RayShadows | None,
        film_transparent: bool,
        by_camera: bool,
        gathered: Features,
        shared: SharedGather | None,
    ) -> None:
        """Background and surfaces, seen directly."""
        for kind in (PixelClass.BACKGROUND, PixelClass.SURFACE):
            features = self._lighting.features
            if kind is PixelClass.SURFACE:
                features = features_for(self._lighting, shadows, is_seen=True, gathered=gathered)
            if kind is PixelClass.BACKGROUND and film_transparent:
                if not features & LAMPS:
                    continue
                features |= {FILM_TRANSPARENT}
            as_camera = by_camera or kind != PixelClass.BACKGROUND
            rays = rays_of(features, shadows)
            buffers = self._materials.buffers if kind is PixelClass.SURFACE else NONE
            is_shared = shared is not None and kind is PixelClass.SURFACE
            shader = shade_shader(kind, features, buffers, as_camera, is_shared)
            self._draw(
                shader,
                kind,
                seen,
                view_uniforms,
                weight,
                rays,
                seen.made if buffers else None,
                shared if is_shared else None,
            )

    def _add_shown(
        self,
        seen: SurfaceBuffer,
        reflected: SurfaceBuffer | Sequence[Environment] | None,
        view_uniforms: Any,
        weight: float,
        shadows: RayShadows | None,
        gathered: Features,
        shared: SharedGather | None,
        most_hits: int,
        tells_mirrors: bool,
    ) -> None:
        """Background and surfaces, seen in mirrors; `tells_mirrors`: mirrors are a class of their own among them."""
        if isinstance(reflected, SurfaceBuffer) or not reflected:
            shader = shade_shader(PixelClass.MIRROR, self._lighting.features, NONE)
            self._draw(shader, PixelClass.MIRROR, seen, view_uniforms, weight)
        if isinstance(reflected, SurfaceBuffer):
            for kind in (PixelClass.MIRROR_OF_SURFACE, *([PixelClass.MIRROR_OF_MIRROR] if tells_mirrors else [])):
                features = features_for(self._lighting, shadows, ends=self.mirror_bounces == 0, gathered=gathered)
                is_shared = shared is not None and kind is PixelClass.MIRROR_OF_SURFACE
                if kind is PixelClass.MIRROR_OF_MIRROR and most_hits > 1:
                    assert isinstance(reflected, PathBuffer)
                    shader = whole_path_shader(features, self._materials.buffers)
                    shader.bind()
                    if knows(shader, "most_hits"):
                        # (Where nothing is lit all has its own light alone.)
                        shader.uniform_float("most_hits", float(most_hits))
                    for name, texture in zip(WHOLE_PATH, (reflected.before, reflected.throughput), strict=True):
                        shader.uniform_sampler(name, texture)
                else:
                    features |= {WHOLE_PATHS} if most_hits > 1 else frozenset()
                    shader = shade_shader(kind, features, self._materials.buffers, True, is_shared)
                    shader.bind()
                textures = (reflected.position, reflected.normal, reflected.color)
                for name, texture in zip(REFLECTED, textures, strict=True):
                    shader.uniform_sampler(name, texture)
                rays = rays_of(features, shadows)
                made, rays_shared = reflected.made, shared if is_shared else None
                self._draw(shader, kind, seen, view_uniforms, weight, rays, made, rays_shared)
            return
        for environment in reflected or ():
            shader = environment_shader(environment.lookup, self._lighting.features)
            shader.bind()
            shader.uniform_float("mirror", float(environment.mirror))
            environment.bind(shader, environment.radiance)
            self._draw(shader, PixelClass.MIRROR, seen, view_uniforms, weight)

    def _add_front(
        self,
        seen: SurfaceBuffer,
        view_uniforms: Any,
        weight: float,
        mirrors_only: bool,
        shadows: RayShadows | None,
        by_camera: bool,
    ) -> None:
        """What adds to that in some scenes only (see `shade_front.frag.glsl`)."""
        mirrors = (PixelClass.MIRROR, PixelClass.MIRROR_OF_SURFACE, PixelClass.MIRROR_OF_MIRROR)
        if self._has_base:
            for kind in mirrors:
                features = features_for(self._lighting, shadows, is_seen=True)
                shader = front_shader(True, features, self._materials.buffers, by_camera)
                self._draw(shader, kind, seen, view_uniforms, weight, rays_of(features, shadows), seen.made)
        if mirrors_only:
            return
        kinds: list[PixelClass] = []
        if self._has_bodies[by_camera]:
            # (The background has shown all lamps.)
            others = {PixelClass.BACKGROUND, *(mirrors if self._has_base else ())}
            kinds = [kind for kind in PixelClass if kind not in others]
        for kind in kinds:
            shader = front_shader(False, self._lighting.features, NONE, by_camera)
            self._draw(shader, kind, seen, view_uniforms, weight)

    def _add_path(
        self,
        canvas: Canvas,
        bounce: Bounce,
        view_uniforms: Any,
        weight: float,
        shadows: RayShadows | None,
        gathered: Features,
    ) -> None:
        """Add the light of what rays off mirrors seen in mirrors have hit."""
        features = features_for(self._lighting, shadows, ends=bounce.ends, gathered=gathered)
        shader = path_shader(bounce.goes_on, features, self._materials.buffers)
        path = bounce.path
        target = canvas.with_depth(path.depth)
        with drawing_state("EQUAL", blend="ADDITIVE_PREMULT"), target.bind(), scissored(bounce.window):
            set_viewport(0, 0, path.width, path.height)
            shader.bind()
            if (rays := rays_of(features, shadows)) is not None:
                rays.bind(shader)
            shader.uniform_block("view", view_uniforms)
            shader.uniform_float("weight", weight)
            shader.uniform_sampler("materials", self._materials.table)
            textures = (bounce.mirrors.position, path.direction, path.throughput)
            for name, texture in zip(PATH, textures, strict=True):
                shader.uniform_sampler(name, texture)
            for name, texture in zip(REFLECTED, (path.position, path.normal, path.color), strict=True):
                shader.uniform_sampler(name, texture)
            path.made.bind(shader, self._materials.buffers)
            self._lighting.bind(shader)
            full_screen_triangle().draw(shader)

    def _draw(
        self,
        shader: Any,
        kind: PixelClass,
        seen: SurfaceBuffer,
        view_uniforms: Any,
        weight: float,
        rays: RayScene | None = None,
        made: MaterialBuffers | None = None,
        shared: SharedGather | None = None,
    ) -> None:
        """A full-screen triangle for the pixels of one class; `rays`: if it follows some; `made`: of what is lit;
        `shared`: rays that its pixels share."""
        shader.bind()
        if rays is not None:
            rays.bind(shader)
        shader.uniform_block("view", view_uniforms)
        shader.uniform_float("weight", weight)
        shader.uniform_float("pixel_class", float(kind))
        shader.uniform_sampler("materials", self._materials.table)
        for name, texture in zip(SEEN, (seen.position, seen.normal, seen.color), strict=True):
            shader.uniform_sampler(name, texture)
        if made is not None:
            made.bind(shader, self._materials.buffers)
        self._lighting.bind(shader)
        if shared is not None:
            shared.bind(shader)
        full_screen_triangle().draw(shader)
