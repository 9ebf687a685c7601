/* SPDX-License-Identifier: Apache-2.0 */
/* render_setup.h -- what of a scene is looked at, and with which light.
 *
 * Fails    with the cameras that there are.
 */
#pragma once
#include "base/problems.h"
#include "cli/options/cli.h"
#include "scene/scene.h"

/* The command line's choice; NULL and false: the scene's. */
typedef struct CameraChoice {
    const char *name;          /* a node's, a camera's, or an index */
    double eye[3], look_at[3]; /* m, world */
    double fov_deg;            /* full vertical angle */
    int projection;            /* a PROJECTIONS name's place */
    bool has_eye, has_look_at, has_fov;
} CameraChoice;

/* The first: as the camera is. Radiance's -vta and evalglare mean the second. */
#define PROJECTIONS "perspective|fisheye|equidistant|equisolid"

#define PROJECTION_OPTION(choice) \
    {"--projection", OPTION_CHOICE, PROJECTIONS, \
     "a fisheye sees half the space, 180 degrees in a circle: equidistant, or equal areas of " \
     "equal solid angle (default perspective: as the camera is)", \
     &(choice)->projection}

/* Rows of an option table; `choice` is a CameraChoice *. */
#define CAMERA_OPTIONS(choice) \
    {"--camera", OPTION_TEXT, "NAME|INDEX", "node's or camera's name, or place (default 0)", \
     &(choice)->name}, \
        PROJECTION_OPTION(choice), \
        {"--eye", \
         OPTION_NUMBERS, \
         "X,Y,Z", \
         "instead of a camera: where the eye is, m", \
         (choice)->eye, \
         .low = -1e6, \
         .high = 1e6, \
         .count = 3, \
         .given = &(choice)->has_eye}, \
        {"--look-at", \
         OPTION_NUMBERS, \
         "X,Y,Z", \
         "with --eye: a point in the middle of the picture", \
         (choice)->look_at, \
         .low = -1e6, \
         .high = 1e6, \
         .count = 3, \
         .given = &(choice)->has_look_at}, \
    { \
        "--fov", OPTION_NUMBER, "DEG", "with --eye: the picture's height as an angle (40)", \
            &(choice)->fov_deg, .low = 0.01, .high = 179, .given = &(choice)->has_fov \
    }

/* From --eye to --look-at; else by a node's name, then a camera's, then an index; else the
 * first. A scene without a camera is framed (camera_frame_scene), with a warning. */
bool render_choose_camera(const Scene *scene, const CameraChoice *choice, Problems *problems,
                          SceneCamera *out, Error *err);

/* "camera": as it is; "equidistant", "equisolid". */
const char *render_projection_name(const CameraChoice *choice);

/* The picture's pixels, across and down; given: as typed, else they are set. A fisheye's is a
 * square. */
bool render_check_size(const CameraChoice *choice, bool given, int size[2], Error *err);

/* False of one that lies outside a fisheye's circle. pixel: whole numbers. */
bool render_check_pixel(const SceneCamera *camera, const int size[2], const double pixel[2],
                        Error *err);

/* A warning when nothing of the scene can send light: the frame will be black. */
void render_warn_of_darkness(const Scene *scene, Problems *problems);
