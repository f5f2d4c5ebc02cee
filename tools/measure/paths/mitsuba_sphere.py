# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a rough metal sphere by Mitsuba 3, for convergence.py; runs in a Python that has mitsuba.

    mitsuba_sphere.py OUT.npz ROUGHNESS SAMPLES,.. SEED

OUT gets a picture (SIZE, SIZE, 3) by the number of samples, row 0 at the bottom, and `furnace`: what the sphere
reflects of a world of 1, which is what a single scattering at microfacets leaves.
"""

from __future__ import annotations

import sys
from typing import Any

import mitsuba as mi  # type: ignore[import-not-found]
import numpy as np

mi.set_variant("scalar_rgb")

from surroundings import ANGLE, DISTANCE, MITSUBA_TURN, SIZE, mitsuba_map  # type: ignore[import-not-found]  # noqa: E402

FURNACE_SAMPLES = 256


def scene(roughness: float, sky: dict[str, Any]) -> Any:
    surface: dict[str, Any] = {"type": "conductor", "material": "none"}
    if roughness > 0.0:
        surface = {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": roughness**2}
    eye = mi.ScalarTransform4f().look_at(origin=[0, -DISTANCE, 0], target=[0, 0, 0], up=[0, 0, 1])
    return mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": 2},
            "sensor": {
                "type": "perspective",
                "fov": ANGLE,
                "to_world": eye,
                "film": {
                    "type": "hdrfilm",
                    "width": SIZE,
                    "height": SIZE,
                    "rfilter": {"type": "box"},
                    "pixel_format": "rgb",
                },
                "sampler": {"type": "multijitter", "sample_count": 16},
            },
            "sphere": {"type": "sphere", "bsdf": surface},
            "sky": sky,
        }
    )


def picture(made: Any, samples: int, seed: int) -> np.ndarray:
    return np.array(mi.render(made, spp=samples, seed=seed))[::-1].astype(np.float32)


def main() -> None:
    out, roughness, counts, seed = sys.argv[1], float(sys.argv[2]), sys.argv[3], int(sys.argv[4])
    turn = mi.ScalarTransform4f(np.array(MITSUBA_TURN, float))
    made = scene(roughness, {"type": "envmap", "bitmap": mi.Bitmap(mitsuba_map()), "to_world": turn})
    pictures = {number: picture(made, int(number), seed) for number in counts.split(",")}
    white = scene(roughness, {"type": "constant", "radiance": 1.0})
    np.savez(out, allow_pickle=False, furnace=picture(white, FURNACE_SAMPLES, seed), **pictures)


if __name__ == "__main__":
    main()
