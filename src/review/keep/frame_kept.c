/* SPDX-License-Identifier: Apache-2.0 */
#include "review/keep/frame_kept.h"

#include <stdio.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/file_write.h"
#include "keep/kept.h"
#include "print/print.h"
#include "render/signals.h"

#define FILE_BYTES_MOST ((size_t)1 << 32)
#define CHECKPOINT_S 20 /* between two */

/* ---- whole frames ------------------------------------------------------------------------ */

static bool hash_file(const char *path, uint64_t *out) {
    Error err;
    FileBytes bytes;
    Arena own = arena_reserve(FILE_BYTES_MOST);
    bool ok = file_exists(path) && file_read(path, FILE_BYTES_MOST / 2, &own, &bytes, &err);
    if (ok) *out = XXH3_64bits(bytes.data, bytes.size);
    arena_release(&own);
    return ok;
}

static bool hash_files(const FrameKept *kept, uint64_t out[FRAME_FILES_MOST]) {
    memset(out, 0, FRAME_FILES_MOST * sizeof *out);
    for (int i = 0; i < kept->file_count; i++)
        if (!hash_file(kept->files[i], &out[i])) return false;
    return true;
}

/* Beside the checkpoint: what the files of a whole frame are. */
static const KeptFormat format = {"PRHLFRAM", "the record of a frame", 1, 0};

static const char *path_of(const FrameKept *kept, const char *ending) {
    uint64_t hash = XXH3_64bits(kept->identity, strlen(kept->identity));
    return arena_format(kept->arena, "%s/%016llx.%s", kept->unfinished, (unsigned long long)hash,
                        ending);
}

bool frame_kept_is_whole(const FrameKept *kept) {
    uint64_t written[FRAME_FILES_MOST], there[FRAME_FILES_MOST];
    KeptReader reader;
    Error ignored;
    const char *path = kept->unfinished ? path_of(kept, "frame") : "";
    if (!kept_is_there(&format, path) ||
        !kept_open(&format, path, NULL, kept->arena, &reader, &ignored))
        return false;
    bool is_whole = !strcmp(reader.identity, kept->identity) &&
                    kept_has_left(&reader, sizeof written, &ignored) &&
                    kept_take(&reader, written, sizeof written, &ignored) &&
                    hash_files(kept, there) && !memcmp(written, there, sizeof there);
    kept_close(&reader);
    return is_whole;
}

bool frame_kept_end(const FrameKept *kept, Error *err) {
    uint64_t hashes[FRAME_FILES_MOST];
    if (!kept->unfinished) return true;
    if (!hash_files(kept, hashes))
        return error_at(err, ERROR_OUTPUT, kept->files[0], "", "is gone after it was written");
    const KeptFile file = {&format, path_of(kept, "frame"), kept->identity, "", sizeof hashes};
    if (!kept_write(&file, hashes, *kept->arena, err)) return false;
    file_remove(kept->checkpoint);
    return true;
}

/* ---- checkpoints ------------------------------------------------------------------------- */

static bool write_checkpoint(const FrameKept *kept, const RenderResult *so_far, Error *err) {
    const CheckpointName name = {kept->checkpoint, kept->identity};
    return render_write_checkpoint(&name, kept->options, so_far, *kept->arena, err);
}

static void report(const Error *err, const char *then) {
    char line[2048];
    error_line(err, line, (int)sizeof line);
    print_to(stderr, "parhelion: warning: %s — %s\n", line, then);
}

/* Meanwhile: the frame is worth more than its checkpoint. */
static void keep(void *user, const RenderResult *so_far) {
    Error err;
    if (!write_checkpoint(user, so_far, &err)) report(&err, "the frame goes on without it");
}

static bool find_checkpoint(const FrameKept *kept, Checkpoint *out, Error *err) {
    FilmPart wanted = {.crop = kept->options->crop, .end_sample = kept->options->end_sample};
    return checkpoint_open(kept->checkpoint, kept->arena, out, err) &&
           (!strcmp(out->identity, kept->identity) ||
            error_at(err, ERROR_INPUT, kept->checkpoint, "", "is of another frame")) &&
           checkpoint_fits(out, &wanted, err);
}

bool frame_kept_begin(FrameKept *kept, RenderOptions *options, Error *err) {
    Error fault;
    if (!kept->unfinished) return true;
    kept->options = options;
    kept->checkpoint = path_of(kept, "checkpoint");
    if (file_exists(kept->checkpoint)) {
        Checkpoint *found = ARENA_NEW(kept->arena, Checkpoint, 1);
        if (find_checkpoint(kept, found, &fault)) options->resume = found;
        else report(&fault, "the frame begins anew");
    }
    options->checkpoint = keep;
    options->checkpoint_interval_s = CHECKPOINT_S;
    options->user = kept;
    return file_check_writable(kept->checkpoint, err);
}

bool review_goes_on(Error *err) {
    return !signals_stop_requested() || signals_stopped(err);
}
