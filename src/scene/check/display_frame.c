/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/display_frame.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "spectrum/twice.h"

#define FRONT_COS 0.5f     /* of 60 degrees */
#define LOOK_COS 0.5       /* a camera looks at what is within 60 degrees of its axis */
#define LOOK_MOST_M 5.0    /* and no farther off: others show the room */
#define ACROSS_LEAST 0.05f /* sine between the view and what is up */
#define LEVEL_LEAST 1e-3   /* horizontal length of a unit vector: less is vertical */

/* ---- its frame --------------------------------------------------------------------------- */

typedef struct FrameSums {
    double area, width, height; /* width, height: area times metres a unit of u and v */
    Vec3 centre, right, up, normal;
    float box[4]; /* u, then v: least and most */
} FrameSums;

/* dP/du and dP/dv from the edges e, f and their steps in u and v (Cramer's rule). v counts
 * downwards. */
static void add_triangle(const Scene *scene, const TextureSlot *slot, uint32_t t, FrameSums *s) {
    Vec3 p[3];
    Vec2 c[3];
    for (int k = 0; k < 3; k++) {
        p[k] = scene_corner(scene, t, k);
        c[k] = slot_from_uv(slot, scene_corner_uv(scene, t, k, slot->uv_set));
        s->box[0] = fminf(s->box[0], c[k].x), s->box[1] = fmaxf(s->box[1], c[k].x);
        s->box[2] = fminf(s->box[2], c[k].y), s->box[3] = fmaxf(s->box[3], c[k].y);
    }
    Vec3 e = vec3_sub(p[1], p[0]), f = vec3_sub(p[2], p[0]), n = vec3_cross(e, f);
    float eu = c[1].x - c[0].x, ev = c[1].y - c[0].y;
    float fu = c[2].x - c[0].x, fv = c[2].y - c[0].y;
    float det = eu * fv - fu * ev, area = 0.5f * vec3_length(n);
    if (!(fabsf(det) > 0) || !(area > 0)) return;
    Vec3 du = vec3_scale(vec3_sub(vec3_scale(e, fv), vec3_scale(f, ev)), 1 / det);
    Vec3 dv = vec3_scale(vec3_sub(vec3_scale(f, eu), vec3_scale(e, fu)), 1 / det);
    Vec3 middle = vec3_scale(vec3_add(vec3_add(p[0], p[1]), p[2]), 1.0f / 3);
    s->area += (double)area;
    s->width += (double)(area * vec3_length(du));
    s->height += (double)(area * vec3_length(dv));
    s->centre = vec3_along(s->centre, middle, area);
    s->right = vec3_along(s->right, du, area);
    s->up = vec3_along(s->up, dv, -area);
    s->normal = vec3_along(s->normal, n, 0.5f);
}

bool display_frame_of(const Scene *scene, const Part *part, DisplayFrame *out) {
    const TextureSlot *slot =
        &scene->displays[scene->materials[part->material_id].display_id].content;
    FrameSums s = {.box = {INFINITY, -INFINITY, INFINITY, -INFINITY}};
    for (uint32_t t = 0; t < part->triangle_count; t++)
        add_triangle(scene, slot, part->first_triangle + t, &s);
    if (!(s.area > 0) || !(vec3_length(s.normal) > 0)) return false;
    *out = (DisplayFrame){.centre = vec3_scale(s.centre, (float)(1 / s.area)),
                          .right = vec3_normalize(s.right),
                          .up = vec3_normalize(s.up),
                          .normal = vec3_normalize(s.normal),
                          .width_m = s.width / s.area * (double)(s.box[1] - s.box[0]),
                          .height_m = s.height / s.area * (double)(s.box[3] - s.box[2]),
                          .span = {s.box[1] - s.box[0], s.box[3] - s.box[2]}};
    return true;
}

/* ---- what cannot be meant ---------------------------------------------------------------- */

bool display_side_is_plausible(double m) {
    return m >= DISPLAY_LEAST_M && m <= DISPLAY_MOST_M;
}

bool display_frame_turn(const DisplayFrame *frame, Vec3 eye, Vec3 up, double *degrees) {
    Vec3 way = vec3_normalize(vec3_sub(frame->centre, eye)), across = vec3_cross(way, up);
    float length = vec3_length(across);
    if (-vec3_dot(way, frame->normal) < FRONT_COS || length < ACROSS_LEAST) return false;
    across = vec3_scale(across, 1 / length);
    Vec3 above = vec3_cross(across, way);
    *degrees = degrees_from_radians(
        atan2_d(-(double)vec3_dot(frame->up, across), (double)vec3_dot(frame->up, above)));
    return true;
}

const char *display_turn_words(double degrees) {
    if (fabs(degrees) > 180 - DISPLAY_TURN_MOST_DEG) return "upside down";
    return degrees > 0 ? "on its left side" : "on its right side";
}

static bool looks_at(const SceneCamera *camera, const DisplayFrame *frame) {
    const Transform *world = &camera->world_from_camera;
    Vec3 way = vec3_sub(frame->centre, world->origin);
    float length = vec3_length(way);
    return camera->is_perspective && length < (float)LOOK_MOST_M &&
           -vec3_dot(world->z, way) > (float)LOOK_COS * length;
}

static bool camera_turn(const SceneCamera *camera, const DisplayFrame *frame, double *degrees) {
    const Transform *world = &camera->world_from_camera;
    return looks_at(camera, frame) && display_frame_turn(frame, world->origin, world->y, degrees);
}

static bool frame_of_part(const Scene *scene, int part, DisplayFrame *out) {
    return scene->materials[scene->parts[part].material_id].display_id != NO_ID &&
           display_frame_of(scene, &scene->parts[part], out);
}

/* Sees some display upright: an eye. Others show the car from outside. */
static bool is_eye(const Scene *scene, const SceneCamera *camera) {
    bool found = false;
    for (int i = 0; i < scene->part_count && !found; i++) {
        DisplayFrame frame;
        double degrees;
        found = frame_of_part(scene, i, &frame) && camera_turn(camera, &frame, &degrees) &&
                fabs(degrees) <= DISPLAY_TURN_MOST_DEG;
    }
    return found;
}

/* The camera that sees the picture least turned, an eye if there is one; NULL where none looks
 * at it. */
static const SceneCamera *best_camera(const Scene *scene, const DisplayFrame *frame, double *turn) {
    const SceneCamera *best = NULL;
    bool has_eyes = false;
    for (int i = 0; i < scene->camera_count && !has_eyes; i++)
        has_eyes = is_eye(scene, &scene->cameras[i]);
    for (int i = 0; i < scene->camera_count; i++) {
        const SceneCamera *camera = &scene->cameras[i];
        double degrees;
        if ((has_eyes && !is_eye(scene, camera)) || !camera_turn(camera, frame, &degrees) ||
            (best && fabs(degrees) >= fabs(*turn)))
            continue;
        best = camera;
        *turn = degrees;
    }
    return best;
}

static void doubt_size(const Scene *scene, const Part *part, const DisplayFrame *frame,
                       Problems *problems) {
    const Display *display = &scene->displays[scene->materials[part->material_id].display_id];
    if (display->any_size ||
        (display_side_is_plausible(frame->width_m) && display_side_is_plausible(frame->height_m)))
        return;
    problems_add(problems, SEVERITY_WARNING, scene->inputs[0], "",
                 "display \"%s\" on \"%s\" is %.3g m wide and %.3g m high, plausible are %g to "
                 "%g m: is the model in metres? If it is meant: \"any_size\": true in its "
                 "PARHELION_display",
                 display->name, part->name, frame->width_m, frame->height_m, DISPLAY_LEAST_M,
                 DISPLAY_MOST_M);
}

/* Rows or columns that are all alike have no shape: the picture may be stretched along them. */
static bool has_shape(const Image *picture) {
    static const size_t bytes[] = {[IMAGE_RGBA8] = 4, [IMAGE_RGBA16] = 8, [IMAGE_RGBA32F] = 16};
    size_t pixel = bytes[picture->format], row = pixel * (size_t)picture->width;
    const char *all = picture->pixels;
    bool rows_differ = false, columns_differ = false;
    for (int y = 0; y < picture->height && !(rows_differ && columns_differ); y++) {
        const char *line = all + row * (size_t)y;
        rows_differ |= memcmp(line, all, row) != 0;
        columns_differ |= memcmp(line, line + pixel, row - pixel) != 0;
    }
    return rows_differ && columns_differ;
}

static void doubt_shape(const Scene *scene, const Part *part, const DisplayFrame *frame,
                        Problems *problems) {
    const Display *display = &scene->displays[scene->materials[part->material_id].display_id];
    if (display->any_size || display->content.texture_id == NO_ID || !(frame->height_m > 0)) return;
    const Image *picture = &scene->textures[display->content.texture_id].image;
    double width = (double)frame->span[0] * picture->width;
    double height = (double)frame->span[1] * picture->height;
    Twice twice = twice_shape(
        arena_format(problems->arena, "display \"%s\" on \"%s\"", display->name, part->name),
        width / height, frame->width_m / frame->height_m, problems->arena);
    if (!twice_differ(&twice) || !has_shape(picture)) return;
    problems_add(problems, SEVERITY_WARNING, scene->inputs[0], "",
                 "%s: %.5g x %.5g pixels are stretched over %.3g x %.3g m: fit the picture, or "
                 "the texture coordinates. If it is meant: \"any_size\": true in its "
                 "PARHELION_display",
                 twice_text(&twice, problems->arena), width, height, frame->width_m,
                 frame->height_m);
}

static void doubt_turn(const Scene *scene, const Part *part, const DisplayFrame *frame,
                       Problems *problems) {
    double turn;
    const SceneCamera *camera = best_camera(scene, frame, &turn);
    if (!camera || fabs(turn) <= DISPLAY_TURN_MOST_DEG) return;
    problems_add(problems, SEVERITY_WARNING, scene->inputs[0], "",
                 "display \"%s\" on \"%s\": seen from camera \"%s\" its picture stands %s "
                 "(turned by %.0f degrees): are its texture coordinates turned?",
                 scene->materials[part->material_id].name, part->name,
                 camera->node_name[0] ? camera->node_name : camera->camera_name,
                 display_turn_words(turn), fabs(turn));
}

void displays_doubt(const Scene *scene, Problems *problems) {
    for (int i = 0; i < scene->part_count; i++) {
        DisplayFrame frame;
        if (!frame_of_part(scene, i, &frame)) continue;
        doubt_size(scene, &scene->parts[i], &frame, problems);
        doubt_shape(scene, &scene->parts[i], &frame, problems);
        doubt_turn(scene, &scene->parts[i], &frame, problems);
    }
}

/* ---- where the vehicle points ------------------------------------------------------------ */

bool forward_angle_deg(const double forward[3], const double way[3], double *degrees) {
    double a = hypot_d(forward[0], forward[2]), b = hypot_d(way[0], way[2]);
    double length = hypot_d(b, way[1]);
    if (!(a > 0) || !(b > LEVEL_LEAST * length)) return false;
    double cosine = (forward[0] * way[0] + forward[2] * way[2]) / (a * b);
    *degrees = degrees_from_radians(acos_d(fmax(-1, fmin(1, cosine))));
    return true;
}

static bool looks_at_any(const Scene *scene, const SceneCamera *camera) {
    bool found = false;
    for (int i = 0; i < scene->part_count && !found; i++) {
        DisplayFrame frame;
        found = frame_of_part(scene, i, &frame) && looks_at(camera, &frame);
    }
    return found;
}

/* North is -Z where nothing is said: then nothing is said of the vehicle either. */
static bool says_forward(const Environment *e) {
    bool is_uniform = e->kind == ENVIRONMENT_NONE || e->kind == ENVIRONMENT_CONSTANT;
    bool is_default =
        e->heading == 0 && e->forward.x == 0 && e->forward.y == 0 && e->forward.z == -1;
    return !is_default && (!is_uniform || e->has_sun);
}

void forward_doubt(const Scene *scene, Problems *problems) {
    const Environment *e = &scene->environment;
    const double forward[3] = {(double)e->forward.x, (double)e->forward.y, (double)e->forward.z};
    const SceneCamera *nearest = NULL;
    double least = INFINITY;
    for (int i = 0; i < scene->camera_count && says_forward(e); i++) {
        const SceneCamera *camera = &scene->cameras[i];
        const Vec3 z = camera->world_from_camera.z;
        const double way[3] = {-(double)z.x, -(double)z.y, -(double)z.z};
        double degrees;
        if (!looks_at_any(scene, camera) || !forward_angle_deg(forward, way, &degrees) ||
            degrees >= least)
            continue;
        nearest = camera;
        least = degrees;
    }
    if (!nearest || least <= FORWARD_MOST_DEG) return;
    problems_add(problems, SEVERITY_WARNING, scene->inputs[0], "",
                 "the environment's forward, (%.3g, %.3g, %.3g), is %.0f degrees off where "
                 "camera \"%s\" looks at a display, expected within %g: does the vehicle point "
                 "there?",
                 forward[0], forward[1], forward[2], least,
                 nearest->node_name[0] ? nearest->node_name : nearest->camera_name,
                 FORWARD_MOST_DEG);
}
