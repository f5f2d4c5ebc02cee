# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes of matt things that light each other, and pictures of them: at rest, while the view moves, by Cycles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo.data_blocks import add_object, principled
from curvrefl.curvrefl_addon.demo.shapes import Shape, ball, box
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_moments

SIZE = (96, 72)
SAMPLES = 16
MIRROR = "mirror"
type Color = tuple[float, float, float]


def gray(value: float) -> Color:
    """The same of all colors."""
    return (value, value, value)


def start(bounces: int) -> Any:
    """An empty file with a black world; light bounces off so many surfaces."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene: Any = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.diffuse_bounces, cycles.max_bounces = bounces, 16
    # Light that mirrors throw on what is matt is nobody's business here.
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.use_light_tree = False
    cycles.light_sampling_threshold = 0.0
    world_of(gray(0.0))
    return scene


def world_of(color: Color) -> None:
    """A world of one radiance everywhere."""
    scene: Any = bpy.context.scene
    scene.world = scene.world or bpy.data.worlds.new("world")
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*color, 1.0)


def matte(color: Color, emission: Color = (0.0, 0.0, 0.0)) -> bpy.types.Material:
    """Nothing but a base, by Lambert's law, and what it shines by itself."""
    made = principled("matte", color, roughness=1.0, emission=emission)
    tree: Any = made.node_tree
    tree.nodes["Principled BSDF"].inputs["Specular IOR Level"].default_value = 0.0
    return made


def add_mirror(radius: float, location: Sequence[float] = (0.0, 0.0, 0.0)) -> Any:
    """A ball that reflects all light. It stands in no light's way: what would be lit over it is another matter."""
    made: Any = add_object(MIRROR, ball(radius, 64), principled("chrome", gray(1.0), 1.0, 0.0), True, location)
    made.visible_diffuse = made.visible_shadow = False
    return made


def add_box(
    name: str, low: Sequence[float], high: Sequence[float], material: bpy.types.Material, inward: bool = False
) -> Any:
    """A box between two corners; its faces may be turned to what is in it."""
    middle, size = 0.5 * (np.array(low) + high), np.array(high) - np.array(low)
    return add_object(name, inside_out(box(size.tolist())) if inward else box(size.tolist()), material, location=middle)


def inside_out(shape: Shape) -> Shape:
    """With all faces turned."""
    return Shape(shape.positions, tuple(tuple(reversed(polygon)) for polygon in shape.polygons))


@dataclass(frozen=True)
class Shown:
    """A picture and what is seen where."""

    picture: np.ndarray
    """(h, w, 3), scene-linear, row 0 at the bottom"""
    position: np.ndarray
    """(h, w, 3) of what the eye sees itself"""
    normal: np.ndarray
    is_mirror: np.ndarray
    """(h, w)"""
    is_thing: np.ndarray
    """(h, w): something, which is no mirror"""

    def mean(self, chosen: np.ndarray) -> np.ndarray:
        """(3,) over these pixels."""
        return self.picture[chosen].mean(axis=0)


def read(mirrors: Sequence[str] = (MIRROR,), size: tuple[int, int] = SIZE) -> tuple[SceneArrays, View]:
    """The open scene, as renders read it."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    assert scene is not None
    assert layer is not None
    still, _, _ = read_render_moments(scene, layer, list(mirrors), *size, SAMPLES)
    return still.scene, still.view


def at_rest(samples: int = SAMPLES, size: tuple[int, int] = SIZE, method: str = "auto") -> Shown:
    """The open scene as a render shows it."""
    arrays, view = read(size=size)
    return rendered(arrays, view, samples, method)


def rendered(arrays: SceneArrays, view: View, samples: int = SAMPLES, method: str = "auto") -> Shown:
    """The same of a scene that has been read."""
    renderer = Renderer(arrays, Settings(method=method, samples=samples))
    found = by_renderer(renderer, view)
    renderer.free()
    return found


def by_renderer(renderer: Renderer, view: View) -> Shown:
    """At rest."""
    frame = renderer.render(view)
    return _shown(frame.color(), frame.surfaces)


def moving(arrays: SceneArrays, view: View, samples: int = 4) -> Shown:
    """While the view moves: surfaces are lit by their patches alone."""
    renderer = Renderer(arrays, Settings(method="auto", samples=samples))
    canvas = Canvas.of_size(view.width, view.height)
    reflection = renderer.reflect(view)
    for index in range(samples):
        renderer.add_sub_frame(canvas, reflection, index, 1.0 / samples)
    found = _shown(canvas.pixels(), renderer.surfaces_of(reflection))
    renderer.free()
    return found


def _shown(color: np.ndarray, surfaces: dict[str, np.ndarray]) -> Shown:
    seen = surfaces["seen_color"][..., 3]
    is_there = surfaces["seen_position"][..., 3] > 0.5
    mirrors = is_there & (seen > 0.5)
    place, normal = surfaces["seen_position"][..., :3], surfaces["seen_normal"][..., :3]
    return Shown(color[..., :3], place, normal, mirrors, is_there & ~mirrors)


def by_cycles(samples: int, size: tuple[int, int] = SIZE) -> np.ndarray:
    """(h, w, 3) of the open scene with all its bounces."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    assert scene is not None
    assert layer is not None
    return render_reference(scene, layer, *size, samples, "full").pixels[..., :3]


def without_bounces(arrays: SceneArrays) -> SceneArrays:
    """In light straight from lamps, the world and what shines."""
    return replace(arrays, diffuse_bounces=0)


def inner(chosen: np.ndarray, by: int = 2) -> np.ndarray:
    """Pixels whose neighbors, so many away, are chosen, too: the pixel filter mixes in nothing else."""
    padded = np.pad(chosen, by)
    found = np.ones_like(chosen)
    height, width = chosen.shape
    for row in range(2 * by + 1):
        for column in range(2 * by + 1):
            found &= padded[row : row + height, column : column + width]
    return found
