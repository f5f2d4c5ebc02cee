# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs against Cycles: whether a node tree is drawn as Blender draws it, or says what is not."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import batched

import numpy as np
from curvrefl.curvrefl_addon.renderer.device.shaders import ShaderError

from .evaluation import Board
from .stage import MOST, MakeTree, columns_for, make_board, render_board, sampled_places

TOLERANCE = 1.0 / 255.0
MOST_JUMPS = 0.02
"""Share of pixels that may be those of discontinuities, which a rounding error moves"""


@dataclass(frozen=True, slots=True)
class Verdict:
    """How a tree is drawn."""

    error: float
    """The largest but at discontinuities, relative to what is larger than 1"""
    off: float
    """Share of pixels over the tolerance, discontinuities aside"""
    jumps: float
    """Share of pixels over the tolerance at discontinuities"""
    notes: tuple[str, ...] = ()
    cycles: np.ndarray = field(default_factory=lambda: np.zeros(0), compare=False, repr=False)
    """(SIDE, SIDE, 3), rows from below"""
    ours: np.ndarray = field(default_factory=lambda: np.zeros(0), compare=False, repr=False)

    @property
    def is_right(self) -> bool:
        return self.off == 0.0 and self.jumps <= MOST_JUMPS

    @property
    def is_silently_wrong(self) -> bool:
        return not self.is_right and not self.notes

    def __str__(self) -> str:
        text = f"error {self.error:.4f}, off {self.off:.1%}, jumps {self.jumps:.1%}"
        return f"{text}, notes {list(self.notes)}" if self.notes else text


def judge(make_tree: MakeTree, tolerance: float = TOLERANCE) -> Verdict:
    """One tree. (A picture of Cycles has a start: see `judge_all`.)"""
    return judge_all({"tree": make_tree}, tolerance)["tree"]


def judge_all(trees: Mapping[str, MakeTree], tolerance: float = TOLERANCE, is_back: bool = False) -> dict[str, Verdict]:
    """Many trees, with few pictures of Cycles; `is_back`: of the surface's back."""
    verdicts: dict[str, Verdict] = {}
    for names in batched(trees, MOST, strict=False):
        verdicts.update(zip(names, _judged([trees[name] for name in names], tolerance, is_back), strict=True))
    return verdicts


def _judged(trees: Sequence[MakeTree], tolerance: float, is_back: bool) -> list[Verdict]:
    places = sampled_places(columns_for(len(trees)))
    tiles = make_board(trees, is_back)
    pictures, board = render_board(len(tiles)), Board.of_scene()
    compiled = [board.compiled(tile.material_slots[0].material) for tile in tiles]
    board.load_images()
    verdicts = []
    for (program, notes), tile, cycles, where in zip(compiled, tiles, pictures, places, strict=False):
        try:
            ours = board.evaluated(program, tile, where)
        except ShaderError as error:
            ours = np.full_like(cycles, np.nan)
            notes = []
            print(error)
        verdicts.append(compared(cycles, ours, tuple(notes), tolerance))
    return verdicts


def compared(
    cycles: np.ndarray, ours: np.ndarray, notes: tuple[str, ...] = (), tolerance: float = TOLERANCE
) -> Verdict:
    """Pictures (h, w, 3)."""
    error = np.abs(ours.astype(np.float64) - cycles) / np.maximum(np.abs(cycles), 1.0)
    error = np.where(np.isfinite(error), error, np.inf).max(axis=2)
    is_over = error > tolerance
    is_jump = is_over & _at_discontinuity(cycles, ours, tolerance)
    counted = error[~is_jump]
    return Verdict(
        float(counted.max(initial=0.0)),
        float((is_over & ~is_jump).mean()),
        float(is_jump.mean()),
        notes,
        cycles,
        ours,
    )


def _at_discontinuity(cycles: np.ndarray, ours: np.ndarray, tolerance: float) -> np.ndarray:
    """(h, w): what Cycles has at the pixel and around it differs abruptly."""
    height, width = cycles.shape[:2]
    padded = np.pad(cycles, ((1, 1), (1, 1), (0, 0)), mode="edge")
    around = np.array([padded[y : y + height, x : x + width] for y in range(3) for x in range(3)])
    slack = tolerance * np.maximum(np.abs(cycles), 1.0)
    # Abruptly: more than steep slopes change within the thousandth of a pixel that rounding may be off.
    is_abrupt = around.max(axis=0) - around.min(axis=0) > 8.0 * slack
    return (is_abrupt | (np.abs(ours - cycles) <= slack)).all(axis=2)
