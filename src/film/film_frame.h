/* SPDX-License-Identifier: Apache-2.0 */
/* film_frame.h -- the film as a frame: means of the sums, channel by channel.
 *
 * Memory   the frame lies in the arena.
 */
#pragma once
#include "base/error.h"
#include "film/film.h"
#include "image/frame.h"

/* The frame as frame.h describes it, with R, G, B and the layers requested. Rules:
 *   depth, position, normal, albedo, uv   mean over the samples that hit something (a mean of
 *       unit normals is shorter than one across an edge); NaN where none did. A sample whose
 *       features are not finite counts as a miss here, not for the light;
 *   id.part, id.display   of the lowest sample index that hit a part, or saw a display; -1;
 *       id.display comes with every layer of displays;
 *   display.*   over the samples that saw a display, NaN where none did: emitted, white and
 *       black are means, reflected is the mean of (sample - emitted), so the pixel's mean minus
 *       emitted wherever the whole pixel is display; theta and phi are those of the mean
 *       direction; contrast is the ratio of mean luminances. display.fine is what displays send
 *       to the whole pixel, and display.coverage the share of its samples that saw one: emitted
 *       times coverage is the same as fine, but from these samples alone. Coverage is 0 where
 *       fine is NaN;
 *       display.variance is the variance of the mean of emitted + reflected over these samples,
 *       as if they were independent; NaN below two of them; samples.N comes with it.
 *       display.extrapolated: shares, 0 to 1, of the luminance emitted and of that reflected,
 *       that left in directions (and came from such) that the panel extrapolates;
 *       display.second: where samples saw another display than id.display's, the mean of its
 *       light (emitted + reflected), display.second.variance as above, the share of the
 *       pixel's samples that saw it and its id; elsewhere NaN, NaN, 0 and -1, and NaN, NaN, 0
 *       and -2 where there are several others. All other layers of such a pixel are of its
 *       displays together;
 *   emitted   mean over all samples of what surfaces other than displays send to the eye
 *       themselves: lamps, lit signs;
 *   stokes.S0 .. S3   mean over all samples of the luminance and of its other Stokes
 *       parameters, in the camera's axes (path/polarised.h): S1 > 0 horizontal; stokes.degree
 *       is the polarised share of these means, NaN where it is dark;
 *   light.NAME.{R,G,B}   mean over all samples of what a group of lights gave: the groups' sums
 *       add up to the frame's exactly, these floats within 2^-19 of the pixel's brightest of R,
 *       G, B (16 roundings; measured 2^-20.8);
 *   halves   the weighted difference of two interleaved halves of the samples: its square has
 *       the expectation of the variance of the pixel's mean, if the halves are independent.
 *       Sobol points' halves fill each other's gaps: measured between frames of two seeds, its
 *       root mean square is 0 to 6 % too large at 32 samples, 12 % at 256 (that of `variance`
 *       7 to 29 %). NaN below 24 samples: the smaller half has 8 of them there;
 *   display.halves   the same of display.reflected, over the samples that saw a display.
 * With LAYER_ROUNDED the layers of noise (variance, halves, of displays too) have 8 bits. */
FrameImage film_to_frame(const Film *film, int attribute_room, Arena *arena);

/* The same with these layers alone, as far as the film has them: for looking. */
FrameImage film_to_picture(const Film *film, unsigned layers, int attribute_room, Arena *arena);

/* The same for frame_write alone: its planes hold some rows, which are made as they are written.
 * The film must stay as it is until then. */
FrameImage film_to_rows(const Film *film, int attribute_room, Arena *arena);

/* The fewest samples from index `first` on of which `halves` is known. */
uint32_t film_halves_samples(uint32_t first);

/* False: the arena has no room for it, and hours of rendering would end without a frame. */
bool film_has_room(const Film *film, const Arena *arena, Error *err);

/* What it takes at least, with so many groups of lights: numbers of one channel are left
 * out. */
size_t film_frame_bytes(FilmRect crop, unsigned layers, int light_count);
