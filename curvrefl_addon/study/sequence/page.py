# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report over frames as one page that plays reference and methods; pictures are linked by their names below it.

It needs no network and no server: style, script (`player.js`) and numbers are in it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any

from ...report.html import STYLE
from ...report.table import NO_NUMBER, number
from .curves import color_of, title_of
from .kept import REFERENCE, folder_of
from .summary import MEASURES, names_of, values_of
from .text import cut_sentences, headline

_SCRIPT = Path(__file__).with_name("player.js")
_FRAMES_A_SECOND = (1, 2, 4, 8, 12, 24, 30)
_SPEED = 8
_OWN_STYLE = """
.bar { display: flex; flex-wrap: wrap; gap: .5rem .75rem; align-items: center; margin: 1rem 0 .75rem; }
.bar label { color: var(--dim); }
button, select { font: inherit; color: var(--ink); background: var(--card); border: 1px solid var(--line);
  border-radius: 5px; padding: .2rem .6rem; }
button { cursor: pointer; }
button[aria-pressed="true"] { background: var(--best); }
#scrub { flex: 1 1 12rem; }
#frame { min-width: 6rem; font-variant-numeric: tabular-nums; font-weight: 600; }
.two { display: grid; gap: 1rem; grid-template-columns: 1fr 1fr; }
.two[hidden], .stack[hidden] { display: none; }
.two img, .stack img { display: block; width: 100%; height: auto; background: #000; }
.stack { position: relative; max-width: 1000px; isolation: isolate; }
.stack #picture-above { position: absolute; inset: 0; }
.stack.flip { cursor: pointer; }
.stack.difference { filter: brightness(8); }
.stack.difference #picture-above { mix-blend-mode: difference; }
.small img { image-rendering: pixelated; }
#curve { width: 100%; max-width: 1100px; height: auto; background: var(--card); border: 1px solid var(--line);
  border-radius: 6px; cursor: crosshair; touch-action: none; }
#curve polyline { fill: none; }
#curve text { font-size: 11px; fill: var(--dim); }
#curve .grid { stroke: var(--line); }
#curve .cut { stroke: #cc3311; stroke-dasharray: 2 3; }
#cursor { stroke: var(--ink); }
.legend span { white-space: nowrap; margin-right: 1rem; }
.legend i { display: inline-block; width: 1.2em; height: .25em; vertical-align: middle; margin-right: .4em; }
td a { cursor: pointer; text-decoration: underline; }
kbd { border: 1px solid var(--line); border-radius: 3px; padding: 0 .3em; background: var(--card); }
.sheet { max-width: 100%; }
"""


def sequence_page(report: Mapping[str, Any], has_sheet: bool = True) -> str:
    """The whole page for a report of `merge`. `has_sheet`: contact sheet and curves are beside it."""
    title = f"{report['scene']}: {', '.join(report['reflectors'])}"
    small = " small" if report["resolution"][0] < 500 else ""
    machine = f"Blender {report['blender']} on {', '.join(report['gpu'])}."
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>Curvrefl: {escape(title)}</title><style>{STYLE}{_OWN_STYLE}</style></head><body>",
        f"<h1>{escape(title)}</h1>",
        f"<p>{escape(headline(report))}. {escape(machine)}</p>",
        *(f'<p class="warning">{escape(text)}</p>' for text in (*report.get("warnings", ()), *cut_sentences(report))),
        _player(report, small),
        _table(report),
        "<p>Means over frames; the worst and its frame, which a click shows. FLIP and PSNR as of one frame. Flicker is "
        "what changes from a frame to the next along the exact motion of what the mirrors show, and does not in "
        "Cycles: mean over the pixels that can be followed, of display values from 0 to 1. A pop is how much farther "
        "than in truth what a method shows moves. A hole is a pixel without anything in it where Cycles shows an "
        "object in it and all about it.</p>",
        _pictures(report) if has_sheet else "",
        f'<script type="application/json" id="data">{_data(report)}</script>',
        f"<script>{_SCRIPT.read_text(encoding='utf-8')}</script>",
        "</body></html>",
    ]
    return "\n".join(part for part in parts if part) + "\n"


def _player(report: Mapping[str, Any], small: str) -> str:
    names = _names(report)
    methods = [name for name in names if name != REFERENCE]
    measures = "".join(
        f'<option value="{key}"{" selected" if key == "flicker" else ""}>{escape(measure.label)}</option>'
        for key, measure in MEASURES.items()
    )
    speeds = "".join(f"<option{' selected' if speed == _SPEED else ''}>{speed}</option>" for speed in _FRAMES_A_SECOND)
    legend = "".join(
        f'<span><i style="background:{_color(report, name)}"></i>{escape(title_of(name))}</span>' for name in methods
    )
    first = folder_of(Path(), report["range"]["first"])
    return f"""<div class="bar">
<button id="play">Play</button><button id="previous">◀</button><button id="next">▶</button>
<input id="scrub" type="range" min="0" max="{report["range"]["count"] - 1}" value="0" aria-label="frame">
<span id="frame"></span>
<label>frames a second <select id="speed">{speeds}</select></label></div>
<div class="bar">
<select id="left" aria-label="left picture">{_options(names, REFERENCE)}</select>
<select id="right" aria-label="right picture">{_options(names, methods[0])}</select>
<button id="mode-side">Side by side</button><button id="mode-flip">Flip</button>
<button id="mode-difference">Difference</button>
<span id="number"></span> <a id="own" href="{first}/report.html">this frame's report</a>
<span id="cut" class="warning"></span></div>
<div id="side" class="two{small}">
<figure><img id="picture-left" src="{first}/{REFERENCE}.png" alt="left"></figure>
<figure><img id="picture-right" src="{first}/{methods[0]}.png" alt="right"></figure></div>
<div class="{small.strip()}"><div id="stack" class="stack" hidden>
<img id="picture-below" src="{first}/{REFERENCE}.png" alt="below">
<img id="picture-above" src="{first}/{methods[0]}.png" alt="above"></div></div>
<p id="which"></p>
<div class="bar"><label>curve <select id="measure">{measures}</select></label>
<button id="next-worst">Next worst</button><span>worst first:</span><span id="worst"></span></div>
<svg id="curve" viewBox="0 0 900 220"><line id="cursor" y1="10" y2="196"/></svg>
<p class="legend">{legend}</p>
<p>Keys: <kbd>Space</kbd> play, <kbd>←</kbd> <kbd>→</kbd> step, <kbd>Home</kbd> <kbd>End</kbd>, <kbd>↑</kbd>
<kbd>↓</kbd> method, <kbd>S</kbd> side by side, <kbd>F</kbd> flip, <kbd>D</kbd> difference, <kbd>W</kbd> next
worst.</p>"""


def _color(report: Mapping[str, Any], name: str) -> str:
    """(Black is as the page writes, which may be on black.)"""
    color = color_of(name, list(report["peers"]))
    return "var(--ink)" if color == "#000000" else color


def _names(report: Mapping[str, Any]) -> list[str]:
    return [REFERENCE, *report["methods"], *report["peers"]]


def _options(names: list[str], chosen: str) -> str:
    return "".join(
        f'<option value="{escape(name)}"{" selected" if name == chosen else ""}>'
        f"{escape('Cycles, the reference' if name == REFERENCE else title_of(name))}</option>"
        for name in names
    )


def _table(report: Mapping[str, Any]) -> str:
    titles = "".join(f"<th>{escape(measure.label)}</th>" for measure in MEASURES.values())
    lines = ['<div class="scroll"><table>', f"<tr><th></th>{titles}</tr>"]
    for group in ("methods", "peers"):
        for name, numbers in report[group].items():
            cells = "".join(_cell(name, key, numbers.get(key)) for key in MEASURES)
            lines.append(f"<tr><td>{escape(title_of(name))}</td>{cells}</tr>")
    return "\n".join([*lines, "</table></div>"])


def _cell(name: str, key: str, numbers: Mapping[str, Any] | None) -> str:
    if numbers is None:
        return f"<td>{NO_NUMBER}</td>"
    decimals = MEASURES[key].decimals
    if not numbers["worst"]:
        # (Where all is zero no frame is the worst.)
        return f"<td>{number(numbers['mean'], decimals)}</td>"
    worst = f"{number(numbers['worst'], decimals)} @ {numbers['worst_frame']}"
    jump = f'data-frame="{numbers["worst_frame"]}" data-name="{escape(name)}" data-measure="{key}"'
    return f"<td>{number(numbers['mean'], decimals)}; <a {jump}>{worst}</a></td>"


def _pictures(report: Mapping[str, Any]) -> str:
    sheet = '<h2>Contact sheet</h2>\n<img class="sheet" src="contact_sheet.png" alt="contact sheet">'
    curves = '<h2>Over time</h2>\n<img class="sheet" src="curves.svg" alt="curves over time">'
    # (Times are others each time: they are not in the page, but beside it.)
    times = '<h2>Times</h2>\n<img class="sheet" src="times.svg" alt="times by frame">'
    return f"{sheet}\n{curves}\n{times}"


def _data(report: Mapping[str, Any]) -> str:
    entries = report["frames"]
    groups = [(group, name) for group in ("methods", "peers") for name in names_of(entries, group)]
    data = {
        "frames": [
            {"frame": entry["frame"], "folder": folder_of(Path(), entry["frame"]).name, "cut": entry.get("cut", "")}
            for entry in entries
        ],
        "peers": list(report["peers"]),
        "colors": {name: _color(report, name) for _, name in groups},
        "measures": [
            {"key": key, "label": one.label, "decimals": one.decimals, "isBetterHigh": one.is_better_high}
            for key, one in MEASURES.items()
        ],
        "values": {
            key: {
                name: values_of(entries, group, name, key)
                for group, name in groups
                if group == "methods" or measure.of_peers
            }
            for key, measure in MEASURES.items()
        },
    }
    # (Nothing in it may end the element that holds it.)
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
