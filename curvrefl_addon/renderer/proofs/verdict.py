# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What proofs have found: what of the device is used from then on, and what is said of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ..device.ways.features import FEATURES, Features, features, use_features
from .table import PROOFS


@dataclass(frozen=True, slots=True)
class Failure:
    """A proof that has failed."""

    name: str
    words: str
    """How far off the usual way was, or why it did not run"""
    without: str = ""
    """Feature whose place another way takes, which is right; nothing where no way is"""


@dataclass(frozen=True, slots=True)
class Verdict:
    """On one device and driver."""

    proven: tuple[str, ...] = ()
    """Names of the proofs that were tried"""
    failures: tuple[Failure, ...] = ()

    @property
    def features(self) -> Features:
        """What of the device is used."""
        lacking = [failure.without for failure in self.failures if failure.without]
        methods = {proof.name: proof.methods for proof in PROOFS}
        wrong = {method for failure in self.failures if not failure.without for method in methods.get(failure.name, ())}
        return replace(Features().without(*lacking), distrusted=frozenset(wrong))

    @property
    def sentence(self) -> str:
        """For the panel: nothing where all is right."""
        subjects = {proof.name: proof.subject for proof in PROOFS}
        wrong = [subjects[failure.name] for failure in self.failures if not failure.without]
        other = [subjects[failure.name] for failure in self.failures if failure.without]
        parts = []
        if wrong:
            parts.append(f"gets {joined(wrong)} wrong")
        if other:
            parts.append(f"gets {joined(other)} right by another way alone, which is slower")
        if not parts:
            return ""
        return f'This graphics driver {", and ".join(parts)}: update it, or send what "Copy Report" copies.'

    def with_more(self, other: Verdict) -> Verdict:
        """What later proofs have found as well."""
        names = set(other.proven)
        kept = tuple(failure for failure in self.failures if failure.name not in names)
        return Verdict(tuple(dict.fromkeys((*self.proven, *other.proven))), kept + other.failures)

    def as_json(self) -> dict[str, Any]:
        """To be kept."""
        failures = {item.name: {"words": item.words, "without": item.without} for item in self.failures}
        return {"proven": list(self.proven), "failures": failures}

    @classmethod
    def from_json(cls, kept: Mapping[str, Any]) -> Verdict:
        """What `as_json` gave; proofs that there are no more are left out. Raises KeyError, TypeError or ValueError for
        what it did not give."""
        names = {proof.name for proof in PROOFS}
        proven = tuple(str(name) for name in kept["proven"] if name in names)
        failures = tuple(
            Failure(str(name), str(item["words"]), str(item["without"]))
            for name, item in dict(kept["failures"]).items()
            if name in names
        )
        if unknown := {failure.without for failure in failures} - {"", *FEATURES}:
            raise ValueError(f"{min(unknown)} is nothing that a device has.")
        return cls(proven, failures)


def joined(words: list[str]) -> str:
    """In a sentence."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


_known = [Verdict()]


def known_verdict() -> Verdict:
    """Nothing is wrong as long as nothing was proven."""
    return _known[0]


def take_verdict(verdict: Verdict) -> bool:
    """From now on use what it says; whether that is something else than before, so that what was drawn and solved
    until now may be wrong."""
    used, distrusted = features(), features().distrusted
    _known[0] = verdict
    use_features(verdict.features)
    return (used, distrusted) != (features(), features().distrusted)
