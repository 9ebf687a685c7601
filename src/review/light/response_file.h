/* SPDX-License-Identifier: Apache-2.0 */
/* response_file.h -- a response in a file, for the next review that needs the same probe.
 *
 * File     assets/schemas/response.md. It holds the text of everything that decides it, and is
 *          named by that text's hash; what it gives is bit for bit what tracing gives.
 * Memory   the arena's.
 * Threads  one at a time.
 * Writing  seen when it is whole and on the disk (base/file_write.h).
 * Fails    every fault of a file is reported in one line that names it.
 */
#pragma once
#include "review/light/response.h"

#define RESPONSE_VERSION 3

/* A probe's reading of the scene's own light, under any sky. */
typedef struct OwnLight {
    double lamps, displays; /* at level 1 */
} OwnLight;

typedef struct ResponseFile {
    const char *path;
    const char *identity; /* all that decides it: render/identity.h's lines */
    size_t bytes;         /* set by writing and reading */
} ResponseFile;

bool response_write(ResponseFile *file, const Response *response, const OwnLight *own,
                    Arena scratch, Error *err);

/* One that is of another identity is refused by what differs first. After a failure *out and
 * *own are as they were. */
bool response_read(ResponseFile *file, Arena *arena, Response *out, OwnLight *own, Error *err);
