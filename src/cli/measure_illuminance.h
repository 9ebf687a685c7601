/* SPDX-License-Identifier: Apache-2.0 */
/* measure_illuminance.h -- `parhelion measure --illuminance`: a luxmeter at a point of a
 * scene. */
#pragma once
#include "cli/options/scene_options.h"

/* A luxmeter in a scene. */
typedef struct LuxmeterRequest {
    bool   given;
    double place[6]; /* x, y, z in metres, then where the head faces */
    long   samples;
    SceneOptions      scene;
    EnvironmentChange environment;
} LuxmeterRequest;

/* Loads the scene, changed as asked, and prints the illuminance there. */
bool measure_illuminance(const Cli *cli, const LuxmeterRequest *request, Arena *arena,
                         Error *err);
