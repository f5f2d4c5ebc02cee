# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The IES Texture."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import bpy

from ...materials.node_links import Source
from ..builder import Builder, Handler
from ..expression import Expression
from ..ies import photometry
from .coordinates import texture_vector
from .values.places import NORMALS_FILE, needs_instance

_UNREADABLE = 100.0
"""What Cycles takes for a file that is none"""


def ies_texture(b: Builder, source: Source) -> Expression:
    """How a lamp on the market shines in a direction, by default that of the light."""
    node: Any = source.node
    strength = b.input(source, "Strength", "float")
    found = photometry(_text(node))
    if found is None:
        b.note("IES files {of} that cannot be read shine alike to all sides, as in Cycles.")
        return b.made("float", f"{strength.text} * {_UNREADABLE}")
    if b.is_linked(source, "Vector"):
        vector = texture_vector(b, source)
    elif b.is_world:
        b.depend("position")
        vector = b.made("vector", "-s.position")
    else:
        b.depend("position")
        needs_instance(b)
        vector = b.call("vector", "tangent_object_normal", "s", "s.incoming", file=NORMALS_FILE)
    first = b.record(len(found.horizontal), len(found.vertical))
    for angles in (found.horizontal, found.vertical, found.intensity.ravel()):
        b.table(angles[:, None])
    text = f"s.records + {first}"
    factor = b.call("float", "ies_intensity", text, vector, file="nodes/ies.glsl", low=0.0)
    return b.made("float", f"{strength.text} * {factor.text}")


def _text(node: Any) -> str:
    if node.mode == "INTERNAL":
        return "" if node.ies is None else str(node.ies.as_string())
    try:
        path = Path(bpy.path.abspath(node.filepath, library=node.id_data.library))
        return path.read_text(encoding="latin-1") if node.filepath else ""
    except OSError:
        return ""


NODES: Mapping[str, Handler] = {"TEX_IES": ies_texture}
