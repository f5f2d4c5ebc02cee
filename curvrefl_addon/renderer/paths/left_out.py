# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What only rays show of a mirror: others leave it out and say so, and `auto` follows rays for it. Pure numpy."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ...optics.catalog import Method
from ...scene.arrays import InstanceArrays, SceneArrays
from ...scene.remarks import Remark, sentences
from .features import (
    ALPHA,
    ANISOTROPY,
    COAT,
    FILM,
    GLASS,
    ROUGH,
    SHEEN,
    TINT,
    VARIES,
    features_of,
    in_use,
    path_features,
)

BUMPS = "BUMPS"
"""Beside the features of paths"""
KINDS = {
    BUMPS: ("Bumps {of} are left out", "has bumps"),
    GLASS: ("The glass {of} is drawn as a plain mirror", "is glass"),
    ALPHA: ("The transparency {of} is left out", "is transparent in part"),
    COAT: ("The coat {of} is left out", "has a coat"),
    SHEEN: ("The sheen {of} is left out", "has sheen"),
    FILM: ("The thin film {of} is left out", "has a thin film"),
    ROUGH: ("Roughness {of} is left out", "is rough"),
    ANISOTROPY: ("Anisotropy {of} is left out", "is anisotropic"),
    TINT: ("The tint of edges {of} is left out", "has tinted edges"),
    VARIES: ("Textures of more than its color {of} are left out", "has textures of its gloss"),
}
"""What is left out, and why `auto` follows rays: the first that there is"""
SCENERY = "The transparency {of} is left out in mirrors"


class PathNeeds:
    """What a scene needs of paths, wherever its objects are: looked up when it is made of something else, not in each
    view."""

    def __init__(self, scene: SceneArrays, mirrors: Iterable[int]) -> None:
        """`mirrors`: indices of their instances."""
        self._scene, self._mirrors = scene, tuple(mirrors)
        self._left_out: dict[str, tuple[str, ...]] = {}
        self.features = path_features(scene)
        self.reasons = reasons_for_rays(scene, self._mirrors)
        """See `reasons_for_rays`"""

    def left_out_by(self, method: Method) -> tuple[str, ...]:
        """See the function."""
        if method.label not in self._left_out:
            self._left_out[method.label] = left_out_by(method, self._scene, self._mirrors)
        return self._left_out[method.label]


def left_out_by(method: Method, scene: SceneArrays, mirrors: Iterable[int]) -> tuple[str, ...]:
    """What a method does not show of the mirrors, instances with these indices, and in them; one sentence each."""
    if method.follows_rays or method.chooses:
        return ()
    named: dict[str, list[str]] = {kind: [] for kind in KINDS}
    for mirror in mirrors:
        for kind in kinds_of(scene, scene.instances[mirror]):
            named[kind].append(scene.instances[mirror].object_name)
    if not method.solves_vertices:
        # (Environments are looked up by the bent normals.)
        del named[BUMPS]
    found: list[Remark] = []
    for kind, names in named.items():
        others = "Automatic, Exact or an environment method" if kind == BUMPS else "Automatic or Exact"
        cause = f"{KINDS[kind][0]}: choose {others} to see {'them' if kind == BUMPS else 'it'}."
        found += [Remark(cause, "mirror", name) for name in names]
    cause = f"{SCENERY}: choose Automatic or Exact to see what is behind."
    return sentences(found + [Remark(cause, "object", name) for name in _seen_through(scene)])


def reasons_for_rays(scene: SceneArrays, mirrors: Iterable[int]) -> dict[str, str]:
    """By the name of a mirror that needs them: "has bumps"."""
    found = {}
    for mirror in mirrors:
        instance = scene.instances[mirror]
        if kind := next(kinds_of(scene, instance), None):
            found[instance.object_name] = KINDS[kind][1]
    return found


def kinds_of(scene: SceneArrays, mirror: InstanceArrays) -> Iterator[str]:
    """Keys of `KINDS`, in their order."""
    found = {BUMPS} if any(scene.materials[index].varies("normal") for index in mirror.materials) else set[str]()
    of = {index: features_of(scene.materials[index], True) for index in mirror.materials}
    for index in in_use(scene, mirror, {index for index, features in of.items() if features}):
        found |= of[index]
    yield from (kind for kind in KINDS if kind in found)


def lets_light_on(scene: SceneArrays, instance: InstanceArrays) -> bool:
    """Whether an instance is seen through, at least in part."""
    through = {index for index in instance.materials if scene.materials[index].is_seen_through}
    return bool(in_use(scene, instance, through))


def _seen_through(scene: SceneArrays) -> Iterator[str]:
    """Names of what mirrors would show so."""
    if not any(material.is_seen_through for material in scene.materials):
        return
    for instance in scene.instances:
        if instance.visible_glossy and instance.object_id not in scene.reflectors and lets_light_on(scene, instance):
            yield instance.object_name
