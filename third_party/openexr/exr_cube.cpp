/* SPDX-License-Identifier: Apache-2.0 */
#include "openexr/exr_cube.h"

#include <OpenEXR/ImfEnvmap.h>

#include <algorithm>

size_t exr_cube_pixel(const double direction[3], int side) {
    /* The library's places go from the middle of a face's first pixel to that of its last one:
     * those of a very fine face are shares of the whole face. */
    const int fine = 1 << 20;
    const Imath::Box2i window({0, 0}, {fine, 6 * (fine + 1) - 1});
    Imf::CubeMapFace face;
    Imath::V2f in_face;
    Imf::CubeMap::faceAndPixelPosition(
        Imath::V3f((float)direction[0], (float)direction[1], (float)direction[2]), window, face,
        in_face);
    const Imath::V2f at = Imf::CubeMap::pixelPosition(face, window, in_face);
    auto texel = [&](double place) {
        return (size_t)std::clamp((int)(place / fine * side), 0, side - 1);
    };
    return ((size_t)face * (size_t)side + texel((double)at.y - (double)face * (fine + 1))) *
               (size_t)side +
           texel((double)at.x);
}
