/* SPDX-License-Identifier: Apache-2.0 */
#include "image/tiff_directory.h"

uint64_t tiff_number(const Tiff *tiff, uint64_t at, unsigned width)
{
    uint64_t value = 0;
    if (at > tiff->size || tiff->size - at < width) return 0;
    for (unsigned i = 0; i < width; i++)
        value = value << 8 | tiff->bytes[at + (tiff->is_big_endian ? i : width - 1 - i)];
    return value;
}

TiffList tiff_list(const Tiff *tiff, unsigned tag)
{
    unsigned wide = tiff->is_wide ? 8 : 4, head = tiff->is_wide ? 8 : 2;
    uint64_t at = tiff_number(tiff, wide, wide), entries = tiff_number(tiff, at, head);
    at += head;
    for (uint64_t i = 0; i < entries && at < tiff->size; i++, at += 4 + 2 * wide) {
        if (tiff_number(tiff, at, 2) != tag) continue;
        uint64_t type = tiff_number(tiff, at + 2, 2), value = at + 4 + wide;
        TiffList out = {value, tiff_number(tiff, at + 4, wide),
                        type == 3 ? 2 : type == 16 ? 8 : type == 1 || type == 7 ? 1 : 4};
        if (out.count * out.width > wide) out.at = tiff_number(tiff, value, wide);
        return out;
    }
    return (TiffList){0, 0, 0};
}
