# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compiles node trees to GLSL: each node once, in the order in which the tree is walked from its output."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

from ..arrays import ImageSource
from ..materials.node_links import Source, find_input
from .expression import Expression, Kind, glsl_type
from .program import IMAGE_RECORDS, Attribute, ImageUse, Program, Shape

type Handler = Callable[[Builder, Source], Expression | None]
"""From an output of a node (`source.socket`) to its value; None: it cannot be compiled, and stands as its default"""

_ZERO: Mapping[Kind, tuple[float, ...]] = {"float": (0.0,), "vector": (0.0,) * 3, "color": (0.0,) * 3}
_KINDS: Mapping[str, Kind] = {"VALUE": "float", "INT": "float", "BOOLEAN": "float", "VECTOR": "vector", "RGBA": "color"}
"""By a socket's type"""


class Images(Protocol):
    """Finds the images that nodes show."""

    def index_of(self, node: Any, note: Callable[[str], None], tile: int = 0) -> int | None:
        """Place in `SceneArrays.images` of an image node's image, or of this one of its tiles; None where it has no
        image."""

    def source(self, index: int) -> ImageSource:
        """What is at a place in it."""


class Builder:
    """One program in the making."""

    def __init__(
        self,
        handlers: Mapping[str, Handler],
        images: Images,
        notes: list[str],
        luminance: Sequence[float] = (0.2126, 0.7152, 0.0722),
        is_world: bool = False,
    ) -> None:
        """`handlers`: by the type of node. `notes` gets causes of remarks. `luminance`: weights of the working space.
        `is_world`: the program is a world's, whose positions are directions."""
        self._handlers = handlers
        self._images = images
        self._notes = notes
        self.luminance = tuple(float(weight) for weight in luminance)
        self.is_world = is_world
        self.objects: set[int] = set()
        """Those (session_uid) beside its own whose place the program knows"""
        self._depth = 0
        self._functions: list[str] = []
        self._lines: list[str] = []
        self._known: dict[Any, Expression] = {}
        self._names = 0
        self._files: dict[str, None] = {}
        self._records: list[tuple[float, float, float, float]] = []
        self._attributes: dict[Attribute, int] = {}
        self._instance_attributes: dict[str, int] = {}
        self._uses: list[ImageUse] = []
        self._needs: set[str] = set()
        self._depends: set[str] = set()
        self._open: set[Any] = set()

    # Inputs of nodes

    def value(self, source: Source, kind: Kind) -> Expression:
        """What the end of a chain of links gives where a value of this kind is asked for."""
        return self.as_kind(self._value(source), kind)

    def input(self, source: Source, name: str, kind: Kind) -> Expression:
        """The same of the input called `name` (identifier or name) of the source's node."""
        return self.value(source.input(name), kind)

    def is_linked(self, source: Source, name: str) -> bool:
        """Whether anything is plugged into the input (through groups: a value of the group's counts as plugged in)."""
        found = source.input(name)
        return found.node is not None or found.socket != find_input(source.node, name)

    def constant_of(self, source: Source, name: str) -> tuple[float, ...] | None:
        """The input's value where it is known now; None where it is not."""
        found = source.input(name)
        node = found.node
        if node is None:
            return plain_value(found.socket)
        return plain_value(found.socket) if node.type in ("VALUE", "RGB") else None

    def as_kind(self, value: Expression, kind: Kind) -> Expression:
        """Converted as Cycles converts: a color to its luminance, a vector to its mean."""
        if value.kind == kind:
            return value
        if value.kind == "vec4":
            return self.as_kind(Expression(f"{value.text}.xyz", "color", None, value.low, value.high), kind)
        if kind == "float":
            if value.constant is not None and len(set(value.constant)) == 1:
                return Expression(f"{value.text}.x", "float", value.constant[:1], value.low, value.high)
            weights = self.luminance if value.kind == "color" else (1.0 / 3.0,) * 3
            if value.kind == "color":
                text = f"dot({value.text}, vec3({', '.join(map(_number, weights))}))"
            else:
                # (As Cycles adds, to the last bit: the mean may be hashed.)
                text = f"(({value.text}.x + {value.text}.y + {value.text}.z) * {_number(weights[0])})"
            known: tuple[float, ...] | None = None
            if value.constant is not None:
                known = (float(np.dot(value.constant, weights)),)
            return Expression(text, "float", known, value.low, value.high)
        if value.kind == "float":
            known = None if value.constant is None else value.constant * 3
            return Expression(f"vec3({value.text})", kind, known, value.low, value.high)
        return Expression(value.text, kind, value.constant, value.low, value.high)

    # Values

    def parameter(self, *values: float) -> Expression:
        """A constant of the tree, which is no part of the program's shape: one number or three."""
        kind: Kind = "float" if len(values) == 1 else "vector"
        number = self.record(*values)
        known = tuple(float(value) for value in values)
        text = f"P({number}).x" if kind == "float" else f"P({number}).xyz"
        return Expression(text, kind, known, min(known), max(known))

    def record(self, *values: float) -> int:
        """Up to four constants; the number of their record: `P(number)` in the text."""
        padded = [float(value) for value in values] + [0.0] * (4 - len(values))
        self._records.append((padded[0], padded[1], padded[2], padded[3]))
        return len(self._records) - 1

    def table(self, rows: Any) -> int:
        """Constants (n, 1..4) of a curve or ramp; the number of the first record. (n is part of the shape.)"""
        first = len(self._records)
        for row in np.atleast_2d(np.asarray(rows, np.float64)):
            self.record(*row.tolist())
        return first

    def call(
        self,
        kind: Kind,
        function: str,
        *arguments: Expression | str | float | int,
        file: str = "",
        low: float = -np.inf,
        high: float = np.inf,
    ) -> Expression:
        """What a function of a GLSL `file` ("nodes/noise.glsl") gives; plain numbers are part of the shape."""
        if file:
            self._files[file] = None
        return self.made(kind, f"{function}({', '.join(map(_argument, arguments))})", low, high)

    def made(self, kind: Kind, text: str, low: float = -np.inf, high: float = np.inf) -> Expression:
        """A value by any GLSL, which is computed once."""
        return Expression(self.made_as(glsl_type(kind), text), kind, None, float(low), float(high))

    def made_as(self, glsl: str, text: str) -> str:
        """The same of any type of GLSL, a struct's or vec2: its name."""
        name = f"v{self._names}"
        self._names += 1
        self._lines.append(f"  {glsl} {name} = {text};")
        return name

    def shared(self, key: Any, make: Callable[[], Expression]) -> Expression:
        """Made once for all outputs of a node: `key` has the node's name for what is made, and the source's groups."""
        if key not in self._known:
            self._known[key] = make()
        return self._known[key]

    def include(self, file: str) -> None:
        """The program needs a GLSL file."""
        self._files[file] = None

    def attribute(self, kind: str, name: str) -> Expression:
        """Of the mesh: four numbers."""
        number = self._attributes.setdefault(Attribute(kind, name), len(self._attributes))
        return Expression(f"s.attributes[{number}]", "vec4")

    def instance_attribute(self, name: str) -> Expression:
        """Of the instance or the object: four numbers."""
        number = self._instance_attributes.setdefault(name, len(self._instance_attributes))
        return Expression(f"instance_attribute(s, {number})", "vec4")

    def image(self, source: Source, tile: int = 0) -> int | None:
        """The first of the IMAGE_RECORDS parameters of the image of the source's node, or of a tile of it; None where
        it has none."""
        self.need("PROGRAM_IMAGES")
        index = self._images.index_of(source.node, self.note, tile)
        if index is None:
            return None
        first = self.record()
        for _ in range(IMAGE_RECORDS - 1):
            self.record()
        self._uses.append(ImageUse(first, index))
        return first

    def image_source(self, source: Source, tile: int = 0) -> ImageSource | None:
        """What is known of that image."""
        index = self._images.index_of(source.node, self.note, tile)
        return None if index is None else self._images.source(index)

    def need(self, name: str) -> None:
        """A define that the program's ShadingPoint needs (`programs/shading_point.glsl`)."""
        self._needs.add(name)

    def depend(self, what: str) -> None:
        """What values differ with beside a mesh's own: "position", "generated", "ray", "instance", "random"."""
        self._depends.add(what)

    def function(self, source: Source, kind: Kind) -> str:
        """The value at a source as a GLSL function of a ShadingPoint, whose name this is: to be asked at neighbors."""
        lines, known = self._lines, self._known
        self._lines, self._known = [], {}
        self._depth += 1
        try:
            result = self.value(source, kind)
            body = "\n".join([*self._lines, f"  return {result.text};"])
        finally:
            self._lines, self._known = lines, known
            self._depth -= 1
        name = f"value_{len(self._functions)}"
        self._functions.append(f"{glsl_type(kind)} {name}(ShadingPoint s)\n{{\n{body}\n}}\n")
        return name

    @property
    def attributes(self) -> Mapping[Attribute, int]:
        """Those of the mesh that are read so far, with their numbers."""
        return self._attributes

    @property
    def is_at_neighbors(self) -> bool:
        """Whether what is compiled is asked at neighbors too, between which only positions and attributes differ."""
        return self._depth > 0

    def note(self, cause: str) -> None:
        """Something is not drawn as it is: the cause of a remark ("Wireframe nodes {of} are not drawn.")."""
        if cause not in self._notes:
            self._notes.append(cause)

    # The end

    def finished(self, channels: Mapping[str, Expression]) -> Program:
        """The program that sets these fields of Material."""
        lines = [*self._lines, *(f"  m.{name} = {value.text};" for name, value in channels.items())]
        body = "\n".join(lines)
        main = f"void material_program(ShadingPoint s, inout Material m)\n{{\n{body}\n}}\n"
        shape = Shape(
            "\n".join([*self._functions, main]),
            tuple(self._files),
            len(self._attributes),
            tuple(channels),
            frozenset(self._needs),
        )
        return Program(
            shape,
            np.array(self._records, np.float32).reshape(-1, 4),
            tuple(self._attributes),
            tuple(self._uses),
            tuple(self._instance_attributes),
            frozenset(self._depends),
        )

    def _value(self, source: Source) -> Expression:
        node = source.node
        key = (source.socket.as_pointer(), tuple(group.as_pointer() for group in source.groups))
        if key in self._known:
            return self._known[key]
        if node is None:
            found: Expression | None = self._constant(source.socket)
        elif node.type in ("VALUE", "RGB"):
            found = self._constant(source.socket)
        elif key in self._open:
            # (Blender leaves loops of links as they are, and marks them.)
            self.note("Loops of links {of} are not drawn.")
            found = None
        else:
            self._open.add(key)
            handler = self._handlers.get(node.type)
            found = None if handler is None else handler(self, source)
            self._open.discard(key)
        if found is None:
            self.note(f"{node.bl_label} nodes {{of}} are not drawn.")
            found = self._typed(self.parameter(*_ZERO[_KINDS.get(source.socket.type, "float")]), source.socket)
        self._known[key] = found
        return found

    def _constant(self, socket: Any) -> Expression:
        value = plain_value(socket)
        return self._typed(self.parameter(*value), socket)

    @staticmethod
    def _typed(value: Expression, socket: Any) -> Expression:
        kind = _KINDS.get(socket.type, "float")
        return Expression(value.text, kind, value.constant, value.low, value.high)


def plain_value(socket: Any) -> tuple[float, ...]:
    """The value of a socket by itself: one number, or three."""
    value = getattr(socket, "default_value", 0.0)
    if isinstance(value, str):
        return (0.0,)
    try:
        parts = tuple(float(part) for part in value)
    except TypeError:
        return (float(value),)
    return parts[:3] if len(parts) >= 3 else (*parts, *(0.0,) * (3 - len(parts)))


def _argument(value: Expression | str | float) -> str:
    if isinstance(value, Expression):
        return value.text
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    return value if isinstance(value, str) else _number(value)


def _number(value: float) -> str:
    """A float in GLSL, with all its digits in single precision."""
    text = repr(float(np.float32(value)))
    return text if any(mark in text for mark in ".en") else f"{text}.0"
