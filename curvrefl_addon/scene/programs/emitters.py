# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds that are more than a color or an image, as programs; and what shines of shaders, as one value."""

from __future__ import annotations

import math
from typing import Any

from ..arrays import SunDisc, WorldArrays
from ..materials.color_spaces import luminance_weights
from ..materials.node_links import Source
from .builder import Builder
from .expression import Expression
from .images import ProgramImages
from .nodes.skies import LEAST_SIZE, is_plain, sun_angles
from .registry import HANDLERS

EMISSION = "emission"
"""The channel that programs of worlds and lamps set"""


def world_program(source: Source, images: ProgramImages, notes: list[str]) -> WorldArrays:
    """What the shader at a world's output shines, by a program. `images` lists its images, `notes` gets causes of
    remarks."""
    b = Builder(HANDLERS, images, notes, tuple(luminance_weights().tolist()), is_world=True)
    value = radiance(b, source)
    if value.constant is not None:
        red, green, blue = value.constant
        return WorldArrays((red, green, blue))
    discs = tuple(disc for sky in _skies(source, set()) if (disc := _disc_of(b, sky)) is not None)
    program = b.finished({EMISSION: value})
    if "PROGRAM_CAMERA" in program.shape.needs:
        notes.append("What follows the camera {of} is drawn black.")
        return WorldArrays()
    return WorldArrays((1.0, 1.0, 1.0), program=program, discs=discs, program_images=images.sources)


def radiance(b: Builder, source: Source) -> Expression:
    """A color: what a shader shines."""
    node = source.node
    if node is None:
        return Expression("vec3(0.0)", "color", (0.0, 0.0, 0.0), 0.0, 0.0)
    if source.socket.type != "SHADER":
        # Cycles takes a color for a background of it.
        return b.value(source, "color")
    if node.type in ("BACKGROUND", "EMISSION"):
        color, strength = b.input(source, "Color", "color"), b.input(source, "Strength", "float")
        if color.constant is not None and strength.constant is not None:
            value = tuple(part * strength.constant[0] for part in color.constant)
            return Expression(f"({color.text} * {strength.text})", "color", value)
        return b.made("color", f"{color.text} * {strength.text}")
    if node.type == "ADD_SHADER":
        first, second = (radiance(b, source.input(name)) for name in ("Shader", "Shader_001"))
        if first.constant is not None and second.constant is not None:
            total = tuple(map(sum, zip(first.constant, second.constant, strict=True)))
            return Expression(f"({first.text} + {second.text})", "color", total)
        return b.made("color", f"{first.text} + {second.text}")
    if node.type == "MIX_SHADER":
        factor = b.input(source, "Fac", "float")
        if factor.constant is not None and not 0.0 < factor.constant[0] < 1.0:
            return radiance(b, source.input("Shader_001" if factor.constant[0] > 0.5 else "Shader"))
        first, second = (radiance(b, source.input(name)) for name in ("Shader", "Shader_001"))
        text = f"mix({first.text}, {second.text}, clamp({factor.text}, 0.0, 1.0))"
        if factor.constant is not None and first.constant is not None and second.constant is not None:
            share = factor.constant[0]
            pairs = zip(first.constant, second.constant, strict=True)
            return Expression(text, "color", tuple(a + share * (c - a) for a, c in pairs))
        return b.made("color", text)
    b.note(f"{node.bl_label} {{of}} is drawn black.")
    return Expression("vec3(0.0)", "color", (0.0, 0.0, 0.0), 0.0, 0.0)


def _skies(source: Source, seen: set[Any]) -> list[Source]:
    """Sky textures that a value is made of."""
    node = source.node
    key = None if node is None else (node.as_pointer(), tuple(group.as_pointer() for group in source.groups))
    if key is None or key in seen:
        return []
    seen.add(key)
    assert node is not None
    found = [source] if node.type == "TEX_SKY" else []
    return found + [sky for inner in source.inputs() for sky in _skies(inner, seen)]


def _disc_of(b: Builder, sky: Source) -> SunDisc | None:
    node = sky.node
    assert node is not None
    if node.sky_type not in ("SINGLE_SCATTERING", "MULTIPLE_SCATTERING") or not node.sun_disc or not is_plain(b, sky):
        return None
    elevation, rotation = sun_angles(node)
    flat = math.cos(elevation)
    direction = (-flat * math.sin(rotation), flat * math.cos(rotation), math.sin(elevation))
    return SunDisc(direction, max(float(node.sun_size), LEAST_SIZE))
