# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A comparison as one page: per method ours | Cycles | difference x16 | EEVEE, with the numbers under each."""

from __future__ import annotations

from html import escape
from typing import Any

from .table import decibels, headline, milliseconds, number, percent, rows

STYLE = """
:root { color-scheme: light dark; --ink: #1c1e21; --dim: #63686f; --paper: #fbfbf9; --card: #fff; --line: #dfe0dc;
        --best: #d9efdf; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e7e7e4; --dim: #9a9fa6; --paper: #17181a; --card: #202225; --line: #34373b; --best: #23422e; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1500px; padding: 2rem 1.5rem 4rem; background: var(--paper); color: var(--ink);
       font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.5rem; margin: 0; }
h2 { font-size: 1.1rem; margin: 2.5rem 0 .75rem; }
p { margin: .3rem 0; color: var(--dim); max-width: 75ch; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin-top: 1.25rem; background: var(--card); font-variant-numeric: tabular-nums; }
th, td { padding: .4rem .8rem; border: 1px solid var(--line); text-align: right; white-space: nowrap; }
th { font-weight: 600; color: var(--dim); }
th:first-child, td:first-child { text-align: left; }
td.best { background: var(--best); }
.pictures { display: grid; gap: 1rem; grid-template-columns: repeat(auto-fit, minmax(280px, 1fr)); }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: 6px; overflow: hidden; }
figure img { display: block; width: 100%; height: auto; background: #000; }
figcaption { padding: .6rem .8rem .7rem; }
figcaption strong { display: block; }
dl { display: grid; grid-template-columns: auto 1fr; gap: 0 1rem; margin: .3rem 0 0; font-size: .87rem;
     font-variant-numeric: tabular-nums; }
dt { color: var(--dim); }
dd { margin: 0; text-align: right; }
.warning { color: #a86400; }
"""


def report_page(report: dict[str, Any], mismatch: dict[str, float | None] | None = None) -> str:
    """The whole page for a report of `compare`; pictures are linked by their names beside it.

    `mismatch`: per method the share of mirror pixels by which its mask differs from Cycles' (`metrics.mask_mismatch`).
    """
    title = f"{report['scene']}: {', '.join(report['reflectors'])}"
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>Curvrefl: {escape(title)}</title><style>{STYLE}</style></head><body>",
        f"<h1>{escape(title)}</h1>",
        f"<p>{escape(headline(report))}. Blender {escape(report['blender'])} on {escape(report['gpu'])}.</p>",
        *(f'<p class="warning">{escape(warning)}</p>' for warning in report.get("warnings", ())),
        _table(report),
        "<p>Pictures are as the file shows them: with its film, view transform, look, exposure and gamma. FLIP (0 is "
        "equal, lower is better), PSNR and the differences are measured through Blender's Standard view without any of "
        "these, over the mirror's pixels. The angle is how far, seen from the mirror, the shown point lies from the "
        "one that Cycles shows. "
        "The time of a peer is its second render of the frame.</p>",
        *(_method(report, name, (mismatch or {}).get(name)) for name in report["methods"]),
        _other_peers(report),
        "</body></html>",
    ]
    return "\n".join(part for part in parts if part) + "\n"


def _table(report: dict[str, Any]) -> str:
    titles, *body = rows(report)
    best = _best_rows(report)
    lines = ['<div class="scroll"><table>', "<tr>" + "".join(f"<th>{escape(title)}</th>" for title in titles) + "</tr>"]
    for index, row in enumerate(body):
        cells = (
            f'<td class="best">{escape(cell)}</td>' if best.get(column) == index else f"<td>{escape(cell)}</td>"
            for column, cell in enumerate(row)
        )
        lines.append("<tr>" + "".join(cells) + "</tr>")
    return "\n".join([*lines, "</table></div>"])


def _best_rows(report: dict[str, Any]) -> dict[int, int]:
    """Column of FLIP and of the frame time to the row with the smallest value."""
    flips = [entry["image"]["flip"] for group in ("methods", "peers") for entry in report[group].values()]
    times = [method["time_ms"]["frame"] for method in report["methods"].values()]
    times += [peer["time_ms"] for peer in report["peers"].values()]
    best = {}
    for column, values in ((1, flips), (9, times)):
        known = [value for value in values if value is not None]
        if len(known) > 1:
            best[column] = values.index(min(known))
    return best


def _method(report: dict[str, Any], name: str, mismatch: float | None) -> str:
    method, reference = report["methods"][name], report["reference"]
    geometry, times, solve = method["geometry"], method["time_ms"], method["solve"]
    angle = geometry["angle_deg"]
    figures = [
        _figure(
            f"{name}.png",
            f"Ours: {name}",
            {
                **_image_numbers(method["image"]),
                "frame": f"{milliseconds(times['frame'])} ms",
                "of it solve, draw": f"{milliseconds(times['solve'])}, {milliseconds(times['draw'])} ms",
                "once: extract, bake": f"{milliseconds(times['extract'])}, {milliseconds(times['bake'])} ms",
            },
        ),
        _figure(
            "reference.png",
            "Cycles",
            {
                "samples": str(reference["samples"]),
                "light": reference["light"],
                "time": f"{reference['time_s']:.1f} s",
                "mirror pixels": str(report["mask_pixels"]),
            },
        ),
        _figure(
            f"{name}_error.png",
            "Difference x16",
            {
                "angle, median": f"{number(angle['median'], 3)}°",
                "angle, p95 and p99": f"{number(angle['p95'], 2)}°, {number(angle['p99'], 2)}°",
                "wrong object": percent(geometry["wrong_object"]),
                "mask differs": percent(mismatch),
                "vertices reflected": f"{solve['reflected']} of {solve['vertices']}",
                "unconverged": str(solve["unconverged"]),
            },
        ),
    ]
    if "eevee" in report["peers"]:
        figures.append(_peer_figure(report, "eevee"))
    return f'<h2>{escape(name)}</h2>\n<div class="pictures">\n' + "\n".join(figures) + "\n</div>"


def _other_peers(report: dict[str, Any]) -> str:
    others = [_peer_figure(report, name) for name in report["peers"] if name != "eevee"]
    return '<h2>Other peers</h2>\n<div class="pictures">\n' + "\n".join(others) + "\n</div>" if others else ""


def _peer_figure(report: dict[str, Any], name: str) -> str:
    peer = report["peers"][name]
    return _figure(
        f"{name}.png",
        peer_title(name),
        {**_image_numbers(peer["image"]), "frame": f"{milliseconds(peer['time_ms'])} ms"},
    )


def peer_title(name: str) -> str:
    """'eevee' to 'EEVEE', 'cycles8' to 'Cycles, 8 samples'."""
    if name == "eevee":
        return "EEVEE, ray tracing"
    count = name.removeprefix("cycles")
    return f"Cycles, {count} sample{'' if count == '1' else 's'}"


def _image_numbers(image: dict[str, Any]) -> dict[str, str]:
    return {"FLIP": number(image["flip"], 4), "PSNR": f"{decibels(image['psnr'], image['flip'])} dB"}


def _figure(picture: str, title: str, numbers: dict[str, str]) -> str:
    source = escape(picture, quote=True)
    entries = "".join(f"<dt>{escape(key)}</dt><dd>{escape(value)}</dd>" for key, value in numbers.items())
    return (
        f'<figure><a href="{source}"><img src="{source}" alt="{escape(title, quote=True)}"></a>'
        f"<figcaption><strong>{escape(title)}</strong><dl>{entries}</dl></figcaption></figure>"
    )
