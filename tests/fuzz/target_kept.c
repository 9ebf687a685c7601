/* SPDX-License-Identifier: Apache-2.0 */
/* What the program keeps for itself, and may get from anywhere: trained fields, responses,
 * journals of answers. Their checksums are corrected after most changes: whoever sends
 * such a file can do that. */
#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/count.h"
#include "base/file.h"
#include "guide/guide_file.h"
#include "harness.h"
#include "keep/journal.h"
#include "review/eye/eye_reading.h"
#include "review/eye/false_suns.h"
#include "review/eye/gaze_reading.h"
#include "review/light/response_file.h"
#include "review/symbol/text_find.h"

/* A file that was written, as an input. */
static size_t take_file(const char *path, uint8_t *data, size_t max_size, Arena scratch)
{
    FileBytes bytes;
    Error     err = {0};
    fuzz_claim(file_read(path, max_size, &scratch, &bytes, &err), "an input fits its target");
    memcpy(data, bytes.data, bytes.size);
    return bytes.size;
}

static size_t change(uint8_t *data, size_t size, size_t max_size, uint64_t *state)
{
    if (fuzz_random(state) % 4) fuzz_mutate_places(data, size, fuzz_random(state));
    else size = fuzz_mutate_bytes(data, size, max_size);
    return size;
}

/* What all have in common (keep/kept.c): a head, and a checksum at the end or, of a journal, of
 * each entry. */
enum { KEPT_HEAD = 32, AT_ORDER = 8, AT_BYTES = 16, AT_IDENTITY = 24 };

static void mend_head(uint8_t *data, const char *magic, uint32_t version)
{
    const uint32_t order[2] = {0x01020304u, version};
    memcpy(data, magic, 8);
    memcpy(data + AT_ORDER, order, sizeof order);
}

static void mend_file(uint8_t *data, size_t size)
{
    uint64_t bytes = size, checksum;
    memcpy(data + AT_BYTES, &bytes, sizeof bytes);
    checksum = XXH3_64bits(data, size - sizeof checksum);
    memcpy(data + size - sizeof checksum, &checksum, sizeof checksum);
}

/* ---- fields (guide_file.c) --------------------------------------------------------------- */

enum { FIELD_HEAD = KEPT_HEAD + 16, FIELD_NODE = 16, FIELD_CELL = 1120 };

static LightGuide *make_guide(uint32_t cells, Arena *arena)
{
    LightGuide *guide = ARENA_NEW(arena, LightGuide, 1);
    *guide = (LightGuide){.node_count = 2 * cells - 1, .cell_count = cells, .asks = true,
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

size_t fuzz_make_field(uint8_t *data, size_t max_size, unsigned number, Arena *arena)
{
    Error       err = {0};
    const char *path = fuzz_path("made.field", arena);
    if (number > 3) return 0;
    fuzz_claim(guide_write(path, make_guide(1 + 2 * number, arena), *arena, &err),
               "a field can be written");
    return take_file(path, data, max_size, *arena);
}

size_t fuzz_mutate_field(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    const uint64_t no_identity = 0;
    uint64_t       state = seed;
    size = change(data, size, max_size, &state);
    if (size < FIELD_HEAD + FIELD_NODE + FIELD_CELL + 8 || !(fuzz_random(&state) % 16))
        return size;
    size_t   each = 2 * FIELD_NODE + FIELD_CELL; /* a cell more is two nodes more */
    uint32_t cells = (uint32_t)((size - FIELD_HEAD - 8 + FIELD_NODE) / each);
    uint32_t facts[3] = {2 * cells - 1, cells, GUIDE_BINS};
    mend_head(data, "PRHLFELD", GUIDE_VERSION);
    memcpy(data + AT_IDENTITY, &no_identity, sizeof no_identity);
    memcpy(data + KEPT_HEAD, facts, sizeof facts);
    size = FIELD_HEAD + cells * each - FIELD_NODE + 8;
    mend_file(data, size);
    return size;
}

static void claim_view(const LightGuide *guide, Vec3 at)
{
    const GuideSurface surface = {.ns = {0, 1, 0}, .wo = {0.6f, 0.8f, 0}, .diffuse = 0.5f,
                                  .f0 = 0.04f, .f90 = 1, .alpha = 0.1f};
    GuideView view;
    uint32_t  cell = guide_cell_at(guide, at);
    fuzz_claim(cell < guide->cell_count, "every place has a cell");
    guide_view(guide, cell, &surface, &view);
    for (int aim = 0; aim < GUIDE_AIMS; aim++) {
        const GuideChoice *choice = &view.towards[aim];
        fuzz_claim(choice->sum >= 0 && isfinite(choice->sum), "a choice has a finite sum");
        if (!(choice->sum > 0)) continue;
        Vec3  wi = guide_sample(choice, 0.3f, 0.7f);
        float pdf = guide_pdf(choice, wi), length = vec3_length(wi);
        fuzz_claim(pdf > 0 && isfinite(pdf), "what is sampled has a density");
        fuzz_claim(fabsf(length - 1) < 1e-3f, "a direction has unit length");
    }
}

void fuzz_field(const uint8_t *data, size_t size, Arena *arena)
{
    static const float places[] = {-1e30f, -1, -0.1f, 0, 0.25f, 2, 1e30f};
    const GuideScene   scene = {.has = {true, true}, .light_count = 8, .lamp_count = 4};
    const LightGuide  *guide;
    Error              err = {0};
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

size_t fuzz_make_response(uint8_t *data, size_t max_size, unsigned number, Arena *arena)
{
    Error          err = {0};
    Response       response;
    const OwnLight own = {0.25, 1.5};
    ResponseFile   file = {.path = fuzz_path("made.response", arena), .identity = identity};
    if (number > 2) return 0;
    float *shares = response_empty(0, arena, &response);
    for (unsigned i = 0; i < number * RESPONSE_BANDS; i++)
        shares[3 * i] = 1.0f / (float)(i + 3);
    response.paths = 640;
    response.relative_error = 0.0123;
    fuzz_claim(response_write(&file, &response, &own, *arena, &err),
               "a response can be written");
    return take_file(file.path, data, max_size, *arena);
}

size_t fuzz_mutate_response(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    uint64_t state = seed;
    size = change(data, size, max_size, &state);
    if (size < RESPONSE_HEAD + 8 || fuzz_random(&state) % 16 == 0) return size;
    mend_head(data, "PRHLRESP", RESPONSE_VERSION);
    mend_file(data, size);
    return size;
}

void fuzz_response(const uint8_t *data, size_t size, Arena *arena)
{
    Error        err = {0};
    Response     found;
    OwnLight     own;
    ResponseFile file = {.path = fuzz_file("a.response", data, size, arena),
                         .identity = identity};
    float        bands[RESPONSE_BANDS];
    double       without[RESPONSE_GROUPS];
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

/* ---- journals ---------------------------------------------------------------------------- */

enum { JOURNAL_ENTRY = 32, ENTRY_SUMMED = 24 };

static JournalKey key_of(unsigned number)
{
    return (JournalKey){number % 3 ? number : 0, number};
}

static void open_journal(const char *path, Arena *arena, Journal **out)
{
    Error    err = {0};
    Problems problems = problems_start(arena);
    fuzz_claim(journal_open(path, arena, &problems, out, &err), "a file becomes a journal");
}

size_t fuzz_make_journal(uint8_t *data, size_t max_size, unsigned number, Arena *arena)
{
    static const uint8_t answer[64] = {1, 2, 3};
    const char *path = fuzz_file("made.journal", "", 0, arena);
    Journal    *journal;
    if (number > 2) return 0;
    open_journal(path, arena, &journal);
    for (unsigned i = 0; i <= 4 * number; i++)
        journal_add(journal, key_of(i), answer, 13 * i % sizeof answer);
    journal_close(journal);
    return take_file(path, data, max_size, *arena);
}

size_t fuzz_mutate_journal(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    const uint64_t no_sizes[2] = {0};
    uint64_t       state = seed, answer, checksum;
    XXH3_state_t   sum;
    size = change(data, size, max_size, &state);
    if (size < KEPT_HEAD || fuzz_random(&state) % 16 == 0) return size;
    mend_head(data, "PRHLJRNL", 2);
    memcpy(data + AT_BYTES, no_sizes, sizeof no_sizes);
    for (size_t at = KEPT_HEAD; size - at >= JOURNAL_ENTRY; at += JOURNAL_ENTRY + answer) {
        memcpy(&answer, data + at + 16, sizeof answer);
        if (answer > size - at - JOURNAL_ENTRY) break;
        XXH3_64bits_reset(&sum);
        XXH3_64bits_update(&sum, data + at, ENTRY_SUMMED);
        XXH3_64bits_update(&sum, data + at + JOURNAL_ENTRY, answer);
        checksum = XXH3_64bits_digest(&sum);
        memcpy(data + at + ENTRY_SUMMED, &checksum, sizeof checksum);
    }
    return size;
}

void fuzz_journal(const uint8_t *data, size_t size, Arena *arena)
{
    unsigned char answer[64];
    Journal      *journal;
    const char   *path = fuzz_file("a.answers", data, size, arena);
    open_journal(path, arena, &journal);
    int count = journal_count(journal);
    fuzz_claim(count >= 0 && (size_t)count <= size / JOURNAL_ENTRY, "entries take room");
    for (unsigned i = 0; i < 9; i++)
        for (size_t bytes = 0; bytes <= sizeof answer; bytes += 13)
            journal_find(journal, key_of(i), answer, bytes);
    journal_add(journal, key_of(77), answer, 5);
    count = journal_count(journal);
    journal_close(journal);
    open_journal(path, arena, &journal);
    fuzz_claim(journal_count(journal) == count, "an answer that is added is kept");
    journal_close(journal);
}

/* ---- answers: what a journal's entries may hold ------------------------------------------ */

/* Rays with places in the table of cells, a gaze, an eye, a text: as bytes, so that any are
 * tried. */
typedef struct AnswerBytes {
    uint8_t parts, texts, rays, cells;
} AnswerBytes;

enum { PARTS_MOST = 16 };

static bool take(const uint8_t **from, size_t *left, void *to, size_t bytes)
{
    if (*left < bytes) return false;
    memcpy(to, *from, bytes);
    *from += bytes;
    *left -= bytes;
    return true;
}

static void claim_suns(const FalseSunRays *rays, int parts, Arena *arena)
{
    float bands[LIGHT_BANDS];
    if (!false_suns_are_sound(rays, parts)) return;
    for (int i = 0; i < LIGHT_BANDS; i++) bands[i] = 1;
    FalseSuns suns = false_suns_of(rays, bands, arena);
    for (int i = 0; i < rays->count; i++) {
        FalseSunSight sight = false_suns_at(&suns, rays->list[i].sun);
        fuzz_claim(!isnan(sight.share) && sight.part_id < parts, "an image is of the scene");
    }
}

static void run_suns(const AnswerBytes *head, const uint8_t **from, size_t *left, Arena *arena)
{
    FalseSunRay *list = ARENA_NEW(arena, FalseSunRay, head->rays);
    int         *first = ARENA_NEW(arena, int, FALSE_SUN_CELLS + 1);
    int          at[2], value = 0, cell = 0;
    for (int i = 0; i < head->rays; i++)
        if (!take(from, left, &list[i], sizeof *list)) return;
    for (int i = 0; i < head->cells && take(from, left, at, sizeof at); i++) {
        int end = at[0] & 0xffff;
        for (; cell < end && cell < FALSE_SUN_CELLS; cell++) first[cell] = value;
        value = at[1];
    }
    for (; cell <= FALSE_SUN_CELLS; cell++) first[cell] = value;
    claim_suns(&(FalseSunRays){list, first, head->rays}, head->parts % PARTS_MOST, arena);
}

void fuzz_answers(const uint8_t *data, size_t size, Arena *arena)
{
    AnswerBytes  head;
    GazeReading  gaze;
    EyeReading   eye;
    TextProposal text;
    int          parts;
    if (!take(&data, &size, &head, sizeof head)) return;
    parts = head.parts % PARTS_MOST;
    if (take(&data, &size, &gaze, sizeof gaze) && gaze_reading_is_sound(&gaze, parts))
        fuzz_claim(gaze.most.pane_id < parts && gaze.most.part_id < parts &&
                       gaze.most.source >= 0 && gaze.most.source < LIGHT_SETS,
                   "what a gaze meets is of the scene");
    if (take(&data, &size, &eye, sizeof eye) && eye_reading_is_sound(&eye))
        fuzz_claim(isfinite(eye.veil) && isfinite(eye.vertical_lx),
                   "an eye's light is a number");
    for (int i = 0; i < head.texts % 6; i++)
        if (take(&data, &size, &text, sizeof text) && text_proposal_is_sound(&text))
            for (int k = 0; k < 4; k++)
                fuzz_claim(text.uv[k] >= 0 && text.uv[k] <= 1, "a text lies in the content");
    run_suns(&head, &data, &size, arena);
}

size_t fuzz_make_answers(uint8_t *data, size_t max_size, unsigned number, Arena *arena)
{
    (void)arena;
    const AnswerBytes  head = {3, 1, (uint8_t)(2 * number), 2};
    const GazeReading  gaze = {.most = {.pane_id = 1, .part_id = NO_ID}};
    const TextProposal text = {.uv = {0.1, 0.2, 0.3, 0.4}, .height_px = 9, .characters = 4};
    const int          cells[2][2] = {{9, 0}, {500, head.rays}};
    size_t read = sizeof head + sizeof gaze + sizeof(EyeReading);
    size_t size = read + sizeof text + head.rays * sizeof(FalseSunRay);
    if (number > 2 || size + sizeof cells > max_size) return 0;
    memset(data, 0, size);
    memcpy(data, &head, sizeof head);
    memcpy(data + sizeof head, &gaze, sizeof gaze);
    memcpy(data + read, &text, sizeof text);
    for (int i = 0; i < head.rays; i++) {
        const FalseSunRay ray = {.sun = {0, 1, 0}, .seen = {0, 0, -1}, .sr = 1e-5f,
                                 .part_id = i % 3};
        memcpy(data + read + sizeof text + (size_t)i * sizeof ray, &ray, sizeof ray);
    }
    memcpy(data + size, cells, sizeof cells);
    return size + sizeof cells;
}
