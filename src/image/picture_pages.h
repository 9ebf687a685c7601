/* SPDX-License-Identifier: Apache-2.0 */
/* picture_pages.h -- what a picture's file holds besides the one picture that is read of it:
 * further pages of a TIFF, frames of a GIF or PNG that moves, elements of a DPX, a PNM's further
 * pictures.
 *
 * A TIFF's smaller copies of a page are none; what is damaged ends the count.
 * Memory   none. Threads: pure functions.
 */
#pragma once
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

typedef struct PicturePages {
    int count; /* at least 1 */
    const char *name;
    uint64_t digest; /* of the bytes of all behind the first; 0: of one */
} PicturePages;

PicturePages picture_pages(const void *bytes, size_t size);

/* False where there are several, for who reads one. */
bool picture_pages_check(const void *bytes, size_t size, const char *name, Error *err);
