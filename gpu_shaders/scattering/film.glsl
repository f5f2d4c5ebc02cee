// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Reflectance under a thin film, as optics/scattering/film.py: Belcour and Barla, "A Practical Extension to Microfacet
// Theory for the Modeling of Varying Iridescence" (2017).
#include "common/ggx_table.glsl"
#include "scattering/fresnel_layers.glsl"

// Nanometers; a material has none up to this.
#define NO_FILM 0.1

// Means of exp(-i 2 pi m path / wavelength) over the colors' matching functions, for m of 1, 2, 3.
struct Sensitivity {
  vec3 real[3];
  vec3 imaginary[3];
};

Sensitivity film_sensitivity(float path)
{
  Sensitivity s;
  for (int m = 0; m < 3; m++) {
    float place = clamp(path * float(m + 1) / GGX_LONGEST_PATH, 0.0, 1.0) * float(GGX_FILM_STEPS - 1);
    int below = min(int(place), GGX_FILM_STEPS - 2);
    float between = place - float(below);
    int row = 2 * GGX_TABLE_SIZE;
    s.real[m] = mix(texelFetch(lighting_ggx, ivec2(below, row), 0).rgb,
                    texelFetch(lighting_ggx, ivec2(below + 1, row), 0).rgb, between);
    s.imaginary[m] = mix(texelFetch(lighting_ggx, ivec2(below, row + 1), 0).rgb,
                         texelFetch(lighting_ggx, ivec2(below + 1, row + 1), 0).rgb, between);
  }
  return s;
}

// Squared amplitudes of what is reflected across and along the plane of incidence, their signs, and the cosine behind,
// 0 where all is reflected.
vec2 polarized_dielectric(float cosine, float eta, out vec2 signs, out float inner)
{
  inner = refracted_cosine(cosine, eta);
  signs = vec2(1.0);
  if (inner <= 0.0) {
    return vec2(1.0);
  }
  float across = (cosine - eta * inner) / max(cosine + eta * inner, 1e-20);
  float along = (eta * cosine - inner) / max(eta * cosine + inner, 1e-20);
  signs = vec2(across >= 0.0 ? 1.0 : -1.0, along >= 0.0 ? 1.0 : -1.0);
  return vec2(across * across, along * along);
}

// Of one polarization: what the top and the bottom reflect, and exp(i phase) of both reflections.
vec3 airy(float top, vec3 bottom, Sensitivity s, vec3 phase_real, vec3 phase_imaginary)
{
  float through = 1.0 - top;
  vec3 both = min(top * bottom, 1.0 - 1e-6);
  vec3 of_bottom = through * through * bottom / (1.0 - both);
  vec3 total = of_bottom + top;
  vec3 share = of_bottom - through;
  vec3 root = sqrt(both);
  vec3 real = phase_real;
  vec3 imaginary = phase_imaginary;
  for (int m = 0; m < 3; m++) {
    share *= root;
    total += 2.0 * share * (real * s.real[m] + imaginary * s.imaginary[m]);
    vec3 next = real * phase_real - imaginary * phase_imaginary;
    imaginary = real * phase_imaginary + imaginary * phase_real;
    real = next;
  }
  return total;
}

// Films under 1 nm fade out.
float film_index(float thickness, float index)
{
  return mix(1.0, max(index, 1e-5), smoothstep(0.0, 1.0, thickness));
}

// A dielectric under a film; scaled towards `f0` where it is low, as Cycles.
vec3 film_on_dielectric(float thickness, float index, vec3 f0, float eta, float cosine)
{
  float film = film_index(thickness, index);
  vec2 top_signs, bottom_signs;
  float inner, inmost;
  cosine = clamp(cosine, 0.0, 1.0);
  vec2 top = polarized_dielectric(cosine, film, top_signs, inner);
  vec2 bottom = polarized_dielectric(inner, eta / film, bottom_signs, inmost);
  if (inner <= 0.0 || inmost <= 0.0) {
    return vec3(1.0);
  }
  Sensitivity s = film_sensitivity(2.0 * film * thickness * inner);
  vec2 phases = -top_signs * bottom_signs;
  vec3 across = airy(top.x, vec3(bottom.x), s, vec3(phases.x), vec3(0.0));
  vec3 along = airy(top.y, vec3(bottom.y), s, vec3(phases.y), vec3(0.0));
  vec3 reflected = clamp(0.5 * (across + along), 0.0, 1.0);
  float real = normal_reflectance(eta);
  if (real > 1e-5) {
    vec3 share = clamp((1.0 - reflected) / max(1.0 - real, 1e-6), 0.0, 1.0);
    reflected *= mix(vec3(1.0), f0 / real, share);
  }
  return reflected;
}

// A metal under a film, its complex index guessed from its color along the normal and at the edge: Gulbrandsen,
// "Artist Friendly Metallic Fresnel" (2014); phases: Born and Wolf, "Principles of Optics", 14.4.1.
vec3 film_on_metal(float thickness, float index, vec3 f0, vec3 dip, float cosine)
{
  float film = film_index(thickness, index);
  vec2 signs;
  float inner;
  cosine = clamp(cosine, 0.0, 1.0);
  vec2 top = polarized_dielectric(cosine, film, signs, inner);
  if (inner <= 0.0) {
    return vec3(1.0);
  }
  vec3 r = min(f0, 0.999);
  vec3 g = tinted_metal(f0, dip, 1.0 / 7.0);
  vec3 root = sqrt(r);
  vec3 n = mix((1.0 + root) / (1.0 - root), (1.0 - r) / (1.0 + r), g);
  vec3 k2 = max((r * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - r), 0.0);
  vec3 relative = n / film;
  vec3 k2_film = k2 / (film * film);
  vec3 inside = ((relative - 1.0) * (relative - 1.0) + k2_film) / ((relative + 1.0) * (relative + 1.0) + k2_film);
  const float s1 = 6.0 / 7.0;
  const float s5 = s1 * s1 * s1 * s1 * s1;
  vec3 inside_dip = (mix(inside, vec3(1.0), s5) - g) * (7.0 / (s5 * s1));
  vec3 bottom = tinted_metal(inside, inside_dip, inner);
  vec3 squares = n * n - k2;
  vec3 twice = 2.0 * n * sqrt(k2);
  vec3 a = squares - film * film * (1.0 - inner * inner);
  vec3 size = sqrt(a * a + twice * twice);
  vec3 u2 = max(0.5 * (size + a), 0.0);
  vec3 v2 = max(0.5 * (size - a), 0.0);
  float ic = film * inner;
  vec3 across_real = ic * ic - u2 - v2;
  vec3 across_imaginary = -2.0 * ic * sqrt(v2);
  vec3 sum = (n * n + k2) * inner;
  vec3 along_real = sum * sum - film * film * (u2 + v2);
  vec3 along_imaginary = 2.0 * ic * (twice * sqrt(u2) - squares * sqrt(v2));
  vec3 across_length = max(sqrt(across_real * across_real + across_imaginary * across_imaginary), 1e-20);
  vec3 along_length = max(sqrt(along_real * along_real + along_imaginary * along_imaginary), 1e-20);
  Sensitivity s = film_sensitivity(2.0 * film * thickness * inner);
  across_length *= -signs.x;
  along_length *= -signs.y;
  vec3 across = airy(top.x, bottom, s, across_real / across_length, across_imaginary / across_length);
  vec3 along = airy(top.y, bottom, s, along_real / along_length, along_imaginary / along_length);
  return clamp(0.5 * (across + along), 0.0, 1.0);
}

bool has_film(float thickness)
{
#ifdef PATHS_FILM
  return thickness > NO_FILM;
#else
  return false;
#endif
}

vec3 film_or_dielectric(float film, float film_ior, vec3 f0, float eta, float cosine)
{
  if (has_film(film)) {
    return film_on_dielectric(film, film_ior, f0, eta, cosine);
  }
  return tinted_dielectric(f0, eta, cosine);
}
