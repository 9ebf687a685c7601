/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_doubt.h"

#include <math.h>
#include <string.h>

#include "review/request/request_check.h"
#include "scene/load/display_frame.h"

#define NEAR_M 0.1 /* from an eye to a display that it reads */
#define FAR_M 10.0

/* The eye that is looked at, and the displays of the symbols. */
typedef struct RequestDoubt {
    const ReviewRequest *request;
    const Scene         *scene;
    Problems            *problems;
    const DisplayFrame  *frames; /* [symbol_count] */
    const bool          *has_frame;
} RequestDoubt;

static const char *place(const RequestDoubt *doubt, const char *list, const char *name,
                         const char *member)
{
    return arena_format(doubt->problems->arena, "/%s/%s%s%s", list, name, member[0] ? "/" : "",
                        member);
}

static void warn(const RequestDoubt *doubt, const char *path, const char *text)
{
    problems_add(doubt->problems, SEVERITY_WARNING, doubt->request->file, path, "%s", text);
}

/* ---- an eye ------------------------------------------------------------------------------ */

typedef struct EyeStand {
    Vec3             at, up;
    const Transform *camera; /* NULL: it has no view of its own */
} EyeStand;

static EyeStand stand_of(const RequestDoubt *doubt, const ReviewEye *eye)
{
    Error none;
    int   id;
    if (eye->kind != EYE_CAMERA)
        return (EyeStand){vec3_from_doubles(eye->position_m), {0, 1, 0}, NULL};
    if (!review_camera_find(doubt->scene, eye, *doubt->problems->arena, &id, &none))
        return (EyeStand){.up = {0, 1, 0}};
    const Transform *world = &doubt->scene->cameras[id].world_from_camera;
    return (EyeStand){world->origin, world->y, world};
}

/* Where an eye may look, and which of it is the least off forward. */
typedef struct Looking {
    const double *forward;
    double        least_deg, way[3];
} Looking;

static void look_along(Looking *looking, Vec3 direction)
{
    double degrees, way[3] = {(double)direction.x, (double)direction.y, (double)direction.z};
    if (!forward_angle_deg(looking->forward, way, &degrees) || degrees >= looking->least_deg)
        return;
    looking->least_deg = degrees;
    memcpy(looking->way, way, sizeof way);
}

/* Its camera's axis, the displays that it reads and the gazes that it has: of a mirror or a
 * display in the door one is off, of a mistaken forward all are. */
static void doubt_forward(const RequestDoubt *doubt, int eye, const EyeStand *stand)
{
    const ReviewRequest *request = doubt->request;
    const double        *forward = request->forward;
    Looking              looking = {.forward = forward, .least_deg = INFINITY};
    if (stand->camera) look_along(&looking, vec3_neg(stand->camera->z));
    for (int i = 0; i < request->symbol_count; i++)
        if (doubt->has_frame[i])
            look_along(&looking,
                       vec3_normalize(vec3_sub(doubt->frames[i].centre, stand->at)));
    for (int i = 0; i < request->gaze_count; i++)
        if (!request->gazes[i].at_symbols && request->gazes[i].for_eye[eye])
            look_along(&looking, vec3_from_doubles(request->gazes[i].direction));
    if (!(looking.least_deg > FORWARD_MOST_DEG) || !(looking.least_deg <= 180)) return;
    warn(doubt, "/forward",
         arena_format(doubt->problems->arena,
                      "(%.3g, %.3g, %.3g) is %.0f degrees off where eye \"%.60s\" looks, (%.3g, "
                      "%.3g, %.3g), expected within %g: does the vehicle point there?",
                      forward[0], forward[1], forward[2], looking.least_deg,
                      request->eyes[eye].name, looking.way[0] + 0.0, looking.way[1] + 0.0,
                      looking.way[2] + 0.0, FORWARD_MOST_DEG));
}

static void doubt_distance(const RequestDoubt *doubt, const ReviewEye *eye,
                           const EyeStand *stand)
{
    double nearest = INFINITY;
    for (int i = 0; i < doubt->request->symbol_count; i++)
        if (doubt->has_frame[i])
            nearest = fmin(nearest, (double)vec3_length(vec3_sub(doubt->frames[i].centre,
                                                                 stand->at)));
    if ((nearest >= NEAR_M && nearest <= FAR_M) || nearest == (double)INFINITY) return;
    warn(doubt, place(doubt, "eyes", eye->name, ""),
         arena_format(doubt->problems->arena,
                      "is %.3g m from the nearest display that is read, expected %g to %g m: is "
                      "its place in metres?", nearest, NEAR_M, FAR_M));
}

static void doubt_turn(const RequestDoubt *doubt, const ReviewEye *eye, const EyeStand *stand)
{
    const ReviewRequest *request = doubt->request;
    double               turn;
    for (int i = 0; i < request->symbol_count; i++) {
        const ReviewSymbol *symbol = &request->symbols[i];
        if (!doubt->has_frame[i] ||
            !display_frame_turn(&doubt->frames[i], stand->at, stand->up, &turn) ||
            fabs(turn) <= DISPLAY_TURN_MOST_DEG)
            continue;
        warn(doubt, place(doubt, "symbols", symbol->name, "display"),
             arena_format(doubt->problems->arena,
                          "the picture of '%.60s' stands %s for eye \"%.60s\" (turned by %.0f "
                          "degrees): are its texture coordinates turned?", symbol->display,
                          display_turn_words(turn), eye->name, fabs(turn)));
    }
}

/* ---- all of it --------------------------------------------------------------------------- */

static bool find_frame(const RequestDoubt *doubt, const ReviewSymbol *symbol, DisplayFrame *out)
{
    ReviewDisplay display;
    Error         none;
    if (!review_display_find(doubt->scene, symbol->display, doubt->problems->arena, &display,
                             &none) ||
        !display_frame_of(doubt->scene, &doubt->scene->parts[display.part_ids[0]], out))
        return false;
    if (doubt->scene->displays[display.display_id].any_size ||
        (display_side_is_plausible(out->width_m) && display_side_is_plausible(out->height_m)))
        return true;
    problems_add(doubt->problems, SEVERITY_ERROR, doubt->request->file,
                 place(doubt, "symbols", symbol->name, "display"),
                 "'%.60s' is %.3g m wide and %.3g m high, required %g to %g m: is the model in "
                 "metres? If it is meant: \"any_size\": true in its PARHELION_display",
                 symbol->display, out->width_m, out->height_m, DISPLAY_LEAST_M, DISPLAY_MOST_M);
    return true;
}

void review_request_doubt(const ReviewRequest *request, const Scene *scene, Problems *problems)
{
    Arena        *arena = problems->arena;
    DisplayFrame *frames = ARENA_NEW(arena, DisplayFrame, request->symbol_count);
    bool         *has_frame = ARENA_NEW(arena, bool, request->symbol_count);
    RequestDoubt  doubt = {request, scene, problems, frames, has_frame};
    for (int i = 0; i < request->symbol_count; i++)
        has_frame[i] = find_frame(&doubt, &request->symbols[i], &frames[i]);
    for (int i = 0; i < request->eye_count; i++) {
        EyeStand stand = stand_of(&doubt, &request->eyes[i]);
        doubt_forward(&doubt, i, &stand);
        doubt_distance(&doubt, &request->eyes[i], &stand);
        doubt_turn(&doubt, &request->eyes[i], &stand);
    }
}
