# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints what the papers' own figures come to here, on scenes that are like theirs in kind and in number of vertices.

python tools/measure/measure_papers.py

* Estalella et al. 2006, table 1: steps of the search on the screen over animations, each frame from the last one's
  texels, at half and at all of the number of frames.
* Estalella et al. 2005, figures 7 and 8: shares of grid vertices, numbers of steps.
* Roger & Holzschuch 2006, section 3.2 and figure 3(c): steps of the secant search, and where they are many.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from statistics import mean

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bootstrap
import bpy  # noqa: F401  (before the package)
import numpy as np

bootstrap.load_package()

from curvrefl.curvrefl_addon.optics import status  # noqa: E402
from curvrefl.curvrefl_addon.optics.fermat import sample  # noqa: E402
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, RadialSurface, unit  # noqa: E402
from curvrefl.curvrefl_addon.renderer.reflection import Reflection  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays  # noqa: E402
from curvrefl.curvrefl_addon.scene.meshes.made import smooth_mesh  # noqa: E402
from curvrefl.curvrefl_addon.study.solvers.solver_table import solver_table, study_view  # noqa: E402
from curvrefl.curvrefl_addon.study.solvers.vertex_accuracy import VertexTruth  # noqa: E402

WHOLE = 50.0
"""Pixel tolerance at which these meshes are not split"""
FACES = ((0, -1.0), (0, 1.0), (1, -1.0), (1, 1.0), (2, -1.0), (2, 1.0))


@dataclass(frozen=True)
class Animation:
    """A scene like one of the paper's, and how it moves."""

    name: str
    paper_mean: float
    """Of the averages of all frames (table 1)"""
    paper_max: float
    """Mean over the frames of each one's longest search"""
    surface: RadialSurface
    things: tuple[MeshArrays, ...]
    mirrors: tuple[tuple[tuple[float, float, float], float], ...]
    """Place and size"""
    eyes: tuple[tuple[float, float, float], tuple[float, float, float]]
    """First and last, about the origin that is looked at"""
    length: int
    """Frames"""
    descent: float = 0.0
    """How far the mirrors come down in all"""

    def frames(self, count: int) -> Iterator[tuple[SceneArrays, np.ndarray]]:
        """Scene and homogeneous eye of each frame; arrays that stay are the same objects."""
        mirror = ball(self.surface, 96)
        material = MaterialArrays("chrome", base_color=(1, 1, 1), metallic=1, roughness=0)
        meshes = (mirror, *self.things)
        things = tuple(
            InstanceArrays(f"thing {index}", 100 + index, 1 + index, np.eye(4), (0,))
            for index in range(len(self.things))
        )
        for share in np.linspace(0.0, 1.0, count):
            placed = []
            for number, (place, size) in enumerate(self.mirrors, 1):
                matrix = np.diag([size, size, size, 1.0])
                matrix[:3, 3] = np.array(place) - [0.0, 0.0, share * self.descent]
                placed.append(InstanceArrays(f"mirror {number}", number, 0, matrix, (1,)))
            instances = (*placed, *things)
            ids = tuple(range(1, len(placed) + 1))
            scene = SceneArrays(meshes, instances, (MaterialArrays("gray"), material), (), (), WorldArrays(), ids)
            first, last = (np.array(eye) for eye in self.eyes)
            yield scene, np.append((1.0 - share) * first + share * last, 1.0)


def ball(
    surface: RadialSurface, columns: int, center: tuple[float, ...] = (0.0, 0.0, 0.0), size: float = 1.0
) -> MeshArrays:
    """A star-shaped surface as longitude and latitude."""
    rows = columns // 2
    longitude = np.linspace(0.0, 2.0 * np.pi, columns, endpoint=False)
    latitude = np.linspace(-0.5 * np.pi, 0.5 * np.pi, rows + 1)[:, None]
    ones = np.ones_like(longitude)
    u = np.stack(
        [np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude) * ones], axis=-1
    )
    at = sample(surface, unit(u.reshape(-1, 3)))
    low = (np.arange(rows)[:, None] * columns + np.arange(columns)).ravel()
    next_low = (np.arange(rows)[:, None] * columns + (np.arange(columns) + 1) % columns).ravel()
    lower = np.column_stack([low, next_low, next_low + columns])[columns:]
    upper = np.column_stack([low, next_low + columns, low + columns])[:-columns]
    return smooth_mesh("mesh", np.asarray(center) + size * at.position, at.normal, np.concatenate([lower, upper]))


def block(center: tuple[float, ...], halves: tuple[float, ...], cells: int) -> MeshArrays:
    """A box with cells^2 quads on each side."""
    positions: list[np.ndarray] = []
    normals: list[np.ndarray] = []
    triangles: list[np.ndarray] = []
    edge = np.linspace(-1.0, 1.0, cells + 1)
    x, y = (grid.ravel() for grid in np.meshgrid(edge, edge))
    low = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    quads = np.concatenate(
        [np.column_stack([low, low + 1, low + cells + 2]), np.column_stack([low, low + cells + 2, low + cells + 1])]
    )
    for axis, sign in FACES:
        points = np.empty((len(x), 3))
        points[:, axis], points[:, (axis + 1) % 3], points[:, (axis + 2) % 3] = sign, x, sign * y
        triangles.append(quads + len(x) * len(positions))
        positions.append(np.asarray(center) + points * np.asarray(halves))
        normals.append(np.tile(sign * np.eye(3)[axis], (len(x), 1)))
    return smooth_mesh("mesh", np.concatenate(positions), np.concatenate(normals), np.concatenate(triangles))


def floor(height: float, half: float, cells: int) -> MeshArrays:
    edge = np.linspace(-half, half, cells + 1)
    x, y = (grid.ravel() for grid in np.meshgrid(edge, edge))
    low = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    quads = np.concatenate(
        [np.column_stack([low, low + 1, low + cells + 2]), np.column_stack([low, low + cells + 2, low + cells + 1])]
    )
    positions = np.column_stack([x, y, np.full(len(x), height)])
    return smooth_mesh("mesh", positions, np.tile([0.0, 0.0, 1.0], (len(x), 1)), quads)


def kitchen() -> Animation:
    """A bowl, seen from outside, among things on a table and walls around; the eye comes closer."""
    random = np.random.default_rng(1)
    things = [floor(-0.6, 4.0, 40), block((0.0, 0.0, 3.0), (6.0, 6.0, 4.0), 16)]
    for number in range(26):
        angle, distance, size = 2.4 * number, random.uniform(1.4, 3.6), random.uniform(0.12, 0.35)
        place = (distance * np.cos(angle), distance * np.sin(angle), size - 0.6)
        things.append(ball(Ellipsoid(), 32, place, size) if number % 2 else block(place, (size,) * 3, 7))
    eyes = ((2.0, -5.2, 2.2), (0.8, -2.1, 0.9))
    return Animation("kitchen", 4.7, 14.9, Ellipsoid(1.0, 1.0, 0.6), tuple(things), (((0.0, 0.0, 0.0), 1.0),), eyes, 60)


def landing() -> Animation:
    """A flat round thing that comes down between towers, seen from a fixed place."""
    random = np.random.default_rng(2)
    things = [floor(-2.2, 14.0, 100)]
    for number in range(46):
        angle, distance = 2.4 * number, random.uniform(2.6, 12.0)
        height = random.uniform(0.4, 2.4)
        place = (distance * np.cos(angle), distance * np.sin(angle), height - 2.2)
        things.append(block(place, (0.5, 0.5, height), 15))
    eyes = ((1.5, -5.0, 0.6), (1.5, -5.0, 0.6))
    return Animation(
        "landing", 4.2, 71.2, Ellipsoid(1.0, 1.0, 0.3), tuple(things), (((0.0, 0.0, 0.8), 1.3),), eyes, 120, descent=2.0
    )


def eyes_of_ants() -> Animation:
    """Eight small balls among cans; the eye passes by."""
    random = np.random.default_rng(3)
    things = [floor(-1.0, 6.0, 60)]
    for number in range(28):
        angle, distance, size = 2.4 * number, random.uniform(2.0, 5.5), random.uniform(0.2, 0.5)
        place = (distance * np.cos(angle), distance * np.sin(angle), size - 1.0)
        things.append(ball(Ellipsoid(0.7, 0.7, 1.0), 40, place, size))
    mirrors = tuple(
        ((1.2 * np.cos(1.57 * k) + s, 1.2 * np.sin(1.57 * k), -0.5), 0.14) for k in range(4) for s in (-0.18, 0.18)
    )
    return Animation("ants", 3.3, 7.5, Ellipsoid(), tuple(things), mirrors, ((3.0, -5.0, 1.6), (-1.0, -5.4, 1.2)), 12)


def table_1(animation: Animation, count: int) -> None:
    """Steps of each frame; the first one starts in the middle of the mirror."""
    means, longest, moves = [], [], []
    # The meshes are as fine as they are, like the paper's after its loader.
    settings = Settings(method="bisector_screen", pixel_tolerance=WHOLE)
    renderer: Renderer | None = None
    reflection: Reflection | None = None
    before = None
    for scene, eye in animation.frames(count):
        if renderer is None:
            renderer = Renderer(scene, settings)
        else:
            renderer.update(scene)
        view = study_view(eye)
        reflection = renderer.reflect(view, last=reflection)
        read = [solution.read() for solution in reflection.solutions]
        points, code, steps = (np.concatenate([part[k] for part in read]) for k in range(3))
        means.append(float(steps.mean()))
        longest.append(int(steps.max()))
        if before is not None:
            shown = (code == status.REFLECTED) & (before[1] == status.REFLECTED)
            texels = view.project(points[shown].astype(np.float64)) - view.project(before[0][shown].astype(np.float64))
            moves.append(float(np.abs(texels).sum(axis=1).mean()))
        before = points, code
    assert renderer is not None
    vertices = len(steps) // len(renderer.mirrors)
    renderer.free()
    ratio = mean(means) / animation.paper_mean - 1.0
    print(
        f"{animation.name:10} {vertices:8,} {len(animation.mirrors):7} {count:6} {mean(moves):6.2f} {means[0]:11.1f} "
        f"{mean(means):6.2f} {animation.paper_mean:6.1f} {ratio:+6.0%} {mean(means[1:]):13.2f} {mean(longest):12.1f} "
        f"{animation.paper_max:6.1f}"
    )


def steps_and_grids(animation: Animation) -> None:
    """Vertex errors and times of the 2005 paper's settings in the middle of the animation."""
    *_, (scene, eye) = animation.frames(2)
    truth = VertexTruth(scene, study_view(eye))
    try:
        truth.prepare()
        rows = [
            ("all vertices", Settings(method="bisector_cube", steps=steps), f"{steps} steps") for steps in (3, 5, 7, 9)
        ]
        rows += [
            ("grids", Settings(method="bisector_grid", grid_share=share), f"{share:.1%} of the vertices")
            for share in (0.041, 0.055, 0.096, 0.143)
        ]
        for kind, settings, text in rows:
            found = truth.measure(settings)
            assert found is not None
            more = truth.time_again(found, settings)
            print(
                f"{kind:14} {text:24} {found.median_px or 0.0:12.3f} {found.p95_px or 0.0:8.2f} "
                f"{found.misclassified:12.2%} {found.unconverged:9.2%} {more.ms_per_million.median:12.0f}"
            )
    finally:
        truth.free()


def secant_steps() -> None:
    """By how close the reflection is to the silhouette."""
    shapes = ("sphere", "ellipsoid", "bumpy", "kettle")
    rows, _ = solver_table(
        600,
        shapes,
        ("far", "near", "contact", "grazing", "silhouette"),
        ("secant_star",),
        timed=False,
        only_defaults=True,
    )
    for row in rows:
        print(
            f"{row.reflector:12} {row.regime:12} {row.iterations_mean:6.1f} {row.iterations_p99:5.0f} "
            f"{row.iterations_max:5d} {row.unconverged:9.2%}"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.parse_args()
    print("Estalella 2006, table 1, at 640 x 480; moved: texels per frame, |x| + |y|")
    print(
        f"{'':10} {'vertices':>8} {'mirrors':>7} {'frames':>6} {'moved':>6} {'first frame':>11} {'mean':>6} "
        f"{'paper':>6} {'':>6} {'without first':>13} {'frame longest':>12} {'paper':>6}"
    )
    for animation in (kitchen(), landing(), eyes_of_ants()):
        for share in (0.5, 1.0):
            table_1(animation, round(share * animation.length))
    print("\nEstalella 2005, figures 7 and 8, on the kitchen's last frame")
    print(f"{'':14} {'':24} {'px: median':>12} {'p95':>8} {'wrong side':>12} {'unsolved':>9} {'ms/million':>12}")
    steps_and_grids(kitchen())
    print("\nRoger & Holzschuch 2006, section 3.2: steps of the secant search")
    print(f"{'':12} {'':12} {'mean':>6} {'p99':>5} {'max':>5} {'unsolved':>9}")
    secant_steps()


if __name__ == "__main__":
    main()
