// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a surface does to a path that meets it: one decision, and what the path's throughput is multiplied by; as
// optics/scattering/scatter.py. The diffuse base takes no part: it is shaded with base_share.
// random.xy: which microfacet; random.z: which layer, then whether it reflects; random.w: whether anything is there.
#include "scattering/layers.glsl"

#define SCATTER_ENDS 0
#define SCATTER_REFLECTS 1
#define SCATTER_TRANSMITS 2
#define SCATTER_PASSES 3

struct Facing {
  vec3 normal;   // unit shading normal on the viewer's side
  vec3 tangent;  // unit
  bool is_back;  // seen from inside
};

struct Scatter {
  vec3 direction;
  vec3 weight;   // what the path's throughput is multiplied by
  float pdf;     // per solid angle; 0: sharp
  int kind;
};

// Chances of coat, of metal and dielectric, and of glass.
vec3 layer_chances(Layers layers)
{
  vec3 shares = vec3(0.0, mean_of(layers.specular_albedo), 0.0);
#ifdef PATHS_COAT
  shares.x = layers.coat_albedo;
#endif
#ifdef PATHS_GLASS
  shares.z = mean_of(layers.glass.reflected) + mean_of(layers.glass.transmitted);
#endif
  float sum = shares.x + shares.y + shares.z;
  return sum > 0.0 ? shares / sum : vec3(0.0);
}

mat3 frame_of(Material m, Facing f)
{
#ifdef PATHS_ANISOTROPY
  mat3 frame = surface_frame(f.normal, f.tangent);
  float turn = 2.0 * PI * m.anisotropic_rotation;
  vec3 x = frame[0] * cos(turn) + frame[1] * sin(turn);
  return mat3(x, cross(f.normal, x), f.normal);
#else
  return surface_frame(f.normal, f.normal);
#endif
}

// Values of all rough lobes to a direction, times its cosine. In the surface's frame; `bent`: the microfacet that
// refracts from one to the other, where the light is on the far side.
vec3 rough_lobes(Layers layers, vec3 chances, vec3 to_viewer, vec3 to_light, vec3 bent, out float pdf)
{
  vec3 sum = vec3(0.0);
  pdf = 0.0;
  if (to_light.z > 0.0) {
    vec3 h = normalize(to_viewer + to_light);
    float cosine = clamp(dot(to_viewer, h), 0.0, 1.0);
#ifdef PATHS_COAT
    if (chances.x > 0.0 && !is_sharp_alpha(layers.coat_alpha)) {
      vec2 alpha = vec2(layers.coat_alpha);
      pdf += chances.x * reflected_density(to_viewer, h, alpha, cap_bound(to_viewer, alpha));
      float fresnel = layers.coat * fresnel_dielectric(cosine, layers.coat_eta);
      sum += vec3(fresnel * reflected_value(to_viewer, to_light, h, alpha));
    }
#endif
    if (chances.y > 0.0 && !layers.is_sharp) {
      pdf += chances.y * reflected_density(to_viewer, h, layers.alpha, cap_bound(to_viewer, layers.alpha));
      sum += specular_fresnel(layers, cosine) * reflected_value(to_viewer, to_light, h, layers.alpha);
    }
#ifdef PATHS_GLASS
    if (chances.z > 0.0 && !layers.glass.is_sharp) {
      vec3 reflects, transmits;
      vec2 alpha = vec2(layers.glass.alpha);
      pane_shares(layers.glass, cosine, reflects, transmits);
      float bound = layers.glass.is_thin ? cap_bound(to_viewer, alpha) : 1.0;
      pdf += chances.z * reflected_chance(reflects, transmits) * reflected_density(to_viewer, h, alpha, bound);
      sum += reflects * reflected_value(to_viewer, to_light, h, alpha);
    }
#endif
  }
#ifdef PATHS_GLASS
  else if (to_light.z < 0.0 && chances.z > 0.0 && !layers.glass.is_far_sharp) {
    vec3 reflects, transmits;
    vec2 alpha = vec2(layers.glass.far_alpha);
    float density, value;
    vec3 h = bent;
    if (layers.glass.is_thin) {
      // The reflected lobe, turned through the wall.
      vec3 turned = vec3(to_light.xy, -to_light.z);
      h = normalize(to_viewer + turned);
      density = reflected_density(to_viewer, h, alpha, cap_bound(to_viewer, alpha));
      value = reflected_value(to_viewer, turned, h, alpha);
    }
    else {
      if (dot(h, to_viewer) <= 0.0 || dot(h, to_light) >= 0.0) {
        return sum;
      }
      density = refracted_density(to_viewer, to_light, h, alpha.x, layers.glass.eta);
      value = density * shadowing(to_viewer, to_light, alpha);
    }
    pane_shares(layers.glass, clamp(dot(to_viewer, h), 0.0, 1.0), reflects, transmits);
    pdf += chances.z * (1.0 - reflected_chance(reflects, transmits)) * density;
    sum += transmits * value;
  }
#endif
  return sum;
}

Scatter scatter(Material m, Facing f, vec3 to_viewer, vec4 random)
{
  Scatter s = Scatter(-to_viewer, vec3(0.0), 0.0, SCATTER_ENDS);
#ifdef PATHS_ALPHA
  if (random.w >= clamp(m.alpha, 0.0, 1.0)) {
    s.weight = m.transparent_tint;
    s.kind = SCATTER_PASSES;
    return s;
  }
#endif
  Layers layers = layers_of(m, f.is_back, dot(f.normal, to_viewer));
  vec3 chances = layer_chances(layers);
  mat3 frame = frame_of(m, f);
  vec3 viewer = viewer_in(frame, to_viewer);
  float choice = random.z;
  vec3 light, bent = vec3(0.0, 0.0, 1.0);
  vec3 sharp_weight = vec3(0.0);
  bool is_sharp = layers.is_sharp;
  s.kind = SCATTER_REFLECTS;
#ifdef PATHS_COAT
  if (choice < chances.x) {
    vec2 alpha = vec2(layers.coat_alpha);
    is_sharp = is_sharp_alpha(layers.coat_alpha);
    if (is_sharp) {
      sharp_weight = vec3(layers.coat * fresnel_dielectric(layers.cos_viewer, layers.coat_eta) / chances.x);
    }
    else {
      light = reflect(-viewer, visible_normal(viewer, alpha, cap_bound(viewer, alpha), random.xy));
    }
  }
  else
#endif
#ifdef PATHS_GLASS
  if (choice >= 1.0 - chances.z) {
    choice = (choice - (1.0 - chances.z)) / chances.z;
    vec3 reflects, transmits;
    Pane pane = layers.glass;
    vec3 h = vec3(0.0, 0.0, 1.0);
    if (!pane.is_sharp && !pane.is_thin) {
      h = visible_normal(viewer, vec2(pane.alpha), 1.0, random.xy);
    }
    pane_shares(pane, clamp(dot(viewer, h), 0.0, 1.0), reflects, transmits);
    float reflected = reflected_chance(reflects, transmits);
    if (choice < reflected) {
      is_sharp = pane.is_sharp;
      sharp_weight = reflects / (chances.z * max(reflected, 1e-12));
      if (pane.is_thin) {
        h = visible_normal(viewer, vec2(pane.alpha), cap_bound(viewer, vec2(pane.alpha)), random.xy);
      }
      light = reflect(-viewer, h);
    }
    else {
      s.kind = SCATTER_TRANSMITS;
      is_sharp = pane.is_far_sharp;
      sharp_weight = transmits / (chances.z * max(1.0 - reflected, 1e-12));
      if (pane.is_thin) {
        h = visible_normal(viewer, vec2(pane.far_alpha), cap_bound(viewer, vec2(pane.far_alpha)), random.xy);
        light = reflect(-viewer, h);
        light.z = -light.z;
      }
      else {
        light = refracted(viewer, h, pane.eta);
        bent = h;
      }
      if (is_sharp) {
        bool is_straight = pane.is_thin || abs(pane.eta - 1.0) < STRAIGHT_THROUGH;
        s.direction = is_straight ? -to_viewer : refracted(to_viewer, f.normal, pane.eta);
      }
    }
  }
  else
#endif
  {
    if (is_sharp) {
      sharp_weight = specular_fresnel(layers, layers.cos_viewer) / chances.y;
    }
    else {
      light = reflect(-viewer, visible_normal(viewer, layers.alpha, cap_bound(viewer, layers.alpha), random.xy));
    }
  }
  if (is_sharp) {
    s.weight = sharp_weight;
    if (s.kind == SCATTER_REFLECTS) {
      s.direction = reflect(-to_viewer, f.normal);
    }
  }
  else {
    vec3 value = rough_lobes(layers, chances, viewer, light, bent, s.pdf);
    s.weight = s.pdf > 0.0 ? value / s.pdf : vec3(0.0);
    s.direction = frame * light;
    if ((light.z > 0.0) != (s.kind == SCATTER_REFLECTS)) {
      s.weight = vec3(0.0);
    }
  }
  // (Also what is no number ends here.)
  if (!(largest(s.weight) > 0.0) || !(largest(s.weight) < 1e30)) {
    s = Scatter(-to_viewer, vec3(0.0), 0.0, SCATTER_ENDS);
  }
  return s;
}

// Value of the lobes that scatter() chooses among, those that are sharp left out, times the cosine to the light.
vec3 scattered(Material m, Facing f, vec3 to_viewer, vec3 to_light, out float pdf)
{
  Layers layers = layers_of(m, f.is_back, dot(f.normal, to_viewer));
  mat3 frame = frame_of(m, f);
  vec3 viewer = viewer_in(frame, to_viewer);
  vec3 light = to_light * frame;
  vec3 bent = vec3(0.0, 0.0, 1.0);
#ifdef PATHS_GLASS
  bent = layers.glass.eta * light + viewer;
  bent = normalize(bent.z < 0.0 ? -bent : bent);
#endif
  return rough_lobes(layers, layer_chances(layers), viewer, light, bent, pdf);
}

// Albedo of the diffuse base under all lobes.
vec3 base_share(Material m, Facing f, float cos_viewer)
{
  return layers_of(m, f.is_back, cos_viewer).base;
}

// What the coat lets through of what is below it, as of emission.
vec3 coat_passes(Material m, float cos_viewer)
{
  Layers layers;
  layers.cos_viewer = clamp(cos_viewer, 1e-4, 1.0);
  add_coat(m, layers);
  return layers.above;
}
