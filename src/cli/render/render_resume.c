/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/render_resume.h"

#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/file_write.h"
#include "print/print.h"
#include "render/identity.h"

/* Hours of rendering must not end at a checkpoint that cannot be written, and a slip of the
 * fingers must not replace a scene by one. */
bool render_check_checkpoint(const RenderRequest *request, Error *err) {
    const char *path = request->checkpoint;
    if (request->replays || !path) return true;
    if (!strcmp(path, request->output) || (request->png && !strcmp(path, request->png)))
        return error_set(err, ERROR_USAGE, "%s and --checkpoint name the same file, %s",
                         strcmp(path, request->output) ? "--png" : "-o", path);
    if (file_exists(path) && !checkpoint_is_there(path))
        return error_at(err, ERROR_OUTPUT, path, "",
                        "is there and is not a checkpoint — move it, or name another by "
                        "--checkpoint FILE");
    return !request->keeps_checkpoints || file_check_writable(path, err);
}

/* One line on stderr, unless nothing is to be said. */
static void say(const RenderRequest *request, const char *text) {
    if (!request->cli.quiet) print_to(stderr, "parhelion: %s: %s\n", request->checkpoint, text);
}

static bool open_and_check(const RenderRequest *request, const char *identity, Arena *arena,
                           Checkpoint *out, Error *err) {
    const RenderOptions *options = &request->render;
    const FilmPart wanted = {.crop = options->crop,
                             .first_sample = options->first_sample,
                             .end_sample = options->end_sample};
    Checkpoint found;
    if (!checkpoint_open(request->checkpoint, arena, &found, err)) return false;
    const char *difference = identity_difference(found.identity, identity, arena);
    if (difference && !identity_same_program(found.identity, identity))
        return error_at(err, ERROR_MACHINE, request->checkpoint, "",
                        "was made by another program or instruction set: %s — go on where it "
                        "was made, or by its --isa; leave out --resume to begin anew",
                        difference);
    if (difference)
        return error_at(err, ERROR_INPUT, request->checkpoint, "",
                        "is of another render: %s — leave out --resume to begin anew", difference);
    if (!checkpoint_fits(&found, &wanted, err)) return false;
    if (options->noise > 0 && options->noise_area.display != FILM_ALL_PIXELS && !found.has_features)
        return error_at(err, ERROR_INPUT, request->checkpoint, "",
                        "does not know which samples saw a display, which --noise display: "
                        "asks for — leave out --resume to begin anew");
    *out = found;
    return true;
}

bool render_find_checkpoint(const RenderRequest *request, const char *identity, Arena *arena,
                            const Checkpoint **out, Error *err) {
    *out = NULL;
    if (request->replays || !request->checkpoint) return true;
    bool is_there = file_exists(request->checkpoint);
    if (!request->resumes) {
        if (is_there)
            say(request, "a checkpoint is there; this render begins from the start and will "
                         "replace it — --resume goes on from it");
        return true;
    }
    if (!is_there) {
        say(request, "no checkpoint is there: the render begins from the start");
        return true;
    }
    Checkpoint *found = ARENA_NEW(arena, Checkpoint, 1);
    if (!open_and_check(request, identity, arena, found, err)) return false;
    say(request, arena_format(arena, "goes on after %u of %u samples a pixel",
                              found->done.end_sample - found->done.first_sample,
                              request->render.end_sample - request->render.first_sample));
    *out = found;
    return true;
}

bool render_keep_checkpoint(const RenderRequest *request, const char *identity,
                            const RenderResult *so_far, Arena scratch, Error *err) {
    const CheckpointName name = {request->checkpoint, identity};
    return render_write_checkpoint(&name, &request->render, so_far, scratch, err);
}

void render_remove_checkpoint(const RenderRequest *request) {
    const char *path = request->checkpoint;
    if (path && checkpoint_is_there(path)) file_remove(path);
}
