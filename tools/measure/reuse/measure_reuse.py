# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What reused frames calm, on a slow orbit: flicker along exact motion, error, places and time.

    .venv/bin/python tools/measure/reuse/measure_reuse.py FILE.blend --reflector A[,B..] [--size 320x240] [--samples 4]
        [--reuse 3] [--frames 4] [--step 0.5] [--converged 64] [--method exact] [--roughness R] [--keep DIR]
        [--picture OUT.jpg]

The camera goes round the vertical axis through the mirrors' middle, `--step` degrees a frame. Of the mirrors' pixels
whose scene point the mirror showed a frame before too (by the exact solution in float64): *error*, the root mean square
difference from the picture of `--converged` sub-frames, *flicker*, that of these differences from a frame to the next
along the motion, both by 1/255 of the display's range, and FLIP. A row each of frames as they are without, and with the
frames before; then how far the places are from the exact ones. `--roughness` is given to the mirrors' materials.
`--keep`: strips of the last two frames, without, with, converged; `--picture`: the mirrors of the last one, twice as
large.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tools" / "measure")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402, F401 (the modules of Blender are there after it)

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture  # noqa: E402
from curvrefl.curvrefl_addon.renderer.exposure import ALL, Turn, with_frames_before  # noqa: E402
from curvrefl.curvrefl_addon.renderer.frame import Frame  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.reuse.earlier import with_earlier  # noqa: E402
from curvrefl.curvrefl_addon.renderer.reuse.kept_frame import KeptFrame  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.truth.motion import places_then  # noqa: E402
from curvrefl.curvrefl_addon.report.display import display_transform  # noqa: E402
from curvrefl.curvrefl_addon.report.images import save_png  # noqa: E402
from curvrefl.curvrefl_addon.report.metrics import flip_in_mask  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from light.given_file import GivenFile, file_parser  # noqa: E402
from light.measure_jitter import turned  # noqa: E402
from PIL import Image  # noqa: E402

QUALITY = 90


class Orbit:
    """The converged pictures and the exact motion."""

    def __init__(self, scene: Any, views: list[View], settings: Settings) -> None:
        renderer = Renderer(scene, settings)
        renderer.settle()
        self.pictures: list[np.ndarray] = []
        self.masks: list[np.ndarray] = []
        self.motion: list[tuple[np.ndarray, np.ndarray]] = []
        """Of each frame but the first, pixels and where the frame before showed the same"""
        before: View | None = None
        for view in views:
            frame = renderer.render(view)
            self.pictures.append(frame.color())
            self.masks.append(frame.mask() > 0)
            if before is not None:
                points = frame.truth.points
                places, known = places_then(scene, points, scene, before, lambda: None)
                known &= (places > 0.5).all(axis=1) & (places < np.array([view.width, view.height]) - 0.5).all(axis=1)
                self.motion.append((points.pixel[known], places[known]))
            before = view
        renderer.free()

    def judged(self, pictures: list[np.ndarray], first: int) -> tuple[float, float, float]:
        """Error, flicker and FLIP of pictures from `first` on."""
        error = [shown(one) - shown(right) for one, right in zip(pictures, self.pictures, strict=True)]
        wrong, flicker, flips = [], [], []
        for number in range(first, len(pictures)):
            pixel, places = self.motion[number - 1]
            here = error[number].reshape(-1, 3)[pixel]
            wrong.append((here**2).mean())
            flicker.append(((here - between(error[number - 1], places)) ** 2).mean())
            made, right = (display_transform(one[number][..., :3]) for one in (pictures, self.pictures))
            flips.append(flip_in_mask(made, right, self.masks[number]) or 0.0)
        return float(np.sqrt(np.mean(wrong))), float(np.sqrt(np.mean(flicker))), float(np.mean(flips))


def shown(pixels: np.ndarray) -> np.ndarray:
    return 255.0 * display_transform(pixels[..., :3])


def between(picture: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(n, 3) bilinear, at places (n, 2) in pixels."""
    corner = np.floor(places - 0.5).astype(int)
    part = (places - 0.5 - corner)[:, :, None]
    x, y = corner.T
    low = picture[y, x] * (1.0 - part[:, 0]) + picture[y, x + 1] * part[:, 0]
    high = picture[y + 1, x] * (1.0 - part[:, 0]) + picture[y + 1, x + 1] * part[:, 0]
    return low * (1.0 - part[:, 1]) + high * part[:, 1]


def places_error(renderer: Renderer, frame: Frame, kept: list[KeptFrame], motion: Any) -> tuple[float, np.ndarray]:
    """Share of what the frame before has shown that is found, and how far off, pixels."""
    found: list[np.ndarray] = []

    def read(_: Any, sub_frame: Any) -> dict[str, Any]:
        places = with_earlier(kept[-1], sub_frame.targets.seen, [kept[-2]])[2]
        found.append(read_texture(places[0]).reshape(-1, 4))
        return {}

    renderer.surfaces_of(frame.reflection, read)
    pixel, exact = motion
    is_found = found[0][pixel, 2] > 0.5
    return float(is_found.mean()), np.linalg.norm(found[0][pixel, :2] - exact, axis=1)[is_found]


def main() -> None:
    parser = file_parser(__doc__)
    parser.set_defaults(size="320x240")
    parser.add_argument("--samples", type=int, default=4)
    parser.add_argument("--reuse", type=int, default=3)
    parser.add_argument("--frames", type=int, default=4, help="that are judged")
    parser.add_argument("--step", type=float, default=0.5, help="degrees")
    parser.add_argument("--converged", type=int, default=64)
    parser.add_argument("--method", default="exact")
    parser.add_argument("--roughness", type=float)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--picture", type=Path)
    options = parser.parse_args()
    given = GivenFile(options)
    still = given.read()
    scene = still.scene if options.roughness is None else roughened(still.scene, options.roughness)
    placed = [item.matrix[:3, 3] for item in scene.instances if item.object_id in scene.reflectors]
    count = options.frames + options.reuse + 1
    views = [turned(still.view, np.mean(placed, axis=0), options.step * number) for number in range(count)]
    settings = Settings(method=options.method, samples=options.samples)
    orbit = Orbit(scene, views, replace(settings, samples=options.converged))
    first = options.reuse + 1
    plain, times, _ = pictures_of(scene, views, settings, 0, orbit)
    calm, others, places = pictures_of(scene, views, settings, options.reuse, orbit)
    print("| | error | flicker | FLIP | ms |\n|---|---|---|---|---|")
    for name, pictures, took in (("without", plain, times), (f"with {options.reuse} frames", calm, others)):
        error, flicker, difference = orbit.judged(pictures, first)
        print(f"| {name} | {error:.2f} | {flicker:.2f} | {difference:.4f} | {np.median(took[first:]):.0f} |")
    share, off = np.mean([one for one, _ in places]), np.concatenate([one for _, one in places])
    print(f"Found {100 * share:.1f} %; px off: median {np.median(off):.4f}, 95 % {np.quantile(off, 0.95):.3f}")
    if options.keep is not None:
        options.keep.mkdir(parents=True, exist_ok=True)
        rows = [np.hstack([one[number] for one in (plain, calm, orbit.pictures)]) for number in (count - 2, count - 1)]
        save_png(options.keep / f"{options.file.stem}.png", np.vstack(rows))
    if options.picture is not None:
        save_mirrors(options.picture, [one[-1] for one in (plain, calm, orbit.pictures)], orbit.masks[-1])


def save_mirrors(path: Path, pictures: list[np.ndarray], mask: np.ndarray) -> None:
    """Side by side, cut out."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    cut = (slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1))
    strip = np.hstack([display_transform(one[cut][..., :3])[::-1] for one in pictures])
    drawn = Image.fromarray(np.round(255.0 * strip).astype(np.uint8))
    drawn.resize((2 * drawn.width, 2 * drawn.height), Image.Resampling.NEAREST).save(path, quality=QUALITY)


def roughened(scene: Any, roughness: float) -> Any:
    """With the mirrors' materials as rough."""
    mirrors = {index for item in scene.instances if item.object_id in scene.reflectors for index in item.materials}
    materials = [
        replace(material, roughness=roughness) if index in mirrors else material
        for index, material in enumerate(scene.materials)
    ]
    return replace(scene, materials=tuple(materials))


def pictures_of(
    scene: Any, views: list[View], settings: Settings, reuse: int, orbit: Orbit
) -> tuple[list[np.ndarray], list[float], list[tuple[float, np.ndarray]]]:
    """Pictures, milliseconds of each, and of reused frames how right the places are."""
    renderer = Renderer(scene, replace(settings, samples=settings.samples * (reuse + 1)))
    renderer.settle()
    pictures, times, places = [], [], []
    kept: list[KeptFrame] = []
    for number, view in enumerate(views):
        start = perf_counter()
        frame = renderer.render(view, turn=Turn(number, reuse + 1) if reuse else ALL)
        if reuse:
            picture, _, one = with_frames_before(renderer, frame, None, kept[-reuse:])
            kept = [*kept[-reuse:], one]
            frame.color_texture = picture.texture
        pictures.append(frame.color())
        times.append(1e3 * (perf_counter() - start))
        if len(kept) > 1:
            places.append(places_error(renderer, frame, kept, orbit.motion[number - 1]))
    renderer.free()
    return pictures, times, places


if __name__ == "__main__":
    main()
