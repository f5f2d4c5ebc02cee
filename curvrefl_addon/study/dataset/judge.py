# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Judges somebody's pictures by the data set's references, in numbers that a paper can cite.

Of each scene NAME the results may hold `NAME_position.exr`, what the mirrors show at the pixels' centers (red, green,
blue: world position and alpha 1, or unit direction and alpha 0), as `render --passes position` writes it, and
`NAME.exr`, the picture, scene-linear.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from ...report.metrics import direction_angle_deg, flip_in_mask, missing_flip
from ...report.table import aligned, number, percent
from ...scene.arrays import Float32Array, Float64Array
from ...scene.exr_files import load_exr
from .dataset import CYCLES, LAYER, PASSES
from .exr_layers import load_layers
from .files import VERSION, whole_report
from .scenes import SCENES

WRONG = 1.0
"""Pixels by which what is shown may be off"""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Of one scene; None where there is no such result."""

    scene: str
    pixels: int
    """That show a mirror"""
    wrong: float | None = None
    """Share of them that are off by more than WRONG pixels, or show nothing"""
    median_px: float | None = None
    p95_px: float | None = None
    median_deg: float | None = None
    p95_deg: float | None = None
    flip: float | None = None
    """Of the picture, over the mirrors, against Cycles"""


def judge(dataset: Path, results: Path) -> list[Verdict]:
    """All scenes of the data set that there are results of. Raises InputError for a folder that is no data set of this
    version, results of another size, or none at all."""
    verdicts = []
    for name in SCENES:
        position, picture = results / f"{name}_position.exr", results / f"{name}.exr"
        if not (position.is_file() or picture.is_file()):
            continue
        if (report := whole_report(dataset / name)) is None or report["made"]["version"] != VERSION:
            raise InputError(
                f'"{dataset / name}" is no whole scene of version {VERSION} of the data set: '
                f"make it by curvrefl dataset {name}."
            )
        verdicts.append(_judged(name, dataset / name, position, picture))
    if not verdicts:
        wanted = f"{next(iter(SCENES))}_position.exr or {next(iter(SCENES))}.exr"
        raise InputError(f'There are no results in "{results}": they are called {wanted}, and so on.')
    return verdicts


def format_verdicts(verdicts: list[Verdict]) -> str:
    """As lines of text, columns aligned."""
    table: list[tuple[str, ...]] = [
        ("", "mirror pixels", f"off by > {WRONG:g} px", "px: median", "p95", "deg: median", "p95", "FLIP")
    ]
    for item in verdicts:
        angles = (number(item.median_deg, 4), number(item.p95_deg, 3))
        offsets = (number(item.median_px, 3), number(item.p95_px, 2))
        table.append((item.scene, str(item.pixels), percent(item.wrong), *offsets, *angles, number(item.flip, 4)))
    lines = [f"Curvrefl data set, version {VERSION}", *aligned(table)]
    if any(item.flip is None for item in verdicts) and (missing := missing_flip()):
        lines.append(missing)
    return "\n".join(lines)


def as_json(verdicts: list[Verdict]) -> dict[str, Any]:
    """The same for programs."""
    return {"dataset": "curvrefl", "version": VERSION, "scenes": [asdict(item) for item in verdicts]}


def _judged(name: str, folder: Path, position: Path, picture: Path) -> Verdict:
    reference = load_layers(folder / PASSES)
    mask = _layer(reference, "Mirror ID", "X") > 0.0
    found: dict[str, Any] = {}
    if position.is_file():
        shown = _loaded(position, mask.shape)
        degrees = angle_errors(reference, shown)
        pixels = degrees / pixel_angles(reference)[mask]
        found["wrong"] = float((pixels > WRONG).mean()) if len(pixels) else None
        for unit, values in (("px", pixels), ("deg", degrees)):
            if len(values):
                found[f"median_{unit}"], found[f"p95_{unit}"] = np.percentile(values, (50.0, 95.0)).tolist()
    if picture.is_file() and not missing_flip():
        found["flip"] = flip_in_mask(_loaded(picture, mask.shape), load_exr(folder / CYCLES), mask)
    return Verdict(name, int(mask.sum()), **found)


def angle_errors(reference: dict[str, Float32Array], shown: Float32Array) -> Float64Array:
    """(n,) degrees, as seen from the mirror's points, between what a result (h, w, 4) shows at mirrors' pixels and what
    it should; 180 where it shows nothing."""
    mask = _layer(reference, "Mirror ID", "X") > 0.0
    values = shown[mask].astype(np.float64)
    there = np.isfinite(values).all(axis=1) & values.any(axis=1)
    values[~there] = 0.0
    # (A picture that was saved with other alphas is a direction or a point all the same.)
    values[:, 3] = values[:, 3] > 0.5
    seen = _layer(reference, "Mirror Position", "XYZ")[mask].astype(np.float64)
    wanted = _layer(reference, "Position", "XYZW")[mask].astype(np.float64)
    return np.where(there, direction_angle_deg(seen, values, wanted), 180.0)


def pixel_angles(reference: dict[str, Float32Array]) -> Float64Array:
    """(h, w) degrees, as seen from the mirror's point, between what a pixel shows and its neighbors do: what one pixel
    is. The smallest of the sides where the same mirror shows the same object; of pixels without such a neighbor the
    scene's median."""
    mask = _layer(reference, "Mirror ID", "X")
    objects = _layer(reference, "Object", "X")
    wanted = _layer(reference, "Position", "XYZW").astype(np.float64)
    seen = _layer(reference, "Mirror Position", "XYZ").astype(np.float64)
    least = np.full(mask.shape, np.inf)
    for axis in (0, 1):
        here = tuple(slice(0, -1) if side == axis else slice(None) for side in (0, 1))
        next_one = tuple(slice(1, None) if side == axis else slice(None) for side in (0, 1))
        same = (mask[here] > 0.0) & (mask[here] == mask[next_one]) & (objects[here] == objects[next_one])
        angle = np.full(same.shape, np.inf)
        angle[same] = direction_angle_deg(seen[here][same], wanted[here][same], wanted[next_one][same])
        least[here] = np.minimum(least[here], angle)
        least[next_one] = np.minimum(least[next_one], angle)
    known = np.isfinite(least) & (least > 0.0)
    return np.where(known, least, np.median(least[known]) if known.any() else 1.0)


def _loaded(path: Path, shape: tuple[int, ...]) -> Float32Array:
    pixels = load_exr(path)
    if pixels.shape[:2] != shape:
        raise InputError(
            f'"{path}" has {pixels.shape[1]} x {pixels.shape[0]} pixels and the data set {shape[1]} x {shape[0]}: '
            "render that many."
        )
    return pixels


def _layer(reference: dict[str, Float32Array], name: str, letters: str) -> Float32Array:
    """(h, w), or (h, w, channels) of more than one."""
    parts = [reference[f"{LAYER}.{name}.{letter}"] for letter in letters]
    return parts[0] if len(parts) == 1 else np.stack(parts, axis=-1)
