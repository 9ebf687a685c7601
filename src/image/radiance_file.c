/* SPDX-License-Identifier: Apache-2.0 */
#include "image/radiance_file.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"

/* ---- the header -------------------------------------------------------------------------- */

enum { LINE_MAX_BYTES = 512 }; /* of a line whose numbers are read */

typedef struct RadianceHeader {
    const char *next, *end, *name;
    long line; /* the one that was read last, from 1 */
    char text[LINE_MAX_BYTES];
    Arena *arena;
    Error *err;
} RadianceHeader;

/* False at the end of the bytes. What does not fit is cut off: comments may be long. */
static bool next_line(RadianceHeader *in) {
    if (in->next >= in->end) return false;
    const char *stop = memchr(in->next, '\n', (size_t)(in->end - in->next));
    if (!stop) return false;
    size_t length = (size_t)(stop - in->next);
    if (length && in->next[length - 1] == '\r') length--;
    if (length > LINE_MAX_BYTES - 1) length = LINE_MAX_BYTES - 1;
    memcpy(in->text, in->next, length);
    in->text[length] = 0;
    for (size_t i = 0; i < length; i++)
        if (!in->text[i]) in->text[i] = '\1'; /* a zero byte ends no line: what is behind counts */
    in->next = stop + 1;
    in->line++;
    return true;
}

static bool line_is_wrong(const RadianceHeader *in, const char *wanted) {
    char place[32];
    snprintf(place, sizeof place, "line %ld", in->line);
    return error_at(in->err, ERROR_INPUT, in->name, place, "'%.60s', required: %s", in->text,
                    wanted);
}

/* Exactly `count` numbers behind the sign of equality. */
static bool line_numbers(const RadianceHeader *in, int count, double *out) {
    const char *at = strchr(in->text, '=') + 1;
    for (int i = 0; i < count; i++) {
        const char *after = number_read(at, &out[i]);
        if (!after || (*after && *after != ' ' && *after != '\t')) return false;
        at = after;
    }
    return at[strspn(at, " \t")] == 0 && strlen(in->text) < LINE_MAX_BYTES - 1;
}

/* Takes off again what the values were multiplied by. */
static bool divide_by(const RadianceHeader *in, int count, const char *wanted, RadianceFile *out) {
    double factor[3];
    if (!line_numbers(in, count, factor)) return line_is_wrong(in, wanted);
    for (int i = 0; i < 3; i++) {
        double f = factor[count == 3 ? i : 0];
        if (!(f > 0)) return line_is_wrong(in, wanted);
        out->scale[i] /= f;
    }
    return true;
}

static void set_primaries(const double xy[8], RadianceFile *out) {
    out->has_matrix = !chromaticities_are_rec709(xy);
    if (out->has_matrix) out->rec709 = rec709_from_primaries(xy);
}

static bool read_primaries(const RadianceHeader *in, RadianceFile *out) {
    double xy[8];
    if (!line_numbers(in, 8, xy) || !chromaticities_are_usable(xy))
        return line_is_wrong(in, "x and y of red, green, blue and white, of primaries that "
                                 "light can be mixed from");
    set_primaries(xy, out);
    return true;
}

static bool begins(const char *text, const char *with) {
    return !strncmp(text, with, strlen(with));
}

static bool read_format(const RadianceHeader *in, bool *is_xyz) {
    *is_xyz = begins(in->text, "FORMAT=32-bit_rle_xyze");
    return *is_xyz || begins(in->text, "FORMAT=32-bit_rle_rgbe") ||
           line_is_wrong(in, "FORMAT=32-bit_rle_rgbe or 32-bit_rle_xyze");
}

static bool read_variable(const RadianceHeader *in, bool *is_xyz, RadianceFile *out) {
    if (begins(in->text, "EXPOSURE="))
        return divide_by(in, 1, "EXPOSURE= and a number above 0", out);
    if (begins(in->text, "COLORCORR="))
        return divide_by(in, 3, "COLORCORR= and three numbers above 0", out);
    if (begins(in->text, "PRIMARIES=")) return read_primaries(in, out);
    if (begins(in->text, "FORMAT=")) return read_format(in, is_xyz);
    if (begins(in->text, "VIEW=") && strlen(in->text) == LINE_MAX_BYTES - 1)
        return line_is_wrong(in, "VIEW= and no more than 500 letters");
    if (begins(in->text, "VIEW="))
        out->view = arena_string(in->arena, in->text + 5, strlen(in->text + 5));
    return true;
}

/* "-Y 32 +X 64": 32 scan lines from the top (-Y: Y grows upwards), 64 pixels from the left. */
static bool read_size(RadianceHeader *in, RadianceFile *out) {
    static const char wanted[] = "-Y HEIGHT +X WIDTH, or another order of X and Y, 1 to 65536";
    char sign[2], axis[2];
    uint64_t size[2];
    if (!next_line(in))
        return error_at(in->err, ERROR_INPUT, in->name, "", "the header ends before the size");
    const char *at = in->text;
    for (int i = 0; i < 2; i++, at += strspn(at, " \t")) {
        if (!*at || !at[1]) return line_is_wrong(in, wanted);
        sign[i] = at[0], axis[i] = at[1];
        at = number_read_count(at + 2 + strspn(at + 2, " \t"), &size[i]);
        if (!at) return line_is_wrong(in, wanted);
    }
    if (*at) return line_is_wrong(in, wanted);
    bool is_known = (axis[0] == 'Y' && axis[1] == 'X') || (axis[0] == 'X' && axis[1] == 'Y');
    for (int i = 0; i < 2; i++)
        is_known &= (sign[i] == '-' || sign[i] == '+') && size[i] >= 1 && size[i] <= 65536;
    if (!is_known) return line_is_wrong(in, wanted);
    bool by_rows = axis[0] == 'Y';
    out->count = size[0];
    out->length = size[1];
    out->height = by_rows ? size[0] : size[1];
    out->width = by_rows ? size[1] : size[0];
    bool from_right = sign[by_rows] == '-', from_below = sign[!by_rows] == '+';
    long across = from_right ? -1 : 1, down = from_below ? -out->width : out->width;
    out->first =
        (from_right ? out->width - 1 : 0) + (from_below ? (long)(out->height - 1) * out->width : 0);
    out->line_step = by_rows ? down : across;
    out->pixel_step = by_rows ? across : down;
    return true;
}

/* What all lines of the header come to, as far as values can be multiplied by it. */
static bool check_scale(const RadianceHeader *in, const RadianceFile *made) {
    for (int i = 0; i < 3; i++)
        if (!(made->scale[i] >= (double)FLT_MIN && made->scale[i] <= (double)FLT_MAX))
            return error_at(in->err, ERROR_INPUT, in->name, "header",
                            "EXPOSURE= and COLORCORR= together divide by %.6g, required: a number "
                            "from 1e-38 to 1e38",
                            1 / made->scale[i]);
    return true;
}

/* The luminance of a white of 1, by Rec.709's parts. */
static void set_unit(RadianceFile *out) {
    const double luminance[3] = {0.2126, 0.7152, 0.0722};
    out->unit_cd_m2 = 0;
    for (int i = 0; i < 3; i++) {
        double y = luminance[i];
        for (int k = 0; k < 3 && out->has_matrix; k++)
            y = (k ? y : 0) + luminance[k] * out->rec709.m[k][i];
        out->scale[i] *= RADIANCE_LM_W;
        out->unit_cd_m2 += y * out->scale[i];
    }
}

bool radiance_recognise(const void *bytes, size_t size) {
    return size > 2 && !memcmp(bytes, "#?", 2);
}

bool radiance_open(const void *bytes, size_t size, const char *name, Arena *arena,
                   RadianceFile *out, Error *err) {
    static const double XYZ[8] = {1, 0, 0, 1, 0, 0, 1.0 / 3, 1.0 / 3};
    RadianceHeader in = {
        .next = bytes, .end = (const char *)bytes + size, .name = name, .arena = arena, .err = err};
    RadianceFile made = {.scale = {1, 1, 1}};
    bool is_xyz = false;
    while (next_line(&in) && in.text[0])
        if (!read_variable(&in, &is_xyz, &made)) return false;
    if (!check_scale(&in, &made) || !read_size(&in, &made)) return false;
    if (is_xyz) set_primaries(XYZ, &made);
    set_unit(&made);
    made.pixels = (const unsigned char *)in.next;
    made.size = (size_t)(in.end - in.next);
    *out = made;
    return true;
}

/* ---- pixels ------------------------------------------------------------------------------ */

typedef unsigned char Rgbe[4];

/* Bytes that are taken from the front. */
typedef struct RadianceBytes {
    const unsigned char *next;
    size_t left;
} RadianceBytes;

static bool take(RadianceBytes *in, size_t count, unsigned char *to) {
    if (in->left < count) return false;
    memcpy(to, in->next, count);
    in->next += count;
    in->left -= count;
    return true;
}

/* The four components one after the other, in runs (a count above 128) and as they are. */
static bool take_components(RadianceBytes *in, int length, Rgbe *line) {
    unsigned char head, value = 0;
    for (int c = 0; c < 4; c++)
        for (int x = 0; x < length;) {
            if (!take(in, 1, &head)) return false;
            bool is_run = head > 128;
            int count = is_run ? head - 128 : head;
            if (count == 0 || count > length - x) return false;
            for (int i = 0; i < count; i++) {
                if ((!is_run || i == 0) && !take(in, 1, &value)) return false;
                line[x++][c] = value;
            }
        }
    return true;
}

/* Pixels, of which 1, 1, 1 and a count repeat the one before; further such ones in a row hold
 * the count's higher digits (of 256). */
static bool take_pixels(RadianceBytes *in, int length, Rgbe *line) {
    int digit = 0;
    for (int x = 0; x < length;) {
        Rgbe pixel;
        if (!take(in, 4, pixel)) return false;
        bool is_run = pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
        long count = is_run ? (long)pixel[3] << (8 * digit) : 1;
        if ((is_run && (x == 0 || digit > 2)) || count > length - x) return false;
        for (long i = 0; i < count; i++)
            memcpy(line[x + i], is_run ? line[x - 1] : pixel, sizeof pixel);
        digit = is_run ? digit + 1 : 0;
        x += (int)count;
    }
    return true;
}

static bool take_line(RadianceBytes *in, int length, Rgbe *line) {
    const unsigned char *h = in->next;
    bool in_components = in->left >= 4 && length >= 8 && length < 32768 && h[0] == 2 && h[1] == 2 &&
                         h[2] < 128 && h[2] * 256 + h[3] == length;
    if (!in_components) return take_pixels(in, length, line);
    in->next += 4;
    in->left -= 4;
    return take_components(in, length, line);
}

static void store(const unsigned char pixel[4], float *rgba) {
    float step = pixel[3] ? ldexpf(1, pixel[3] - 136) : 0;
    for (int c = 0; c < 3; c++) rgba[c] = ((float)pixel[c] + 0.5f) * step;
    rgba[3] = 1;
}

bool radiance_read(const RadianceFile *file, Arena scratch, float *rgba, Error *err) {
    RadianceBytes in = {file->pixels, file->size};
    Rgbe *line = ARENA_NEW(&scratch, Rgbe, file->length);
    int y = 0;
    for (; y < file->count && take_line(&in, file->length, line); y++)
        for (int x = 0; x < file->length; x++)
            store(line[x], rgba + 4 * (file->first + y * file->line_step + x * file->pixel_step));
    return y == file->count || error_set(err, ERROR_INPUT,
                                         "damaged hdr picture: scan line %d of %d is cut off, or "
                                         "its runs do not fit it",
                                         y, file->count);
}
