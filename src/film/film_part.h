/* SPDX-License-Identifier: Apache-2.0 */
/* film_part.h -- the film's exact sums as a second part of a frame's file, and back.
 *
 * A frame holds means in single precision, which cannot be added up exactly. So a frame that
 * is a part of another (some samples, some pixels) carries the sums themselves, from which any
 * number of parts, in any order, make the very film that one run would have made.
 *
 * File     an OpenEXR part named "film" of unsigned 32-bit channels, behind the part "picture"
 *          and in its windows. At 64 samples a pixel it takes about 70 bytes a pixel, 150 with
 *          all layers.
 *          A sum is a two's complement number of four words, NAME.0 (least) to NAME.3, that
 *          counts steps (film.h):
 *            xyz.{X,Y,Z}                     of the samples
 *            squares.{R,G,B}.{low,high}      of the squares below and above the split
 *            odd.{X,Y,Z}                     of the samples in every second block
 *            depth.Z position.{X,Y,Z} normal.{X,Y,Z} albedo.{R,G,B} uv.{U,V}
 *            emitted reflected white black .{X,Y,Z}, direction.{X,Y,Z}    displays
 *            fine mirror lambertian .{X,Y,Z}, extrapolated.{E,R}    displays
 *            display_squares.{R,r,G,g,B,b}   of displays' light, below and above the split
 *            shared.{1,2,3,X,Y,Z,R,r,G,g,B,b}  powers of displays' ids, in ones; id times XYZ
 *                                            and squares, of which those below the split in
 *                                            steps of 2^-45
 *            stokes.{1,2,3}, sources.{X,Y,Z} of the samples
 *            light.N.{X,Y,Z}                 group N of lights
 *          and words that are one channel each: samples, hits, displayHits, odd.samples, the
 *          lowest sample index that hit a part, or saw a display, and which (4294967295: none):
 *          part.sample, part.id, display.sample, display.id.
 *          Attributes state the sizes of the steps, the layers, the samples' range, what was
 *          dropped, what it cost, and a checksum of all of it; with groups of lights also their
 *          names, a line each.
 * Memory   the arena's; reading takes bands of rows, not the whole part.
 * Threads  one part belongs to one thread at a time.
 * Fails    with the reason; the file is the caller's to name.
 */
#pragma once
#include "film/film.h"
#include "image/frame.h"

typedef struct FilmPart {
    const char *name;  /* of the file, for messages; not in the file */
    int width, height; /* of the whole frame */
    FilmRect crop;
    unsigned layers;
    FilmLights lights;
    uint32_t first_sample, end_sample; /* half-open, of the frame: of these
                                          every pixel has had its share */
    uint32_t asked_end; /* where the run was to end: above end_sample when it was stopped */
    FilmDropped dropped;
    uint64_t paths, camera_rays, bounce_rays, shadow_rays; /* what the samples cost */
} FilmPart;

/* Pixels times samples. */
uint64_t film_part_volume(const FilmPart *part);

/* Describes a film of samples [first_sample, end_sample); name and costs are left empty. */
FilmPart film_part_of(const Film *film, uint32_t first_sample, uint32_t end_sample);

/* Lets the frame carry the film's sums into its file. The film must stay as it is until the
 * frame is written. */
void film_part_attach(FrameImage *frame, const Film *film, const FilmPart *part, Arena *arena);

/* ---- and back ---------------------------------------------------------------------------- */

/* A file that is read band by band. */
typedef struct FilmPartReader {
    ExrReader *file;
    FilmPart part;
    uint64_t checksum, wanted_checksum;
    int next_y; /* the row that comes next; part.crop.y1: all is read */
} FilmPartReader;

/* Refuses frames that carry no sums, and sums that this program does not know (ERROR_MACHINE). The
 * names of lights are the arena's. */
bool film_part_open(const char *path, Arena *arena, FilmPartReader *out, Error *err);

/* Adds the next band of rows to a film of the same layers whose crop holds the part's. With
 * the last band come the dropped samples and the check of the checksum: until then, and after
 * a failure, the film is worth nothing. */
bool film_part_add_band(FilmPartReader *from, Film *to, Arena scratch, Error *err);

void film_part_close(FilmPartReader *from);
