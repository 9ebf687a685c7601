/* SPDX-License-Identifier: Apache-2.0 */
#include "page/page_data.h"

#include <zlib.h>

#include "text/base64.h"

#define LEVEL 9 /* pages are written once and read often */

bool page_data_add(Text *page, const uint32_t *values, size_t count, int bytes, Arena scratch,
                   Error *err)
{
    size_t size = count * (size_t)bytes;
    uLong  room = compressBound((uLong)size);
    unsigned char *planes = ARENA_NEW(&scratch, unsigned char, size);
    unsigned char *packed = ARENA_NEW(&scratch, unsigned char, room);
    for (size_t at = 0; at < size; at++) {
        size_t   i = at % count;
        unsigned shift = 8 * (unsigned)(at / count);
        uint32_t before = i > 0 ? values[i - 1] >> shift : 0;
        planes[at] = (unsigned char)((values[i] >> shift) - before);
    }
    if (compress2(packed, &room, planes, (uLong)size, LEVEL) != Z_OK)
        return error_set(err, ERROR_MEMORY, "memory is out: numbers of the page");
    base64_encode(page, packed, room);
    return true;
}
