# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is done for a view before it is drawn: how each mirror is shown is decided, and what that needs is solved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..scene.arrays import SceneArrays
from ..scene.camera.view import View
from .choice import Choice, MirrorChoice, Scenery, choose, in_shadow
from .device.cubes import cube_texture
from .environments.cube import EnvironmentCube
from .geometry.chunk import Batches, Chunk
from .geometry.split import SOON, share_of_step
from .mirrors.baked_shape import BakedShape
from .mirrors.mirror import Mirror
from .paths.left_out import lets_light_on
from .reflection import Reflection
from .settings import Settings
from .shading.calm import CalmHistory
from .shading.lookup import Environment
from .shown.environment import ShownEnvironment
from .shown.nothing import ShownNothing
from .shown.rays import ShownRays
from .shown.shown import Shown, Stage
from .shown.vertices import ShownVertices
from .vertices.mirror_solver import MirrorSolver

EYE_INSIDE = 'The eye is inside of "{}", which shows itself there: choose Automatic or Exact, else it is black.'
CUT_OPEN = 'The near clip distance cuts "{}" open: its inside is shown as if light got in.'
SHARP = "Depth of field is left out: it takes more than one sample."


class Preparation:
    """Of one scene, in any view. Keeps what does not depend on the view: solvers, environment cubes, balls."""

    def __init__(self) -> None:
        self._solvers: dict[int, MirrorSolver] = {}
        """By the mirror's id"""
        self._scenery: Scenery | None = None
        self._cubes: tuple[list[BakedShape], list[EnvironmentCube]] | None = None

    def follow(self, scene: SceneArrays, mirrors: Sequence[Mirror]) -> None:
        """Another state of the scene, with these mirrors."""
        self._scene = scene
        self._solvers = {key: solver for key, solver in self._solvers.items() if solver.mirror in mirrors}
        self._scenery = self._cubes = None

    def forget_cubes(self) -> None:
        """Environment cubes would be drawn otherwise now."""
        self._cubes = None

    def reflect(
        self,
        stage: Stage,
        view: View,
        settings: Settings,
        reasons: Mapping[str, str],
        last: Reflection | None,
        is_still: bool,
        at_rest: bool,
    ) -> Reflection:
        """See `Renderer.reflect`. `reasons`: why mirrors need rays, by their names."""
        before = [None] * len(stage.mirrors) if last is None else last.of(stage.mirrors)
        choice = self._choose(stage, view, settings, reasons, is_still, last)
        chosen: Sequence[MirrorChoice | None] = [None] * len(stage.mirrors) if choice is None else choice.mirrors
        used = [settings if item is None else item.settings for item in chosen]
        self._split_scenery(stage, view, used, moves=last is not None and not at_rest)
        shown: list[Shown] = []
        warnings = [SHARP] if view.lens is not None and settings.samples == 1 else []
        for mirror, mine, item, old in zip(stage.mirrors, used, chosen, before, strict=True):
            if item is not None and item.shows_nothing:
                shown.append(ShownNothing(mirror, mine))
                continue
            shown.append(self._show(stage, mirror, view, mine, old, at_rest, warnings))
            if item is not None and isinstance(shown[-1], ShownVertices):
                warnings += shown[-1].shape.warnings
        coarse = stage.lighting.too_coarse(view)
        is_calm = not at_rest and stage.tracer is not None and stage.tracer.can_be_calm
        calm = None
        if is_calm and any(isinstance(one, ShownRays) for one in shown):
            calm = CalmHistory() if last is None or last.calm is None else last.calm
        told = tuple(dict.fromkeys(warnings))
        gathers = stage.indirect.is_gathered
        return Reflection(view, settings, tuple(shown), told, choice, coarse, at_rest, gathers, calm)

    def _choose(
        self,
        stage: Stage,
        view: View,
        settings: Settings,
        reasons: Mapping[str, str],
        is_still: bool,
        last: Reflection | None,
    ) -> Choice | None:
        """What `auto` does in a view; None for other methods."""
        if not settings.entry.chooses:
            return None
        if self._scenery is None:
            self._scenery = _read_scenery(stage, self._scene)
        before: dict[int, MirrorChoice] = {}
        if last is not None and last.choice is not None:
            before = {id(one.mirror): item for one, item in zip(last.shown, last.choice.mirrors, strict=False)}
        return choose(
            settings,
            view,
            stage.mirrors,
            self._scenery,
            reasons,
            is_still,
            [before.get(id(mirror)) for mirror in stage.mirrors],
        )

    @staticmethod
    def _split_scenery(stage: Stage, view: View, settings: Sequence[Settings], moves: bool) -> None:
        """Split edges that solved mirrors would show bent; while the view `moves` also some of those that they will
        when they are larger."""
        solved = [
            (mirror, used.pixel_tolerance, mirror.shape(used.map_resolution))
            for mirror, used in zip(stage.mirrors, settings, strict=True)
            if used.entry.solves_vertices and not mirror.holds_eye(view, mirror.shape(used.map_resolution))
        ]
        if not solved:
            return
        sights = [mirror.sight(view, tolerance, shape) for mirror, tolerance, shape in solved]
        stage.geometry.refine(sights)
        if moves:
            share = max(share_of_step(shape.radius_pixels(view)) for _, _, shape in solved)
            soon = [mirror.sight(view, tolerance, shape, SOON) for mirror, tolerance, shape in solved]
            if soon != sights:
                stage.geometry.refine_ahead(soon, share)

    def _show(
        self,
        stage: Stage,
        mirror: Mirror,
        view: View,
        settings: Settings,
        last: Shown | None,
        at_rest: bool,
        warnings: list[str],
    ) -> Shown:
        """By a method of the catalog; `warnings` gets what is not shown."""
        if mirror.is_cut_open(view, mirror.shape(settings.map_resolution)):
            warnings.append(CUT_OPEN.format(mirror.object_name))
        method = settings.entry
        if method.follows_rays:
            stage.rays()
            return ShownRays(mirror, settings)
        if mirror.holds_eye(view, mirror.shape(settings.map_resolution)):
            black_cube = cube_texture(np.zeros((6, 1, 1, 4), np.float32))
            black = Environment("environment_cube", black_cube, lambda: black_cube, mirror=mirror.number)
            warnings.append(EYE_INSIDE.format(mirror.object_name))
            return ShownEnvironment(mirror, settings, black)
        if method.is_environment:
            cube = self.environment_cubes(stage, settings)[mirror.number - 1]
            return ShownEnvironment(mirror, settings, cube.environment(settings.method, view))
        solver = self._solvers.get(id(mirror))
        if solver is None:
            solver = self._solvers[id(mirror)] = MirrorSolver(mirror)
        own = stage.geometry.of_instance(mirror.index)
        known = last.found if isinstance(last, ShownVertices) else None
        scenery = _scenery_shown(stage, mirror, view)
        parts, found = solver.solve(view, settings, scenery, own, stage.materials, known)
        if method.curves_edges and at_rest:
            parts = solver.with_curved_edges(view, settings, parts, own, stage.materials, stage.geometry.longest_edge)
        return ShownVertices(mirror, settings, mirror.shape(settings.map_resolution), parts, found, at_rest)

    def environment_cubes(self, stage: Stage, settings: Settings) -> list[EnvironmentCube]:
        """One per mirror, drawn when first asked for."""
        shapes = [mirror.shape(settings.map_resolution) for mirror in stage.mirrors]
        if self._cubes is None or self._cubes[0] != shapes:
            centers, radii = stage.geometry.balls()
            cubes = [
                EnvironmentCube(
                    mirror.number,
                    shape,
                    stage.geometry.scenery(mirror.index),
                    float((np.linalg.norm(centers - shape.center, axis=1) + radii).max()),
                    stage.materials,
                    stage.lighting,
                    stage.shade,
                    settings.environment_resolution,
                )
                for mirror, shape in zip(stage.mirrors, shapes, strict=True)
            ]
            self._cubes = shapes, cubes
        return self._cubes[1]


def _read_scenery(stage: Stage, scene: SceneArrays) -> Scenery:
    own = [mirror.index for mirror in stage.mirrors]
    there = [item.instance.visible_glossy and len(item.mesh.triangles) > 0 for item in stage.geometry.placed]
    mirrors = set(own)
    shown = [index for index, is_there in enumerate(there) if is_there and index not in mirrors]
    meshes = [stage.geometry.placed[index].mesh for index in shown]
    mirror_centers, mirror_radii = stage.geometry.balls(np.array(own, np.int64))
    return Scenery(
        *stage.geometry.balls(np.array(shown, np.int64)),
        np.array([len(mesh.positions) for mesh in meshes], np.int64),
        np.array([len(mesh.triangles) for mesh in meshes], np.int64),
        np.array([lets_light_on(scene, stage.geometry.placed[index].instance) for index in shown], bool),
        mirror_centers,
        np.where(np.array([there[index] for index in own], bool), mirror_radii, 0.0),
    )


def _scenery_shown(stage: Stage, mirror: Mirror, view: View) -> list[tuple[Chunk, Batches]]:
    """All that a mirror may show, but chunks that it cannot for sure: these are not solved."""
    parts = stage.geometry.scenery(mirror.index)
    hidden = in_shadow(mirror, view, *stage.geometry.chunk_balls([chunk for chunk, _ in parts]))
    return [part for part, is_hidden in zip(parts, hidden.tolist(), strict=True) if not is_hidden]
