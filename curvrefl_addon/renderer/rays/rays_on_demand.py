# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as rays need it, made when it is first asked for."""

from __future__ import annotations

from collections.abc import Mapping

from ...scene.arrays import SceneArrays
from ..geometry.mesh_facts import MeshFactsCache
from ..geometry.vertex_uploads import VertexUploads
from .ray_scene import RayScene


class RaysOnDemand:
    """Of one renderer; until the rays are asked for all this costs nothing."""

    def __init__(self, facts: MeshFactsCache, uploads: VertexUploads) -> None:
        self._facts, self._uploads = facts, uploads
        self._scene: RayScene | None = None
        self._is_whole = False

    def of(self, scene: SceneArrays, numbers: Mapping[int, int]) -> RayScene:
        """Of this state; `numbers`: as for `RayScene.follow`. Raises as that; OutOfTime where the next call goes on."""
        if self._scene is None:
            self._scene = RayScene(self._facts, self._uploads)
        if not self._is_whole:
            self._scene.follow(scene, numbers)
            self._is_whole = True
        return self._scene

    def follow(self, scene: SceneArrays, numbers: Mapping[int, int]) -> None:
        """Know another state."""
        if self._scene is not None:
            self._scene.follow(scene, numbers)
            self._is_whole = True

    def free(self) -> None:
        """Let go of them."""
        self._scene, self._is_whole = None, False

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each."""
        return () if self._scene is None else self._scene.warnings

    @property
    def counters(self) -> dict[str, int]:
        """How often hierarchies were made, since the start."""
        return {} if self._scene is None else self._scene.counters

    @property
    def build_ms(self) -> float:
        """Of the last time that meshes came."""
        return 0.0 if self._scene is None else self._scene.build_ms

    @property
    def can_improve(self) -> bool:
        """Whether `improve` would do anything."""
        return self._scene is not None and self._is_whole and self._scene.can_improve

    def improve(self) -> None:
        """Do a little work that makes later pictures faster, and no different."""
        if self._scene is not None and self._is_whole:
            self._scene.improve()

    def finish(self) -> None:
        """Do all of that at once."""
        if self._scene is not None:
            self._scene.finish()
