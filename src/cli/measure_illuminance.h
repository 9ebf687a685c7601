/* measure_illuminance.h -- `parhelion measure --illuminance`: a luxmeter at a point of a
 * scene. */
#pragma once
#include "cli/options/cli.h"

/* A luxmeter in a scene. */
typedef struct LuxmeterRequest {
    bool   given;
    double place[6]; /* x, y, z in metres, then where the head faces */
    long   samples;
    const char *root; /* --root, or NULL */
} LuxmeterRequest;

/* Loads cli->arguments as one scene and prints the illuminance there. */
bool measure_illuminance(const Cli *cli, const LuxmeterRequest *request, Arena *arena,
                         Error *err);
