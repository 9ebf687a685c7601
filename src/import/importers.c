/* SPDX-License-Identifier: Apache-2.0 */
/* The formats, in the order in which they test whether a file is theirs: those with a sure
 * mark first, text of any layout last. */
#include "import/importers.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/count.h"
#include "text/nearest_word.h"
#include "text/removed.h"

#define FORMATS_MAX 64

const Importer *const importers[] = {
    &importer_zemax, &importer_speos,    &importer_astm, &importer_rgl, &importer_merl,
    &importer_ies,   &importer_eulumdat, &importer_text, NULL,
};

/* ---- which importer ---------------------------------------------------------------------- */

static const Importer *importer_named(const char *name, Error *err) {
    const char *names[FORMATS_MAX];
    char advice[512];
    int count = 0;
    for (int i = 0; importers[i] && i < FORMATS_MAX; i++) {
        if (!strcmp(importers[i]->name, name)) return importers[i];
        names[count++] = importers[i]->name;
    }
    const char *instead = removed_instead("--format", name);
    if (instead) {
        error_set(err, ERROR_USAGE, "--format %s was removed: %s", name, instead);
        return NULL;
    }
    error_set(err, ERROR_USAGE, "--format '%s' is unknown — %s", name,
              nearest_word_advice(name, names, count, advice, (int)sizeof advice));
    return NULL;
}

static bool read_head(const char *file, char *head, size_t *size, Error *err) {
    struct stat info; /* a pipe would be waited for */
    if (!stat(file, &info) && !S_ISREG(info.st_mode))
        return error_at(err, ERROR_INPUT, file, "", "is %s, a file is required",
                        S_ISDIR(info.st_mode) ? "a folder" : "not a regular file");
    FILE *stream = fopen(file, "rb");
    if (!stream)
        return error_at(err, ERROR_INPUT, file, "", "cannot be opened: %s", strerror(errno));
    *size = fread(head, 1, IMPORT_HEAD_BYTES, stream);
    head[*size] = 0;
    bool ok = !ferror(stream);
    fclose(stream);
    return ok || error_at(err, ERROR_INPUT, file, "", "cannot be read");
}

/* Formats of before, by what stands in their first bytes and in none of the formats that are
 * tried before text. */
static const struct {
    const char *name, *mark;
} FORMATS_REMOVED[] = {
    {"FRED", "type bsdf_data"},       {"FRED", "!!BSDF Data"},
    {"LightTools", "ScatterAzimuth"}, {"Mountain", "#format: theta phi"},
    {"Mountain", "#incident_angle"},  {"SSDD", "DATA_TYPE "},
    {"WINDOW", "<WindowElement"},     {"KAIST", "tensor_file"},
};

static const char *format_removed(const char *head, size_t size) {
    for (int i = 0; i < COUNT_OF(FORMATS_REMOVED); i++) {
        const char *mark = FORMATS_REMOVED[i].mark;
        if (memmem(head, size, mark, strlen(mark))) return FORMATS_REMOVED[i].name;
    }
    return NULL;
}

bool import_file(const char *file, const ImportOptions *options, ImportSet *set, Error *err) {
    char head[IMPORT_HEAD_BYTES + 1];
    size_t size = 0;
    const Importer *named = options->format ? importer_named(options->format, err) : NULL;
    if ((options->format && !named) || !read_head(file, head, &size, err)) return false;
    if (!size) return error_at(err, ERROR_INPUT, file, "", "is empty");
    if (named) return named->read(file, options, set, err);
    for (int i = 0; importers[i]; i++) {
        const char *gone = importers[i] == &importer_text ? format_removed(head, size) : NULL;
        if (gone)
            return error_at(err, ERROR_INPUT, file, "",
                            "is of %s's format, which is no longer read — export it as text "
                            "(parhelion help measuring-a-panel)",
                            gone);
        if (importers[i]->recognises(file, head, size))
            return importers[i]->read(file, options, set, err);
    }
    return error_at(
        err, ERROR_INPUT, file, "",
        "is of no format that is known here — export a workbook's tables as CSV, or name "
        "a format with --format");
}
