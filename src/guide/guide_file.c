/* SPDX-License-Identifier: Apache-2.0 */
#include "guide/guide_file.h"

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/file_write.h"

#define MAGIC "PRHLFELD"
#define FILE_MAX ((size_t)1 << 26)
#define ASKED_LEAST 0.01f /* of a set that is there */

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "numbers go out as they lie");

typedef struct GuideHead {
    char     magic[8];
    uint32_t version, node_count, cell_count, bins;
    uint64_t hash;
} GuideHead;

typedef struct CellRow {
    uint16_t light[GUIDE_AIMS][GUIDE_BINS];
    float    asked[GUIDE_LIGHTS], is_lit;
    GuideLamps lamps;
} CellRow;

_Static_assert(sizeof(GuideHead) == 32 && sizeof(CellRow) == 1120 && sizeof(GuideNode) == 16,
               "no padding goes to a file");

static CellRow row_of(const GuideCell *cell)
{
    CellRow row;
    memcpy(row.light, cell->light, sizeof row.light);
    memcpy(row.asked, cell->asked, sizeof row.asked);
    row.is_lit = cell->is_lit;
    row.lamps = cell->lamps;
    return row;
}

uint64_t guide_hash(const LightGuide *guide)
{
    uint64_t hash = XXH3_64bits(guide->nodes, guide->node_count * sizeof *guide->nodes);
    for (uint32_t i = 0; i < guide->cell_count; i++) {
        CellRow row = row_of(&guide->cells[i]);
        hash = XXH3_64bits_withSeed(&row, sizeof row, hash);
    }
    return hash ? hash : 1;
}

bool guide_write(const char *path, const LightGuide *guide, Arena scratch, Error *err)
{
    size_t nodes = guide->node_count * sizeof *guide->nodes;
    size_t size = sizeof(GuideHead) + nodes + guide->cell_count * sizeof(CellRow);
    unsigned char *bytes = ARENA_NEW(&scratch, unsigned char, size), *at = bytes;
    GuideHead head = {.version = GUIDE_VERSION, .node_count = guide->node_count,
                      .cell_count = guide->cell_count, .bins = GUIDE_BINS,
                      .hash = guide_hash(guide)};
    memcpy(head.magic, MAGIC, sizeof head.magic);
    memcpy(at, &head, sizeof head);
    memcpy(at += sizeof head, guide->nodes, nodes);
    at += nodes;
    for (uint32_t i = 0; i < guide->cell_count; i++, at += sizeof(CellRow)) {
        CellRow row = row_of(&guide->cells[i]);
        memcpy(at, &row, sizeof row);
    }
    return file_write(path, bytes, size, err);
}

/* ---- reading ----------------------------------------------------------------------------- */

/* Children stand behind their parent, each once: every walk down ends at a leaf. */
static bool check_tree(const LightGuide *guide, Error *err)
{
    uint32_t next = 1, leaves = 0;
    for (uint32_t i = 0; i < guide->node_count; i++) {
        const GuideNode *node = &guide->nodes[i];
        if (!node->child) {
            leaves++;
            if (node->cell >= guide->cell_count)
                return error_set(err, ERROR_INPUT, "damaged field: node %u has cell %u of %u",
                                 i, node->cell, guide->cell_count);
            continue;
        }
        if (node->child <= i || node->child >= guide->node_count - 1 || node->axis < 0 ||
            node->axis > 2 || !isfinite(node->plane))
            return error_set(err, ERROR_INPUT, "damaged field: node %u of %u does not part "
                                               "its box", i, guide->node_count);
        next += 2;
    }
    if (next == guide->node_count && leaves == guide->cell_count) return true;
    return error_set(err, ERROR_INPUT, "damaged field: %u nodes and %u cells make no tree",
                     guide->node_count, guide->cell_count);
}

static bool check_lamps(const GuideLamps *lamps, uint32_t cell, const GuideScene *scene,
                        Error *err)
{
    bool ok = lamps->count >= 0 && lamps->count <= GUIDE_LAMPS && lamps->others >= 0 &&
              lamps->others < 1;
    for (int i = 0; ok && i < lamps->count; i++) {
        ok = lamps->arrives[i] > 0 && lamps->arrives[i] <= 1 && lamps->id[i] >= 0;
        for (int k = 0; k < i; k++) ok = ok && lamps->id[k] != lamps->id[i];
    }
    if (!ok)
        return error_set(err, ERROR_INPUT, "damaged field: cell %u knows impossible lamps",
                         cell);
    for (int i = 0; i < lamps->count; i++)
        if (lamps->id[i] >= scene->light_count)
            return error_set(err, ERROR_INPUT, "is a field of other light: cell %u knows lamp "
                                               "%d, the scene has %d", cell, lamps->id[i],
                             scene->light_count);
    bool is_all = lamps->count == scene->lamp_count;
    if (lamps->count == 0 || lamps->others > 0 || is_all) return true;
    return error_set(err, ERROR_INPUT, "is a field of other light: cell %u looks for %d lamps "
                                       "alone, the scene has %d", cell, lamps->count,
                     scene->lamp_count);
}

static bool check_row(const CellRow *row, uint32_t cell, const GuideScene *scene, Error *err)
{
    bool ok = row->is_lit == 0 || row->is_lit == 1;
    for (int i = 0; i < GUIDE_LIGHTS; i++) ok = ok && row->asked[i] >= 0 && row->asked[i] <= 1;
    if (!ok)
        return error_set(err, ERROR_INPUT, "damaged field: cell %u holds a value outside of "
                                           "0 to 1", cell);
    for (int i = 0; i < GUIDE_LIGHTS; i++)
        if (scene->has[i] && !(row->asked[i] >= ASKED_LEAST))
            return error_set(err, ERROR_INPUT, "is a field of other light: cell %u never asks "
                                               "for a kind of light that this scene has",
                             cell);
    return check_lamps(&row->lamps, cell, scene, err);
}

static bool check_head(const FileBytes *file, GuideHead *head, Error *err)
{
    if (file->size < sizeof *head || memcmp(file->data, MAGIC, sizeof head->magic) != 0)
        return error_set(err, ERROR_INPUT, "is not a field of a render");
    memcpy(head, file->data, sizeof *head);
    if (head->version != GUIDE_VERSION || head->bins != GUIDE_BINS)
        return error_set(err, ERROR_INPUT, "field of version %u with %u bins, required: %u "
                         "with %d", head->version, head->bins, GUIDE_VERSION,
                         GUIDE_BINS);
    if (!head->cell_count || head->cell_count > GUIDE_CELLS_MAX ||
        head->node_count != 2 * head->cell_count - 1 ||
        file->size != sizeof *head + head->node_count * sizeof(GuideNode) +
                          head->cell_count * sizeof(CellRow))
        return error_set(err, ERROR_INPUT, "damaged field: %zu bytes for %u nodes and %u cells",
                         file->size, head->node_count, head->cell_count);
    return true;
}

static bool take(const FileBytes *file, const GuideHead *head, const GuideScene *scene,
                 LightGuide *guide, Error *err)
{
    const unsigned char *at = file->data + sizeof *head;
    memcpy(guide->nodes, at, head->node_count * sizeof(GuideNode));
    at += head->node_count * sizeof(GuideNode);
    for (uint32_t i = 0; i < head->cell_count; i++, at += sizeof(CellRow)) {
        CellRow row;
        memcpy(&row, at, sizeof row);
        if (!check_row(&row, i, scene, err)) return false;
        memcpy(guide->cells[i].light, row.light, sizeof row.light);
        memcpy(guide->cells[i].asked, row.asked, sizeof row.asked);
        guide->cells[i].is_lit = row.is_lit;
        guide->cells[i].lamps = row.lamps;
    }
    if (!check_tree(guide, err)) return false;
    if (guide_hash(guide) == head->hash) return true;
    return error_set(err, ERROR_INPUT, "damaged field: its hash is %016llx, required: %016llx",
                     (unsigned long long)guide_hash(guide), (unsigned long long)head->hash);
}

bool guide_read(const char *path, const GuideScene *scene, Arena *arena,
                const LightGuide **out, Error *err)
{
    FileBytes file;
    GuideHead head;
    if (!file_read(path, FILE_MAX, arena, &file, err)) return false;
    if (!check_head(&file, &head, err)) return error_in_file(err, path);
    LightGuide *guide = ARENA_NEW(arena, LightGuide, 1);
    *guide = (LightGuide){.node_count = head.node_count, .cell_count = head.cell_count,
                     .asks = true, .nodes = ARENA_NEW(arena, GuideNode, head.node_count),
                     .cells = ARENA_NEW(arena, GuideCell, head.cell_count)};
    guide_place_bins(guide);
    if (!take(&file, &head, scene, guide, err)) return error_in_file(err, path);
    *out = guide;
    return true;
}
