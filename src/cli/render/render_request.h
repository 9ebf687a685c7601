/* SPDX-License-Identifier: Apache-2.0 */
/* render_request.h -- what the user of `parhelion render` typed.
 *
 * Memory   everything lives in the command's arena.
 */
#pragma once
#include <jansson.h>

#include "cli/options/cli.h"
#include "cli/options/scene_options.h"
#include "cli/render/dealt_part.h"
#include "cli/render/noise_goal.h"
#include "cli/render/render_setup.h"
#include "image/develop.h"
#include "missed/missed.h"
#include "render/render.h"
#include "scene/scene.h"

#define RENDER_SUMMARY "render a scene to a linear, photometric EXR" /* of the command */

typedef struct RenderRequest {
    Cli cli;
    SceneOptions scene;
    const char *output;  /* NULL only when replaying */
    const char *png;     /* NULL: none */
    bool previews;       /* a few samples, for looking: a first look as soon as there is one */
    bool only_png;       /* the frame is not kept: output is png */
    DevelopOptions look; /* of the png */
    const char *live;    /* the file that has the frame so far; NULL: none */
    CameraChoice camera;
    EnvironmentChange environment;
    RenderOptions render;
    uint64_t field_hash;      /* of the guide, once it is trained; 0: none */
    NoiseGoal noise;          /* goes into render once the scene is known, as does */
    FrameArea favoured;       /* what all samples are for; option NULL: the whole frame */
    bool names_halves;        /* --layers requests halves by name */
    bool replays;             /* one sample of one pixel, printed */
    DealtPart part;           /* of the samples: --part */
    bool is_part;             /* some samples or pixels only: the frame can be merged */
    const char *command_line; /* without what leaves every pixel as it is
                                 (command_line_join) */
    const char *resume_line;  /* with everything, and --resume */
    const char *checkpoint;   /* the file; without --checkpoint OUTPUT.checkpoint; NULL:
                                 there is none */
    bool keeps_checkpoints;   /* while rendering; else only when it is stopped */
    bool resumes;             /* goes on from the checkpoint, if there is one */
    const Scene *scene_lit; /* once it is known what paths miss of its light, and that; else NULL */
    const MissedLight *missed;
    json_t *about; /* members that the answer has besides, the caller's; NULL: none */
} RenderRequest;

bool render_request_parse(int argc, char **argv, Arena *arena, RenderRequest *out, Error *err);

/* Is it written as a Radiance picture (.hdr)? */
bool render_output_is_radiance(const RenderRequest *request);

/* The bits of a list as --layers has it join *bits. */
bool render_layers_parse(const char *list, unsigned *bits, Error *err);

/* FilmLayer bits as --layers names them, with commas. */
const char *render_layer_list(unsigned layers, Arena *arena);
