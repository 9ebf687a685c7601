/* SPDX-License-Identifier: Apache-2.0 */
#include "image/picture_pages.h"

#include <ctype.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/count.h"
#include "image/tiff_directory.h"

static uint64_t mixed(uint64_t digest, const void *bytes, size_t size) {
    return XXH3_64bits_withSeed(bytes, size, digest);
}

/* Bytes of a TIFF, fewer than `left` of which may still be looked at: pages may share them, and a
 * small file might ask for days. */
static bool add_bytes(const Tiff *tiff, uint64_t at, uint64_t size, uint64_t *left,
                      uint64_t *digest) {
    if (at > tiff->size || size > tiff->size - at || size >= *left) return false;
    *left -= size + 1;
    *digest = mixed(*digest, tiff->bytes + at, size);
    return true;
}

/* Its strips or tiles, and what decides what they show. */
static bool add_page(const Tiff *tiff, uint64_t at, uint64_t *left, uint64_t *digest) {
    static const unsigned short DECIDING[] = {256, 257, 258, 259, 262, 266, 274, 277,  284,
                                              317, 320, 322, 323, 338, 339, 347, 34675};
    static const unsigned short PIXELS[2][2] = {{273, 279}, {324, 325}};
    bool ok = true;
    for (int i = 0; i < COUNT_OF(DECIDING) && ok; i++) {
        TiffList list = tiff_list_in(tiff, at, DECIDING[i]);
        ok = list.count <= tiff->size &&
             add_bytes(tiff, list.at, list.count * list.width, left, digest);
    }
    for (int k = 0; k < 2; k++) {
        TiffList where = tiff_list_in(tiff, at, PIXELS[k][0]);
        TiffList length = tiff_list_in(tiff, at, PIXELS[k][1]);
        for (uint64_t i = 0; i < where.count && i < length.count && ok; i++) {
            uint64_t from = tiff_number(tiff, where.at + i * where.width, where.width);
            uint64_t bytes = tiff_number(tiff, length.at + i * length.width, length.width);
            ok = add_bytes(tiff, from, bytes, left, digest);
        }
    }
    return ok;
}

/* NewSubfileType 1 and SubfileType 2 are smaller copies (TIFF 6.0, section 8). What cannot be
 * found page by page is all of the file. */
static void count_tiff(const unsigned char *bytes, size_t size, PicturePages *out) {
    Tiff tiff = tiff_open(bytes, size);
    uint64_t left = 4 * (uint64_t)size, at = tiff_next(&tiff, tiff_first(&tiff));
    bool ok = true;
    for (; at && at < size && ok; at = tiff_next(&tiff, at)) {
        uint64_t entries = tiff_number(&tiff, at, tiff.is_wide ? 8 : 2);
        uint64_t unused = 0;
        ok = entries < size && add_bytes(&tiff, at, entries * 12, &left, &unused);
        TiffList kind = tiff_list_in(&tiff, at, 254), old = tiff_list_in(&tiff, at, 255);
        bool is_copy = kind.count && tiff_number(&tiff, kind.at, kind.width) & 1;
        is_copy |= old.count && tiff_number(&tiff, old.at, old.width) == 2;
        out->count += !is_copy;
        ok = ok && (is_copy || add_page(&tiff, at, &left, &out->digest));
    }
    if (!ok) out->digest = mixed(0, bytes, size);
}

/* Blocks (GIF89a): the first byte says which; data are pieces with their length before them. */
static void count_gif(const unsigned char *bytes, size_t size, PicturePages *out) {
    int images = 0;
    size_t at = 13, second = size;
    out->name = "frames";
    if (size < 14) return;
    if (bytes[10] & 0x80) at += (size_t)6 << (bytes[10] & 7);
    while (at + 2 < size && (bytes[at] == 0x21 || bytes[at] == 0x2c)) {
        bool is_image = bytes[at] == 0x2c;
        images += is_image;
        if (is_image && at + 10 >= size) break;
        if (is_image) at += 11 + (bytes[at + 9] & 0x80 ? (size_t)6 << (bytes[at + 9] & 7) : 0);
        else at += 2;
        while (at < size && bytes[at]) at += 1 + (size_t)bytes[at];
        at++;
        if (images == 1 && is_image) second = at;
    }
    if (images < 2 || second > size) return;
    out->count = images;
    out->digest = mixed(out->digest, bytes + second, size - second);
}

static uint32_t u32_at(const unsigned char *p) {
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/* fcTL begins a frame, fdAT has its pixels (PNG, third edition, 11.3.6); the still picture is a
 * frame only where one begins before it. */
static void count_png(const unsigned char *bytes, size_t size, PicturePages *out) {
    int begun = 0;
    bool is_behind = false;
    out->name = "frames";
    for (size_t at = 8; at + 12 <= size;) {
        size_t length = u32_at(bytes + at);
        const unsigned char *name = bytes + at + 4;
        if (length > size - at - 12) return;
        bool is_start = !memcmp(name, "fcTL", 4), is_frame = !memcmp(name, "fdAT", 4);
        is_behind |= !memcmp(name, "IDAT", 4);
        begun += is_start && is_behind;
        if (is_behind && (is_start || is_frame))
            out->digest = mixed(out->digest, name + 8, length < 4 ? 0 : length - 4);
        at += 12 + length;
    }
    out->count += begun;
}

/* Their number stands at byte 770 (SMPTE 268M). */
static void count_dpx(const unsigned char *bytes, size_t size, PicturePages *out) {
    if (size < 772) return;
    int count = bytes[0] == 'S' ? bytes[770] << 8 | bytes[771] : bytes[771] << 8 | bytes[770];
    out->name = "elements";
    if (count < 2 || count > 8) return;
    out->count = count;
    out->digest = mixed(out->digest, bytes, size);
}

/* A number of a PNM's head, behind white space and remarks; 0: none. */
static size_t pnm_number(const unsigned char *bytes, size_t size, size_t *at) {
    size_t number = 0;
    for (bool is_remark = false;
         *at < size && (is_remark || isspace(bytes[*at]) || bytes[*at] == '#'); (*at)++)
        is_remark = (is_remark || bytes[*at] == '#') && bytes[*at] != '\n';
    for (; *at < size && isdigit(bytes[*at]) && number < 1 << 20; (*at)++)
        number = 10 * number + bytes[*at] - '0';
    return number;
}

/* Pictures stand one behind the other. */
static void count_pnm(const unsigned char *bytes, size_t size, PicturePages *out) {
    int images = 0;
    size_t at = 0, second = 0;
    while (at + 2 < size && bytes[at] == 'P' && (bytes[at + 1] == '5' || bytes[at + 1] == '6')) {
        size_t channels = bytes[at + 1] == '6' ? 3 : 1;
        at += 2;
        size_t width = pnm_number(bytes, size, &at), height = pnm_number(bytes, size, &at);
        size_t most = pnm_number(bytes, size, &at);
        at += 1 + width * height * channels * (most > 255 ? 2 : 1);
        if (++images == 1) second = at;
    }
    if (images < 2) return;
    out->count = images;
    out->name = "pictures";
    out->digest = mixed(out->digest, bytes + second, size - second);
}

PicturePages picture_pages(const void *bytes, size_t size) {
    PicturePages out = {.count = 1, .name = "pages"};
    if (size < 16) return out;
    if (!memcmp(bytes, "\x89PNG\r\n\x1a\n", 8)) count_png(bytes, size, &out);
    if (!memcmp(bytes, "GIF8", 4)) count_gif(bytes, size, &out);
    if (!memcmp(bytes, "P5", 2) || !memcmp(bytes, "P6", 2)) count_pnm(bytes, size, &out);
    if (!memcmp(bytes, "II*\0", 4) || !memcmp(bytes, "MM\0*", 4) || !memcmp(bytes, "II+\0", 4) ||
        !memcmp(bytes, "MM\0+", 4))
        count_tiff(bytes, size, &out);
    if (!memcmp(bytes, "SDPX", 4) || !memcmp(bytes, "XPDS", 4)) count_dpx(bytes, size, &out);
    return out;
}

bool picture_pages_check(const void *bytes, size_t size, const char *name, Error *err) {
    PicturePages pages = picture_pages(bytes, size);
    return pages.count == 1 || error_at(err, ERROR_INPUT, name, "",
                                        "holds %d %s, required: one picture that stands still",
                                        pages.count, pages.name);
}
