/* SPDX-License-Identifier: Apache-2.0 */
/* Layout (OpenEXR File Layout): magic number and version, 4 bytes each; of every attribute a
 * name, a type, both ended by a zero byte, the value's size in 4 bytes, little endian, and the
 * value. An empty name ends the header; several headers, one a part, end with an empty one. */
#include "openexr/exr_header.h"

#include <stdint.h>
#include <string.h>

enum { FIRST_HEADER = 8, VERSION_AT = 5, MULTIPART = 0x10 };

typedef struct HeaderPlace {
    const unsigned char *bytes;
    size_t at, size;
} HeaderPlace;

/* False when the text's end is not there. */
static bool skip_text(HeaderPlace *place) {
    const unsigned char *from = place->bytes + place->at;
    const unsigned char *end = memchr(from, 0, place->size - place->at);
    if (end) place->at += (size_t)(end - from) + 1;
    return end != NULL;
}

static bool read_size(HeaderPlace *place, uint32_t *out) {
    if (place->size - place->at < 4) return false;
    const unsigned char *b = place->bytes + place->at;
    *out = b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
    place->at += 4;
    return true;
}

/* What the library in use would call damage: 0 to 9 are none to DWAB, of OpenEXR 2.2. */
static bool check_compression(const char *name, unsigned kind, Error *err) {
    static const char *const NEWER[] = {" (HTJ2K256)", " (HTJ2K32)", " (ZSTD)"};
    enum { KNOWN = 10 };
    if (strcmp(name, "compression") != 0 || kind < KNOWN) return true;
    return error_set(err, ERROR_INPUT,
                     "is compressed in a way %u%s that is newer than the library here reads, "
                     "required: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA or DWAB",
                     kind, kind < KNOWN + 3 ? NEWER[kind - KNOWN] : "");
}

bool exr_check_header(const unsigned char *bytes, size_t size, size_t file_size, Error *err) {
    HeaderPlace place = {bytes, FIRST_HEADER, size};
    bool is_multipart = size > VERSION_AT && bytes[VERSION_AT] & MULTIPART;
    bool is_empty = true; /* the header so far */
    while (place.at < size) {
        const char *name = (const char *)bytes + place.at;
        uint32_t length;
        if (!skip_text(&place)) return true;
        if (!*name) {
            if (is_empty || !is_multipart) return true;
            is_empty = true;
            continue;
        }
        is_empty = false;
        if (!skip_text(&place) || !read_size(&place, &length)) return true;
        if (length > file_size - place.at)
            return error_set(err, ERROR_INPUT,
                             "damaged: attribute \"%.40s\" has %u bytes, the file ends after "
                             "%zu",
                             name, length, file_size - place.at);
        if (length > size - place.at) return true;
        if (length == 1 && !check_compression(name, bytes[place.at], err)) return false;
        place.at += length;
    }
    return true;
}
