/* SPDX-License-Identifier: Apache-2.0 */
/* radiance_picture.h -- a frame as a Radiance picture (.hdr).
 *
 * Written  W m^-2 sr^-1 in Radiance's own primaries and equal-energy white, as PRIMARIES= says:
 *          179 (0.265 R + 0.670 G + 0.065 B) is the luminance, which is how evalglare and
 *          Radiance's tools take any picture. 8 bits a component and one exponent a pixel; a
 *          code is the whole steps of a value, and stands for the middle of its step: a
 *          luminance is right within 0.4 %, and in the mean. Light out of the primaries' gamut
 *          moves towards white of its luminance; what is not finite or below 0 is black. The
 *          view is VIEW= (frame_view.h); of a frame's layers R, G, B alone are there.
 *          Source: G. Ward, "Radiance File Formats".
 * Fails    as frame.h: with the file's name; a write that fails leaves nothing.
 */
#pragma once
#include "image/frame.h"

/* command: a line of the header, in which Radiance's tools say what made a picture. */
bool radiance_picture_write(const char *path, const FrameImage *frame, const char *command,
                            Arena scratch, Error *err);
