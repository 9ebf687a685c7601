/* SPDX-License-Identifier: Apache-2.0 */
/* picture_png.h -- a picture becomes a PNG, by libpng.
 *
 * It needs no thread and no library that has to be loaded first: a picture that is finished can
 * be kept however little the machine still gives.
 *
 * Memory   the file lies in the arena; libpng has some rows of its own.
 * Threads  no state.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "base/file.h"
#include "openimageio/image_file_types.h"

/* Of 8 or 16 bits. The same input gives the same bytes. */
bool picture_png_encode(const ImageToEncode *image, Arena *arena, FileBytes *out, Error *err);
