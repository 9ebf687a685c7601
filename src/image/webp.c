/* SPDX-License-Identifier: Apache-2.0 */
#include "image/webp.h"

#include <webp/decode.h>

bool webp_size(const void *bytes, size_t size, int *width, int *height, Error *err)
{
    WebPBitstreamFeatures found;
    if (WebPGetFeatures(bytes, size, &found) != VP8_STATUS_OK || found.width < 1 ||
        found.height < 1)
        return error_set(err, ERROR_INPUT, "damaged webp picture: its beginning is wrong");
    if (found.has_animation)
        return error_set(err, ERROR_INPUT, "a webp picture that moves; one that stands still "
                         "is wanted");
    *width = found.width;
    *height = found.height;
    return true;
}

bool webp_read(const void *bytes, size_t size, unsigned char *rgba, Error *err)
{
    int width, height;
    if (!webp_size(bytes, size, &width, &height, err)) return false;
    size_t row = 4 * (size_t)width;
    return WebPDecodeRGBAInto(bytes, size, rgba, row * (size_t)height, (int)row) ||
           error_set(err, ERROR_INPUT, "damaged webp picture: its pixels cannot be decoded");
}
