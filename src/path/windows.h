/* SPDX-License-Identifier: Apache-2.0 */
/* windows.h -- thin sheets on a path's way: panes, films, holes. HOT.
 *
 * The first ones that an eye's ray meets are followed both ways, straight behind and what they
 * show themselves: by chance, one sample in twelve would show the cabin's mirror image and not
 * the street, noise that everyone sees.
 */
#pragma once
#include "path/path_collector.h"

/* Is this a sheet that is followed both ways now? Then one of splits_left is used up. */
bool sheet_is_followed(PathState *path, const Surface *surface);

/* Memory of a path that follows the light of a sheet itself. */
typedef struct SheetRoom {
    SheetStack stack;
    _Alignas(64) char collectors[COLLECTORS_MAX_BYTES];
} SheetRoom;

/* *branch: the path once more, with collectors of its own; what it finds is its own. It keeps
 * the path's stack. */
void sheet_branch(const PathState *path, SheetRoom *room, PathState *branch);

/* Does this sample follow it? *sheet: the path that does, at the sheet. */
bool sheet_is_shown(PathState *path, const Surface *surface, SheetRoom *room, PathState *sheet);

/* *mirror: how the path leaves a window, by its mirror; false: it ends. *pane: what is shaded
 * instead of a laminated pane, its images and its haze; false: it is none. */
bool window_reflects(PathState *sheet, const Surface *surface, Vec3 wo, BsdfSample *mirror);
bool pane_shows_itself(const Surface *surface, Surface *pane);

/* The path itself is followed straight through. */
void sheet_pass(PathState *path, const Surface *surface, Vec3 wo);

/* Where a ray along `way` enters a plate of clear solid glass, the surface becomes that thick
 * pane, which refers to *plate. */
void plate_meet(const PathState *path, const Hit *hit, Vec3 way, Surface *surface, Plate *plate);

/* Goes straight on behind the surface, a hole or a window: first to what else lies in its
 * plane, then past it, from where an opaque surface in the same plane is still met. */
void sheet_go_behind(PathState *path, const Surface *surface);

/* Start of the image of a pane's far face that leaves along wi, `along` m along the surface
 * from the hit. False: the pane's frame, or something else opaque, stands before it. */
bool pane_image_start(const PathState *path, const Surface *surface, Vec3 wi, float along,
                      Vec3 *out);
