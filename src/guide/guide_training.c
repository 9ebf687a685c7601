/* SPDX-License-Identifier: Apache-2.0 */
#include "guide/guide_training.h"

#include <math.h>

#define LEAST 0.05   /* of a cell's light, over all bins alike */
#define NEIGHBOURS 4 /* cells on either side in the tree's order */
#define DOUBT 4.0    /* rays into a bin of theirs, in the mean, that count as the cell's own */

#define NODES_MAX (2 * GUIDE_CELLS_MAX - 1) /* of a tree with so many leaves */

/* ---- the tree ---------------------------------------------------------------------------- */

static float coordinate(const GuidePlace *place, int axis) {
    return axis == 0 ? place->position.x : axis == 1 ? place->position.y : place->position.z;
}

/* The axis along which the places are spread most. */
static int widest(const GuidePlace *places, uint32_t count) {
    double variance[3];
    for (int axis = 0; axis < 3; axis++) {
        double sum = 0, squares = 0;
        for (uint32_t i = 0; i < count; i++) {
            double at = (double)coordinate(&places[i], axis);
            sum += at;
            squares += at * at;
        }
        variance[axis] = squares / count - sum / count * (sum / count);
    }
    return variance[0] >= variance[1] && variance[0] >= variance[2] ? 0
           : variance[1] >= variance[2]                             ? 1
                                                                    : 2;
}

/* Puts places below `plane` first; returns how many they are. Keeps no order. */
static uint32_t below(GuidePlace *places, uint32_t count, int axis, float plane) {
    uint32_t low = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!(coordinate(&places[i], axis) < plane)) continue;
        GuidePlace place = places[i];
        places[i] = places[low];
        places[low++] = place;
    }
    return low;
}

/* The median, by halving the range of values. */
static float median(const GuidePlace *places, uint32_t count, int axis) {
    float low = coordinate(&places[0], axis), high = low;
    for (uint32_t i = 1; i < count; i++) {
        low = fminf(low, coordinate(&places[i], axis));
        high = fmaxf(high, coordinate(&places[i], axis));
    }
    for (int step = 0; step < 24; step++) {
        float middle = 0.5f * (low + high);
        uint32_t smaller = 0;
        for (uint32_t i = 0; i < count; i++) smaller += coordinate(&places[i], axis) < middle;
        if (smaller * 2 <= count) low = middle;
        else high = middle;
    }
    return high;
}

typedef struct TreeBuild {
    LightGuide *guide;
    uint32_t *first_place;
    uint32_t most;
    const GuidePlace *all;
} TreeBuild;

/* Cells come in the order of their places. */
static void part(TreeBuild *build, uint32_t node, GuidePlace *places, uint32_t count) {
    LightGuide *guide = build->guide;
    int axis = 0;
    float plane = 0;
    uint32_t low = 0;
    if (count > build->most) {
        axis = widest(places, count);
        plane = median(places, count, axis);
        low = below(places, count, axis, plane);
    }
    bool is_full = guide->node_count + 2 > NODES_MAX; /* every node ends in a cell of its own */
    if (low == 0 || low == count || is_full) {
        build->first_place[guide->cell_count] = (uint32_t)(places - build->all);
        guide->nodes[node] = (GuideNode){.cell = guide->cell_count++};
        return;
    }
    uint32_t child = guide->node_count;
    guide->node_count += 2;
    guide->nodes[node] = (GuideNode){plane, axis, child, 0};
    part(build, child, places, low);
    part(build, child + 1, places + low, count - low);
}

/* Medians leave cells of more than half of `most`: were there more of those than the guide
 * holds, the places that come last would share one. */
static uint32_t most_a_cell(uint32_t count, uint32_t most) {
    uint32_t least = 2 * (count / GUIDE_CELLS_MAX + 1);
    return most > least || count <= GUIDE_CELLS_MAX ? most : least;
}

GuideTraining *guide_training_start(GuidePlace *places, uint32_t count, uint32_t most,
                                    Arena *arena) {
    GuideTraining *training = ARENA_NEW(arena, GuideTraining, 1);
    LightGuide *guide = &training->guide;
    guide->nodes = ARENA_NEW(arena, GuideNode, NODES_MAX);
    guide->node_count = 1;
    training->places = places;
    training->first_place = ARENA_NEW(arena, uint32_t, GUIDE_CELLS_MAX + 1);
    TreeBuild build = {guide, training->first_place, most_a_cell(count, most), places};
    part(&build, 0, places, count);
    training->first_place[guide->cell_count] = count;
    guide->cells = ARENA_NEW(arena, GuideCell, guide->cell_count);
    training->cells = ARENA_NEW(arena, CellTraining, guide->cell_count);
    for (uint32_t i = 0; i < guide->cell_count; i++) {
        for (int aim = 0; aim < GUIDE_AIMS; aim++)
            training->cells[i].sums[aim] = ARENA_NEW(arena, float, GUIDE_BINS);
        training->cells[i].counts = ARENA_NEW(arena, uint32_t, GUIDE_BINS);
    }
    guide_place_bins(guide);
    return training;
}

/* ---- training passes --------------------------------------------------------------------- */

void guide_training_choose(GuideTraining *training, int round) {
    for (uint32_t cell = 0; cell < training->guide.cell_count; cell++) {
        CellTraining *own = &training->cells[cell];
        uint32_t first = training->first_place[cell];
        uint32_t count = training->first_place[cell + 1] - first;
        own->point_count = count < GUIDE_POINTS ? (int)count : GUIDE_POINTS;
        for (int i = 0; i < own->point_count; i++) {
            uint32_t step = count / (uint32_t)own->point_count;
            uint32_t at = (uint32_t)i * step + (uint32_t)round * 7u % step;
            own->points[i] = training->places[first + at];
        }
    }
}

/* What rays into every bin found: sums of luminances, and numbers of rays. */
typedef struct BinFinds {
    double sum[GUIDE_BINS], count[GUIDE_BINS];
} BinFinds;

static void add_finds(const CellTraining *own, GuideAim aim, BinFinds *finds) {
    for (int i = 0; i < GUIDE_BINS; i++) {
        finds->sum[i] += (double)own->sums[aim][i];
        finds->count[i] += own->counts[i];
    }
}

/* Few rays of its own find a small light by luck: those of neighbours, which see much the
 * same, count a little, too. */
static void with_neighbours(const GuideTraining *training, uint32_t cell, GuideAim aim,
                            BinFinds *finds) {
    uint32_t first = cell > NEIGHBOURS ? cell - NEIGHBOURS : 0;
    uint32_t end = cell + NEIGHBOURS + 1;
    BinFinds all = {.count = {0}};
    for (uint32_t i = first; i < end && i < training->guide.cell_count; i++)
        add_finds(&training->cells[i], aim, &all);
    for (int i = 0; i < GUIDE_BINS; i++) {
        if (!(all.count[i] > 0)) continue;
        finds->sum[i] += DOUBT * all.sum[i] / all.count[i];
        finds->count[i] += DOUBT;
    }
}

/* The mean luminance of a bin times its solid angle, up to a factor. */
static double bin_light(const LightGuide *guide, const BinFinds *finds, int bin) {
    int row = bin / GUIDE_SIDE, lane = bin % GUIDE_SIDE;
    double taxicab = 0;
    for (int k = 0; k < 3; k++) taxicab += fabs((double)guide->bin[k][row][lane]);
    return finds->count[bin] > 0 ? finds->sum[bin] / finds->count[bin] * taxicab * taxicab * taxicab
                                 : 0;
}

/* A little is left everywhere: what the training pass did not find may be there all the
 * same. */
static bool update_aim(const GuideTraining *training, uint32_t cell, GuideAim aim,
                       GuideRow out[GUIDE_SIDE]) {
    BinFinds finds = {.count = {0}};
    double light[GUIDE_BINS], total = 0, most = 0;
    add_finds(&training->cells[cell], aim, &finds);
    with_neighbours(training, cell, aim, &finds);
    for (int i = 0; i < GUIDE_BINS; i++) total += light[i] = bin_light(&training->guide, &finds, i);
    for (int i = 0; i < GUIDE_BINS && total > 0; i++) {
        light[i] = (1 - LEAST) * light[i] / total + LEAST / GUIDE_BINS;
        most = fmax(most, light[i]);
    }
    for (int i = 0; i < GUIDE_BINS && total > 0; i++)
        out[i / GUIDE_SIDE][i % GUIDE_SIDE] = (uint16_t)(light[i] / most * UINT16_MAX);
    return total > 0;
}

void guide_training_update(GuideTraining *training, uint32_t cell) {
    GuideCell *out = &training->guide.cells[cell];
    bool has_light = update_aim(training, cell, GUIDE_LIGHT, out->light[GUIDE_LIGHT]);
    bool has_sky = update_aim(training, cell, GUIDE_SKY, out->light[GUIDE_SKY]);
    out->is_lit = has_light || has_sky;
}

/* A plane's illuminance by bins of this light, up to a factor. */
static double illuminance(const LightGuide *guide, const float light[GUIDE_BINS], Vec3 normal) {
    float lane[GUIDE_SIDE] = {0};
    double sum = 0;
    for (int i = 0; i < GUIDE_BINS; i++) {
        int row = i / GUIDE_SIDE, x = i % GUIDE_SIDE;
        float cosine = normal.x * guide->bin[0][row][x] + normal.y * guide->bin[1][row][x] +
                       normal.z * guide->bin[2][row][x];
        lane[x] += light[i] * fmaxf(cosine, 0);
    }
    for (int x = 0; x < GUIDE_SIDE; x++) sum += (double)lane[x];
    return sum;
}

double guide_training_illuminance(const GuideTraining *training, uint32_t cell) {
    uint32_t first = training->first_place[cell], end = training->first_place[cell + 1];
    BinFinds finds = {.count = {0}};
    float light[GUIDE_BINS];
    double sum = 0;
    add_finds(&training->cells[cell], GUIDE_LIGHT, &finds);
    for (int i = 0; i < GUIDE_BINS; i++) light[i] = (float)bin_light(&training->guide, &finds, i);
    for (uint32_t p = first; p < end; p++)
        sum += illuminance(&training->guide, light, training->places[p].normal);
    return end > first ? sum * 4 / GUIDE_BINS / (double)(end - first) : 0;
}
