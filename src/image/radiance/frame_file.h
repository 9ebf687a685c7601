/* SPDX-License-Identifier: Apache-2.0 */
/* frame_file.h -- a frame from any file of light: OpenEXR, or a Radiance picture.
 *
 * Memory   the arena's. Threads: no shared state.
 * Fails    as frame_read and radiance_picture_read.
 */
#pragma once
#include "image/frame.h"

bool frame_file_read(const char *path, Arena *arena, FrameImage *out, Error *err);
