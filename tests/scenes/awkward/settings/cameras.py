# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras: lenses, shutters, sensors, projections, places."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from mathutils import Matrix

from ..registry import MIRROR, awkward
from ..stage import add_ball, bpy, find, matte, mirror, stage


def _camera(**properties: Any) -> Any:
    stage()
    camera: Any = bpy.context.scene.camera.data
    for name, value in properties.items():
        setattr(camera, name, value)
    return camera


@awkward("depth of field on the mirror", words=("depth of field",))
def dof_on_mirror(folder: Path) -> None:
    camera = _camera()
    camera.dof.use_dof, camera.dof.focus_distance, camera.dof.aperture_fstop = True, 4.2, 0.03


@awkward("depth of field on what stands before the mirror", words=("depth of field",))
def dof_near(folder: Path) -> None:
    camera = _camera()
    camera.dof.use_dof, camera.dof.focus_object, camera.dof.aperture_fstop = True, find("Green"), 0.03


@awkward("depth of field with blades and an anamorphic lens", words=("depth of field",))
def dof_blades(folder: Path) -> None:
    camera = _camera()
    camera.dof.use_dof, camera.dof.focus_distance, camera.dof.aperture_fstop = True, 3.0, 0.03
    camera.dof.aperture_blades, camera.dof.aperture_ratio = 3, 2.0


@awkward("depth of field of an orthographic camera", words=("depth of field",))
def dof_orthographic(folder: Path) -> None:
    camera = _camera(type="ORTHO", ortho_scale=5.0)
    camera.dof.use_dof, camera.dof.focus_distance, camera.dof.aperture_fstop = True, 2.5, 0.4


@awkward("a thing that moves while the shutter is open", words=("motion blur",))
def motion_blur_thing(folder: Path) -> None:
    scene = stage()
    for frame, x in ((0, 0.6), (2, 3.2)):
        find("Red").location.x = x
        find("Red").keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0


@awkward("a camera that moves while the shutter is open", words=("motion blur",))
def motion_blur_camera(folder: Path) -> None:
    scene = stage()
    for frame, x in ((0, -0.6), (2, 0.6)):
        scene.camera.location.x = x
        scene.camera.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0


@awkward("a mirror that turns while the shutter is open", words=("motion blur",))
def motion_blur_mirror(folder: Path) -> None:
    scene = stage()
    find(MIRROR).scale = (1.2, 0.5, 1.0)
    for frame, turn in ((0, -0.6), (2, 0.6)):
        find(MIRROR).rotation_euler.z = turn
        find(MIRROR).keyframe_insert("rotation_euler", frame=frame)
    scene.frame_set(1)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0


@awkward("a mesh that changes shape while the shutter is open", words=("motion blur",))
def motion_blur_deform(folder: Path) -> None:
    scene = stage()
    thing = find("Blue")
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="Long")
    for point in key.data:
        point.co.z *= 4.0
    for frame, value in ((0, 0.0), (2, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    scene.frame_set(1)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0


@awkward("motion blur on, and nothing moves")
def motion_blur_still(folder: Path) -> None:
    stage().render.use_motion_blur = True


@awkward("a panoramic camera", words=("panoramic",))
def panorama_equirectangular(folder: Path) -> None:
    _camera(type="PANO", panorama_type="EQUIRECTANGULAR")


@awkward("a fisheye", words=("panoramic",))
def panorama_fisheye(folder: Path) -> None:
    _camera(type="PANO", panorama_type="FISHEYE_EQUISOLID")


@awkward("orthographic from above")
def orthographic_above(folder: Path) -> None:
    _camera(type="ORTHO", ortho_scale=5.0)
    bpy.context.scene.camera.matrix_world = Matrix.Translation((0.0, 0.0, 8.0))


@awkward("orthographic from the front, the camera within the mirror's reach")
def orthographic_front(folder: Path) -> None:
    _camera(type="ORTHO", ortho_scale=4.5)


@awkward("orthographic, the near clip distance behind the camera", words=("clip",))
def orthographic_near(folder: Path) -> None:
    _camera(type="ORTHO", ortho_scale=4.5)
    bpy.context.scene.camera.location = (0.0, -0.8, 1.0)
    bpy.context.scene.camera.rotation_euler = (np.pi / 2.0, 0.0, 0.0)


@awkward("a shifted lens")
def shift(folder: Path) -> None:
    _camera(shift_x=0.25, shift_y=-0.2)


@awkward("a sensor fitted to its height")
def sensor_vertical(folder: Path) -> None:
    _camera(sensor_fit="VERTICAL", sensor_height=40.0)


@awkward("an upright picture with the sensor fitted by itself")
def sensor_upright(folder: Path) -> None:
    _camera()
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y = 90, 160


@awkward("a focal length of one millimeter")
def lens_tiny(folder: Path) -> None:
    _camera(lens=1.0)
    bpy.context.scene.camera.location = (0.0, -2.2, 1.0)


@awkward("a focal length of five meters, from far away")
def lens_huge(folder: Path) -> None:
    _camera(lens=5000.0, clip_end=2000.0)
    direction = np.array([0.0, -0.95, 0.22])
    scene = bpy.context.scene
    scene.camera.location = 500.0 * direction + [0.0, 0.0, 0.8]
    from mathutils import Vector

    scene.camera.rotation_euler = Vector((-direction).tolist()).to_track_quat("-Z", "Y").to_euler()


@awkward("clip distances from a micrometer to ten thousand kilometers")
def clip_wide(folder: Path) -> None:
    _camera(clip_start=1e-6, clip_end=1e7)


@awkward("a near clip distance that cuts into the mirror")
def clip_into_mirror(folder: Path) -> None:
    _camera(clip_start=4.6)


@awkward("a far clip distance before the mirror")
def clip_before_mirror(folder: Path) -> None:
    _camera(clip_end=4.0)


@awkward("a far clip distance that cuts what mirrors show, and does not in Cycles")
def clip_behind_mirror(folder: Path) -> None:
    _camera(clip_end=6.0)
    add_ball("Far", (0.0, -14.0, 4.0), 3.0, matte("Far", (0.8, 0.5, 0.1)))


@awkward("a camera inside the closed mirror")
def camera_in_mirror(folder: Path) -> None:
    _camera(clip_start=0.001)
    bpy.context.scene.camera.location = (0.2, -0.3, 1.1)


@awkward("a camera inside the mirror, which has a lamp in it")
def camera_in_lit_mirror(folder: Path) -> None:
    _camera(clip_start=0.001)
    bpy.context.scene.camera.location = (0.2, -0.5, 1.1)
    add_ball("Seed", (-0.1, 0.3, 1.0), 0.15, matte("Seed", (0.8, 0.4, 0.1)))
    lamp = bpy.data.lights.new("Inside", "POINT")
    lamp.energy, lamp.shadow_soft_size = 5.0, 0.02
    thing = bpy.data.objects.new("Inside", lamp)
    thing.location = (0.4, 0.1, 1.3)
    bpy.context.scene.collection.objects.link(thing)


@awkward("a camera on the mirror's surface")
def camera_on_mirror(folder: Path) -> None:
    _camera(clip_start=0.001)
    bpy.context.scene.camera.location = (0.0, -1.0, 1.0)


@awkward("a camera just before the mirror")
def camera_near_mirror(folder: Path) -> None:
    _camera(clip_start=0.0001)
    bpy.context.scene.camera.location = (0.0, -1.02, 1.05)
    bpy.context.scene.camera.rotation_euler = (np.pi / 2.0, 0.0, 0.2)


@awkward("a camera with a scale, mirrored and uneven")
def camera_scaled(folder: Path) -> None:
    _camera()
    bpy.context.scene.camera.scale = (-2.0, 1.0, 0.3)


@awkward("a camera whose parent is sheared")
def camera_sheared(folder: Path) -> None:
    _camera()
    scene = bpy.context.scene
    parent = bpy.data.objects.new("Parent", None)
    parent.scale = (1.0, 2.0, 1.0)
    scene.collection.objects.link(parent)
    scene.camera.parent = parent


@awkward("a marker that changes the camera at this frame")
def marker_camera(folder: Path) -> None:
    scene = stage()
    camera = bpy.data.objects.new("Second", bpy.data.cameras.new("Second"))
    camera.location = (3.5, -3.5, 3.0)
    from mathutils import Vector

    camera.rotation_euler = (Vector((0.0, 0.0, 0.8)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.timeline_markers.new("Cut", frame=1).camera = camera
    scene.frame_set(1)


@awkward("a lamp as the camera", words=("not a camera",))
def camera_is_lamp(folder: Path) -> None:
    bpy.context.scene.camera = None
    scene = stage()
    scene.camera = find("Sun")


@awkward("two views for stereo", words=("stereo", "view"))
def stereo(folder: Path) -> None:
    render = stage().render
    render.use_multiview, render.image_settings.views_format = True, "STEREO_3D"


@awkward("rolling shutter", words=("motion blur", "shutter"))
def rolling_shutter(folder: Path) -> None:
    motion_blur_thing(folder)
    bpy.context.scene.cycles.rolling_shutter_type = "TOP"


@awkward("two mirrors that face each other across the camera")
def between_two_mirrors(folder: Path) -> None:
    _camera()
    add_ball("Second", (1.2, -6.5, 1.4), 1.2, mirror("Chrome 2", (0.9, 0.7, 0.5)))


@awkward("a sensor wider than the lens sees: perspective to the limit of its angle")
def angle_wide(folder: Path) -> None:
    _camera(sensor_width=100.0, lens=8.0)
