/* SPDX-License-Identifier: Apache-2.0 */
/* windows.h -- thin sheets on a path's way: panes, films, holes. HOT.
 *
 * The first ones that an eye's ray meets are followed both ways, straight behind and what they
 * show themselves: by chance, one sample in twelve would show the cabin's mirror image and not
 * the street, noise that everyone sees.
 */
#pragma once
#include "path/path_collector.h"

/* Is this a sheet that is followed both ways now? One of those that may be is used up. */
bool sheet_is_followed(PathState *path, const Surface *surface);

/* What a path needs room for besides, that follows what a sheet shows itself. */
typedef struct SheetRoom {
    SheetStack stack;
    _Alignas(64) char collectors[COLLECTORS_MAX_BYTES];
} SheetRoom;

/* Does this sample follow it? *sheet: the path that does, at the sheet. */
bool sheet_is_shown(PathState *path, const Surface *surface, SheetRoom *room, PathState *sheet);

/* How the path there leaves the sheet, if that is a window: by its mirror. False: it ends. Of a
 * laminated pane *pane is what is shaded instead: its images and its haze. */
bool window_reflects(PathState *sheet, const Surface *surface, Vec3 wo, BsdfSample *mirror);
bool pane_shows_itself(const Surface *surface, Surface *pane);

/* The path itself is followed straight through. */
void sheet_pass(PathState *path, const Surface *surface, Vec3 wo);

/* Goes straight on behind the surface, a hole or a window: to what else lies there; then past
 * it, from where an opaque surface in the same plane is still met. */
void sheet_go_behind(PathState *path, const Surface *surface);

/* Where the image of a pane's far face starts, whose way leaves along wi and begins so many m
 * along the surface from where that was met. False: the pane's frame, or what else is opaque,
 * stands before it. */
bool pane_image_start(const PathState *path, const Surface *surface, Vec3 wi, float along,
                  Vec3 *out);
