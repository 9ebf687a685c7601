/* SPDX-License-Identifier: Apache-2.0 */
/* inherited.h -- what the variants of a review take over from it instead of making it anew:
 * guides of its moments, and clear skies.
 *
 * A guide directs paths and biases no reading. It takes long to train, and where a display is
 * tilted or gets a hood light comes from about where it came before. So a guide that was
 * trained in the review's own scene serves variants, too, and readings with one guide have more
 * of their noise in common. A clear sky depends on sun, air and ground alone.
 *
 * Memory   an arena of its own, until inherited_end: up to 5 MB a moment, 2 MB a sky.
 * Threads  one at a time; skies are built by as many as their input sets.
 */
#pragma once
#include "guide/guide_file.h"
#include "review/request/request.h"

typedef struct Inherited Inherited;

/* For a review, whose request must outlive it. To be ended. */
Inherited *inherited_start(const ReviewRequest *request);
void       inherited_end(Inherited *inherited); /* NULL is fine */

/* Where the review's guide of a condition is to lie, and that it lies there now. */
Arena *inherited_room(Inherited *inherited);
void   inherited_keep_guide(Inherited *inherited, int condition_id, const LightGuide *guide,
                            const GuideScene *scene);

/* For a variant's request. NULL: the review has none, or another scene. */
const LightGuide *inherited_guide(const Inherited *inherited, const ReviewRequest *variant,
                                  int condition_id, const GuideScene *scene);

/* daylight_build of a clear sky whose sun has no time, once for all who need it. Lasts until
 * the next is requested. NULL: that failed. */
const Daylight *inherited_sky(Inherited *inherited, const DaylightInput *input, Error *err);
