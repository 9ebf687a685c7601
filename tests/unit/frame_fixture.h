/* SPDX-License-Identifier: Apache-2.0 */
/* frame_fixture.h -- frames of known light. */
#pragma once
#include "fixture.h"

#include "image/frame.h"

/* Every pixel of R, G, B holds cd_m2 of D65. */
static inline FrameImage uniform_frame(int width, int height, float cd_m2, Arena *arena) {
    ExrWindow whole = {0, 0, width, height};
    FrameImage frame = frame_create(width, height, whole, 3, 0, arena);
    for (int c = 0; c < 3; c++) {
        char name[2] = {"RGB"[c], 0};
        float *plane = frame_add_channel(&frame, name, false, arena);
        for (int i = 0; i < width * height; i++) plane[i] = cd_m2;
    }
    return frame;
}
