/* camera.h -- a film position becomes a ray.
 *
 * Frame    glTF's camera: looks along -Z, +Y up; film x to the right, y down, (0,0) the upper
 *          left corner of the frame, in pixels.
 */
#pragma once
#include "bvh/ray.h"
#include "scene/scene.h"

typedef struct Camera {
    Transform world_from_camera; /* unit axes */
    bool  is_perspective;
    float half_width, half_height; /* perspective: at distance 1; orthographic: metres */
    int   width, height;           /* pixels */
} Camera;

/* The vertical field of view (or magnification) is kept; the width follows width / height. */
Camera camera_from_scene(const SceneCamera *camera, int width, int height);

/* x, y: film position in pixels, 0 <= x <= width. The direction has unit length. */
Ray camera_ray(const Camera *camera, float x, float y);

/* A camera that sees the whole scene from the front (+Z), slightly from above: for scenes that
 * have none. Without triangles: from the origin along -Z. */
SceneCamera camera_frame_scene(const Scene *scene);
