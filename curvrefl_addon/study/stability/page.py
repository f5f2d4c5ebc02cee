# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where methods fail, as one page: a row of pictures per trial, then motion and fuzz as tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape

from ...optics.catalog import label_of
from ...report.html import STYLE
from ...report.table import percent
from .fuzz import Fuzz
from .motion import Motion
from .pictures import TrialPicture
from .scenes import Trial

_OWN_STYLE = """
.pictures.small { grid-template-columns: repeat(auto-fill, minmax(230px, 1fr)); }
.refused { padding: .6rem .8rem; color: var(--dim); }
"""
_MOTION_TITLES = (
    "Method",
    "Reflector",
    "What moves",
    "Vertices",
    "Jitter, median",
    "p99",
    "Worst pop",
    "Steps, first frame",
    "Later frames",
    "Identical at rest",
)
_FUZZ_TITLES = (
    "Method",
    "Triples",
    "Not finite",
    "Off the reflector",
    "Without code",
    "Reflected",
    "Hidden",
    "Unsolved",
)


def stability_page(
    heading: str,
    fuzzed: Sequence[Fuzz],
    motions: Sequence[Motion],
    pictures: Sequence[tuple[Trial, Mapping[str, TrialPicture]]],
) -> str:
    """The whole page; pictures are linked by their names beside it. `heading` says of what version on what device."""
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>Curvrefl: where methods fail</title><style>{STYLE}{_OWN_STYLE}</style></head><body>",
        "<h1>Where methods fail</h1>",
        f"<p>{escape(heading)}</p>",
        "<p>Under each picture is the share of the mirror's pixels that show something else than Exact does, which is "
        "right at every pixel. All reflectors and regimes in numbers: "
        '<a href="solver_table.txt">solver_table.txt</a>.</p>',
        *(_trial(trial, results) for trial, results in pictures),
        "<h2>In motion</h2>",
        "<p>A slow path of the eye, and one of the vertices, against the oracle; pixels of a picture of 640 x 480. "
        "Jitter is the second difference from frame to frame, a pop the largest move that the true point does not "
        "make.</p>",
        _table(_MOTION_TITLES, (_motion_row(motion) for motion in motions)),
        "<h2>Any input</h2>",
        "<p>Random eyes, vertices and reflectors, among them points that are no numbers or lie in the mirror's center."
        "</p>",
        _table(_FUZZ_TITLES, (_fuzz_row(item) for item in fuzzed)),
        "</body></html>",
    ]
    return "\n".join(parts) + "\n"


def _trial(trial: Trial, results: Mapping[str, TrialPicture]) -> str:
    figures = []
    for method, result in results.items():
        label = escape(label_of(method))
        if result.file:
            source = escape(result.file, quote=True)
            figures.append(
                f'<figure><a href="{source}"><img src="{source}" alt="{label}"></a><figcaption><strong>{label}</strong>'
                f"{percent(result.differs)} differs</figcaption></figure>"
            )
    refused = [
        f'<p class="refused"><strong>{escape(label_of(method))}</strong>: {escape(result.refusal)}</p>'
        for method, result in results.items()
        if not result.file
    ]
    return "\n".join(
        [
            f"<h2>{escape(trial.name.capitalize())}</h2>",
            f"<p>{escape(trial.sentence)}</p>",
            '<div class="pictures small">',
            *figures,
            "</div>",
            *refused,
        ]
    )


def _motion_row(motion: Motion) -> tuple[str, ...]:
    return (
        label_of(motion.method),
        motion.reflector,
        motion.path,
        str(motion.vertices),
        f"{motion.jitter_median_px:.3g}",
        f"{motion.jitter_p99_px:.3g}",
        f"{motion.worst_pop_px:.3g}",
        f"{motion.iterations_first:.1f}",
        f"{motion.iterations_later:.1f}",
        "yes" if motion.identical_at_rest else "NO",
    )


def _fuzz_row(item: Fuzz) -> tuple[str, ...]:
    counts = (item.triples, item.not_finite, item.wild, item.without_code)
    shares = (item.reflected, item.hidden, item.unsolved)
    return (
        label_of(item.method),
        *(f"{count:,}" for count in counts),
        *(percent(share / max(item.triples, 1)) for share in shares),
    )


def _table(titles: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = ['<div class="scroll"><table>', _row("th", titles), *(_row("td", row) for row in rows), "</table></div>"]
    return "\n".join(lines)


def _row(tag: str, cells: Sequence[str]) -> str:
    return "<tr>" + "".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in cells) + "</tr>"
