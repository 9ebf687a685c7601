/* SPDX-License-Identifier: Apache-2.0 */
/* luxmeter.h -- `measure --illuminance`: lx at points of a scene, on planes that face
 * somewhere.
 *
 * Memory   the command's arena.
 * Fails    naming the option, or the file and its line, where a point is wrong.
 */
#pragma once
#include "cli/options/scene_options.h"

extern const TableKind luxmeter_kind; /* of the answer at a point */

typedef struct LuxmeterRequest {
    CliTexts places; /* of --illuminance: X,Y,Z,NX,NY,NZ or a file of such rows */
    long samples;    /* of each */
    bool wants_csv;
    SceneOptions scene;
    EnvironmentChange environment;
} LuxmeterRequest;

/* Loads the scene, changed as requested, and prints the illuminance at every point, in
 * order. */
bool luxmeter_run(const Cli *cli, const LuxmeterRequest *request, Arena *arena, Error *err);
