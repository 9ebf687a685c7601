/* SPDX-License-Identifier: Apache-2.0 */
/* frame.h -- a frame: named float channels over a data window, and a note of what made it.
 *
 * Units    R, G, B linear Rec.709/D65 in cd m^-2; the other channels as in the table.
 * Layout   planar, row 0 at the top; windows are half-open, the display window starts at 0, 0
 *          in frames that this program writes.
 * Memory   names, values and attributes come from the arena that is passed in.
 * Threads  plain data; one thread builds it.
 * Fails    reading and writing do, with the file's name; a write that fails leaves nothing.
 *
 * Channels (a layer is what stands before the last dot):
 *   R G B                                 cd m^-2, negative values kept
 *   xyz.{X,Y,Z}                           CIE XYZ, Y in cd m^-2
 *   depth.Z                               m along the ray
 *   position.{X,Y,Z}  normal.{X,Y,Z}      world, m (as 32-bit numbers) and unit
 *   albedo.{R,G,B}                        linear Rec.709
 *   id.part  id.display                   whole numbers, -1 none
 *   uv.{U,V}
 *   variance.{R,G,B}                      variance of the pixel's mean, (cd m^-2)^2
 *   halves.{R,G,B}                        cd m^-2, signed: from two halves of the samples; the
 *                                         square is the variance of the pixel's mean in the
 *                                         mean over pixels (film.h)
 *   samples.N                             whole number
 *   light.NAME.{R,G,B}                    cd m^-2, what one group of lights gives; the groups
 *                                         add up to R, G, B (film_frame.h)
 *   stokes.{S0,S1,S2,S3}                  cd m^-2, of the luminance, as the camera sees it:
 *                                         S1 > 0 swings horizontally, S2 > 0 from lower left
 *                                         to upper right, S3 > 0 turns clockwise
 *   stokes.degree                         sqrt(S1^2 + S2^2 + S3^2) / S0, NaN in the dark
 *   display.{emitted,reflected,white,black,fine}.{R,G,B}   cd m^-2, NaN off displays;
 *                                         what the panes before them let through
 *   display.{mirror,scattered}.{R,G,B}    the two parts of the reflected;
 *   display.{haze,lambertian}.{R,G,B}     the two parts of the scattered
 *   display.halves.{R,G,B}                what halves is of the reflected alone
 *   display.theta  display.phi            degrees, NaN off displays
 *   display.variance.{R,G,B}              what variance is of emitted + reflected, over the
 *                                         samples that saw a display
 *   display.second.{R,G,B}  display.second.variance.{R,G,B}  display.second.coverage
 *   id.second                             of pixels that saw two displays: light of the one
 *                                         that is not id.display's, its variance, its share,
 *                                         its number
 *   display.contrast                      (white + reflected) / (black + reflected), NaN off
 *   display.extrapolated.{emitted,reflected}   shares of these luminances by directions that
 *                                         were not measured, NaN off
 *   display.coverage                      share of the pixel's samples that saw a display
 * Attributes that give the numbers of id.* their names (strings):
 *   "parhelion:part.N"     name of part N
 *   "parhelion:display.N"  name of display N (its material)
 *   "parhelion:light.NAME" what the scene calls the group of lights NAME
 * A frame of some samples or pixels, that can be merged with others, has a second part in its
 * file for `words` (film/film_part.h describes them); readers take the first and leave
 * `words` NULL.
 */
#pragma once
#include "base/arena.h"
#include "image/colour.h"
#include "openexr/exr_file.h"

/* The contents of an OpenEXR file; `Frame` is an orthonormal frame (base/vec.h). */
typedef ExrPicture FrameImage;

/* An empty frame of width x height pixels whose data window is `data`, with room for some
 * channels and attributes; more may be added. It carries the chromaticities of Rec.709 and
 * whiteLuminance 1 already. */
FrameImage frame_create(int width, int height, ExrWindow data, int channel_room, int attribute_room,
                        Arena *arena);

/* Pixels in the data window. */
static inline size_t frame_pixel_count(const FrameImage *frame) {
    return (size_t)(frame->data.x1 - frame->data.x0) * (size_t)(frame->data.y1 - frame->data.y0);
}

/* Adds a channel and returns its zeroed values, one for each pixel of the data window, or of
 * `rows->count` of its rows. The name is copied; it must be new. */
float *frame_add_channel(FrameImage *frame, const char *name, bool is_whole, Arena *arena);

/* Adds an attribute or replaces the one of that name. */
void frame_set_string(FrameImage *frame, const char *name, const char *text, Arena *arena);
void frame_set_number(FrameImage *frame, const char *name, double value, Arena *arena);
void frame_set_whole(FrameImage *frame, const char *name, int value, Arena *arena);

/* A kind of its own, as the OpenEXR standard requires it for a few names ("worldToCamera"
 * EXR_MATRIX44, "expTime" EXR_FLOAT ...). values: as many as the kind has. */
void frame_set_values(FrameImage *frame, const char *name, ExrKind kind, const double *values,
                      Arena *arena);

/* NULL when there is none. */
const float *frame_channel(const FrameImage *frame, const char *name);
const ExrAttribute *frame_attribute(const FrameImage *frame, const char *name);
const char *frame_string(const FrameImage *frame, const char *name);

/* The R, G, B channels of a layer ("" is the frame itself); false when one is missing. */
bool frame_rgb(const FrameImage *frame, const char *layer, const float *rgb[3]);

/* The frame with these planes in place of its R, G, B, which it has; the rest is shared. */
FrameImage frame_with_rgb(const FrameImage *frame, float *const planes[3], Arena *arena);

/* The number that names a display (or "part") in id.*, -1 when there is none such. what is
 * "display" or "part". */
int frame_id_of(const FrameImage *frame, const char *what, const char *name);

/* The names of all displays with commas, "none" without any: for messages. */
const char *frame_display_names(const FrameImage *frame, Arena *arena);

/* OpenEXR, ZIP, the same bytes for the same frame; written under a temporary name beside
 * `path`, flushed to the disk, then renamed: after a failure nothing is left. */
bool frame_write(const char *path, const FrameImage *frame, Error *err);

/* The first part of an OpenEXR file, which is flat; a data window that reaches out of the
 * display window is kept so. What the file states of its light is applied: layers R, G, B are
 * times its whiteLuminance and of Rec.709, whatever its chromaticities (layer albedo: these
 * alone); X, Y and Z without R are CIE XYZ and become R, G and B, and so does Y alone, a grey. What
 * was stated is kept as "parhelion:whiteLuminance" and "parhelion:chromaticities". */
bool frame_read(const char *path, Arena *arena, FrameImage *out, Error *err);

/* What takes the colours that the attributes state to Rec.709; false where they are that
 * already, as they are without a statement. */
bool frame_needs_rec709(const FrameImage *frame, ColourMatrix *out);

/* The same for a file that lies in memory; `name` is for messages. */
bool frame_read_memory(const void *bytes, size_t size, const char *name, Arena *arena,
                       FrameImage *out, Error *err);
