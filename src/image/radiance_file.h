/* SPDX-License-Identifier: Apache-2.0 */
/* radiance_file.h -- a Radiance picture (.hdr) as it is stored, and what its header states.
 *
 * Radiance (.hdr) holds radiance, W m^-2 sr^-1, times all its EXPOSURE= and COLORCORR= (several
 * multiply; each is divided out again), in the primaries of PRIMARIES=, or as CIE XYZ where
 * FORMAT= says so; times 179 lm/W it is luminance (Radiance's file formats and WHTEFFICACY,
 * G. Ward). A code stands for the middle of its step, (m + 1/2) 2^(e - 136), as in Radiance's
 * tools (G. Ward, "Real Pixels", Graphics Gems II, 1991). Without PRIMARIES= colours are taken
 * as Rec.709, which is what other programs mean that write none; Radiance itself would mean its
 * own primaries and equal-energy white. Lines that are indented describe pictures that this one
 * was made from, and do not count. Pixels are plain, in runs of old (a pixel of 1, 1, 1 repeats
 * the one before) or of new kind, in any of the eight orders that a size can state.
 *
 * Memory   pixels from the arena. Threads: no shared state.
 * Fails    for a header or pixels that are wrong: file, line or row, what was found.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "image/colour.h"

#define RADIANCE_LM_W 179.0 /* Radiance's white efficacy, lm/W */

typedef struct RadianceFile {
    int width, height; /* upright */
    double scale[3];   /* stored values times these are cd m^-2 of the primaries */
    bool has_matrix;   /* these are not Rec.709's */
    ColourMatrix rec709;
    double unit_cd_m2;           /* luminance of a white whose stored values are 1 */
    const char *view;            /* behind the last VIEW=, as Radiance's tools take it; NULL */
    const unsigned char *pixels; /* behind the header */
    size_t size;
    int count, length;                 /* scan lines, and the pixels of each */
    long first, line_step, pixel_step; /* of the upright picture's pixels */
} RadianceFile;

bool radiance_recognise(const void *bytes, size_t size);

/* The header. bytes must outlive it. */
bool radiance_open(const void *bytes, size_t size, const char *name, Arena *arena,
                   RadianceFile *out, Error *err);

/* rgba: width * height pixels from the upper left, as they are stored; alpha 1. */
bool radiance_read(const RadianceFile *file, Arena scratch, float *rgba, Error *err);
