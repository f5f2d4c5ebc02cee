# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Footprints: solved points only bound where a triangle may be reflected, each pixel inside tests its own ray.

    python tools/measure/footprints/measure_footprints.py [--triangles N] [--pixels N] [--views N]

No proof says that the box of a triangle (method.py) holds its whole reflection, so this command counts the mirror
pixels where the picture is another than that of `exact`.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent))

import bootstrap
import bpy  # noqa: F401  (before gpu)

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture  # noqa: E402
from curvrefl.curvrefl_addon.renderer.measured.hall import hall, view_of_mirror  # noqa: E402
from curvrefl.curvrefl_addon.renderer.mirrors.mirror import Mirror  # noqa: E402
from curvrefl.curvrefl_addon.renderer.rays.paths import IN_THE_OPEN, PathBuffer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.materials import Materials  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.primary import draw_primary  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.surface_buffer import SurfaceBuffer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.view_block import view_block  # noqa: E402
from footprints.method import Footprints, Margins  # noqa: E402


@dataclass
class Comparison:
    """Of mirror pixels of one view with `exact`."""

    pixels: int
    hits: int
    """Of `exact`"""
    missing: int
    """`exact` hits something, footprints nothing"""
    farther: int
    """Both do, footprints behind it"""
    nearer: int
    """Or before it, or where `exact` hits nothing"""


class Compared:
    """One scene, drawn both ways."""

    def __init__(self, triangles: int, pixels: float, size: tuple[int, int]) -> None:
        scene = hall(triangles)
        self.size, self.pixels = size, pixels
        self.materials = Materials(scene)
        self.renderer = Renderer(scene, Settings(method="newton", samples=1))
        self.seen, self.shown, self.path = SurfaceBuffer(*size), SurfaceBuffer(*size), PathBuffer(*size)

    @property
    def mirror(self) -> Mirror:
        return self.renderer.mirrors[0]

    def compare(self, turn: float, footprints: Footprints) -> Comparison:
        """The eye goes round the mirror by `turn`, radians."""
        view = view_of_mirror(*self.size, self.pixels, turn)
        uniforms = view_block(view)
        draw_primary(self.seen, self.renderer.geometry.seen(view), self.materials, uniforms)
        footprints.draw(self.shown, self.seen, view, uniforms)
        window = self.mirror.window(view)
        self.path.follow(self.seen, self.renderer.rays(), self.materials, uniforms, window, IN_THE_OPEN)
        x, y, width, height = window

        def part(texture: Any) -> np.ndarray:
            return read_texture(texture)[y : y + height, x : x + width]

        is_mirror = part(self.seen.color)[..., 3] > 0.5
        origin = part(self.seen.position)[is_mirror][:, :3]
        truth, found = (part(buffer.position)[is_mirror] for buffer in (self.path, self.shown))
        far, near = (np.linalg.norm(hits[:, :3] - origin, axis=1) for hits in (found, truth))
        is_hit, is_found = truth[:, 3] > 0.5, found[:, 3] > 0.5
        both = is_hit & is_found
        return Comparison(
            int(is_mirror.sum()),
            int(is_hit.sum()),
            int((is_hit & ~is_found).sum()),
            int((both & (far > near * (1.0 + 1e-4))).sum()),
            int((both & (far < near * (1.0 - 1e-4))).sum() + (is_found & ~is_hit).sum()),
        )


def main() -> None:
    """Compare with `exact` and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--triangles", type=int, default=125_000, help="of the largest scene (%(default)s)")
    parser.add_argument("--pixels", type=float, default=300.0, help="width of the mirror (%(default)s)")
    parser.add_argument("--views", type=int, default=8, help="around the mirror (%(default)s)")
    parser.add_argument("--margins", type=float, nargs=4, help="see Margins")
    options = parser.parse_args()
    require_gpu()
    margins = Margins(*options.margins) if options.margins else Margins()
    for count in (n for n in (1_000, 10_000, 125_000, 500_000, 2_000_000) if n <= options.triangles):
        compared = Compared(count, options.pixels, (640, 480))
        footprints = Footprints(compared.renderer, compared.materials, margins)
        total = Comparison(0, 0, 0, 0, 0)
        for number in range(options.views):
            one = compared.compare(number * 2.0 * np.pi / options.views, footprints)
            total = Comparison(*(getattr(total, name) + getattr(one, name) for name in Comparison.__dataclass_fields__))
        counts = ", ".join(f"{number:,} {name}" for name, number in footprints.counts.items())
        print(f"{footprints.triangles:,} triangles, {footprints.points:,} points solved; {counts}")
        print(
            f"   {total.pixels:,} mirror pixels, {total.hits:,} hits: {total.missing:,} missing, "
            f"{total.farther:,} too far, {total.nearer:,} too near",
            flush=True,
        )
        compared.renderer.free()


if __name__ == "__main__":
    main()
