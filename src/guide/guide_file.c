/* SPDX-License-Identifier: Apache-2.0 */
#include "guide/guide_file.h"

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "keep/kept.h"

#define ASKED_LEAST 0.01f /* of a set that is there */

typedef struct GuideFacts {
    uint32_t node_count, cell_count, bins, zero;
} GuideFacts;

typedef struct CellRow {
    uint16_t light[GUIDE_AIMS][GUIDE_BINS];
    float asked[GUIDE_LIGHTS], is_lit;
    GuideLamps lamps;
} CellRow;

_Static_assert(sizeof(GuideFacts) == 16 && sizeof(CellRow) == 1120 && sizeof(GuideNode) == 16,
               "no padding goes to a file");

static const KeptFormat format = {"PRHLFELD", "a field of a render", GUIDE_VERSION,
                                  sizeof(GuideFacts)};

static size_t body_bytes(uint32_t nodes, uint32_t cells) {
    return nodes * sizeof(GuideNode) + cells * sizeof(CellRow);
}

static CellRow row_of(const GuideCell *cell) {
    CellRow row;
    memcpy(row.light, cell->light, sizeof row.light);
    memcpy(row.asked, cell->asked, sizeof row.asked);
    row.is_lit = cell->is_lit;
    row.lamps = cell->lamps;
    return row;
}

uint64_t guide_hash(const LightGuide *guide) {
    uint64_t hash = XXH3_64bits(guide->nodes, guide->node_count * sizeof *guide->nodes);
    for (uint32_t i = 0; i < guide->cell_count; i++) {
        CellRow row = row_of(&guide->cells[i]);
        hash = XXH3_64bits_withSeed(&row, sizeof row, hash);
    }
    return hash ? hash : 1;
}

bool guide_write(const char *path, const LightGuide *guide, Arena scratch, Error *err) {
    const GuideFacts facts = {guide->node_count, guide->cell_count, GUIDE_BINS, 0};
    const KeptFile file = {&format, path, "", &facts,
                           body_bytes(guide->node_count, guide->cell_count)};
    unsigned char *body = ARENA_NEW(&scratch, unsigned char, file.body_bytes);
    unsigned char *at = body + guide->node_count * sizeof *guide->nodes;
    memcpy(body, guide->nodes, (size_t)(at - body));
    for (uint32_t i = 0; i < guide->cell_count; i++, at += sizeof(CellRow)) {
        CellRow row = row_of(&guide->cells[i]);
        memcpy(at, &row, sizeof row);
    }
    return kept_write(&file, body, scratch, err);
}

/* ---- reading ----------------------------------------------------------------------------- */

/* Children stand behind their parent, each once: every walk down ends at a leaf. */
static bool check_tree(const LightGuide *guide, Error *err) {
    uint32_t next = 1, leaves = 0;
    for (uint32_t i = 0; i < guide->node_count; i++) {
        const GuideNode *node = &guide->nodes[i];
        if (!node->child) {
            leaves++;
            if (node->cell >= guide->cell_count)
                return error_set(err, ERROR_INPUT, "damaged field: node %u has cell %u of %u", i,
                                 node->cell, guide->cell_count);
            continue;
        }
        if (node->child <= i || node->child >= guide->node_count - 1 || node->axis < 0 ||
            node->axis > 2 || !isfinite(node->plane))
            return error_set(err, ERROR_INPUT,
                             "damaged field: node %u of %u does not part "
                             "its box",
                             i, guide->node_count);
        next += 2;
    }
    if (next == guide->node_count && leaves == guide->cell_count) return true;
    return error_set(err, ERROR_INPUT, "damaged field: %u nodes and %u cells make no tree",
                     guide->node_count, guide->cell_count);
}

static bool check_lamps(const GuideLamps *lamps, uint32_t cell, const GuideScene *scene,
                        Error *err) {
    bool ok =
        lamps->count >= 0 && lamps->count <= GUIDE_LAMPS && lamps->others >= 0 && lamps->others < 1;
    for (int i = 0; ok && i < lamps->count; i++) {
        ok = lamps->arrives[i] > 0 && lamps->arrives[i] <= 1 && lamps->id[i] >= 0;
        for (int k = 0; k < i; k++) ok = ok && lamps->id[k] != lamps->id[i];
    }
    if (!ok)
        return error_set(err, ERROR_INPUT, "damaged field: cell %u knows impossible lamps", cell);
    for (int i = 0; i < lamps->count; i++)
        if (lamps->id[i] >= scene->light_count)
            return error_set(err, ERROR_INPUT,
                             "is a field of other light: cell %u knows lamp "
                             "%d, the scene has %d",
                             cell, lamps->id[i], scene->light_count);
    bool is_all = lamps->count == scene->lamp_count;
    if (lamps->count == 0 || lamps->others > 0 || is_all) return true;
    return error_set(err, ERROR_INPUT,
                     "is a field of other light: cell %u looks for %d lamps "
                     "alone, the scene has %d",
                     cell, lamps->count, scene->lamp_count);
}

static bool check_row(const CellRow *row, uint32_t cell, const GuideScene *scene, Error *err) {
    bool ok = row->is_lit == 0 || row->is_lit == 1;
    for (int i = 0; i < GUIDE_LIGHTS; i++) ok = ok && row->asked[i] >= 0 && row->asked[i] <= 1;
    if (!ok)
        return error_set(err, ERROR_INPUT,
                         "damaged field: cell %u holds a value outside of "
                         "0 to 1",
                         cell);
    for (int i = 0; i < GUIDE_LIGHTS; i++)
        if (scene->has[i] && !(row->asked[i] >= ASKED_LEAST))
            return error_set(err, ERROR_INPUT,
                             "is a field of other light: cell %u never asks "
                             "for a kind of light that this scene has",
                             cell);
    return check_lamps(&row->lamps, cell, scene, err);
}

static bool check_facts(const KeptReader *reader, const GuideFacts *facts, Error *err) {
    if (facts->bins != GUIDE_BINS)
        return kept_damaged(reader, err, "its cells have %u bins, required: %d", facts->bins,
                            GUIDE_BINS);
    if (!facts->cell_count || facts->cell_count > GUIDE_CELLS_MAX ||
        facts->node_count != 2 * facts->cell_count - 1)
        return kept_damaged(reader, err,
                            "%u nodes and %u cells, required: 1 to %u cells, and "
                            "twice as many nodes less one",
                            facts->node_count, facts->cell_count, GUIDE_CELLS_MAX);
    return kept_has_left(reader, body_bytes(facts->node_count, facts->cell_count), err);
}

static bool take_cells(KeptReader *reader, const GuideScene *scene, LightGuide *guide, Error *err) {
    for (uint32_t i = 0; i < guide->cell_count; i++) {
        GuideCell *cell = &guide->cells[i];
        CellRow row;
        if (!kept_take(reader, &row, sizeof row, err) || !check_row(&row, i, scene, err))
            return false;
        memcpy(cell->light, row.light, sizeof row.light);
        memcpy(cell->asked, row.asked, sizeof row.asked);
        cell->is_lit = row.is_lit;
        cell->lamps = row.lamps;
    }
    return true;
}

static bool take_guide(KeptReader *reader, const GuideFacts *facts, const GuideScene *scene,
                       Arena *arena, const LightGuide **out, Error *err) {
    if (!check_facts(reader, facts, err)) return false;
    LightGuide *guide = ARENA_NEW(arena, LightGuide, 1);
    *guide = (LightGuide){.node_count = facts->node_count,
                          .cell_count = facts->cell_count,
                          .asks = true,
                          .nodes = ARENA_NEW(arena, GuideNode, facts->node_count),
                          .cells = ARENA_NEW(arena, GuideCell, facts->cell_count)};
    guide_place_bins(guide);
    *out = guide;
    return kept_take(reader, guide->nodes, guide->node_count * sizeof *guide->nodes, err) &&
           check_tree(guide, err) && take_cells(reader, scene, guide, err);
}

bool guide_read(const char *path, const GuideScene *scene, Arena *arena, const LightGuide **out,
                Error *err) {
    KeptReader reader;
    GuideFacts facts;
    const LightGuide *guide;
    if (!kept_open(&format, path, &facts, arena, &reader, err)) return false;
    bool ok = take_guide(&reader, &facts, scene, arena, &guide, err);
    kept_close(&reader);
    if (!ok) return error_in_file(err, path);
    *out = guide;
    return true;
}
