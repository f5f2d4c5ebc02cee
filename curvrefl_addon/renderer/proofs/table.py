# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All proofs: what each is about, and what is given up where it fails."""

from __future__ import annotations

from functools import partial

from .other_searches import prove_grid, prove_parametric, prove_planar, prove_screen
from .paths import prove_paths
from .pictures import prove_pictures
from .proof import Proof
from .quads import prove_quads
from .records import prove_list, prove_records
from .searches import prove_refraction, prove_regions, prove_search
from .walk import prove_fits, prove_walk

BY_COMPUTE = ("compute",)
BY_LIST = ("atomics", "compute")

FIRST = (
    Proof("records", "records that compute shaders write", prove_records, BY_COMPUTE),
    Proof("list", "lists by image atomics", prove_list, BY_LIST),
    Proof("newton", 'reflection points by "Newton"', partial(prove_search, "newton"), BY_LIST, ("newton",)),
    Proof("rays", "rays", prove_walk, (), ("exact",)),
    Proof("fits", "rays at what deforms", prove_fits, ("fits",)),
    Proof("quads", "derivatives between pixels", prove_quads, ("quads",)),
    Proof("pictures", "surfaces, materials and light", prove_pictures),
)
"""Of what `auto` draws by"""
OTHERS = (
    Proof("paths", "rough, layered and glassy surfaces", prove_paths),
    Proof("regions", 'further images by "Newton"', prove_regions, BY_COMPUTE, ("newton",)),
    Proof(
        "secant_star",
        'reflection points by "Secant Search"',
        partial(prove_search, "secant_star"),
        BY_COMPUTE,
        ("secant_star",),
    ),
    Proof("secant_uv", 'reflection points by "Secant Search in UV"', prove_parametric, BY_COMPUTE, ("secant_uv",)),
    Proof(
        "bisector_cube",
        'reflection points by "Bisector Field"',
        partial(prove_search, "bisector_cube"),
        BY_COMPUTE,
        ("bisector_cube", "bisector_grid"),
    ),
    Proof(
        "bisector_grid", 'reflection points by "Bisector Field on Grids"', prove_grid, BY_COMPUTE, ("bisector_grid",)
    ),
    Proof(
        "bisector_screen", 'reflection points by "Bisector on Screen"', prove_screen, BY_COMPUTE, ("bisector_screen",)
    ),
    Proof("planar", 'reflection points by "Planar Mirror"', prove_planar, BY_COMPUTE, ("planar",)),
    Proof("newton_refraction", 'points by "Newton through Glass"', prove_refraction, BY_LIST, ("newton_refraction",)),
)
PROOFS = FIRST + OTHERS
