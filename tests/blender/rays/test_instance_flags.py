# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What rays know of an instance: who sees it, and how what light leaves again sees itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer.geometry.mesh_facts import MeshFactsCache
from curvrefl.curvrefl_addon.renderer.geometry.vertex_uploads import VertexUploads
from curvrefl.curvrefl_addon.renderer.rays.ray_records import InstanceFlag
from curvrefl.curvrefl_addon.renderer.rays.ray_scene import INSTANCE_RECORDS, RayScene
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, SceneArrays
from scenes.mirror_room import Room

pytestmark = pytest.mark.usefixtures("gpu")
ALL = (
    InstanceFlag.SEEN_BY_CAMERA
    | InstanceFlag.SEEN_IN_MIRRORS
    | InstanceFlag.SEEN_THROUGH_GLASS
    | InstanceFlag.CASTS_SHADOWS
    | InstanceFlag.SEEN_BY_DIFFUSE
)
ITSELF = InstanceFlag.NEVER_SEES_ITSELF | InstanceFlag.IS_CLOSED


def a_mirror_and_a_ball() -> SceneArrays:
    room = Room()
    room.add_mirror(Ellipsoid(), 32)
    room.add_ball((0.0, -2.0, 0.0), 0.5)
    return room.arrays()


def with_ball(scene: SceneArrays, **changes: bool) -> SceneArrays:
    ball: InstanceArrays = replace(scene.instances[1], **changes)
    return replace(scene, instances=(scene.instances[0], ball))


def flags_of_ball(rays: RayScene) -> tuple[InstanceFlag, float]:
    """On the GPU, with the length that counts as none."""
    record = rays._top_places[1] + INSTANCE_RECORDS + 3
    _, _, flags, own = np.asarray(rays.regions.texture.read(), np.float32).reshape(-1, 4)[record]
    return InstanceFlag(int(flags)), own


@pytest.mark.parametrize(
    ("changes", "lost", "gained"),
    [
        ({"visible_camera": False}, InstanceFlag.SEEN_BY_CAMERA, InstanceFlag(0)),
        ({"visible_glossy": False}, InstanceFlag.SEEN_IN_MIRRORS, InstanceFlag(0)),
        ({"visible_shadow": False}, InstanceFlag.CASTS_SHADOWS, InstanceFlag(0)),
        ({"visible_transmission": False}, InstanceFlag.SEEN_THROUGH_GLASS, InstanceFlag(0)),
        ({"holdout": True}, InstanceFlag(0), InstanceFlag.HOLDS_OUT),
    ],
    ids=str,
)
def test_who_sees_an_instance_follows_its_switches(
    changes: dict[str, bool], lost: InstanceFlag, gained: InstanceFlag
) -> None:
    scene = a_mirror_and_a_ball()
    rays = RayScene(MeshFactsCache(), VertexUploads())
    rays.follow(scene, {0: 1})
    assert flags_of_ball(rays)[0] == ALL
    rays.follow(with_ball(scene, **changes), {0: 1})
    assert flags_of_ball(rays)[0] == ALL & ~lost | gained


def test_what_becomes_glass_knows_how_it_sees_itself() -> None:
    scene = a_mirror_and_a_ball()
    rays = RayScene(MeshFactsCache(), VertexUploads())
    rays.follow(scene, {0: 1})
    assert flags_of_ball(rays)[0] == ALL
    gray, chrome = scene.materials
    rays.follow(replace(scene, materials=(replace(gray, transmission=1.0), chrome)), {0: 1})
    flags, own = flags_of_ball(rays)
    # (of the diagonal of the box around it)
    assert flags == ALL | ITSELF and own == pytest.approx(1e-4 * np.sqrt(3.0), rel=1e-3)
    rays.follow(scene, {0: 1})
    assert flags_of_ball(rays)[0] == ALL
