/* SPDX-License-Identifier: Apache-2.0 */
/* light_file.h -- the one loader of files that hold light: frames and pictures of surroundings.
 *
 * OpenEXR as frame.h says, Radiance pictures as radiance_file.h says, and other pictures of
 * floats (TIFF), which are taken for cd m^-2 of Rec.709. Every command that reads light reads
 * it here, so that all of them see the same.
 *
 * Units    linear Rec.709, cd m^-2. Memory: the arena's. Threads: no shared state.
 * Fails    for a file that is no such one or that is damaged, and where what it states of its
 *          light cannot be: file, place, what was found. Of what is not read of it (further
 *          parts, the name of a colour space) there are warnings.
 */
#pragma once
#include "base/file.h"
#include "base/problems.h"
#include "image/frame.h"
#include "image/image.h"

typedef enum LightFormat { LIGHT_FILE_OPENEXR, LIGHT_FILE_RADIANCE, LIGHT_FILE_FLOATS } LightFormat;

typedef struct LightFile {
    LightFormat format;
    FrameImage frame;  /* of a Radiance picture: R, G, B, and VIEW= as "VIEW" */
    double unit_cd_m2; /* luminance of a white whose stored values are 1 */
} LightFile;

bool light_file_read(const char *path, Arena *arena, Problems *problems, LightFile *out,
                     Error *err);
bool light_file_read_memory(FileBytes bytes, const char *name, Arena *arena, Problems *problems,
                            LightFile *out, Error *err);

/* OpenEXR and Radiance, by the first bytes: what is never a picture of codes. */
bool light_file_recognise(const void *bytes, size_t size);

/* A decoded picture of floats. */
LightFile light_file_of_floats(const Image *image, Arena *arena);
