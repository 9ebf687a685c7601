/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/outputs.h"

#include <assert.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"

void outputs_note(Outputs *outputs, const char *option, const char *path) {
    assert(outputs->count < OUTPUTS_MAX);
    outputs->list[outputs->count++] = (Output){option, path};
}

/* Folders may be read and written, devices and pipes are not replaced. */
static bool is_same_file(const char *output, const char *input) {
    struct stat info;
    return file_is_same(output, input) && !stat(output, &info) && S_ISREG(info.st_mode);
}

/* A file that is read and written, as a checkpoint, is an output too: its option, or NULL. */
static const char *option_of(const Outputs *outputs, const char *path) {
    for (int i = 0; i < outputs->count; i++)
        if (outputs->list[i].path == path) return outputs->list[i].option;
    return NULL;
}

static bool spares(const Outputs *outputs, const char *input, Error *err) {
    const char *kept = option_of(outputs, input);
    for (int i = 0; i < outputs->count; i++) {
        const Output *output = &outputs->list[i];
        if (input == output->path || !is_same_file(output->path, input)) continue;
        if (kept)
            return error_set(err, ERROR_USAGE, "%s and %s name the same file, %s", output->option,
                             kept, input);
        return error_at(err, ERROR_OUTPUT, output->path, "",
                        "is read, and %s would write over it — name another file", output->option);
    }
    return true;
}

bool outputs_spare(const Outputs *outputs, const char *const *files, int count, Error *err) {
    for (int i = 0; i < count; i++)
        if (files[i] && !spares(outputs, files[i], err)) return false;
    return true;
}

bool outputs_spare_words(const Outputs *outputs, const CliTexts *words, Error *err) {
    for (int i = 0; i < words->count; i++)
        for (const char *at = words->list[i]; at;) {
            if (*at && !spares(outputs, at, err)) return false;
            const char *sign = strpbrk(at, "=:");
            at = sign ? sign + 1 : NULL;
        }
    return true;
}
