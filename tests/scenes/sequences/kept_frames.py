# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of a comparison that are made up, so that what changes from one to the next is known."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.design.anamorphosis.png_file import png_bytes
from curvrefl.curvrefl_addon.report.display import inverse_display_transform
from curvrefl.curvrefl_addon.study.sequence.kept import KeptFrame, Shown, folder_of, save_kept

HEIGHT, WIDTH = 48, 64
MADE: dict[str, Any] = {"file": "a.blend", "methods": ["exact"], "peers": ["cycles1"], "samples": 4, "step": 1}
GRAY = np.full((HEIGHT, WIDTH, 3), 0.5)
OBJECTS = {1: "Mirror", 2: "Block"}


def kept_frame(frame: int = 2, shift: tuple[float, float] = (0.0, 0.0), **changes: Any) -> KeptFrame:
    """All of the picture is a mirror that shows a block 3 meters away; what a pixel shows now was `shift` pixels to the
    right and up of it in the frame before. Pictures: display values of the reference, the method, the peer."""
    shown = changes.pop("pictures", (GRAY, GRAY, GRAY))
    names = ("reference", "exact", "cycles1")
    everywhere = np.ones((HEIGHT, WIDTH), np.int32)
    values: dict[str, Any] = {
        "frame": frame,
        "made": MADE,
        "camera": "Camera",
        "before": {"frame": frame - 1, "camera": "Camera", "reason": ""},
        "objects": OBJECTS,
        "pictures": {
            name: inverse_display_transform(values.astype(np.float32))
            for name, values in zip(names, shown, strict=True)
        },
        "mask": everywhere,
        "object": 2 * everywhere,
        "distance": np.full((HEIGHT, WIDTH), 3.0, np.float32),
        "place": np.broadcast_to(np.array(shift, np.float32), (HEIGHT, WIDTH, 2)),
        "distance_before": np.full((HEIGHT, WIDTH), 3.0, np.float32),
        "shown": {"exact": Shown(2 * everywhere, np.zeros((HEIGHT, WIDTH, 2), np.float32))},
    }
    return KeptFrame(**(values | changes))


def write_frame(output: Path, kept: KeptFrame, time_ms: float = 10.0, **changes: Any) -> Path:
    """Its folder, with a report as `compare` writes it."""
    folder = folder_of(output, kept.frame)
    folder.mkdir(parents=True)
    save_kept(folder, kept)
    times = {"extract": 1.0, "bake": 2.0, "solve": 1.0, "draw": time_ms - 1.0, "frame": time_ms}
    image = {"flip": 0.01 * kept.frame, "psnr": 40.0 - kept.frame}
    report = {
        "scene": "a.blend",
        "reflectors": ["Mirror"],
        "resolution": [WIDTH, HEIGHT],
        "blender": "5.2.3",
        "gpu": "none",
        "reference": {"engine": "CYCLES", "samples": 4, "light": "full", "time_s": time_ms},
        "mask_pixels": int(np.count_nonzero(kept.mask)),
        "methods": {
            "exact": {
                "image": image,
                "geometry": {"angle_deg": {"median": 0.0, "p95": 0.1, "p99": 0.2}, "wrong_object": 0.0},
                "time_ms": times,
            }
        },
        "peers": {"cycles1": {"image": image, "time_ms": 2.0 * time_ms}},
    }
    (folder / "report.json").write_text(json.dumps(report | changes))
    (folder / "report.html").write_text("<!doctype html>")
    for name, picture in kept.pictures.items():
        rgba = np.concatenate([np.clip(picture, 0.0, 1.0), np.ones((HEIGHT, WIDTH, 1))], axis=2).astype(np.float32)
        (folder / f"{name}.png").write_bytes(png_bytes(rgba))
        if name == "exact":
            (folder / f"{name}_error.png").write_bytes(png_bytes(rgba))
    return folder
