/* SPDX-License-Identifier: Apache-2.0 */
/* judge.h -- figures held against limits: margins and a verdict.
 *
 * A limit is kept when the whole 95 % interval of its figure keeps it, broken when the whole
 * interval breaks it, and too close to call when the limit lies within. A case is as bad as the
 * worst limit that counts: fail, then cannot be judged, then too close, then pass. Advice is
 * listed and does not count, nor does a limit of which the program measures no figure: of a
 * width, and of a shape that has no strokes their ratio (`found` NaN).
 *
 * A case cannot be judged (`unjudged`, in this order) where half of it is hidden or more, where
 * its panel says of itself that it is not usable, where no limit that counts applies to it,
 * where more than UNJUDGED_DATA_SHARE of the light that it reflects came via materials without
 * data (what hangs on the light: a height that fails fails all the same), and where a figure is
 * NaN.
 *
 * What must not be read (must_not_be_read) is held against limits of visual security alone
 * (vision/privacy.h): the profile's that apply in its light, or the assumed one, or the
 * review's own. It passes where S is surely as high as required, so that it cannot be read; a
 * contrast that misses a limit of reading is no such thing. The veil in the eye, which hides
 * more, does not count. Anything that is seen of it is judged; it passes, too, where nothing of
 * it is. Each of its images in glass (private_image.h) is held against the same limits, which
 * follow its own in the list; the case is as bad as the worst of all, and limit_id and margin
 * are those of the least margin.
 *
 * Memory   lists come from the arena.
 * Threads  pure functions but for the case that is passed in.
 * Fails    never.
 */
#pragma once
#include "review/profile.h"

/* Sets the case's ambient from its display_lux, where the condition itself names none. */
void judge_ambient(ReviewCase *review_case, const Profile *profile, bool sun_on_display);

/* The one place where contrasts are made: from the case's luminances and the interval of what
 * is reflected. Sets reflected_range, contrast_ratio, contrast_low, contrast_high and
 * contrast_with_veil (of no veil, NaN: contrast_ratio). The ends hold, besides that interval,
 * what the panel states of its own errors, each taken as normal and as independent of all else:
 * of what it reflects, and of each of the two luminances. */
void judge_contrasts(ReviewCase *review_case, MeanInterval reflected);

/* Sets open_by of a case that was judged. Errors fall as the root of the paths, but for a share
 * `fixed` of what sampling leaves in doubt, and for the panel's own. How far the true figure
 * lies from the limit is known as well as the figure is (normal, as wide as the interval says).
 * Where it more likely than not lies so near that those errors alone reach the limit, no paths
 * decide it. */
void judge_open(ReviewCase *review_case, double fixed);

/* Is it required, and is there something to hold against it? */
bool limit_counts(const LimitVerdict *limit);

/* From the case's ambient, contrasts and their interval, height, stroke_ratio, visible_share,
 * panel and without_data_share: sets limits, limit_count, limit_id, margin, verdict and
 * unjudged; of one that is not too close it clears open_by. limit_id is, among the
 * contrast limits that count, the one that requires the greatest ratio; margin is its margin.
 *
 * The levels of `visibilities` are made anew of the case's luminances; a limit of visibility is
 * about the least of them, an upper one about the greatest.
 *
 * A profile that uses the veil limits contrast_with_veil; its interval is that of
 * contrast_ratio seen through the veil, whose own doubt is not in it. */
void judge_case(ReviewCase *review_case, const Profile *profile, Arena *arena);

/* From what was read of a gaze and of its road: sets its limits, verdict and unjudged, and those
 * of its road's ages. It is by night where no sun is up. It cannot be judged where more than
 * UNJUDGED_DATA_SHARE of the road's veil came via materials without optical data, or from
 * displays whose panels say that they are not usable. */
void judge_gaze(GazeFinding *gaze, const Profile *profile, Arena *arena);

/* Held against the most that its area allows (INFINITY: the request sets none), or the profile
 * where that is less: sets has_limit and limit. Where it lies in no area that must be kept free
 * nothing is required. profile: or NULL. */
void judge_pane(struct PaneFinding *finding, const Profile *profile, Ambient ambient,
                double contrast_most);

/* Sets its limits and verdict; the sun is up. */
void judge_false_sun(ReviewFalseSun *sun, const Profile *profile, Arena *arena);
