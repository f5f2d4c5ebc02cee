# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes whose time tells what `auto` counts with, in a hall."""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from ..choice import VERTICES
from ..costs.model import layers_around
from ..device.shaders import compiled
from ..device.textures import read_texture
from ..rays.paths import IN_THE_OPEN, PathBuffer
from ..reflection import Reflection
from ..renderer import Renderer
from ..settings import Settings
from ..surfaces.materials import Materials
from ..surfaces.primary import draw_primary
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.view_block import view_block
from ..surfaces.windows import Window
from ..vertices.mirror_solver import SOLVER_SHARE, MirrorSolver
from ..vertices.reflected import draw_reflected
from ..vertices.solution import SolvedChunk, VertexSolution
from ..vertices.solve import PreparedSolve, prepare_solve
from .hall import hall, view_of_mirror

THINGS = 12
"""Objects of a hall"""
MAP = 64
COVERED = 0.9
"""Of a picture's width by the mirror"""
TURN = 0.002
"""The eye goes round so far between two frames, radians"""


class HallPasses:
    """A hall, and the passes that are timed in it.

    Raises as a renderer does. `renderer` is to be freed.
    """

    def __init__(self, triangles: int) -> None:
        scene = hall(triangles, THINGS)
        self.settings = Settings(method=VERTICES, samples=1, map_resolution=MAP)
        self.renderer = Renderer(scene, self.settings)
        self.materials = Materials(scene)
        self.triangles = sum(len(scene.meshes[item.mesh].triangles) for item in scene.instances[1:])
        self.mirror = self.renderer.mirrors[0]
        self.shape = self.mirror.shape(MAP)
        self.own = self.renderer.geometry.of_instance(self.mirror.index)
        centers, radii = self.renderer.geometry.balls(np.arange(1, len(scene.instances)))
        self._reflection: Reflection | None = None
        self._turn = 0.0
        self.layers = layers_around(self.shape.center, centers, radii)

    def build_trees(self) -> Generator[None]:
        """Hierarchies as a viewport at rest has them."""
        yield from compiled(self.renderer.rays)
        while self.renderer.hierarchies.can_improve:
            yield
            self.renderer.hierarchies.improve()

    def look(self, size: int) -> None:
        """At the mirror, in pictures so wide and high."""
        self.size = size
        self.view = view_of_mirror(size, size, COVERED * size)
        self.uniforms, self.window = view_block(self.view), self.mirror.window(self.view)
        self.seen, self.shown = SurfaceBuffer(size, size), SurfaceBuffer(size, size)
        self.path = PathBuffer(size, size)

    def see(self) -> None:
        """What the eye sees itself."""
        draw_primary(self.seen, self.renderer.geometry.seen(self.view), self.materials, self.uniforms)

    def walk(self) -> None:
        """Rays of the mirror's pixels."""
        rays = self.renderer.rays()
        self.path.follow(self.seen, rays, self.materials, self.uniforms, self.window, IN_THE_OPEN, goes_on=False)

    def draw(self, parts: tuple[SolvedChunk, ...], window: Window | None = None) -> None:
        """Solved triangles onto the mirror, or only in a window of its pixels, over those of the time before, which are
        as near."""
        bound = self.shape.bound
        window = self.window if window is None else window
        number = self.mirror.number
        draw_reflected(self.shown, self.seen, number, None, parts, self.materials, self.uniforms, bound, window)

    def touch(self, parts: tuple[SolvedChunk, ...]) -> None:
        """Draw onto a single pixel."""
        self.draw(parts, (self.size // 2, self.size // 2, 1, 1))

    def clear(self, parts: tuple[SolvedChunk, ...]) -> None:
        """All targets of that, and touch them: drivers drop a clear that another follows."""
        self.shown.clear()
        self.touch(parts)

    def reflect(self) -> Reflection:
        """Solve for a moving eye, each time from the points of the time before."""
        self._turn = TURN - self._turn
        view = view_of_mirror(self.size, self.size, COVERED * self.size, self._turn)
        self._reflection = self.renderer.reflect(view, last=self._reflection)
        return self._reflection

    def rest(self) -> Reflection:
        """Solve from the start, and ask of the edges what a view at rest asks."""
        self._reflection = self.renderer.reflect(self.view, at_rest=True)
        return self._reflection

    def wait_for_points(self) -> None:
        """Of the last of these."""
        assert self._reflection is not None
        self._reflection.wait()

    def prepared(self, positions: object, count: int, turn: float, last: VertexSolution | None) -> PreparedSolve:
        """A solve of points around the mirror."""
        view = view_of_mirror(self.size, self.size, COVERED * self.size, turn)
        reflector = MirrorSolver(self.mirror).reflector(view, self.settings, self.own, self.materials)
        tolerance = SOLVER_SHARE * self.settings.pixel_tolerance
        return prepare_solve(self.settings.method, view, reflector, positions, count, tolerance, last)

    def mirror_pixels(self) -> int:
        """Of the picture that was seen last."""
        return int((read_texture(self.seen.color)[..., 3] == self.mirror.number).sum())
