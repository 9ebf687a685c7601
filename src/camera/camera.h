/* SPDX-License-Identifier: Apache-2.0 */
/* camera.h -- a film position becomes a ray, and a part of the scene a box on the film.
 *
 * Frame    glTF's camera: looks along -Z, +Y up; film x to the right, y down, (0,0) the upper
 *          left corner of the frame, in pixels.
 * Fisheye  sees half the space in the greatest circle about the frame's middle, and nothing
 *          outside of it (image/fisheye.h). A pixel that the circle cuts stands for its part
 *          within.
 */
#pragma once
#include "base/sampler.h"
#include "bvh/ray.h"
#include "scene/scene.h"

typedef struct Camera {
    Transform world_from_camera; /* unit axes */
    bool is_perspective;         /* rays from one point: of a fisheye, too */
    Fisheye fisheye;
    float half_width, half_height; /* perspective: at distance 1; orthographic: metres; fisheye:
                                      radii of its circle */
    int width, height;             /* pixels */
} Camera;

/* The vertical field of view (or magnification) is kept; the width follows width / height. A
 * fisheye takes the camera's place and axes alone. */
Camera camera_from_scene(const SceneCamera *camera, int width, int height);

/* x, y: film position in pixels, 0 <= x <= width, that the camera sees. The direction has unit
 * length. */
Ray camera_ray(const Camera *camera, float x, float y);

/* Of a place of the film, and of anything of a pixel. */
bool camera_sees(const Camera *camera, float x, float y);
bool camera_sees_pixel(const Camera *camera, int x, int y);

/* HOT. The ray of a sample through pixel x, y, which the camera sees: even over what it sees of
 * the pixel. at: the sample's pair of numbers in [0, 1); sampler: what it came from, of which
 * further pairs are made where `at` is out of view. */
Ray camera_pixel_ray(const Camera *camera, int x, int y, Vec2 at, const Sampler *sampler);

/* A camera at `eye` that looks at `target`, both in the scene's metres, +Y up (-Z where it
 * looks along Y); yfov: radians, full vertical angle. The two points must differ. */
SceneCamera camera_look_at(Vec3 eye, Vec3 target, float yfov);

/* For scenes that have no camera: sees the displays from their front, at a distance at which
 * all of them are in view; else the whole scene from its front (+Z), slightly from above;
 * without triangles from the origin along -Z. Displays that face apart are seen from the front
 * of the largest; occlusion is not tested. The camera's name records which. */
SceneCamera camera_frame_scene(const Scene *scene);
