# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""From a stage and a picture to anamorphoses, as the operator and the verb make them."""

from __future__ import annotations

from dataclasses import dataclass

from ...scene.arrays import Float64Array
from ..stage import ChosenSurface, Stage, quoted
from ..ways import WaysByMirrors
from .picture import Picture
from .picture_frame import FrameChoice, frame_on_mirror
from .placed import FINENESS, Anamorphosis, Chart, Landing, Placed
from .sheet import Paper, Sheet, sheet_of

FINE_ENOUGH = 1.5
"""Pixels of a picture along a texel, above which more texels would show more of it"""


@dataclass(frozen=True, slots=True)
class Making:
    """A picture framed on mirrors."""

    stage: Stage
    ways: WaysByMirrors
    picture: Picture
    anamorphosis: Anamorphosis

    def image(self, surface: ChosenSurface, width: int, height: int) -> Placed:
        """The image of a surface's UV map."""
        chart = Chart(surface.object_id, surface.mesh, surface.chart_places())
        return self.anamorphosis.image(chart, width, height, self.picture)

    def sheet(self, surface: ChosenSurface, paper: Paper) -> Sheet:
        """The print of a flat surface; raises as `sheet_of`."""
        eye: Float64Array = self.stage.view.place
        if self.stage.view.is_orthographic:
            eye = self.stage.middle + 1e3 * self.stage.view.eye[:3]
        return sheet_of(self.anamorphosis, self.stage.scene, surface.object_id, surface.name, eye, self.picture, paper)

    def told(self, placed: list[Placed]) -> tuple[Landing, list[str]]:
        """What becomes of the picture with these images; and sentences about it and what could be better."""
        landing = self.anamorphosis.landing(placed)
        names = {surface.object_id: surface.name for surface in self.stage.surfaces}
        found = landing.sentences(quoted([names[item.object_id] for item in placed]))
        for item in placed:
            if FINE_ENOUGH < item.coarseness < float("inf"):
                found.append(
                    f'A texel on "{names[item.object_id]}" holds {item.coarseness:.1f} pixels of the picture: '
                    "a larger image, or a UV map of the part that is seen, shows it sharper."
                )
        return landing, [*found, *self.stage.warnings]


def begin(stage: Stage, picture: Picture, choice: FrameChoice, fineness: int = FINENESS, beyond: float = 0.0) -> Making:
    """Frame the picture and follow what is seen through it. Raises InputError where no mirror is seen,
    GpuUnavailableError without a GPU context."""
    ways = WaysByMirrors(stage.scene, stage.middle)
    mirrors = set(stage.mirrors)
    aspect = picture.width / picture.height
    frame = frame_on_mirror(ways, stage.view, mirrors, choice, aspect, stage.mirror_names)
    anamorphosis = Anamorphosis(ways, stage.scene, stage.view, frame, mirrors, fineness, beyond)
    return Making(stage, ways, picture, anamorphosis)
