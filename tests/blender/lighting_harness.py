# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes lit by both Cycles and `Lighting`: the same points, normals and materials go through both."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.renderer.device.batches import full_screen_triangle
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer
from curvrefl.curvrefl_addon.renderer.device.shaders import FULL_SCREEN, Piece, build_shader, named
from curvrefl.curvrefl_addon.renderer.device.state import drawing_state, set_viewport
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture, read_texture, texture_2d
from curvrefl.curvrefl_addon.renderer.geometry.scene_geometry import SceneGeometry
from curvrefl.curvrefl_addon.renderer.lighting.lighting import Lighting, lighting_piece
from curvrefl.curvrefl_addon.scene.arrays import (
    InstanceArrays,
    LightArrays,
    MaterialArrays,
    MeshArrays,
    SceneArrays,
    WorldArrays,
)
from curvrefl.gpu_shaders.loader import Snippet
from mathutils import Matrix, Vector


@dataclass
class Body:
    """A mesh with one material."""

    positions: np.ndarray
    triangles: np.ndarray
    material: MaterialArrays = field(
        default_factory=lambda: MaterialArrays("grey", (0.5, 0.5, 0.5), specular_level=0.0)
    )
    smooth_center: tuple[float, float, float] | None = None
    """Shading normals point away from here; None: flat"""
    visible_shadow: bool = True


@dataclass
class Stage:
    """What both renderers are given."""

    bodies: list[Body]
    lights: list[LightArrays] = field(default_factory=list)
    world: WorldArrays = field(default_factory=WorldArrays)
    eye: tuple[float, float, float] = (0.0, 0.0, 6.0)
    target: tuple[float, float, float] = (0.0, 0.0, 0.0)
    width: float = 2.0
    """Orthographic width of the picture, metres"""
    pixels: int = 48


def plane(size: float = 4.0, z: float = 0.0, **more: Any) -> Body:
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32) * (size / 2)
    corners[:, 2] = z
    return Body(corners, np.array([[0, 1, 2], [0, 2, 3]], np.int32), **more)


def box(low: tuple[float, float, float], high: tuple[float, float, float], **more: Any) -> Body:
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], np.float32)
    corners = np.asarray(low, np.float32) + corners * (np.asarray(high, np.float32) - np.asarray(low, np.float32))
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return Body(corners, np.array(triangles, np.int32), **more)


def ball(center: tuple[float, float, float], radius: float, rings: int = 48, smooth: bool = True, **more: Any) -> Body:
    theta = np.linspace(0, np.pi, rings + 1)
    phi = np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False)
    t, p = np.meshgrid(theta, phi, indexing="ij")
    points = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=-1).reshape(-1, 3)
    index = np.arange(points.shape[0]).reshape(rings + 1, 2 * rings)
    a, b = index[:-1], np.roll(index[:-1], -1, axis=1)
    c, d = np.roll(index[1:], -1, axis=1), index[1:]
    upper = np.stack([a, d, c], axis=-1).reshape(-1, 3)
    lower = np.stack([a, c, b], axis=-1).reshape(-1, 3)
    triangles = np.concatenate([upper[2 * rings :], lower[: -2 * rings]])
    positions = (np.asarray(center) + radius * points).astype(np.float32)
    return Body(positions, triangles.astype(np.int32), smooth_center=center if smooth else None, **more)


def scene_arrays(stage: Stage) -> SceneArrays:
    meshes, instances, materials = [], [], []
    for index, body in enumerate(stage.bodies):
        positions = body.positions[body.triangles].reshape(-1, 3)
        if body.smooth_center is None:
            a, b, c = (body.positions[body.triangles[:, k]] for k in range(3))
            normals = np.repeat(np.cross(b - a, c - a), 3, axis=0)
        else:
            normals = positions - np.asarray(body.smooth_center, np.float32)
        normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
        count = len(positions)
        meshes.append(
            MeshArrays(
                f"mesh{index}",
                positions,
                np.arange(count, dtype=np.int32),
                normals.astype(np.float32),
                None,
                None,
                np.arange(count, dtype=np.int32).reshape(-1, 3),
                np.zeros(count // 3, np.int32),
            )
        )
        materials.append(body.material)
        instances.append(
            InstanceArrays(f"body{index}", index + 1, index, np.eye(4), (index,), visible_shadow=body.visible_shadow)
        )
    return SceneArrays(tuple(meshes), tuple(instances), tuple(materials), (), tuple(stage.lights), stage.world)


def lamp(
    kind: str,
    color: tuple[float, float, float],
    place: tuple[float, float, float] = (0.0, 0.0, 3.0),
    towards: tuple[float, float, float] = (0.0, 0.0, 0.0),
    **more: Any,
) -> LightArrays:
    back = (Vector(place) - Vector(towards)).normalized()
    rotation = back.to_track_quat("Z", "Y").to_matrix().to_4x4()
    matrix = np.array(Matrix.Translation(place) @ rotation, np.float64)
    return LightArrays(kind.lower(), kind, color, matrix, **more)


def camera_matrix(stage: Stage) -> np.ndarray:
    back = (Vector(stage.eye) - Vector(stage.target)).normalized()
    rotation = back.to_track_quat("Z", "Y").to_matrix().to_4x4()
    return np.array(Matrix.Translation(stage.eye) @ rotation, np.float64)


def build_blender(stage: Stage) -> None:
    """Make the current Blender file show the stage."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    for body in stage.bodies:
        mesh = bpy.data.meshes.new("body")
        mesh.from_pydata(body.positions.tolist(), [], body.triangles.tolist())
        if body.smooth_center is not None:
            mesh.shade_smooth()
            normals = body.positions - np.asarray(body.smooth_center, np.float32)
            mesh.normals_split_custom_set_from_vertices((normals / np.linalg.norm(normals, axis=1)[:, None]).tolist())
        mesh.materials.append(_blender_material(body.material))
        placed = bpy.data.objects.new("body", mesh)
        placed.visible_shadow = body.visible_shadow
        scene.collection.objects.link(placed)
    for light in stage.lights:
        _add_blender_light(light)
    _set_blender_world(stage.world)
    camera = bpy.data.cameras.new("camera")
    camera.type = "ORTHO"
    camera.ortho_scale = stage.width
    camera.clip_end = 1000.0
    placed = bpy.data.objects.new("camera", camera)
    placed.matrix_world = Matrix(camera_matrix(stage).tolist())
    scene.collection.objects.link(placed)
    scene.camera = placed
    scene.render.resolution_x = scene.render.resolution_y = stage.pixels
    scene.render.resolution_percentage = 100


def cycles_picture(stage: Stage, samples: int = 256, world_light_samples: bool = True) -> np.ndarray:
    """(pixels, pixels, 3) scene-linear, row 0 at the bottom: light at the pixel centres, no indirect diffuse light."""
    build_blender(stage)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.pixel_filter_type = "BLACKMAN_HARRIS"
    cycles.filter_width = 0.01
    cycles.max_bounces = 4
    cycles.diffuse_bounces = 0
    cycles.glossy_bounces = 1
    cycles.transmission_bounces = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = 0.0
    cycles.use_light_tree = False
    scene.view_settings.view_transform = "Raw"
    settings = scene.render.image_settings
    settings.file_format = "OPEN_EXR"
    settings.color_depth = "32"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "cycles.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        pixels = np.empty(stage.pixels * stage.pixels * 4, np.float32)
        image.pixels.foreach_get(pixels)
    return pixels.reshape(stage.pixels, stage.pixels, 4)[..., :3]


def surface_buffers(stage: Stage) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Position, normal, direction to the viewer (pixels, pixels, 3) and body index (-1 background) at pixel centres."""
    build_blender(stage)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    matrix = camera_matrix(stage)
    forward = Vector(-matrix[:3, 2])
    bodies = [placed for placed in bpy.context.scene.objects if placed.type == "MESH"]
    size = stage.pixels
    positions, normals = np.zeros((size, size, 3)), np.zeros((size, size, 3))
    number = np.full((size, size), -1)
    for row in range(size):
        for column in range(size):
            u, v = ((np.array([column, row]) + 0.5) / size - 0.5) * stage.width
            origin = Vector(matrix[:3, 3] + u * matrix[:3, 0] + v * matrix[:3, 1])
            hit, place, normal, _, placed, _ = bpy.context.scene.ray_cast(depsgraph, origin, forward)
            if not hit:
                continue
            index = [body.name for body in bodies].index(placed.name)
            center = stage.bodies[index].smooth_center
            positions[row, column] = place
            normals[row, column] = normal if center is None else (place - Vector(center)).normalized()
            number[row, column] = index
    viewers = np.broadcast_to(matrix[:3, 2], positions.shape)
    return positions, normals, viewers, number


def our_picture(stage: Stage, sub_frames: int = 16, function: str = "shade_surface") -> tuple[np.ndarray, np.ndarray]:
    """The same as `cycles_picture` by `Lighting`, and the body indices."""
    require_gpu()
    positions, normals, viewers, number = surface_buffers(stage)
    scene = scene_arrays(stage)
    geometry = SceneGeometry()
    geometry.update(scene, {})
    lighting = Lighting(scene, geometry, sub_frames)
    harness = Harness(lighting, positions, normals, viewers, number, stage.bodies, function)
    total = np.zeros((stage.pixels, stage.pixels, 3))
    for sub_frame in range(sub_frames):
        total += harness.shade(sub_frame)
    picture = total / sub_frames
    lighting.free()
    return picture, number


class Harness:
    """A shade pass over given surface buffers."""

    def __init__(
        self,
        lighting: Lighting,
        positions: np.ndarray,
        normals: np.ndarray,
        viewers: np.ndarray,
        number: np.ndarray,
        bodies: list[Body],
        function: str = "shade_surface",
    ) -> None:
        self.lighting = lighting
        shape = positions.shape[:2]

        def texture(array: np.ndarray) -> Any:
            full = np.zeros((*shape, 4), np.float32)
            full[..., : array.shape[-1]] = array
            return texture_2d(full)

        materials = [body.material for body in bodies] or [MaterialArrays("none")]
        base = np.array([m.base_color for m in materials])[number]
        gloss = np.array([[m.metallic, m.roughness, m.ior, m.specular_level] for m in materials])[number]
        extra = np.array([[*m.emission, float(m.glossy_only)] for m in materials])[number]
        self.textures = {
            "position": texture(np.concatenate([positions, number[..., None] + 1.0], axis=-1)),
            "normal": texture(normals),
            "viewer": texture(viewers),
            "base": texture(base),
            "gloss": texture(gloss),
            "extra": texture(extra),
        }
        self.shader = build_shader(
            "lighting test",
            FULL_SCREEN,
            lighting_piece(),
            Piece(
                samplers=named("FLOAT_2D", *(f"buffer_{name}" for name in self.textures)),
                outputs={"color": "VEC4"},
                fragment=Snippet("lighting_harness", _MAIN.replace("FUNCTION", function)),
            ),
        )
        self.target = empty_texture(shape[1], shape[0])
        self.frame_buffer = frame_buffer(self.target)

    def draw(self, sub_frame: int) -> None:
        self.lighting.prepare(sub_frame)
        with drawing_state(), self.frame_buffer.bind():
            set_viewport(0, 0, self.target.width, self.target.height)
            self.shader.bind()
            for name, texture in self.textures.items():
                self.shader.uniform_sampler(f"buffer_{name}", texture)
            self.lighting.bind(self.shader)
            full_screen_triangle().draw(self.shader)

    def shade(self, sub_frame: int) -> np.ndarray:
        self.draw(sub_frame)
        return read_texture(self.target)[..., :3].astype(np.float64)


_MAIN = """
#include "lighting/lighting.glsl"

vec3 mirror_at(Surface s, vec3 to_viewer)
{
  float cosine = max(dot(s.normal, to_viewer), 0.0);
  return sharp_reflectance(s.base_color, s.metallic, s.ior, s.specular_level, s.glossy_only, cosine);
}

vec3 world_and_lamps_at(Surface s, vec3 to_viewer)
{
  vec3 direction = reflect(-to_viewer, s.normal);
  return mirror_at(s, to_viewer) * (world_radiance(direction) + lamps_seen(s.position, direction, 2e30).rgb);
}

vec3 lamps_nearer_than_2(Surface s, vec3 to_viewer)
{
  return lamps_seen(s.position, reflect(-to_viewer, s.normal), 2.0).rgb;
}

vec3 lamps_nearer_than_4(Surface s, vec3 to_viewer)
{
  return lamps_seen(s.position, reflect(-to_viewer, s.normal), 4.0).rgb;
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(buffer_position, pixel, 0);
  vec4 gloss = texelFetch(buffer_gloss, pixel, 0);
  vec4 extra = texelFetch(buffer_extra, pixel, 0);
  vec3 to_viewer = texelFetch(buffer_viewer, pixel, 0).xyz;
  Surface s;
  s.position = position.xyz;
  s.normal = texelFetch(buffer_normal, pixel, 0).xyz;
  s.base_color = texelFetch(buffer_base, pixel, 0).rgb;
  s.metallic = gloss.x;
  s.roughness = gloss.y;
  s.ior = gloss.z;
  s.specular_level = gloss.w;
  s.emission = extra.rgb;
  s.glossy_only = extra.w > 0.5;
  color = vec4(world_radiance(-to_viewer), 1.0);
  if (position.w > 0.5) {
    color.rgb = FUNCTION(s, to_viewer);
  }
}
"""


def _blender_material(material: MaterialArrays) -> Any:
    made = bpy.data.materials.new(material.name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    if material.glossy_only:
        node = tree.nodes.new("ShaderNodeBsdfAnisotropic")
        node.distribution = "MULTI_GGX"
        node.inputs["Color"].default_value = (*material.base_color, 1.0)
        node.inputs["Roughness"].default_value = material.roughness
    else:
        node = tree.nodes.new("ShaderNodeBsdfPrincipled")
        node.inputs["Base Color"].default_value = (*material.base_color, 1.0)
        node.inputs["Metallic"].default_value = material.metallic
        node.inputs["Roughness"].default_value = material.roughness
        node.inputs["IOR"].default_value = material.ior
        node.inputs["Specular IOR Level"].default_value = material.specular_level
        node.inputs["Emission Color"].default_value = (*material.emission, 1.0)
        node.inputs["Emission Strength"].default_value = 1.0
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return made


def _add_blender_light(light: LightArrays) -> None:
    data = bpy.data.lights.new(light.name, light.kind)
    data.energy = 1.0
    data.color = light.color
    strongest = max(light.color)
    data.color = tuple(channel / strongest for channel in light.color)
    data.energy = strongest
    data.use_shadow = light.casts_shadow
    if light.kind == "SUN":
        data.angle = light.angle
    elif light.kind == "AREA":
        data.shape = "ELLIPSE" if light.ellipse else "RECTANGLE"
        data.size, data.size_y = light.size
    else:
        data.shadow_soft_size = light.radius
        if light.kind == "SPOT":
            data.spot_size = light.spot_angle
            data.spot_blend = light.spot_blend
    placed = bpy.data.objects.new(light.name, data)
    placed.matrix_world = Matrix(light.matrix.tolist())
    placed.visible_glossy = light.visible_glossy
    bpy.context.scene.collection.objects.link(placed)


def _set_blender_world(world: WorldArrays) -> None:
    made = bpy.data.worlds.new("world")
    bpy.context.scene.world = made
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputWorld")
    background = tree.nodes.new("ShaderNodeBackground")
    background.inputs["Color"].default_value = (*world.color, 1.0)
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    if world.image is not None:
        height, width = world.image.shape[:2]
        image = bpy.data.images.new("sky", width, height, float_buffer=True)
        image.colorspace_settings.name = "Non-Color"
        pixels = np.ones((height, width, 4), np.float32)
        pixels[..., :3] = world.image
        image.pixels.foreach_set(pixels.ravel())
        node = tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = image
        tree.links.new(node.outputs["Color"], background.inputs["Color"])
