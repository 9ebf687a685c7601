#include "image/plain_png.h"

#include <stdint.h>
#include <string.h>
#define ZLIB_CONST
#include <zlib.h>

#define SIDE_MAX 65536
#define HEAD_BYTES 13
#define FIRST_PART 8 /* behind the signature */

/* One part ("chunk") of the file. */
typedef struct PngPart {
    const unsigned char *type, *data;
    size_t size;
} PngPart;

static uint32_t u32_at(const unsigned char *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/* The part that begins at *at, which moves on. False: there is none. */
static bool next_part(const unsigned char *bytes, size_t size, size_t *at, PngPart *out)
{
    if (size - *at < 12) return false;
    size_t length = u32_at(bytes + *at);
    if (length > size - *at - 12) return false;
    *out = (PngPart){bytes + *at + 4, bytes + *at + 8, length};
    *at += 12 + length;
    return true;
}

static bool is_type(const PngPart *part, const char *type)
{
    return !memcmp(part->type, type, 4);
}

/* Parts that change what the pixels mean, and those that nobody knows. */
static bool is_unusual(const PngPart *part)
{
    bool is_needed = !(part->type[0] & 0x20); /* a capital letter */
    return is_type(part, "tRNS") || is_type(part, "sBIT") ||
           (is_needed && !is_type(part, "IDAT"));
}

static bool read_head(const PngPart *part, PlainPng *out)
{
    static const int CHANNELS[7] = {1, 0, 3, 0, 2, 0, 4}; /* of a colour type */
    if (!is_type(part, "IHDR") || part->size != HEAD_BYTES) return false;
    const unsigned char *d = part->data;
    uint32_t width = u32_at(d), height = u32_at(d + 4);
    bool is_plain = d[8] == 8 && d[9] < 7 && !d[10] && !d[11] && !d[12]; /* 12: interlaced */
    if (!is_plain || !CHANNELS[d[9]]) return false;
    if (width < 1 || height < 1 || width > SIDE_MAX || height > SIDE_MAX) return false;
    out->width = (int)width;
    out->height = (int)height;
    out->channels = CHANNELS[d[9]];
    out->row_bytes = 1 + (size_t)width * (size_t)out->channels;
    return true;
}

bool plain_png_open(const unsigned char *bytes, size_t size, PlainPng *out)
{
    size_t  at = FIRST_PART;
    PngPart part;
    *out = (PlainPng){.bytes = bytes, .size = size};
    if (size < FIRST_PART || !next_part(bytes, size, &at, &part) || !read_head(&part, out))
        return false;
    while (next_part(bytes, size, &at, &part)) {
        if (is_type(&part, "IEND")) return true;
        if (is_unusual(&part)) return false;
    }
    return false;
}

/* The pixels' parts are one stream: it must fill the rows, and end with its last byte. */
static bool inflate_parts(z_stream *stream, const PlainPng *png)
{
    size_t  at = FIRST_PART;
    PngPart part;
    int     state = Z_OK;
    while (next_part(png->bytes, png->size, &at, &part) && !is_type(&part, "IEND")) {
        if (!is_type(&part, "IDAT") || !part.size) continue;
        if (state != Z_OK) return false;
        stream->next_in = part.data;
        stream->avail_in = (uInt)part.size;
        state = inflate(stream, Z_NO_FLUSH);
        if (state == Z_BUF_ERROR && !stream->avail_in) state = Z_OK; /* it wants more */
        if ((state != Z_OK && state != Z_STREAM_END) || stream->avail_in) return false;
    }
    return state == Z_STREAM_END && !stream->avail_out;
}

/* The nearest of left, above and the corner between them to what their plane predicts. */
static int paeth(int left, int above, int corner)
{
    int to_left = above - corner, to_above = left - corner, to_corner = to_left + to_above;
    to_left = to_left < 0 ? -to_left : to_left;
    to_above = to_above < 0 ? -to_above : to_above;
    to_corner = to_corner < 0 ? -to_corner : to_corner;
    if (to_left <= to_above && to_left <= to_corner) return left;
    return to_above <= to_corner ? above : corner;
}

/* row, above: behind the filter's byte; above NULL: the first row. step: bytes of a pixel. */
static bool unfilter(int filter, unsigned char *row, const unsigned char *above, size_t count,
                     size_t step)
{
    switch (filter) {
    case 0: return true;
    case 1:
        for (size_t i = step; i < count; i++) row[i] += row[i - step];
        return true;
    case 2:
        for (size_t i = 0; above && i < count; i++) row[i] += above[i];
        return true;
    case 3:
        for (size_t i = 0; i < count; i++) {
            int left = i < step ? 0 : row[i - step], over = above ? above[i] : 0;
            row[i] += (unsigned char)((left + over) / 2);
        }
        return true;
    case 4:
        for (size_t i = 0; i < step; i++) row[i] += above ? above[i] : 0;
        for (size_t i = step; i < count; i++)
            row[i] += (unsigned char)(above ? paeth(row[i - step], above[i], above[i - step])
                                            : row[i - step]);
        return true;
    default: return false;
    }
}

static bool unfilter_all(const PlainPng *png, unsigned char *rows)
{
    const unsigned char *above = NULL;
    for (int y = 0; y < png->height; y++, rows += png->row_bytes) {
        if (!unfilter(rows[0], rows + 1, above, png->row_bytes - 1, (size_t)png->channels))
            return false;
        above = rows + 1;
    }
    return true;
}

bool plain_png_read(const PlainPng *png, unsigned char *rows)
{
    size_t   size = png->row_bytes * (size_t)png->height;
    z_stream stream = {.next_out = rows, .avail_out = (uInt)size};
    if (size > UINT32_MAX || inflateInit(&stream) != Z_OK) return false;
    bool ok = inflate_parts(&stream, png);
    inflateEnd(&stream);
    return ok && unfilter_all(png, rows);
}
