# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Two surfaces as one: exactly where one set of channels says it, else by chance, which is exact in the mean."""

from __future__ import annotations

from ..builder import Builder
from ..expression import Expression
from .arithmetic import chosen, clamped, constant, is_at, is_same, mixed, product, quotient, rest_of, total
from .chance import Chance
from .closure import BLACK, DEFAULTS, Closure, matt
from .inputs import DARKENS

HALF = constant(0.5)
LEAST_ALPHA = 1.0 / 16.0
"""Of a surface that light is added to: where less is there, some of that light is left out"""
_OF_DIFFUSE = ("normal", "diffuse_roughness", "subsurface")
"""Channels that two diffuse parts have to have in common to be one"""


def mix(b: Builder, first: Closure, second: Closure, share: Expression, chance: Chance) -> Closure:
    """`share` (0 to 1) of the second; `chance`: that of the mix itself."""
    if first.is_clear:
        return _with_clear(b, first, second, share)
    if second.is_clear:
        return _with_clear(b, second, first, rest_of(b, share))
    found = _mixed_matt(b, first, second, share)
    return _by_chance(b, first, second, share, chance) if found is None else found


def add(b: Builder, first: Closure, second: Closure, chance: Chance) -> Closure:
    """The sum."""
    if first.only_emits:
        first, second = second, first
    if second.only_emits:
        return _with_light(b, first, second.get("emission"))
    if _are_one_diffuse(first, second):
        color = total(b, first.get("base_color"), second.get("base_color"))
        return _merged(first, second).with_(base_color=color, emission=_sum(b, first, second, "emission"))
    if first.is_scalable and second.is_scalable:
        if any(one.get("metallic").high > 0.0 and one.get("roughness").high > DARKENS for one in (first, second)):
            # (Twice as bright a metal loses less between its facets.)
            b.note("Rough gloss {of} that is added to another shader is drawn a little too bright.")
        return _by_chance(b, first.scaled(b, 2.0), second.scaled(b, 2.0), HALF, chance)
    b.note("Of added shaders {of} only the first one and the light of both are drawn.")
    if first.is_opaque and second.is_opaque:
        return first.with_(emission=_sum(b, first, second, "emission"))
    return first


def _with_clear(b: Builder, clear: Closure, other: Closure, share: Expression) -> Closure:
    """`share` of the other, the rest is clear."""
    own, tint = other.get("alpha"), clear.get("transparent_tint")
    alpha = product(b, share, own)
    if not other.is_opaque and not is_same(tint, other.get("transparent_tint")):
        through = total(
            b,
            product(b, tint, rest_of(b, share)),
            product(b, other.get("transparent_tint"), product(b, share, rest_of(b, own))),
        )
        tint = quotient(b, through, rest_of(b, alpha))
    scalable = other.is_scalable and clear.is_scalable
    return other.with_(is_scalable=scalable, alpha=alpha, transparent_tint=tint)


def _are_one_diffuse(first: Closure, second: Closure) -> bool:
    """Whether both are diffuse or shine, and differ in their colors alone."""
    if not (first.is_matt and second.is_matt and first.is_opaque and second.is_opaque):
        return False
    both = _merged(first, second)
    names = (*_OF_DIFFUSE, "translucency")
    return all(is_same(one.get(name), both.get(name)) for one in (first, second) for name in names if one.has(name))


def _mixed_matt(b: Builder, first: Closure, second: Closure, share: Expression) -> Closure | None:
    """Two diffuse or shining surfaces as one; None where they are not that."""
    one, other = first, second
    if is_same(first.get("base_color"), second.get("base_color")) and first.is_matt and second.is_matt:
        # Of one color, they may differ in how much comes out on the other side.
        through = mixed(b, first.get("translucency"), second.get("translucency"), share)
        one, other = first.with_(translucency=through), second.with_(translucency=through)
    if not _are_one_diffuse(one, other):
        return None
    color = mixed(b, first.get("base_color"), second.get("base_color"), share)
    emission = mixed(b, first.get("emission"), second.get("emission"), share)
    return _merged(one, other).with_(base_color=color, emission=emission)


def _by_chance(b: Builder, first: Closure, second: Closure, share: Expression, chance: Chance) -> Closure:
    """Each sample shows one of both."""
    side = chance.is_second(b, share)
    channels = {}
    for name in DEFAULTS:
        one, other = first.channels.get(name), second.channels.get(name)
        if one is None and other is None:
            continue
        # What does not matter on one side can be as on the other.
        pair = [value for value in (one, other) if value is not None]
        channels[name] = chosen(b, side, pair[0], pair[-1])
    if is_same(first.get("alpha"), second.get("alpha")) and first.is_bare and second.is_bare:
        # Light needs no chance.
        channels["emission"] = mixed(b, first.get("emission"), second.get("emission"), share)
    return Closure(channels, first.is_scalable and second.is_scalable)


def _with_light(b: Builder, surface: Closure, light: Expression) -> Closure:
    """A surface that also shines, where nothing else is, too."""
    if is_at(light, 0.0):
        return surface
    alpha, own = surface.get("alpha"), surface.get("emission")
    if not surface.is_bare:
        b.note("Light {of} that is added to a coat or a sheen is drawn below it.")
    if surface.is_opaque:
        return surface.with_(emission=total(b, own, light))
    if not (surface.is_clear or surface.is_matt):
        if alpha.low < LEAST_ALPHA:
            b.note("Light {of} that is added to full transparency is left out there.")
        return surface.with_(emission=total(b, own, quotient(b, light, alpha, LEAST_ALPHA)))
    # At least half of the samples show what shines, the others see through, and each counts for as many as it stands.
    there = clamped(b, alpha, 0.5, 1.0)
    tint = product(b, surface.get("transparent_tint"), quotient(b, rest_of(b, alpha), rest_of(b, there)))
    share = quotient(b, alpha, there)
    emission = total(b, product(b, own, share), quotient(b, light, there))
    plain = surface if surface.has("base_color") else matt(BLACK)
    color = product(b, plain.get("base_color"), share)
    return plain.with_(base_color=color, emission=emission, alpha=there, transparent_tint=tint)


def _merged(first: Closure, second: Closure) -> Closure:
    """The channels of both, of which the first's go before."""
    scalable = first.is_scalable and second.is_scalable
    return Closure({**second.channels, **first.channels}, scalable)


def _sum(b: Builder, first: Closure, second: Closure, name: str) -> Expression:
    return total(b, first.get(name), second.get(name))
