/* SPDX-License-Identifier: Apache-2.0 */
#include "image/light/radiance_picture.h"

#include <math.h>
#include <string.h>

#include "base/file_write.h"
#include "image/colour.h"
#include "image/frame_view.h"
#include "image/radiance_file.h"

/* x, y of red, green, blue and white: Radiance's default. */
static const double RADIANCE_CHROMATICITIES[8] = {0.640, 0.330, 0.290,   0.600,
                                                  0.150, 0.060, 1.0 / 3, 1.0 / 3};

/* Keeps the luminance, of which white has as much of each component. */
static void move_into_gamut(const double y[3], double rgb[3]) {
    double white = y[0] * rgb[0] + y[1] * rgb[1] + y[2] * rgb[2];
    double least = fmin(rgb[0], fmin(rgb[1], rgb[2]));
    bool is_dark = !(white > 0) || !isfinite(white);
    for (int i = 0; i < 3; i++) {
        if (is_dark) rgb[i] = 0;
        else if (least < 0) rgb[i] = white + (rgb[i] - white) * white / (white - least);
    }
}

/* Exponents of pixels have 8 bits: beyond them light is black, or as bright as can be. */
static void pack(const double rgb[3], uint8_t out[4]) {
    double most = fmax(rgb[0], fmax(rgb[1], rgb[2]));
    int exponent;
    memset(out, 0, 4);
    frexp(most, &exponent);
    if (!(most > 0) || exponent < -127) return;
    if (exponent > 127) exponent = 127;
    for (int i = 0; i < 3; i++) out[i] = (uint8_t)fmin(fmax(ldexp(rgb[i], 8 - exponent), 0), 255);
    out[3] = (uint8_t)(exponent + 128);
}

static char *header_of(const FrameImage *frame, const char *command, Arena *arena, Error *err) {
    FrameView view;
    const char *words, *software = frame_string(frame, "software");
    const ExrWindow d = frame->data;
    if (!frame_view_find(frame, &view, err) || !frame_view_words(&view, d, arena, &words, err))
        return NULL;
    const double *c = RADIANCE_CHROMATICITIES;
    return arena_format(arena,
                        "#?RADIANCE\n%s\nSOFTWARE= %s\nVIEW= %s\n"
                        "PRIMARIES= %.4f %.4f %.4f %.4f %.4f %.4f %.4f %.4f\n"
                        "EXPOSURE= 1\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n",
                        command, software ? software : "parhelion", words, c[0], c[1], c[2], c[3],
                        c[4], c[5], c[6], c[7], d.y1 - d.y0, d.x1 - d.x0);
}

/* Plain pixels, which every reader takes: none looks like a run, since one component of a code
 * is at least 128. */
static void pack_all(const FrameImage *frame, const float *const rgb[3], uint8_t *out) {
    ColourMatrix rec709 = rec709_from_primaries(RADIANCE_CHROMATICITIES);
    ColourMatrix xyz = xyz_from_primaries(RADIANCE_CHROMATICITIES);
    ColourMatrix own = colour_inverse(&rec709);
    size_t count = frame_pixel_count(frame);
    for (size_t i = 0; i < count; i++, out += 4) {
        double c[3];
        for (int k = 0; k < 3; k++)
            c[k] = (own.m[k][0] * (double)rgb[0][i] + own.m[k][1] * (double)rgb[1][i] +
                    own.m[k][2] * (double)rgb[2][i]) /
                   RADIANCE_LM_W;
        move_into_gamut(xyz.m[1], c);
        pack(c, out);
    }
}

bool radiance_picture_write(const char *path, const FrameImage *frame, const char *command,
                            Arena scratch, Error *err) {
    FileWriter writer;
    const float *rgb[3];
    char *header = header_of(frame, command, &scratch, err);
    if (!header) return error_in_file(err, path);
    if (!frame_rgb(frame, "", rgb))
        return error_at(err, ERROR_INPUT, path, "", "the frame has no channels R, G, B");
    size_t size = frame_pixel_count(frame) * 4;
    uint8_t *pixels = ARENA_NEW(&scratch, uint8_t, size);
    pack_all(frame, rgb, pixels);
    if (!file_writer_open(path, &writer, err)) return false;
    return file_writer_add(&writer, header, strlen(header), err) &&
           file_writer_add(&writer, pixels, size, err) && file_writer_commit(&writer, err);
}
