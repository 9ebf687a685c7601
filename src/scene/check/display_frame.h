/* SPDX-License-Identifier: Apache-2.0 */
/* display_frame.h -- where a display stands and how large it is, as its triangles and its
 * content's coordinates say; and what of it cannot be meant.
 *
 * Units    metres, world; angles in degrees.
 * Memory   none. Threads: const data.
 */
#pragma once
#include "base/problems.h"
#include "scene/scene.h"

/* Sides of displays that are built: a segment of 5 mm, a dashboard from pillar to pillar. */
#define DISPLAY_LEAST_M 0.005
#define DISPLAY_MOST_M 1.5

/* Means over the area. right, up: of the picture, unit; normal: to the front. */
typedef struct DisplayFrame {
    Vec3 centre, right, up, normal;
    double width_m, height_m; /* along the surface, of what the coordinates span */
    float span[2];            /* that, in u and v: shares of the content */
} DisplayFrame;

/* Of one part that wears a display. False where its coordinates span no area. */
bool display_frame_of(const Scene *scene, const Part *part, DisplayFrame *out);

/* Whether a side is within what is built. */
bool display_side_is_plausible(double m);

/* How far a picture is turned, as whoever is at `eye` with `up` (unit) above sees it: 0 is
 * upright, 180 upside down, positive to the left. False where its front is not
 * seen within 60 degrees of the normal, or `up` is along the view. */
bool display_frame_turn(const DisplayFrame *frame, Vec3 eye, Vec3 up, double *degrees);

/* Beyond it a picture lies on its side. */
#define DISPLAY_TURN_MOST_DEG 60.0

/* "upside down", "on its left side", "on its right side", by a turn beyond that. */
const char *display_turn_words(double degrees);

/* Between where a vehicle points and where an eye in it looks. */
#define FORWARD_MOST_DEG 45.0

/* The angle between two directions seen from above (+Y), 0 to 180 degrees; false where one of
 * them is vertical. */
bool forward_angle_deg(const double forward[3], const double way[3], double *degrees);

/* A warning where an environment turns the scene by a heading or a forward, and no camera that
 * looks at a display looks that way. */
void forward_doubt(const Scene *scene, Problems *problems);

/* Warnings: a size that is not built or a shape that is not the content's, unless the display
 * has `any_size`; a picture that no camera that looks at it sees upright. */
void displays_doubt(const Scene *scene, Problems *problems);
