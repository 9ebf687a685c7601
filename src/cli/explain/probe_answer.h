/* SPDX-License-Identifier: Apache-2.0 */
/* probe_answer.h -- the answer of `parhelion probe`, in words or as JSON, and its rays.
 *
 * Units    cd m^-2; metres; W m^-2 sr^-1 nm^-1. Errors are standard errors.
 */
#pragma once
#include "cli/options/cli.h"
#include "light/light_groups.h"
#include "review/chain/pixel_light.h"

/* The light of one pixel. */
typedef struct Probed {
    int  pixel[2], size[2];
    Vec3 eye;
    Chains      chains;
    PixelLight  light;
    LightGroups groups; /* by which lights are named and coloured */
} Probed;

bool probe_answer(const Cli *cli, const Probed *probed, Arena *arena, Error *err);

/* The rays as lines of a glTF file, each in the colour of its light (ray_file.h). */
bool probe_write_rays(const Probed *probed, const char *path, Arena *arena, Error *err);
