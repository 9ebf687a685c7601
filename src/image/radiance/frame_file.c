/* SPDX-License-Identifier: Apache-2.0 */
#include "image/radiance/frame_file.h"

#include <string.h>

#include "base/file.h"
#include "image/radiance/radiance_picture.h"

#define MAX_FILE_BYTES ((size_t)4 << 30)

static bool is_openexr(const FileBytes *file)
{
    return file->size >= 4 && !memcmp(file->data, "\x76\x2f\x31\x01", 4);
}

static bool is_no_frame(const char *path, const FileBytes *file, Error *err)
{
    return error_at(err, ERROR_INPUT, path, "",
                    "%s, wanted an OpenEXR file or a Radiance picture (.hdr)",
                    file->size ? "is neither by its first bytes" : "is empty");
}

bool frame_file_read(const char *path, Arena *arena, FrameImage *out, Error *err)
{
    Arena     file = arena_reserve(MAX_FILE_BYTES + 4096);
    FileBytes bytes;
    bool      ok = file_read(path, MAX_FILE_BYTES, &file, &bytes, err);
    if (ok && radiance_picture_recognise(bytes.data, bytes.size))
        ok = radiance_picture_read(bytes.data, bytes.size, path, arena, out, err);
    else if (ok)
        ok = (is_openexr(&bytes) || is_no_frame(path, &bytes, err)) &&
             frame_read_memory(bytes.data, bytes.size, path, arena, out, err);
    arena_release(&file);
    return ok;
}
