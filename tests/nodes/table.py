# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All rows of the table of nodes, and their verdicts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from .cases import colors, converters, images, inputs, links, textures, vectors
from .judge import Verdict, judge_all
from .trees import Row

BATCHES: Mapping[str, list[Row]] = {
    "inputs": inputs.ROWS,
    "converters": converters.ROWS,
    "colors": colors.ROWS,
    "vectors": vectors.ROWS,
    "textures": textures.ROWS,
    "images": images.ROWS,
    "links": links.ROWS,
}


@dataclass(frozen=True, slots=True)
class Judged:
    """A row with what came of each of its trees."""

    row: Row
    verdicts: tuple[Verdict, ...]

    @property
    def notes(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(note for verdict in self.verdicts for note in verdict.notes))

    @property
    def error(self) -> float:
        return max(verdict.error for verdict in self.verdicts)

    @property
    def is_right(self) -> bool:
        return all(verdict.is_right for verdict in self.verdicts)

    @property
    def is_drawn(self) -> bool:
        """Right, with nothing to say."""
        return self.is_right and not self.notes

    @property
    def is_silently_wrong(self) -> bool:
        return any(verdict.is_silently_wrong for verdict in self.verdicts)


def judged_rows(rows: Iterable[Row], is_back: bool = False) -> list[Judged]:
    """With as few pictures of Cycles as will do."""
    rows = list(rows)
    trees = {f"{k} {n}": tree for k, row in enumerate(rows) for n, tree in enumerate(row.trees)}
    verdicts = judge_all(trees, is_back=is_back)
    return [Judged(row, tuple(verdicts[f"{k} {n}"] for n in range(len(row.trees)))) for k, row in enumerate(rows)]
