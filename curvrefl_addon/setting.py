# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What there is to know of one setting; `settings_table` has them all.

Light to import: without Blender, numpy and the renderer.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import Any

from .errors import InputError

_ROUNDING = 1e-6
"""Relative: Blender keeps numbers in float32, and the ends of a range must stay inside"""

type Range = tuple[float | None, float | None]
"""Least and most; None: no end on that side"""


@dataclass(frozen=True, slots=True)
class Choice:
    """A value of a setting that has a menu. A file keeps the place in the menu: new choices come last."""

    name: str
    label: str
    text: str


@dataclass(frozen=True, slots=True)
class Flag:
    """An argument of a verb of the command line that sets a setting."""

    verb: str
    spelling: str
    text: str
    default: Any = None
    """None: the setting's own"""
    metavar: str = "N"


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """All that is known of a setting."""

    name: str = ""
    default: Any = None
    """Its type says what is set: a bool, int, float, str (of `choices`), tuple of three floats, or None for an image"""
    first: Any = None
    """What new scenes start with, where that is not the default"""
    label: str
    text: str
    """The tooltip: begins with a capital letter and has no period at its end"""
    hard: Range = (None, None)
    """What is taken"""
    above: bool = False
    """Whether the least value itself is out of range"""
    soft: Range = (None, None)
    """What a slider goes through"""
    step: float | None = None
    """Of a slider's arrows"""
    unit: str = ""
    choices: tuple[Choice, ...] = ()
    panel: str = ""
    """Where it is set in the sidebar; nothing: it is no property of the .blend file"""
    preference: bool = False
    """Whether the preferences hold it; of a property of the scene, they hold what new scenes start with"""
    flags: tuple[Flag, ...] = ()
    said: str = ""
    """Start of the sentence about a value {} out of range"""
    least_note: str = ""
    """What the least value stands for"""

    @property
    def start(self) -> Any:
        """What new scenes start with."""
        return self.default if self.first is None else self.first

    def flag_value(self, flag: Flag) -> Any:
        """What it is on the command line where the argument is not given."""
        return self.default if flag.default is None else flag.default

    @property
    def range_text(self) -> str:
        """The hard range, for instance "1 to 64", or nothing where there is none."""
        least, most = self.hard
        note = f" ({self.least_note})" if self.least_note else ""
        if least is None:
            return "" if most is None else f"at most {_digits(most)}"
        if most is None:
            return f"{_digits(least)}{note} or more"
        if self.above:
            return f"more than {_digits(least)}, at most {_digits(most)}"
        return f"{_digits(least)}{note} to {_digits(most)}"

    def check(self, value: Any) -> None:
        """Raise InputError for a value that is none of the choices, or out of the hard range."""
        if self.choices:
            names = [choice.name for choice in self.choices]
            if value not in names:
                raise InputError(f'There is no {self.label.lower()} "{value}": choose one of {", ".join(names)}.')
        elif self.hard != (None, None) and not self._holds(value):
            said = self.said or f"A value of {{}} for {self.label} is"
            raise InputError(f"{said.format(value)} out of range: choose {self.range_text}.")

    def _holds(self, value: float) -> bool:
        least, most = self.hard
        slack = _ROUNDING if isinstance(value, float) else 0.0
        # (written so that NaN is out of every range)
        is_enough = least is None or (value > least if self.above else value >= least - slack * abs(least))
        return is_enough and (most is None or value <= most + slack * abs(most))


def _digits(number: float) -> str:
    return str(number) if isinstance(number, int) else f"{number:g}"


def setting(default: Any, **known: Any) -> Any:
    """A field of the classes of the table; `known` as in `Setting`."""
    return field(default=default, metadata={"setting": Setting(default=default, **known)})


def settings_in(group: Any) -> tuple[Setting, ...]:
    """Of a dataclass whose fields are all made by `setting`, in their order."""
    return tuple(replace(item.metadata["setting"], name=item.name) for item in fields(group))


def value_of(owner: Any, item: Setting) -> Any:
    """The setting as a property group has it; what is unknown here (saved by a newer extension) is as at the start."""
    value = getattr(owner, item.name)
    # (Blender reads a place that a menu does not have as nothing.)
    return item.start if item.choices and not value else value
