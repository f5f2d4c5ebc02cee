// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// One batch of rays, RAYS_AT_ONCE from each patch: a pixel each of a picture that is PICTURE_WIDTH wide. And links:
// what a ray has met, as the number of the patch there; LINK_NOTHING, or LINK_WITHIN where it began inside of
// something solid; LINK_CLOSE more where it met something close by.

ivec2 texel_of_ray(int place, int ray)
{
  int number = place * RAYS_AT_ONCE + ray;
  return ivec2(number % PICTURE_WIDTH, number / PICTURE_WIDTH);
}

// x: which patch it is from; y: which of its rays.
ivec2 ray_of_texel(ivec2 texel)
{
  int number = texel.y * PICTURE_WIDTH + texel.x;
  return ivec2(number / RAYS_AT_ONCE, number % RAYS_AT_ONCE);
}

int patch_of_link(float link)
{
  return int(floor(link));
}

bool is_link_close(float link)
{
  return fract(link) > 0.5 * LINK_CLOSE;
}
