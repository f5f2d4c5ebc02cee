# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Errors of a picture of reflections, as numbers and as a picture. Pure numpy; FLIP's package only where it is used.

All images are (height, width, 3 or 4) scene-linear Rec.709; alpha is ignored. Colors are compared as the
screen shows them, after the "Standard" display transform.
"""

from __future__ import annotations

import math
from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..scene.arrays import Float32Array, Float64Array, Int32Array
from .display import display_transform

type BoolArray = NDArray[np.bool_]

PIXELS_PER_DEGREE = 67.0
"""FLIP's default: a 0.7 m wide 4K screen seen from 0.7 m"""

ERROR_MAP_GAIN = 16.0


class AngleError(TypedDict):
    """Degrees; None where there is no pixel to measure."""

    median: float | None
    p95: float | None
    p99: float | None


class GeometryError(TypedDict):
    angle_deg: AngleError
    wrong_object: float | None


def missing_flip() -> str:
    """Why FLIP cannot be measured, as one sentence; empty where it can."""
    try:
        import flip_evaluator  # noqa: F401
    except ImportError:
        return (
            "FLIP is missing: it needs the Python package 'flip-evaluator', which this Python lacks; install it there, "
            "for example with 'python -m pip install flip-evaluator'."
        )
    return ""


def flip_in_mask(test: Float32Array, reference: Float32Array, mask: BoolArray) -> float | None:
    """Mean of the FLIP error (0..1, lower is better) over `mask` (h, w), or None for an empty mask.

    Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020, low dynamic range, 67 pixels
    per degree. FLIP looks at a neighborhood, so `test` is given the reference's pixels outside the mask first:
    what lies outside cannot count.

    Raises InputError when the package flip-evaluator is not installed.
    """
    if missing := missing_flip():
        raise InputError(missing)
    import flip_evaluator

    if not mask.any():
        return None
    shown_reference = display_transform(reference[..., :3])
    shown_test = np.where(mask[..., None], display_transform(test[..., :3]), shown_reference)
    error_map, _, _ = flip_evaluator.evaluate(
        np.ascontiguousarray(shown_reference[::-1]),
        np.ascontiguousarray(shown_test[::-1]),
        "LDR",
        inputsRGB=True,
        applyMagma=False,
        computeMeanError=False,
        parameters={"ppd": PIXELS_PER_DEGREE},
    )
    return float(np.asarray(error_map).reshape(mask.shape)[::-1][mask].mean(dtype=np.float64))


def psnr_in_mask(test: Float32Array, reference: Float32Array, mask: BoolArray) -> float | None:
    """Peak signal-to-noise ratio in dB over the colors in `mask`: infinite if they are equal, None if it is empty."""
    if not mask.any():
        return None
    difference = display_transform(test[..., :3])[mask] - display_transform(reference[..., :3])[mask]
    mean_square = float(np.mean(np.square(difference, dtype=np.float64)))
    return -10.0 * math.log10(mean_square) if mean_square > 0.0 else math.inf


def error_map(test: Float32Array, reference: Float32Array) -> Float32Array:
    """(h, w, 3) display-encoded difference times 16, in 0..1."""
    difference = np.abs(display_transform(test[..., :3]) - display_transform(reference[..., :3]))
    return np.minimum(difference * ERROR_MAP_GAIN, 1.0).astype(np.float32)


def direction_angle_deg(origins: Float64Array, first: Float64Array, second: Float64Array) -> Float64Array:
    """(n,) angle in degrees between two targets as seen from `origins` (n, 3).

    Targets are homogeneous (n, 4): a point with w = 1 or a direction with w = 0. A target at the origin itself
    (or a zero direction) has no direction: the angle is 180 degrees unless the other has none either.
    """
    a = first[:, :3] - first[:, 3:] * origins
    b = second[:, :3] - second[:, 3:] * origins
    length_a = np.linalg.norm(a, axis=1, keepdims=True)
    length_b = np.linalg.norm(b, axis=1, keepdims=True)
    unit_a = np.divide(a, length_a, out=np.zeros_like(a), where=length_a > 0.0)
    unit_b = np.divide(b, length_b, out=np.zeros_like(b), where=length_b > 0.0)
    # Kahan's form: exact for small angles, where the arc cosine has lost all digits.
    angle = 2.0 * np.arctan2(np.linalg.norm(unit_a - unit_b, axis=1), np.linalg.norm(unit_a + unit_b, axis=1))
    one_has_none = (length_a[:, 0] > 0.0) != (length_b[:, 0] > 0.0)
    return np.where(one_has_none, 180.0, np.degrees(angle))


def geometry_error(
    *,
    mask: Int32Array,
    reflected_position: Float32Array,
    reflected_object: Int32Array,
    reference_mask: Int32Array,
    reference_reflector_position: Float32Array,
    reference_reflected_position: Float32Array,
    reference_reflected_object: Int32Array,
    reference_valid: BoolArray | None = None,
) -> GeometryError:
    """How far each mirror pixel is from showing what Cycles shows.

    Masks (h, w) hold the object id of the reflector at the pixel center, 0 elsewhere; positions (h, w, 4) are
    points (w = 1) or unit directions of the background (w = 0); `reference_reflector_position` (h, w, 3) is the
    point P that the angles are seen from, in degrees. `wrong_object` is the share of pixels that show another
    object (or the background instead of one, or one instead of it).

    Only pixels count in which both masks hold the same reflector: at the silhouette the two may disagree about
    what the center hits (`mask_mismatch` says how often). Where `reference_valid` is given and false, Cycles
    followed no reflection, and the pixel is left out too. A test position that is not finite counts as 180 degrees.
    """
    both = (mask == reference_mask) & (reference_mask != 0)
    if reference_valid is not None:
        both &= reference_valid
    if not both.any():
        return {"angle_deg": {"median": None, "p95": None, "p99": None}, "wrong_object": None}
    shown = reflected_position[both].astype(np.float64)
    finite = np.isfinite(shown).all(axis=1)
    angle = direction_angle_deg(
        reference_reflector_position[both].astype(np.float64),
        np.where(finite[:, None], shown, 0.0),
        reference_reflected_position[both].astype(np.float64),
    )
    angle[~finite] = 180.0
    median, p95, p99 = (float(value) for value in np.percentile(angle, (50.0, 95.0, 99.0)))
    wrong = reflected_object[both] != reference_reflected_object[both]
    return {"angle_deg": {"median": median, "p95": p95, "p99": p99}, "wrong_object": float(wrong.mean())}


def mask_mismatch(mask: Int32Array, reference_mask: Int32Array) -> float | None:
    """Share of the reference's mirror pixels by which the two masks differ, or None where it has none."""
    pixels = int(np.count_nonzero(reference_mask))
    return float(np.count_nonzero(mask != reference_mask)) / pixels if pixels else None
