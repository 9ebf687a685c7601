/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/measure_illuminance.h"

#include <stdio.h>

#include "cli/options/answer.h"
#include "render/illuminance.h"
#include "scene/load/scene_load.h"
#include "spectrum/photometry.h"

static bool print_illuminance(const Cli *cli, const IlluminanceOptions *options,
                              const Illuminance *e, Error *err)
{
    float xyz[3], xy[2];
    for (int k = 0; k < 3; k++) xyz[k] = (float)e->xyz_lx[k];
    xy_from_xyz(xyz, xy);
    if (cli->json)
        return cli_print_json(
            json_pack("{s:f, s:[f,f], s:[f,f], s:I}", "illuminance_lx", e->xyz_lx[1],
                      "illuminance_interval", e->low_lx, e->high_lx, "xy", (double)xy[0],
                      (double)xy[1], "samples",
                      (json_int_t)options->samples),
            err);
    printf("illuminance  %.6g +- %.2g lx\nx, y         %.4f, %.4f\n", e->xyz_lx[1],
           0.5 * (e->high_lx - e->low_lx),
           (double)xy[0], (double)xy[1]);
    return true;
}

bool measure_illuminance(const Cli *cli, const LuxmeterRequest *request, Arena *arena,
                         Error *err)
{
    Problems     problems = problems_start(arena);
    const double *n = request->place + 3;
    Scene       *scene;
    Illuminance  measured;
    IlluminanceOptions options = {
        .point = {vec3((float)request->place[0], (float)request->place[1],
                       (float)request->place[2]),
                  vec3_normalize(vec3((float)n[0], (float)n[1], (float)n[2]))},
        .samples = request->samples, .max_bounces = 64, .threads = cli->threads};
    if (!(vec3_dot(options.point.ns, options.point.ns) > 0.5f))
        return error_set(err, ERROR_USAGE, "--illuminance: the normal (%g, %g, %g) has no "
                         "direction", n[0], n[1], n[2]);
    const SceneAsked asked = {&request->scene, &request->environment, cli->progress};
    if (!scene_options_load(&asked, arena, &problems, &scene, err)) return false;
    cli_print_warnings(&problems);
    bool ok = illuminance_measure(scene, &options, arena, &measured, err) &&
              print_illuminance(cli, &options, &measured, err);
    scene_close(scene);
    return ok;
}
