/* SPDX-License-Identifier: Apache-2.0 */
/* What the program keeps for itself, and may get from anywhere: trained fields, responses,
 * rows of a condition. Checksums are corrected after most changes: whoever sends such a file can
 * do that. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/count.h"
#include "base/file.h"
#include "guide/guide_file.h"
#include "harness.h"
#include "record/record_write.h"
#include "review/light/response_file.h"
#include "review/output/review_json.h"

/* A file that was written, as an input. */
static size_t take_file(const char *path, uint8_t *data, size_t max_size, Arena scratch) {
    FileBytes bytes;
    Error err = {0};
    fuzz_claim(file_read(path, max_size, &scratch, &bytes, &err), "an input fits its target");
    memcpy(data, bytes.data, bytes.size);
    return bytes.size;
}

static size_t change(uint8_t *data, size_t size, size_t max_size, uint64_t *state) {
    if (fuzz_random(state) % 4) fuzz_mutate_places(data, size, fuzz_random(state));
    else size = fuzz_mutate_bytes(data, size, max_size);
    return size;
}

/* What all have in common (keep/kept.c): a head, and a checksum at the end. */
enum { KEPT_HEAD = 32, AT_ORDER = 8, AT_BYTES = 16, AT_IDENTITY = 24 };

static void mend_head(uint8_t *data, const char *magic, uint32_t version) {
    const uint32_t order[2] = {0x01020304u, version};
    memcpy(data, magic, 8);
    memcpy(data + AT_ORDER, order, sizeof order);
}

static void mend_file(uint8_t *data, size_t size) {
    uint64_t bytes = size, checksum;
    memcpy(data + AT_BYTES, &bytes, sizeof bytes);
    checksum = XXH3_64bits(data, size - sizeof checksum);
    memcpy(data + size - sizeof checksum, &checksum, sizeof checksum);
}

/* ---- fields (guide_file.c) --------------------------------------------------------------- */

enum { FIELD_HEAD = KEPT_HEAD + 16, FIELD_NODE = 16, FIELD_CELL = 1120 };

static LightGuide *make_guide(uint32_t cells, Arena *arena) {
    LightGuide *guide = ARENA_NEW(arena, LightGuide, 1);
    *guide = (LightGuide){.node_count = 2 * cells - 1,
                          .cell_count = cells,
                          .asks = true,
                          .nodes = ARENA_NEW(arena, GuideNode, 2 * cells - 1),
                          .cells = ARENA_NEW(arena, GuideCell, cells)};
    for (uint32_t i = 0; i + 1 < cells; i++) { /* each cuts off one cell */
        guide->nodes[2 * i] = (GuideNode){0.5f - (float)i, (int)i % 3, 2 * i + 1, 0};
        guide->nodes[2 * i + 1] = (GuideNode){.cell = i};
    }
    guide->nodes[2 * cells - 2] = (GuideNode){.cell = cells - 1};
    for (uint32_t c = 0; c < cells; c++) {
        GuideCell *cell = &guide->cells[c];
        cell->is_lit = c % 2 == 0;
        for (int i = 0; i < GUIDE_LIGHTS; i++) cell->asked[i] = 0.2f;
        for (int i = 0; i < GUIDE_AIMS * GUIDE_SIDE; i++)
            cell->light[i / GUIDE_SIDE][i % GUIDE_SIDE][i % 7] = (uint16_t)(i * 37);
        cell->lamps = (GuideLamps){2, {5, 3}, {0.5f, 1}, 0.1f};
    }
    return guide;
}

size_t fuzz_make_field(uint8_t *data, size_t max_size, unsigned number, Arena *arena) {
    Error err = {0};
    const char *path = fuzz_path("made.field", arena);
    if (number > 3) return 0;
    fuzz_claim(guide_write(path, make_guide(1 + 2 * number, arena), *arena, &err),
               "a field can be written");
    return take_file(path, data, max_size, *arena);
}

size_t fuzz_mutate_field(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    const uint64_t no_identity = 0;
    uint64_t state = seed;
    size = change(data, size, max_size, &state);
    if (size < FIELD_HEAD + FIELD_NODE + FIELD_CELL + 8 || !(fuzz_random(&state) % 16)) return size;
    size_t each = 2 * FIELD_NODE + FIELD_CELL; /* a cell more is two nodes more */
    uint32_t cells = (uint32_t)((size - FIELD_HEAD - 8 + FIELD_NODE) / each);
    uint32_t facts[3] = {2 * cells - 1, cells, GUIDE_BINS};
    mend_head(data, "PRHLFELD", GUIDE_VERSION);
    memcpy(data + AT_IDENTITY, &no_identity, sizeof no_identity);
    memcpy(data + KEPT_HEAD, facts, sizeof facts);
    size = FIELD_HEAD + cells * each - FIELD_NODE + 8;
    mend_file(data, size);
    return size;
}

static void claim_view(const LightGuide *guide, Vec3 at) {
    const GuideSurface surface = {.ns = {0, 1, 0},
                                  .wo = {0.6f, 0.8f, 0},
                                  .diffuse = 0.5f,
                                  .f0 = 0.04f,
                                  .f90 = 1,
                                  .alpha = 0.1f};
    GuideView view;
    uint32_t cell = guide_cell_at(guide, at);
    fuzz_claim(cell < guide->cell_count, "every place has a cell");
    guide_view(guide, cell, &surface, &view);
    for (int aim = 0; aim < GUIDE_AIMS; aim++) {
        const GuideChoice *choice = &view.towards[aim];
        fuzz_claim(choice->sum >= 0 && isfinite(choice->sum), "a choice has a finite sum");
        if (!(choice->sum > 0)) continue;
        Vec3 wi = guide_sample(choice, 0.3f, 0.7f);
        float pdf = guide_pdf(choice, wi), length = vec3_length(wi);
        fuzz_claim(pdf > 0 && isfinite(pdf), "what is sampled has a density");
        fuzz_claim(fabsf(length - 1) < 1e-3f, "a direction has unit length");
    }
}

void fuzz_field(const uint8_t *data, size_t size, Arena *arena) {
    static const float places[] = {-1e30f, -1, -0.1f, 0, 0.25f, 2, 1e30f};
    const GuideScene scene = {.has = {true, true}, .light_count = 8, .lamp_count = 4};
    const LightGuide *guide;
    Error err = {0};
    if (!guide_read(fuzz_file("a.field", data, size, arena), &scene, arena, &guide, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    for (int i = 0; i < COUNT_OF(places) * COUNT_OF(places); i++)
        claim_view(guide, vec3(places[i % 7], places[i / 7], places[(i * 3) % 7]));
}

/* ---- responses (response_file.c) --------------------------------------------------------- */

static const char identity[] = "version\t1\nseed\t9\n";

enum { RESPONSE_HEAD = KEPT_HEAD + 40 };

size_t fuzz_make_response(uint8_t *data, size_t max_size, unsigned number, Arena *arena) {
    Error err = {0};
    Response response;
    const OwnLight own = {0.25, 1.5};
    ResponseFile file = {.path = fuzz_path("made.response", arena), .identity = identity};
    if (number > 2) return 0;
    float *shares = response_empty(0, arena, &response);
    for (unsigned i = 0; i < number * RESPONSE_BANDS; i++) shares[3 * i] = 1.0f / (float)(i + 3);
    response.paths = 640;
    response.relative_error = 0.0123;
    fuzz_claim(response_write(&file, &response, &own, *arena, &err), "a response can be written");
    return take_file(file.path, data, max_size, *arena);
}

size_t fuzz_mutate_response(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    uint64_t state = seed;
    size = change(data, size, max_size, &state);
    if (size < RESPONSE_HEAD + 8 || fuzz_random(&state) % 16 == 0) return size;
    mend_head(data, "PRHLRESP", RESPONSE_VERSION);
    mend_file(data, size);
    return size;
}

void fuzz_response(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    Response found;
    OwnLight own;
    ResponseFile file = {.path = fuzz_file("a.response", data, size, arena), .identity = identity};
    float bands[RESPONSE_BANDS];
    double without[RESPONSE_GROUPS];
    BrightSamples bright = {0};
    if (!response_read(&file, arena, &found, &own, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    for (int i = 0; i < RESPONSE_BANDS; i++) bands[i] = 1;
    fuzz_claim(isfinite(own.lamps) && isfinite(own.displays), "own light is finite");
    fuzz_claim(!isnan(response_sun(&found, vec3(0, 1, 0), bands, without, &bright)),
               "what a sun gives is a number");
}

/* ---- what a review keeps of a condition (review/output/review_json.h) --------------------- */

static char *kept_text(const Review *review) {
    json_t *document = record_keep(&review_rows, review);
    char *text = json_dumps(document, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(document);
    fuzz_claim(text != NULL, "rows that were read can be written");
    return text;
}

static bool read_kept(const char *text, size_t size, Arena *arena, Review *out, Error *err) {
    JsonView view;
    const FileBytes bytes = {(const unsigned char *)text, size};
    *out = (Review){0};
    if (!json_view_parse("a.condition", bytes, arena, &view, err)) return false;
    view.is_kept = true;
    bool ok = record_read(&view, &review_rows, out, err);
    json_view_close(&view);
    return ok;
}

/* What is read is kept as it is. */
void fuzz_condition(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    Review review, again;
    if (!read_kept((const char *)data, size, arena, &review, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    char *first = kept_text(&review);
    fuzz_claim(read_kept(first, strlen(first), arena, &again, &err), "what is kept is read");
    char *second = kept_text(&again);
    fuzz_claim(!strcmp(first, second), "what is kept stays the same");
    free(first);
    free(second);
}

size_t fuzz_make_condition(uint8_t *data, size_t max_size, unsigned number, Arena *arena) {
    ReviewCase c = review_case_unknown();
    const LimitVerdict limit = {.name = "contrast", .kind = "contrast_ratio", .value = 2};
    ReviewSweep sweep = {.condition = "sun", .eye = "driver", .symbol = "speed"};
    ReviewFile input = {"a\xff.gltf", "0123456789abcdef"};
    (void)arena;
    c.condition = "sun";
    c.eye = "driver";
    c.symbol = "speed";
    c.limits = &limit;
    c.limit_count = 1;
    sweep.worst = c;
    const Review review = {.cases = &c,
                           .case_count = (int)(number & 1),
                           .sweeps = &sweep,
                           .sweep_count = (int)(number >> 1 & 1),
                           .inputs = &input,
                           .input_count = 1};
    if (number > 3) return 0;
    char *text = kept_text(&review);
    size_t size = strlen(text);
    if (size <= max_size) memcpy(data, text, size);
    free(text);
    return size <= max_size ? size : 0;
}
