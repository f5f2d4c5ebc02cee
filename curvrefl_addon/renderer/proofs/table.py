# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All proofs: what each is about, and what is given up where it fails."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from .proof import Proof, Work


def _by(module: str, function: str, *arguments: str) -> Callable[[], Work]:
    """Imported when it is tried: a session whose device is known needs none of it."""

    def work() -> Work:
        found: Work = getattr(import_module(f".{module}", __package__), function)(*arguments)
        return found

    return work


BY_COMPUTE = ("compute",)
BY_LIST = ("atomics", "compute")

FIRST = (
    Proof("records", "records that compute shaders write", _by("records", "prove_records"), BY_COMPUTE),
    Proof("list", "lists by image atomics", _by("records", "prove_list"), BY_LIST),
    Proof("newton", 'reflection points by "Newton"', _by("searches", "prove_search", "newton"), BY_LIST, ("newton",)),
    Proof("rays", "rays", _by("walk", "prove_walk"), (), ("exact",)),
    Proof("fits", "rays at what deforms", _by("walk", "prove_fits"), ("fits",)),
    Proof("quads", "derivatives between pixels", _by("quads", "prove_quads"), ("quads",)),
    Proof("pictures", "surfaces, materials and light", _by("pictures", "prove_pictures")),
)
"""Of what `auto` draws by"""
OTHERS = (
    Proof("paths", "rough, layered and glassy surfaces", _by("paths", "prove_paths")),
    Proof("regions", 'further images by "Newton"', _by("searches", "prove_regions"), BY_COMPUTE, ("newton",)),
    Proof(
        "secant_star",
        'reflection points by "Secant Search"',
        _by("searches", "prove_search", "secant_star"),
        BY_COMPUTE,
        ("secant_star",),
    ),
    Proof(
        "secant_uv",
        'reflection points by "Secant Search in UV"',
        _by("other_searches", "prove_parametric"),
        BY_COMPUTE,
        ("secant_uv",),
    ),
    Proof(
        "bisector_cube",
        'reflection points by "Bisector Field"',
        _by("searches", "prove_search", "bisector_cube"),
        BY_COMPUTE,
        ("bisector_cube", "bisector_grid"),
    ),
    Proof(
        "bisector_grid",
        'reflection points by "Bisector Field on Grids"',
        _by("other_searches", "prove_grid"),
        BY_COMPUTE,
        ("bisector_grid",),
    ),
    Proof(
        "bisector_screen",
        'reflection points by "Bisector on Screen"',
        _by("other_searches", "prove_screen"),
        BY_COMPUTE,
        ("bisector_screen",),
    ),
    Proof(
        "planar", 'reflection points by "Planar Mirror"', _by("other_searches", "prove_planar"), BY_COMPUTE, ("planar",)
    ),
    Proof(
        "newton_refraction",
        'points by "Newton through Glass"',
        _by("searches", "prove_refraction"),
        BY_LIST,
        ("newton_refraction",),
    ),
)
PROOFS = FIRST + OTHERS
