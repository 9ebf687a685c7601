/* SPDX-License-Identifier: Apache-2.0 */
#include "image/light_picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/colour.h"
#include "openexr/exr_file.h"

/* How stored values become linear Rec.709 in cd/m2: scaled, then through the matrix. */
typedef struct LightScale {
    double       scale[3], unit_cd_m2;
    bool         has_matrix;
    ColourMatrix rec709;
} LightScale;

/* ---- Radiance ---------------------------------------------------------------------------- */

enum { LINE_MAX_BYTES = 512 }; /* of a line whose numbers are read */

typedef struct RadianceHeader {
    const char *next, *end, *name;
    long        line; /* the one that was read last, from 1 */
    char        text[LINE_MAX_BYTES];
    Error      *err;
} RadianceHeader;

/* False at the end of the bytes. What does not fit is cut off: comments may be long. */
static bool next_line(RadianceHeader *in)
{
    if (in->next >= in->end) return false;
    const char *stop = memchr(in->next, '\n', (size_t)(in->end - in->next));
    if (!stop) return false;
    size_t length = (size_t)(stop - in->next);
    if (length && in->next[length - 1] == '\r') length--;
    if (length > LINE_MAX_BYTES - 1) length = LINE_MAX_BYTES - 1;
    memcpy(in->text, in->next, length);
    in->text[length] = 0;
    in->next = stop + 1;
    in->line++;
    return true;
}

static bool line_is_wrong(const RadianceHeader *in, const char *wanted)
{
    char place[32];
    snprintf(place, sizeof place, "line %ld", in->line);
    return error_at(in->err, ERROR_INPUT, in->name, place, "'%.60s', wanted %s", in->text,
                    wanted);
}

/* Exactly `count` numbers behind the sign of equality. */
static bool line_numbers(const RadianceHeader *in, int count, double *out)
{
    const char *at = strchr(in->text, '=') + 1;
    for (int i = 0; i < count; i++) {
        char *after;
        out[i] = strtod(at, &after);
        if (after == at || !isfinite(out[i])) return false;
        at = after;
    }
    return at[strspn(at, " \t")] == 0;
}

/* Takes off again what the values were multiplied by. */
static bool divide_by(const RadianceHeader *in, int count, const char *wanted,
                      LightScale *out)
{
    double factor[3];
    if (!line_numbers(in, count, factor)) return line_is_wrong(in, wanted);
    for (int i = 0; i < 3; i++) {
        double f = factor[count == 3 ? i : 0];
        if (!(f > 0)) return line_is_wrong(in, wanted);
        out->scale[i] /= f;
    }
    return true;
}

static bool set_primaries(const RadianceHeader *in, LightScale *out)
{
    double xy[8];
    if (!line_numbers(in, 8, xy) || !chromaticities_are_usable(xy))
        return line_is_wrong(in, "x and y of red, green, blue and white, of primaries that "
                             "light can be mixed from");
    out->has_matrix = !chromaticities_are_rec709(xy);
    if (out->has_matrix) out->rec709 = rec709_from_primaries(xy);
    return true;
}

static bool begins(const char *text, const char *with)
{
    return !strncmp(text, with, strlen(with));
}

/* Lines that are indented describe pictures that this one was made from, and do not count. */
static bool read_variable(const RadianceHeader *in, LightScale *out)
{
    if (begins(in->text, "EXPOSURE="))
        return divide_by(in, 1, "EXPOSURE= and a number above 0", out);
    if (begins(in->text, "COLORCORR="))
        return divide_by(in, 3, "COLORCORR= and three numbers above 0", out);
    if (begins(in->text, "PRIMARIES=")) return set_primaries(in, out);
    if (!begins(in->text, "FORMAT=") || begins(in->text, "FORMAT=32-bit_rle_rgbe"))
        return true;
    return line_is_wrong(in, "FORMAT=32-bit_rle_rgbe");
}

/* Rows from the top, each from the left: the one order that the decoder knows. */
static bool check_order(RadianceHeader *in)
{
    int width, height;
    if (!next_line(in))
        return error_at(in->err, ERROR_INPUT, in->name, "", "the header ends before the size");
    return sscanf(in->text, "-Y %d +X %d", &height, &width) == 2 ||
           line_is_wrong(in, "-Y HEIGHT +X WIDTH");
}

static bool read_radiance(const void *bytes, size_t size, const char *name, LightScale *out,
                          Error *err)
{
    RadianceHeader in = {.next = bytes, .end = (const char *)bytes + size, .name = name,
                         .err = err};
    while (next_line(&in) && in.text[0])
        if (!read_variable(&in, out)) return false;
    if (!check_order(&in)) return false;
    double y[3] = {0.2126, 0.7152, 0.0722}; /* of Rec.709's primaries */
    if (out->has_matrix)
        for (int i = 0; i < 3; i++)
            y[i] = 0.2126 * out->rec709.m[0][i] + 0.7152 * out->rec709.m[1][i] +
                   0.0722 * out->rec709.m[2][i];
    out->unit_cd_m2 = 0;
    for (int i = 0; i < 3; i++) {
        out->scale[i] *= RADIANCE_LM_W;
        out->unit_cd_m2 += y[i] * out->scale[i];
    }
    return true;
}

/* ---- OpenEXR ----------------------------------------------------------------------------- */

/* Colours are Rec.709's already once image_read_memory has been there. */
static bool read_exr(const void *bytes, size_t size, const char *name, LightScale *out,
                     Error *err)
{
    ExrReader *reader;
    if (!exr_reader_create(name, bytes, size, &reader, err)) return false;
    const ExrPicture *picture = exr_reader_picture(reader);
    double white = 1;
    for (int i = 0; i < picture->attribute_count; i++) {
        const ExrAttribute *a = &picture->attributes[i];
        if (a->kind == EXR_FLOAT && !strcmp(a->name, "whiteLuminance")) white = a->values[0];
    }
    exr_reader_destroy(reader);
    for (int i = 0; i < 3; i++) out->scale[i] = white;
    out->unit_cd_m2 = white;
    return (white > 0 && isfinite(white)) ||
           error_at(err, ERROR_INPUT, name, "whiteLuminance",
                    "is %g, wanted the cd/m2 of white, above 0", white);
}

/* ---- any picture ------------------------------------------------------------------------- */

static void apply(const LightScale *scale, const Image *image)
{
    const double *s = scale->scale;
    float        *rgba = (float *)image->pixels;
    size_t        count = (size_t)image->width * (size_t)image->height;
    if (s[0] == 1 && s[1] == 1 && s[2] == 1 && !scale->has_matrix) return;
    for (size_t i = 0; i < count; i++, rgba += 4) {
        for (int c = 0; c < 3; c++) rgba[c] = (float)((double)rgba[c] * s[c]);
        if (scale->has_matrix) colour_apply(&scale->rec709, rgba, rgba);
    }
}

bool light_picture_read(const void *bytes, size_t size, const char *name, Arena *arena,
                        LightPicture *out, Error *err)
{
    LightScale   scale = {.scale = {1, 1, 1}, .unit_cd_m2 = 1};
    LightPicture picture;
    bool is_radiance = size > 2 && !memcmp(bytes, "#?", 2);
    bool is_exr = size > 4 && !memcmp(bytes, "\x76\x2f\x31\x01", 4);
    if (is_radiance && !read_radiance(bytes, size, name, &scale, err)) return false;
    if (!image_read_memory(bytes, size, name, arena, &picture.image, err)) return false;
    if (is_exr && !read_exr(bytes, size, name, &scale, err)) return error_in_file(err, name);
    if (picture.image.format == IMAGE_RGBA32F) apply(&scale, &picture.image);
    picture.unit_cd_m2 = scale.unit_cd_m2;
    *out = picture;
    return true;
}
