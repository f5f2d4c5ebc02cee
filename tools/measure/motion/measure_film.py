# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plays the frames of a file as a viewport does, by several methods, and says what pops, what is a hole, what is slow.

    python tools/measure/motion/measure_film.py FILE.blend [--methods auto,newton,secant_star,exact] [--frames 1-120]

* *pop*: by how many pixels a vertex's reflection point moves from one frame to the next other than the oracle's, the
  largest of all frames; of methods that solve vertices, for vertices chosen at random whose point is in the picture.
* *px*: how far what pixels show is from where float64 rays show it, in some of the frames: 99th percentile and worst.
* *holes*: pixels that show nothing where rays find something (they and all beside them), over all frames; *missing*:
  vertices in the picture that the oracle reflects and the method does not.
* *ms*: a redraw of one sub-frame as of a viewport while something moves (its resolution follows the time), the GPU's
  work and reading the scene included: the median, and the slowest against it; *CPU* the same by the time of all
  threads, which other work on the machine leaves nearly alone.

The film is played for its times alone first, and again to be judged, at its whole resolution. Mirrors are those that
the file marks. The first frame is drawn when all of the scene is there, as when it is played.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

MEASURE = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(MEASURE.parent), str(MEASURE)]

import bootstrap  # noqa: E402
import bpy  # noqa: E402
import numpy as np  # noqa: E402

bootstrap.load_package()

from motion.pixels import PixelErrors, TruePixels, float64_rays, holes  # noqa: E402
from motion.playing import Film, Showing  # noqa: E402
from motion.points import Followed, TrueVertices  # noqa: E402

METHODS = "auto,newton,secant_star,exact"
RAYS = "exact"


def measure(
    path: Path, methods: list[str], frames: range, size: tuple[int, int], vertices: int, pixels: int, every: int
) -> dict[str, Any]:
    """A row for each method. `vertices`, `pixels`: how many are judged; `every`: frames from one whose pixels are to
    the next."""
    mirrors = _opened(path)
    played = _played(Film(mirrors, size), methods, frames)
    film = Film(mirrors, size)
    shows = {method: Showing(method) for method in dict.fromkeys([*methods, RAYS])}
    followed: dict[tuple[str, int], Followed] = {}
    found: dict[str, list[PixelErrors]] = {method: [] for method in shows}
    empty = dict.fromkeys(shows, 0)
    truths: list[TrueVertices] = []
    rays = None
    with film.playing():
        for frame in frames:
            scene, view = film.frame(frame)
            if frame == frames[0]:
                reflectors = [i for i, item in enumerate(scene.instances) if item.object_id in scene.reflectors]
                truths = [TrueVertices(scene, index, vertices) for index in reflectors] if vertices else []
            for show in shows.values():
                show.draw(scene, view)
            surfaces = {method: show.surfaces() for method, show in shows.items()}
            mask = surfaces[RAYS]["seen_color"][..., 3] > 0.5
            for method, read in surfaces.items():
                empty[method] += holes(read["reflected_position"], surfaces[RAYS]["reflected_position"], mask)
            if pixels and (frame - frames[0]) % every == 0:
                rays = float64_rays(scene, rays)
                judge = TruePixels(rays, view, mask, pixels)
                for method, read in surfaces.items():
                    found[method].append(judge.errors(read["reflected_position"]))
            for true in truths:
                where = true.truth(scene, view)
                for method, show in shows.items():
                    assert show.reflection is not None
                    solved = true.solved(scene, show.reflection, view)
                    if solved is not None:
                        followed.setdefault((method, true.mirror), Followed()).note(solved, where)
            print(f"frame {frame}", end="\r", file=sys.stderr, flush=True)
    rows = {}
    for method in methods:
        points = [of for (name, _), of in followed.items() if name == method]
        rows[method] = _row(played[method], points, found[method], empty[method], frames)
    for show in shows.values():
        show.free()
    return rows


def _played(film: Film, methods: list[str], frames: range) -> dict[str, Showing]:
    """By each method, in turns, frame for frame: for times."""
    shows = {method: Showing(method, follows_time=True) for method in methods}
    with film.playing():
        for frame in frames:
            scene, view = film.frame(frame)
            for show in shows.values():
                show.draw(scene, view, film.read_ms)
    for show in shows.values():
        show.free()
    return shows


def _opened(path: Path) -> list[str]:
    """Names of the mirrors of the file, which is the open one then."""
    from curvrefl.curvrefl_addon import registration
    from curvrefl.curvrefl_addon.options import marked_mirrors
    from curvrefl.curvrefl_addon.scene.opened.blend_file import open_blend

    registration.register()
    open_blend(path)
    scene: Any = bpy.context.scene
    names = [mirror.name for mirror in marked_mirrors(scene)]
    registration.unregister()
    if not names:
        raise SystemExit(f'No object of "{path}" is marked as a mirror.')
    return names


def _row(show: Showing, points: list[Followed], pixels: list[PixelErrors], empty: int, frames: range) -> dict[str, Any]:
    errors = np.concatenate([np.zeros(0), *(one.pixels for one in pixels)])
    changes = [frames[index] for index in range(1, len(show.methods)) if show.methods[index] != show.methods[index - 1]]
    row: dict[str, Any] = {
        "frames": len(show.times_ms),
        "methods": sorted({name for names in show.methods for name in names}),
        "switches": changes,
        "ms": _times(show.times_ms, frames),
        "cpu": _times(show.cpu_ms, frames),
        "holes": empty + sum(one.holes for one in pixels),
        "times_ms": show.times_ms,
        "cpu_ms": show.cpu_ms,
    }
    if pixels:
        judged = sum(one.judged for one in pixels)
        row["pixels"] = {
            "judged": judged,
            "p99": float(np.percentile(errors, 99)) if len(errors) else 0.0,
            "worst": float(errors.max(initial=0.0)),
            "wrong": sum(one.wrong for one in pixels) / max(judged, 1),
        }
    if points:
        pops = np.array([of.worst_pop for of in points])
        row["vertices"] = {
            "judged": int(np.sum([of.judged for of in points])),
            "pop": float(pops.max()),
            "at": int(frames[int(pops.max(axis=0).argmax())]),
            "error": float(np.max([of.worst_error for of in points])),
            "missing": int(np.sum([of.missing for of in points])),
        }
    return row


def _times(values: list[float], frames: range) -> dict[str, float]:
    middle = float(np.median(values))
    slowest = int(np.argmax(values))
    return {
        "median": middle,
        "worst": values[slowest],
        "ratio": values[slowest] / middle,
        "at": frames[slowest],
    }


def table(rows: dict[str, Any]) -> str:
    """What `measure` has found, in lines."""
    lines = [
        f"{'':12}{'ms: median':>11}{'worst':>8}{'ratio':>7}{'at':>5}{'CPU ratio':>11}{'at':>5}"
        f"{'pop px':>9}{'at':>5}{'missing':>9}{'px: p99':>9}{'worst':>8}{'wrong':>8}{'holes':>7}  switches"
    ]
    for method, row in rows.items():
        ms, cpu = row["ms"], row["cpu"]
        line = f"{method:12}{ms['median']:11.1f}{ms['worst']:8.1f}{ms['ratio']:7.2f}{ms['at']:5d}"
        line += f"{cpu['ratio']:11.2f}{cpu['at']:5d}"
        points, pixels = row.get("vertices"), row.get("pixels")
        line += f"{'':23}" if points is None else f"{points['pop']:9.3f}{points['at']:5d}{points['missing']:9d}"
        line += (
            f"{'':25}"
            if pixels is None
            else f"{pixels['p99']:9.3f}{pixels['worst']:8.3f}{100.0 * pixels['wrong']:6.2f} %"
        )
        lines.append(f"{line}{row['holes']:7d}  {', '.join(map(str, row['switches'])) or 'none'}")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("file", type=Path, metavar="FILE.blend")
    parser.add_argument("--methods", default=METHODS)
    parser.add_argument("--frames", default="1-120", metavar="A-B")
    parser.add_argument("--resolution", default="320x240", metavar="WxH")
    parser.add_argument("--vertices", type=int, default=400, help="whose reflection points the oracle judges; 0: none")
    parser.add_argument("--pixels", type=int, default=200, help="in each frame that float64 rays judge; 0: none")
    parser.add_argument("--every", type=int, default=10, help="frames from one of these to the next")
    parser.add_argument("--output", type=Path, metavar="FILE.json")
    given = parser.parse_args()
    first, last = map(int, given.frames.split("-"))
    width, height = map(int, given.resolution.split("x"))
    rows = measure(
        given.file,
        given.methods.split(","),
        range(first, last + 1),
        (width, height),
        given.vertices,
        given.pixels,
        given.every,
    )
    print(table(rows))
    if given.output:
        given.output.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
