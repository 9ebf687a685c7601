/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/panel/show_scene.h"

#include <math.h>

#include "base/units.h"
#include "text/base64.h"
#include "text/text.h"

#define LONGER_SIDE 1280
#define LEAST_SIDE 16
#define WIDEST_FOV_DEG 170

/* ---- directions -------------------------------------------------------------------------- */

void show_place(double theta_deg, double phi_deg, double distance_m, double out_m[3])
{
    double theta = radians_from_degrees(theta_deg), phi = radians_from_degrees(phi_deg);
    out_m[0] = distance_m * sin(theta) * cos(phi);
    out_m[1] = distance_m * sin(theta) * sin(phi);
    out_m[2] = distance_m * cos(theta);
}

double show_distance(const double at_m[3])
{
    return hypot(hypot(at_m[0], at_m[1]), at_m[2]);
}

void show_angles(const double at_m[3], double *theta_deg, double *phi_deg)
{
    double across = hypot(at_m[0], at_m[1]);
    *theta_deg = degrees_from_radians(atan2(across, at_m[2]));
    *phi_deg = across > 0 ? degrees_from_radians(atan2(at_m[1], at_m[0])) : 0;
    if (*phi_deg < 0) *phi_deg += 360;
}

/* ---- the document ------------------------------------------------------------------------ */

/* A strip of two triangles whose content begins at the upper left corner. */
static void add_corners(Text *text)
{
    static const float corners[4][5] = {{-0.5f, 0.5f, 0, 0, 0}, {-0.5f, -0.5f, 0, 0, 1},
                                        {0.5f, 0.5f, 0, 1, 0}, {0.5f, -0.5f, 0, 1, 1}};
    text_add(text, "\"buffers\": [{\"byteLength\": 80, \"uri\": "
                   "\"data:application/octet-stream;base64,");
    base64_encode(text, corners, sizeof corners);
    text_add(text,
             "\"}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 80, \"byteStride\": 20, "
             "\"target\": 34962}], \"accessors\": [{\"bufferView\": 0, "
             "\"componentType\": 5126, \"count\": 4, \"type\": \"VEC3\", "
             "\"min\": [-0.5, -0.5, 0], \"max\": [0.5, 0.5, 0]}, "
             "{\"bufferView\": 0, \"byteOffset\": 12, \"componentType\": 5126, \"count\": 4, "
             "\"type\": \"VEC2\"}], ");
}

/* A dome of lux / pi all around, and a sun: its illuminance is normal to its beam, north -Z. */
static void add_light(Text *text, const ShowScene *scene)
{
    double towards[3], illuminance = scene->directed_lx /
                                     cos(radians_from_degrees(scene->directed_theta));
    text_format(text, "\"extensions\": {\"PARHELION_environment\": {\"type\": \"constant\", "
                      "\"luminance\": %.17g", scene->ambient_lx / PI);
    show_place(scene->directed_theta, scene->directed_phi, 1, towards);
    if (scene->directed_lx > 0)
        text_format(text, ", \"sun\": {\"azimuth_deg\": %.17g, \"elevation_deg\": %.17g, "
                          "\"illuminance_lx\": %.17g}",
                    degrees_from_radians(atan2(towards[0], -towards[2])),
                    degrees_from_radians(asin(towards[1])), illuminance);
    text_add(text, "}}");
}

const char *show_scene_text(const ShowScene *scene, Arena *arena)
{
    Text text = {.arena = arena};
    text_add(&text, "{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": "
                    "[\"PARHELION_environment\", \"PARHELION_display\"], ");
    add_corners(&text);
    text_add(&text, "\"materials\": [{\"name\": \"" SHOW_DISPLAY "\", \"extensions\": "
                    "{\"PARHELION_display\": {\"any_size\": true}}}], "
                    "\"meshes\": [{\"primitives\": [{\"mode\": 5, \"material\": 0, "
                    "\"attributes\": {\"POSITION\": 0, \"TEXCOORD_0\": 1}}]}], ");
    text_format(&text, "\"nodes\": [{\"name\": \"" SHOW_DISPLAY "\", \"mesh\": 0, "
                       "\"scale\": [%.17g, %.17g, 1]}], \"scene\": 0, "
                       "\"scenes\": [{\"nodes\": [0], ", scene->size_m[0], scene->size_m[1]);
    add_light(&text, scene);
    text_add(&text, "}]}\n");
    return text.data;
}

/* ---- the frame --------------------------------------------------------------------------- */

/* Tangents of the half angles, to the side and upwards, that hold all corners. */
static bool find_reach(const ShowScene *scene, double reach[2])
{
    const double *eye = scene->eye_m;
    double far = show_distance(eye);
    double z[3] = {eye[0] / far, eye[1] / far, eye[2] / far}; /* towards the eye */
    double level = hypot(z[0], z[2]);
    double x[3] = {z[2] / level, 0, -z[0] / level};           /* +Y is up */
    double y[2] = {z[1] * x[2], level};                       /* corners have no Z */
    reach[0] = reach[1] = 0;
    for (int i = 0; i < 4; i++) {
        double cx = (i & 1 ? 0.5 : -0.5) * scene->size_m[0];
        double cy = (i & 2 ? 0.5 : -0.5) * scene->size_m[1];
        double depth = far - cx * z[0] - cy * z[1];
        if (!(depth > 1e-3 * far)) return false;
        reach[0] = fmax(reach[0], fabs(cx * x[0]) / depth);
        reach[1] = fmax(reach[1], fabs(cx * y[0] + cy * y[1]) / depth);
    }
    return true;
}

bool show_frame(const ShowScene *scene, bool given, int size[2], double *fov_deg, Error *err)
{
    double reach[2];
    bool   is_before = find_reach(scene, reach);
    double longer = is_before ? fmax(reach[0], reach[1]) : 1;
    for (int i = 0; is_before && !given && i < 2; i++)
        size[i] = (int)fmax(round(LONGER_SIDE * reach[i] / longer), LEAST_SIDE);
    double half = is_before ? fmax(reach[1], reach[0] * size[1] / size[0]) : INFINITY;
    *fov_deg = 2 * degrees_from_radians(atan(half));
    return *fov_deg <= WIDEST_FOV_DEG ||
           error_set(err, ERROR_USAGE, "the eye, %.4g m from the centre of a display of %g x "
                     "%g mm, is too close to see all of it in one picture: required a field of "
                     "view of at most %d degrees",
                     show_distance(scene->eye_m), 1e3 * scene->size_m[0],
                     1e3 * scene->size_m[1], WIDEST_FOV_DEG);
}
