/* render_command.h -- the parts of `parhelion render`; private to src/cli.
 *
 * What the user typed becomes a RenderRequest; the scene is loaded and changed by it; what
 * comes out is written as a frame with everything that is needed to make it again.
 * Memory   everything lives in the command's arena.
 */
#pragma once
#include "cli/options/cli.h"
#include "cli/options/environment_options.h"
#include "image/develop.h"
#include "render/render.h"
#include "scene/scene.h"

typedef struct RenderRequest {
    Cli           cli;
    SceneOptions  scene;
    const char   *output; /* NULL only when replaying */
    const char   *png;    /* NULL: none */
    DevelopOptions look;  /* of the png */
    const char   *camera; /* NULL: the first */
    EnvironmentChange environment;
    RenderOptions render;
    bool          replays; /* one sample of one pixel, printed */
    bool          is_part; /* some samples or pixels only: the frame can be merged */
    const char   *command_line; /* without what leaves every pixel as it is: --threads,
                                   --json, --quiet, --progress, --checkpoint,
                                   --checkpoint-interval, --resume */
    const char   *resume_line;  /* with everything, and --resume */
    const char   *checkpoint;   /* the file; without --checkpoint OUTPUT.checkpoint */
    bool          keeps_checkpoints; /* while rendering; else only when it is stopped */
    bool          resumes;      /* goes on from the checkpoint, if there is one */
} RenderRequest;

bool render_request_parse(int argc, char **argv, Arena *arena, RenderRequest *out, Error *err);

/* FilmLayer bits as --layers names them, with commas. */
const char *render_layer_list(unsigned layers, Arena *arena);

/* By a node's name, then a camera's, then an index; NULL: the first. A scene without a camera
 * is framed whole, and a warning says so. */
bool render_choose_camera(const Scene *scene, const char *wanted, Problems *problems,
                          SceneCamera *out, Error *err);

/* A warning when nothing of the scene can send light: the frame will be black. */
void render_tell_of_darkness(const Scene *scene, Problems *problems);

/* The film as it stands, with its metadata. */
FrameImage render_make_frame(const RenderRequest *request, const Scene *scene,
                             const SceneCamera *camera, const RenderResult *result,
                             Arena *arena);

/* ---- checkpoints ------------------------------------------------------------------------- */

/* Before anything is done: can it be written, and is what stands there a checkpoint? */
bool render_check_checkpoint(const RenderRequest *request, Error *err);

/* What --resume goes on from; *out is NULL where nothing is there yet, and a line says so. One
 * of another render, or of other pixels or samples, is refused by what differs. */
bool render_find_checkpoint(const RenderRequest *request, const char *identity, Arena *arena,
                            const Checkpoint **out, Error *err);

/* Keeps what is done so far, in place of what was kept before. */
bool render_keep_checkpoint(const RenderRequest *request, const char *identity,
                            const RenderResult *so_far, Arena scratch, Error *err);

/* When the finished frame is written. */
void render_remove_checkpoint(const RenderRequest *request);

/* ---- what is printed --------------------------------------------------------------------- */

/* The command's answer on stdout. */
bool render_print_answer(const RenderRequest *request, const RenderResult *result,
                         const Problems *problems, Error *err);

/* The value of the one sample that was replayed, on stdout. */
bool render_print_replay(const RenderRequest *request, const Scene *scene,
                         const RenderResult *result, Arena *arena, Error *err);
