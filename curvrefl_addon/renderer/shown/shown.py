# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What one mirror shows in one view, as one interface with a kind for each way to get there.

A kind draws all of its mirrors in a view at once, so that many mirrors that show the same way cost as many passes as
one: what is done for a group is a class method over the members.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from ...scene.arrays import Float32Array
from ...scene.camera.view import View
from ..device.records import record_texture
from ..geometry.scene_geometry import SceneGeometry
from ..indirect.gather import Gathering
from ..indirect.indirect import IndirectLight
from ..lighting.lighting import Lighting
from ..mirrors.mirror import Mirror
from ..rays.ray_scene import RayScene
from ..settings import Settings
from ..shading.calm import CalmHistory
from ..shading.features import RayShadows
from ..shading.lookup import Environment
from ..shading.shade import ShadePass
from ..surfaces.canvas import Canvas
from ..surfaces.materials import Materials
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.windows import Window
from ..tracing.tracer import PathTracer
from ..vertices.solution import SolvedChunk, VertexSolution
from .targets import Targets

type Reflected = SurfaceBuffer | Sequence[Environment]
"""The reflected scene's surface buffer, or for each mirror the environment that stands for it"""


@dataclass(frozen=True, slots=True)
class Stage:
    """What of a scene all views share."""

    mirrors: Sequence[Mirror]
    geometry: SceneGeometry
    materials: Materials
    lighting: Lighting
    shade: ShadePass
    rays: Callable[[], RayScene]
    """The scene as rays need it, made when first asked for"""
    indirect: IndirectLight
    tracer: PathTracer | None = None
    """Where rays do not only go from sharp mirror to sharp mirror"""


@dataclass(frozen=True, slots=True)
class SubFrame:
    """One sub-frame while it is drawn."""

    stage: Stage
    view: View
    """Jittered"""
    uniforms: Any
    """View block of the same"""
    targets: Targets
    window: Window | None
    """Holds all mirrors, where nothing else is drawn"""
    shadows: RayShadows | None = None
    """Where maps are too coarse for the view"""
    index: int = 0
    """Its number"""
    gathers: Gathering | None = None
    """See `ShadePass.add`"""

    @property
    def sky_is_gathered(self) -> bool:
        """Rays find the world, in place of its directions' shadows."""
        return self.gathers is not None and self.gathers.has_sky


@dataclass(frozen=True, slots=True)
class Light:
    """Where the light of a group is added."""

    canvas: Canvas
    weight: float
    chosen: Any = None
    """Record texture by mirrors' numbers, 1 for those of the group; None where there is one group"""
    with_others: bool = True
    """The pixels that show no mirror are of this group too"""
    film_transparent: bool = False
    calm: CalmHistory | None = None
    """See `Reflection.calm`"""


@dataclass(frozen=True)
class Shown(ABC):
    """What one mirror shows in one view, before it is drawn."""

    has_reliefs: ClassVar[bool] = True
    """The mirror's bumps and normal maps count"""

    mirror: Mirror
    settings: Settings
    """With the method by which it is shown in place of `auto`"""

    @property
    def method(self) -> str:
        """Name in the catalog."""
        return self.settings.method

    @property
    def is_final(self) -> bool:
        """Nothing is left that would be done for a view at rest alone."""
        return True

    @property
    def parts(self) -> tuple[SolvedChunk, ...]:
        """Its scenery with reflection points, where vertices are solved."""
        return ()

    @property
    def solutions(self) -> tuple[VertexSolution, ...]:
        """Of all chunks that it may show: every vertex its first image."""
        return ()

    def wait(self) -> None:
        """Return when the GPU has finished what was done before drawing."""
        for solution in self.solutions:
            solution.wait()

    @classmethod
    @abstractmethod
    def draw(cls, members: Sequence[Self], sub_frame: SubFrame, of_positions: bool = False) -> Reflected | None:
        """Geometry passes of these mirrors; returns what they show, None for the background alone.

        `of_positions`: what is returned is asked for positions, else for light.
        """

    @classmethod
    def add_light(cls, members: Sequence[Self], sub_frame: SubFrame, light: Light) -> None:
        """Add what `draw` has drawn, lit, to a picture."""
        shown = cls.draw(members, sub_frame)
        sub_frame.stage.shade.add(
            light.canvas,
            sub_frame.targets.seen,
            shown,
            sub_frame.uniforms,
            light.weight,
            sub_frame.window,
            shadows=sub_frame.shadows,
            chosen=light.chosen,
            with_others=light.with_others,
            film_transparent=light.film_transparent,
            gathers=sub_frame.gathers,
        )

    @classmethod
    @abstractmethod
    def read_back(cls, members: Sequence[Self], sub_frame: SubFrame) -> dict[str, Float32Array]:
        """(h, w, 4) arrays `reflected_position` and, where there are surfaces, `reflected_color`; see `Frame`."""


def chosen_mirrors(members: Sequence[Shown], count: int) -> Any:
    """See `Light.chosen`; of so many mirrors in all."""
    flags = np.zeros((count + 1, 4), np.float32)
    flags[[shown.mirror.number for shown in members]] = 1.0
    return record_texture(flags)
