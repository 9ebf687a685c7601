/* SPDX-License-Identifier: Apache-2.0 */
/* webp.h -- decodes WebP pictures, lossy and lossless, not animated.
 *
 * The library for all pictures (openimageio/image_file.h) would multiply the colours by alpha
 * and round them, which cannot be undone.
 *
 * By libwebp.
 * Threads  no state. Memory: the caller's, and libwebp's own while it reads.
 * Fails    with what is wrong with the picture.
 */
#pragma once
#include <stddef.h>

#include "base/error.h"

/* width, height: 1 to 16384 each. Only the file's beginning is looked at. */
bool webp_size(const void *bytes, size_t size, int *width, int *height, Error *err);

/* rgba: 4 * width * height bytes, from the top, alpha straight. */
bool webp_read(const void *bytes, size_t size, unsigned char *rgba, Error *err);
