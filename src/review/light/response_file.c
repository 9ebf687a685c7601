/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/response_file.h"

#include <math.h>
#include <string.h>

#include "keep/kept.h"
#include "render/identity.h"

#define CELL_BYTES (RESPONSE_BANDS * sizeof(float))
#define GROUP_BYTES (2 * RESPONSE_GROUPS * sizeof(float))

typedef struct ResponseFacts {
    int32_t level, paths, cells, kept; /* kept: cells that hold anything */
    double relative_error, lamps, displays;
} ResponseFacts;

_Static_assert(sizeof(ResponseFacts) == 16 + 24, "the facts have no gaps");

static const KeptFormat format = {"PRHLRESP", "a response", RESPONSE_VERSION,
                                  sizeof(ResponseFacts)};

static size_t body_bytes(int32_t kept) {
    return (size_t)kept * (sizeof(int32_t) + PROBE_ORDERS * CELL_BYTES + GROUP_BYTES);
}

/* ---- writing ----------------------------------------------------------------------------- */

static bool is_empty(const float *shares) {
    static const float zeros[RESPONSE_BANDS];
    return !memcmp(shares, zeros, CELL_BYTES);
}

static int32_t *find_kept(const Response *response, int32_t *count, Arena *arena) {
    int32_t *kept = ARENA_NEW(arena, int32_t, response->cells.count);
    *count = 0;
    for (int i = 0; i < response->cells.count; i++) {
        size_t at = (size_t)i * RESPONSE_BANDS;
        if (!is_empty(response->first + at) || !is_empty(response->rest + at)) kept[(*count)++] = i;
    }
    return kept;
}

static unsigned char *put(unsigned char *to, const void *bytes, size_t size) {
    memcpy(to, bytes, size);
    return to + size;
}

bool response_write(ResponseFile *file, const Response *response, const OwnLight *own,
                    Arena scratch, Error *err) {
    ResponseFacts facts = {.level = response->cells.level,
                           .paths = response->paths,
                           .cells = response->cells.count,
                           .relative_error = response->relative_error,
                           .lamps = own->lamps,
                           .displays = own->displays};
    int32_t *kept = find_kept(response, &facts.kept, &scratch);
    KeptFile to_keep = {&format, file->path, file->identity, &facts, body_bytes(facts.kept)};
    unsigned char *body = ARENA_NEW(&scratch, unsigned char, to_keep.body_bytes);
    unsigned char *to = put(body, kept, (size_t)facts.kept * sizeof *kept);
    for (int i = 0; i < facts.kept; i++)
        to = put(to, response->first + (size_t)kept[i] * RESPONSE_BANDS, CELL_BYTES);
    for (int i = 0; i < facts.kept; i++)
        to = put(to, response->rest + (size_t)kept[i] * RESPONSE_BANDS, CELL_BYTES);
    for (int i = 0; i < facts.kept; i++)
        to = put(to, response->groups + (size_t)kept[i] * 2 * RESPONSE_GROUPS, GROUP_BYTES);
    file->bytes = kept_bytes(&to_keep);
    return kept_write(&to_keep, body, scratch, err);
}

/* ---- reading ----------------------------------------------------------------------------- */

static bool check_facts(const KeptReader *reader, const ResponseFacts *facts, Error *err) {
    bool is_sound = facts->level >= 0 && facts->level <= RESPONSE_LEVEL && facts->paths > 0 &&
                    facts->cells == 2 * (int32_t)geodesic_count(facts->level) && facts->kept >= 0 &&
                    facts->kept <= facts->cells && isfinite(facts->lamps) &&
                    isfinite(facts->displays) && isfinite(facts->relative_error) &&
                    facts->relative_error >= 0;
    return (is_sound || kept_damaged(reader, err, "its head cannot be")) &&
           kept_has_left(reader, body_bytes(facts->kept), err);
}

static bool check_identity(const ResponseFile *file, const KeptReader *reader, Arena scratch,
                           Error *err) {
    const char *difference = identity_difference(reader->identity, file->identity, &scratch);
    return !difference || error_at(err, ERROR_INPUT, file->path, "",
                                   "is the response of something else: %s", difference);
}

/* Which triangles the values belong to. */
static bool take_cells(KeptReader *reader, const ResponseFacts *facts, int32_t *cells, Error *err) {
    if (!kept_take(reader, cells, (size_t)facts->kept * sizeof *cells, err)) return false;
    for (int i = 0; i < facts->kept; i++)
        if (cells[i] < 0 || cells[i] >= facts->cells)
            return kept_damaged(reader, err, "it has triangles that are not there");
    return true;
}

/* One of the body's parts: `each` values of every triangle. */
static bool spread(KeptReader *reader, const ResponseFacts *facts, const int32_t *cells,
                   size_t each, float *values, Error *err) {
    for (int i = 0; i < facts->kept; i++) {
        float *to = values + (size_t)cells[i] * each;
        if (!kept_take(reader, to, each * sizeof *to, err)) return false;
        for (size_t k = 0; k < each; k++)
            if (!isfinite(to[k]))
                return kept_damaged(reader, err, "it has light that is not finite");
    }
    return true;
}

static bool take_body(KeptReader *reader, const ResponseFacts *facts, float *shares, Arena scratch,
                      Error *err) {
    int32_t *cells = ARENA_NEW(&scratch, int32_t, facts->kept);
    size_t order = (size_t)facts->cells * RESPONSE_BANDS;
    return take_cells(reader, facts, cells, err) &&
           spread(reader, facts, cells, RESPONSE_BANDS, shares, err) &&
           spread(reader, facts, cells, RESPONSE_BANDS, shares + order, err) &&
           spread(reader, facts, cells, 2 * RESPONSE_GROUPS, shares + 2 * order, err);
}

bool response_read(ResponseFile *file, Arena *arena, Response *out, OwnLight *own, Error *err) {
    KeptReader reader;
    ResponseFacts facts;
    if (!kept_open(&format, file->path, &facts, arena, &reader, err)) return false;
    bool ok = check_facts(&reader, &facts, err) && check_identity(file, &reader, *arena, err);
    if (ok) {
        Response found;
        float *shares = response_empty(facts.level, arena, &found);
        ok = take_body(&reader, &facts, shares, *arena, err);
        found.paths = facts.paths;
        found.relative_error = facts.relative_error;
        if (ok) file->bytes = reader.bytes;
        if (ok) *out = found;
        if (ok) *own = (OwnLight){facts.lamps, facts.displays};
    }
    kept_close(&reader);
    return ok;
}
