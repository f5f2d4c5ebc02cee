# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tries proofs one after the other, and another way where one fails."""

from __future__ import annotations

from collections import deque
from collections.abc import Generator, Iterator, Sequence
from dataclasses import replace

from ..device.state import kept_state
from ..device.ways.features import Features, features, only_features
from .proof import Found, Proof, Work
from .table import PROOFS
from .verdict import Failure, Verdict


class Proving:
    """A run of proofs; `verdict` once `work` is through."""

    def __init__(self, proofs: Sequence[Proof] = PROOFS, before: Verdict | None = None) -> None:
        """`before`: what was found of others, and holds."""
        self._proofs = tuple(proofs)
        self._before = before or Verdict()
        self._device = self._before.features
        self._failures: dict[str, Failure] = {}
        self.found: dict[str, str] = {}
        """How each proof came out by the way that is used, in words"""
        self.verdict = self._before

    def work(self) -> Iterator[None]:
        """Ends a slice at each `yield`: one dispatch or draw and the shader for it, or a search in numpy. Passes that
        others run meanwhile use what they did, until somebody takes the verdict (`verdict.take_verdict`)."""
        waiting, tried = deque(self._proofs), list[Proof]()
        while waiting:
            proof = waiting.popleft()
            given_up = yield from self._prove(proof)
            tried.append(proof)
            # What has been right by the way that is left by now has to be so by the other one.
            again = [item for item in tried if given_up in item.features and item is not proof]
            tried = [item for item in tried if item not in again]
            waiting.extendleft(again)
        names = tuple(proof.name for proof in self._proofs)
        self.verdict = self._before.with_more(Verdict(names, tuple(self._failures.values())))

    def _prove(self, proof: Proof) -> Generator[None, None, str]:
        """The feature that is given up for it, if any."""
        result = yield from _tried(proof, self._device)
        self.found[proof.name] = str(result)
        if _is_right(result):
            return ""
        # (One that fails by the second way, too, has failed: the first words are kept.)
        words = self._failures[proof.name].words if proof.name in self._failures else str(result)
        for feature in proof.features:
            if not getattr(self._device, feature):
                continue
            other = self._device.without(feature)
            again = yield from _tried(proof, other)
            if _is_right(again):
                self._device = other
                self.found[proof.name] = f"{again}, without {feature}"
                self._failures[proof.name] = Failure(proof.name, words, feature)
                return feature
        self._failures[proof.name] = Failure(proof.name, words)
        return ""


def prove_all(proofs: Sequence[Proof] = PROOFS) -> Proving:
    """At once."""
    proving = Proving(proofs)
    with kept_state():
        for _ in proving.work():
            pass
    return proving


def _is_right(result: Found | str) -> bool:
    return isinstance(result, Found) and result.is_right


def _tried(proof: Proof, device: Features) -> Generator[None, None, Found | str]:
    """How the proof comes out on a device with these features, or why it does not run."""
    work: Work = proof.work()
    try:
        while True:
            with only_features(replace(device, distrusted=features().distrusted)):
                next(work)
            yield
    except StopIteration as end:
        found: Found = end.value
        return found
    except (RuntimeError, SystemError) as error:
        # (A shader that does not compile, a texture that cannot be made: no other way needs to fail for that.)
        return str(error).strip().rstrip(".") or type(error).__name__
    finally:
        with only_features(device):
            work.close()
