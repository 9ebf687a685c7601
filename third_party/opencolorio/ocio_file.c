/* SPDX-License-Identifier: Apache-2.0 */
#include "opencolorio/ocio_file.h"

#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/number.h"

static bool refuse(const char *path, const char *found, const char *required, Error *err) {
    return error_at(err, ERROR_INPUT, path, "", "%s, required %s", found, required);
}

/* Tables in XML (CLF, CTF, CDL) may name further files, and declare texts that grow. */
static bool check_xml(const char *path, const FileBytes *bytes, Error *err) {
    const char *text = (const char *)bytes->data;
    if (memchr(text, 0, bytes->size)) return refuse(path, "has zero bytes", "XML in UTF-8", err);
    if (strcasestr(text, "<!DOCTYPE"))
        return refuse(path, "has a document type (<!DOCTYPE)", "XML without one", err);
    return !strcasestr(text, "<Reference") ||
           refuse(path, "refers to another file (<Reference>)", "a table by itself", err);
}

static bool is_xml(const FileBytes *bytes) {
    size_t at = 0;
    while (at < bytes->size && at < 8 && bytes->data[at] != '<') at++;
    const char *text = (const char *)bytes->data;
    return at < bytes->size && at < 8 ? true : text[strspn(text, " \t\r\n")] == '<';
}

/* Sony's table makes room for as many rows as it says before it reads one. */
static bool check_length(const char *path, const FileBytes *bytes, Error *err) {
    const char *text = (const char *)bytes->data, *length = strstr(text, "Length");
    if (strncmp(text, "Version", 7) != 0 || !length) return true;
    double rows = 0;
    length += 6 + strspn(length + 6, " \t");
    return (number_read(length, &rows) && rows <= (double)bytes->size) ||
           error_at(err, ERROR_INPUT, path, "",
                    "has Length %g in %zu bytes, required a row for each", rows, bytes->size);
}

static bool check_archive(const char *path, const FileBytes *bytes, Error *err) {
    return memcmp(bytes->data, "PK\3\4", bytes->size < 4 ? bytes->size : 4) != 0 || !bytes->size ||
           refuse(path, "is an archive (.ocioz)",
                  "the configuration in it: unpack it, and name its config.ocio", err);
}

bool ocio_file_check(const char *path, Error *err) {
    Arena scratch = arena_reserve(OCIO_FILE_BYTES_MAX + 4096);
    FileBytes bytes;
    bool ok = file_read(path, OCIO_FILE_BYTES_MAX, &scratch, &bytes, err) &&
              check_archive(path, &bytes, err) &&
              (is_xml(&bytes) ? check_xml(path, &bytes, err) : check_length(path, &bytes, err));
    arena_release(&scratch);
    return ok;
}
