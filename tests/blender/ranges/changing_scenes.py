# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The small scene with what changes from frame to frame, a kind each; three frames tell."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np

FRAMES = range(1, 4)

type Change = Callable[[Path], None]
"""Of the open small scene; files that it needs go into the folder"""


def key(owner: Any, path: str, values: tuple[Any, ...]) -> None:
    """A value for each frame, without any in between."""
    for frame, value in zip(FRAMES, values, strict=True):
        target, name = (
            (owner.path_resolve(path.rpartition(".")[0]), path.rpartition(".")[2]) if "." in path else (owner, path)
        )
        setattr(target, name, value)
        target.keyframe_insert(name, frame=frame)
    block = owner.id_data if not hasattr(owner, "animation_data") else owner
    for layer in block.animation_data.action.layers:
        for bag in layer.strips[0].channelbags:
            for curve in bag.fcurves:
                for point in curve.keyframe_points:
                    point.interpolation = "CONSTANT"


def mirror_ball() -> Any:
    return bpy.data.objects["Mirror Ball"]


def block() -> Any:
    return bpy.data.objects["Block"]


def cuts(_folder: Path) -> None:
    scene: Any = bpy.context.scene
    eye = scene.camera
    for frame, place in zip(FRAMES, ((0.0, -6.0, 0.0), (3.0, -5.0, 2.0), (-4.0, -5.0, 0.0)), strict=True):
        camera = eye if frame == 1 else bpy.data.objects.new(f"Eye {frame}", eye.data)
        if frame > 1:
            scene.collection.objects.link(camera)
            camera.location = place
            camera.rotation_euler = (-camera.location).to_track_quat("-Z", "Y").to_euler()
        scene.timeline_markers.new(camera.name, frame=frame).camera = camera
    scene.camera = eye


def built(_folder: Path) -> None:
    """Faces come one by one, of what is seen and of what is mirrored, and the mirror loses some of its own."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=0.6, location=(-2.0, -1.0, 0.0))
    build = bpy.context.object.modifiers.new("build", "BUILD")
    build.frame_start, build.frame_duration = 1.0, 4.0
    thin = mirror_ball().modifiers.new("thin", "DECIMATE")
    thin.ratio = 1.0
    for frame, ratio in zip(FRAMES, (1.0, 0.5, 0.8), strict=True):
        thin.ratio = ratio
        mirror_ball().keyframe_insert('modifiers["thin"].ratio', frame=frame)


def nodes(_folder: Path) -> None:
    """Geometry nodes make as many points a side as the frame has of its number, and one instance for each."""
    tree: Any = bpy.data.node_groups.new("more", "GeometryNodeTree")
    tree.is_modifier = True
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    time, grid, cube, join, each = (
        tree.nodes.new(kind)
        for kind in (
            "GeometryNodeInputSceneTime",
            "GeometryNodeMeshGrid",
            "GeometryNodeMeshCube",
            "GeometryNodeJoinGeometry",
            "GeometryNodeInstanceOnPoints",
        )
    )
    end = tree.nodes.new("NodeGroupOutput")
    more: Any = tree.nodes.new("ShaderNodeMath")
    more.inputs[1].default_value = 1.0
    tree.links.new(time.outputs["Frame"], more.inputs[0])
    for name in ("Vertices X", "Vertices Y"):
        tree.links.new(more.outputs[0], grid.inputs[name])
    cube.inputs["Size"].default_value = (0.3, 0.3, 0.3)
    tree.links.new(grid.outputs["Mesh"], each.inputs["Points"])
    tree.links.new(cube.outputs["Mesh"], each.inputs["Instance"])
    tree.links.new(each.outputs[0], join.inputs[0])
    tree.links.new(grid.outputs["Mesh"], join.inputs[0])
    tree.links.new(join.outputs[0], end.inputs[0])
    block().modifiers.new("more", "NODES").node_group = tree


def sequence(folder: Path) -> None:
    """A cache of meshes, of an object that is another one in each frame."""
    scene: Any = bpy.context.scene
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=0.6, location=(-2.0, -1.0, 0.0))
    build = bpy.context.object.modifiers.new("build", "BUILD")
    build.frame_start, build.frame_duration = 0.0, 4.0
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    for obj in scene.objects:
        obj.select_set(obj == bpy.context.object)
    path = folder / "meshes.abc"
    bpy.ops.wm.alembic_export(filepath=str(path), selected=True, start=1, end=3, as_background_job=False)
    bpy.ops.object.delete()
    bpy.ops.wm.alembic_import(filepath=str(path), as_background_job=False)


def cloth(_folder: Path) -> None:
    scene: Any = bpy.context.scene
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4, size=2.0, location=(-2.0, -2.0, 1.0))
    bpy.context.object.modifiers.new("cloth", "CLOTH").settings.quality = 2
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    bpy.context.object.modifiers["cloth"].point_cache.frame_end = FRAMES[-1]
    bpy.ops.ptcache.bake_all(bake=True)


def rigid(_folder: Path) -> None:
    scene: Any = bpy.context.scene
    scene.render.fps = 6
    bpy.context.view_layer.objects.active = block()
    bpy.ops.rigidbody.object_add()
    scene.rigidbody_world.point_cache.frame_end = FRAMES[-1]
    bpy.ops.ptcache.bake_all(bake=True)


def particles(_folder: Path) -> None:
    bpy.ops.mesh.primitive_plane_add(size=2.0, location=(0.0, -2.0, 2.0))
    emitter: Any = bpy.context.object
    bpy.ops.mesh.primitive_cube_add(size=0.4, location=(0.0, 30.0, 0.0))
    grain = bpy.context.object
    emitter.modifiers.new("dust", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 12, 1.0, 3.0, 10.0
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", grain, 1.0
    emitter.particle_systems[0].point_cache.frame_end = FRAMES[-1]
    bpy.ops.ptcache.bake_all(bake=True)


def picture(path: Path, color: tuple[float, float, float]) -> None:
    image: Any = bpy.data.images.new("picture", 4, 4)
    image.pixels.foreach_set(np.tile(np.array([*color, 1.0], np.float32), 16))
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)


COLORS = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def shining_picture(obj: Any) -> Any:
    """An image's node, whose color an object shines with."""
    material = bpy.data.materials.new("picture")
    tree: Any = material.node_tree
    tree.nodes.clear()
    output, shine, node = (
        tree.nodes.new(kind) for kind in ("ShaderNodeOutputMaterial", "ShaderNodeEmission", "ShaderNodeTexImage")
    )
    tree.links.new(node.outputs["Color"], shine.inputs["Color"])
    tree.links.new(shine.outputs[0], output.inputs["Surface"])
    obj.data.materials.clear()
    obj.data.materials.append(material)
    return node


def images(folder: Path) -> None:
    for frame, color in zip(FRAMES, COLORS, strict=True):
        picture(folder / f"picture_{frame:04d}.png", color)
    node = shining_picture(block())
    node.image = bpy.data.images.load(str(folder / "picture_0001.png"))
    node.image.source = "SEQUENCE"
    node.image_user.frame_duration, node.image_user.frame_start = 3, 1
    node.image_user.use_auto_refresh = True


def visibility(_folder: Path) -> None:
    key(block(), "hide_render", (False, True, False))
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(-2.0, -1.0, 0.0))
    key(bpy.context.object, "hide_render", (True, False, False))
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.5, location=(0.0, -1.0, 1.5))
    second: Any = bpy.context.object
    second.name = "Second"
    second.data.materials.append(mirror_ball().data.materials[0])
    key(second, "hide_render", (True, False, True))
    key(mirror_ball(), "hide_render", (False, True, False))
    # (What comes and goes does so while the shutter is open.)
    scene: Any = bpy.context.scene
    scene.render.use_motion_blur = True
    scene.render.motion_blur_shutter = 0.8
    scene.camera.location.x = -0.2
    scene.camera.keyframe_insert("location", frame=1)
    scene.camera.location.x = 0.2
    scene.camera.keyframe_insert("location", frame=3)


def materials(_folder: Path) -> None:
    chrome = mirror_ball().data.materials[0].node_tree.nodes["Principled BSDF"]
    base = chrome.inputs["Base Color"]
    key(base, "default_value", ((1.0, 1.0, 1.0, 1.0), (1.0, 0.5, 0.5, 1.0), (0.5, 0.5, 1.0, 1.0)))
    key(chrome.inputs["Roughness"], "default_value", (0.0, 0.0, 0.3))
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(-2.0, -1.0, 0.0))
    paint = bpy.data.materials.new("paint")
    bpy.context.object.data.materials.append(paint)
    shader: Any = paint.node_tree.nodes["Principled BSDF"]
    key(shader.inputs["Emission Strength"], "default_value", (0.0, 1.0, 2.0))
    world: Any = bpy.context.scene.world
    key(world.node_tree.nodes["Background"].inputs["Strength"], "default_value", (1.0, 0.5, 1.5))


def flight(_folder: Path) -> None:
    """To the mirror, whose method splits edges as finely as it has to from there; far from the world's origin."""
    scene: Any = bpy.context.scene
    scene.curvrefl.method = "secant_star"
    bpy.ops.mesh.primitive_cube_add(size=3.0, location=(0.5, -9.0, 0.0))
    for obj in scene.objects:
        obj.location.x += 4096.0
    key(scene.camera, "location", ((4096.0, -6.0, 0.0), (4096.5, -3.0, 0.0), (4096.0, -1.6, 0.0)))


SCENES: dict[str, tuple[Change, ...]] = {
    "cuts, materials, images": (cuts, materials, images),
    "built, nodes, particles": (built, nodes, particles),
    "caches": (sequence, cloth, rigid),
    "visibility in motion": (visibility,),
    "flight": (flight,),
}
