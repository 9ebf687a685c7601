/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_grid.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "hemisphere/vertex/vertex.h"
#include "hemisphere/vertex/vertex_dense.h"
#include "panel/query/panel_components.h"
#include "panel/shape/least_squares.h"

_Static_assert(sizeof(PanelGridHead) == 40, "the file's layout");
_Static_assert(offsetof(PanelGridHead, level) == offsetof(TreeHeader, level) &&
                   offsetof(PanelGridHead, size) == offsetof(TreeHeader, size),
               "finest_level and tree_size read either");

#define CELL_MOST 32767
#define SETTLE_ROUNDS 40
#define SETTLED 0.2 /* of the tolerance */

/* ---- the bytes --------------------------------------------------------------------------- */

static size_t cells_of(const PanelGridHead *head) {
    return 1 + (size_t)(head->thetas - 1) * head->phis;
}

size_t panel_grid_bytes(const PanelGridHead *head) {
    size_t floats = (size_t)head->thetas + head->phis + head->components;
    size_t cells = 2 * cells_of(head) * head->components;
    return (sizeof *head + 4 * floats + cells + head->phis + 7) / 8 * 8;
}

/* A cell of the grid among the stored ones: the pole is one. */
static size_t stored_cell(const PanelGridHead *head, size_t cell) {
    return cell < head->phis ? 0 : 1 + cell - head->phis;
}

static void put(unsigned char **to, const void *from, size_t bytes) {
    memcpy(*to, from, bytes);
    *to += bytes;
}

const void *panel_grid_pack(const PanelGridCells *in, Arena *arena) {
    PanelGridHead head = in->head;
    size_t n = head.components, cells = (size_t)head.thetas * head.phis;
    float *scale = ARENA_NEW(arena, float, n);
    head.magic = PANEL_GRID_MAGIC, head.version = PANEL_GRID_VERSION;
    head.size = panel_grid_bytes(&head);
    for (size_t i = 0; i < cells * n; i++)
        scale[i % n] = fmaxf(scale[i % n], fabsf(in->cell[i]) / CELL_MOST);
    for (size_t k = 0; k < n; k++) scale[k] = fmaxf(scale[k], 1e-20f);
    unsigned char *bytes = (unsigned char *)ARENA_NEW(arena, uint64_t, head.size / 8);
    unsigned char *at = bytes;
    put(&at, &head, sizeof head);
    put(&at, in->axes.theta, 4u * head.thetas);
    put(&at, in->axes.phi, 4u * head.phis);
    put(&at, scale, 4 * n);
    for (size_t c = 0; c < cells; c++)
        for (size_t k = 0; k < n && (c == 0 || c >= head.phis); k++) {
            int16_t value = (int16_t)rintf(in->cell[c * n + k] / scale[k]);
            put(&at, &value, sizeof value);
        }
    for (int p = 0; p < head.phis; p++) *at++ = in->follows[p];
    return bytes;
}

/* ---- checked and read -------------------------------------------------------------------- */

/* A grid, its tree's vertices, and what a component is in channels. */
typedef struct GridExpansion {
    const PanelEmission *emission;
    PanelGridHead head;
    PanelAxes axes;
    size_t cells;
    float *cell; /* cells x components, as stored: the pole is one */
    bool *follows;
    PanelProfiles profiles;
    double *normal; /* components^2: factor of the loadings' normal equations */
    VertexLattice lattice;
    uint32_t vertices;
    float *value; /* vertices x components */
} GridExpansion;

static bool rises(const float *list, int count, float most) {
    for (int i = 0; i < count; i++)
        if (!(list[i] >= 0 && list[i] <= most) || (i && !(list[i] > list[i - 1]))) return false;
    return true;
}

static bool head_is_good(const PanelGridHead *h, size_t size, const PanelEmission *e) {
    return h->version == PANEL_GRID_VERSION && h->components == (uint32_t)e->components &&
           h->thetas >= 3 && h->thetas <= PANEL_GRID_SIDE_MAX && h->phis >= 1 &&
           h->phis <= PANEL_GRID_SIDE_MAX && h->level >= 1 && h->level <= PANEL_GRID_LEVEL_MAX &&
           h->rest > 0 && h->rest < 1 && h->least_share > 0 && h->least_share < 1 &&
           h->tolerance > 0 && h->tolerance < 10 && h->size == size && panel_grid_bytes(h) == size;
}

/* What stands behind a good head. */
static bool read_grid(const void *data, Arena *arena, GridExpansion *g) {
    const unsigned char *at = data;
    const PanelGridHead *h = &g->head;
    size_t n = h->components, floats = (size_t)h->thetas + h->phis + n;
    float *axis = ARENA_NEW(arena, float, floats);
    memcpy(axis, at + sizeof *h, 4 * floats);
    at += sizeof *h + 4 * floats;
    g->axes = (PanelAxes){h->thetas, h->phis, axis, axis + h->thetas};
    g->cells = cells_of(h);
    g->cell = ARENA_NEW(arena, float, g->cells *n);
    g->follows = ARENA_NEW(arena, bool, h->phis);
    const float *scale = axis + h->thetas + h->phis;
    for (size_t k = 0; k < n; k++)
        if (!(scale[k] > 0 && scale[k] < 1)) return false;
    for (size_t i = 0; i < g->cells * n; i++, at += 2) {
        int16_t value;
        memcpy(&value, at, sizeof value);
        g->cell[i] = (float)value * scale[i % n];
    }
    for (int p = 0; p < h->phis; p++) {
        if (at[p] > 1) return false;
        g->follows[p] = at[p];
    }
    return axis[0] == 0 && rises(axis, h->thetas, PI_F / 2 + 1e-3f) &&
           rises(axis + h->thetas, h->phis, 2 * PI_F);
}

/* ---- between components and light -------------------------------------------------------- */

static double fall_of(const PanelEmission *e, double theta) {
    return (double)e->cosine_power * log_d(fmax((double)PANEL_LEAST_COS, cos_d(theta)));
}

/* ln E of the channels without the fall. */
static void channel_logs(const PanelEmission *e, const float *components, float *logs) {
    for (int c = 0; c < e->channels; c++) {
        logs[c] = e->mean[c];
        for (int k = 0; k < e->components; k++)
            logs[c] += e->loading[c * e->components + k] * components[k];
    }
}

#define LOG_MOST 60.0

/* E of all cells of the grid. */
static float *light_of_cells(const GridExpansion *g, Arena *arena) {
    const PanelEmission *e = g->emission;
    size_t phis = g->head.phis, cells = g->head.thetas * phis, n = g->head.components;
    size_t channels = (size_t)e->channels;
    float *out = ARENA_NEW(arena, float, cells *channels),
          *logs = ARENA_NEW(arena, float, channels);
    for (size_t i = 0; i < cells; i++) {
        double fall = fall_of(e, (double)g->axes.theta[i / phis]);
        channel_logs(e, g->cell + stored_cell(&g->head, i) * n, logs);
        for (size_t c = 0; c < channels; c++)
            out[i * channels + c] =
                (float)exp_d(fmin(LOG_MOST, fmax(-LOG_MOST, (double)logs[c] + fall)));
    }
    return out;
}

/* So that logarithms become components: L^T L, a little more on its diagonal, factored. */
static void factor_loadings(GridExpansion *g, Arena *arena) {
    const PanelEmission *e = g->emission;
    int n = e->components;
    g->normal = ARENA_NEW(arena, double, n *n);
    for (int c = 0; c < e->channels; c++)
        for (int i = 0; i < n; i++)
            for (int k = 0; k <= i; k++)
                g->normal[i * n + k] +=
                    (double)e->loading[c * n + i] * (double)e->loading[c * n + k];
    for (int i = 0; i < n; i++) g->normal[i * (n + 1)] += 1e-9;
    least_squares_factor(g->normal, (size_t)n);
}

/* Components of light, by least squares over the channels. */
static void components_of(const GridExpansion *g, const float *light, double fall,
                          float *components) {
    const PanelEmission *e = g->emission;
    int n = e->components;
    double right[PANEL_COMPONENTS_MAX] = {0};
    for (int c = 0; c < e->channels; c++) {
        double rest = log_d(fmax((double)light[c], 1e-30)) - fall - (double)e->mean[c];
        for (int k = 0; k < n; k++) right[k] += (double)e->loading[c * n + k] * rest;
    }
    least_squares_solve(g->normal, right, (size_t)n);
    for (int k = 0; k < n; k++) components[k] = (float)right[k];
}

/* ---- the tree ---------------------------------------------------------------------------- */

static void fill_vertices(GridExpansion *g, Arena *arena) {
    Vec3 *direction = ARENA_NEW(arena, Vec3, g->vertices);
    float *light = ARENA_NEW(arena, float, g->emission->channels);
    vertex_directions(g->lattice, direction);
    for (uint32_t v = 0; v < g->vertices; v++) {
        double theta = acos_d(fmin(1, (double)direction[v].z));
        double last = (double)g->axes.theta[g->axes.thetas - 1];
        double phi = atan2_d((double)direction[v].y, (double)direction[v].x);
        panel_profiles_light(&g->profiles, theta, phi, light);
        components_of(g, light, fall_of(g->emission, fmin(theta, last)),
                      g->value + v * g->head.components);
    }
}

/* The largest change of a channel's logarithm by components. */
static float most_of(const GridExpansion *g, const float *components) {
    const PanelEmission *e = g->emission;
    float most = 0;
    for (int c = 0; c < e->channels; c++) {
        float sum = 0;
        for (int k = 0; k < e->components; k++)
            sum += e->loading[c * e->components + k] * components[k];
        most = fmaxf(most, fabsf(sum));
    }
    return most;
}

/* Triangles are linear where the light between samples is not: what that does to a cell its
 * three vertices take, each by its share (Kaczmarz's method). Returns how many cells did. */
static int settle_cells(GridExpansion *g, const Geodesic *geodesic) {
    size_t n = g->head.components, phis = g->head.phis;
    int moved = 0;
    for (size_t i = 0; i < g->cells; i++) {
        size_t ring = i ? 1 + (i - 1) / phis : 0, p = i ? (i - 1) % phis : 0;
        double theta = (double)g->axes.theta[ring], phi = (double)g->axes.phi[p];
        Vec3 d = vec3((float)(sin_d(theta) * cos_d(phi)), (float)(sin_d(theta) * sin_d(phi)),
                      (float)cos_d(theta));
        VertexPoint at = vertex_find(geodesic, g->lattice, d);
        float miss[PANEL_COMPONENTS_MAX], squares = 0;
        for (int q = 0; q < 3; q++) squares += at.weight[q] * at.weight[q];
        for (size_t k = 0; k < n; k++) {
            miss[k] = g->cell[i * n + k];
            for (int q = 0; q < 3; q++) miss[k] -= at.weight[q] * g->value[at.vertex[q] * n + k];
        }
        if (!(most_of(g, miss) > (float)SETTLED * g->head.tolerance)) continue;
        moved++;
        for (size_t k = 0; k < n; k++)
            for (int q = 0; q < 3; q++)
                g->value[at.vertex[q] * n + k] += at.weight[q] / squares * miss[k];
    }
    return moved;
}

bool panel_grid_expand(const void *data, size_t size, const PanelEmission *emission,
                       const Geodesic *geodesic, Arena *arena, Tree *out) {
    GridExpansion grid = {.emission = emission}, *g = &grid;
    memcpy(&g->head, data, sizeof g->head);
    if (!head_is_good(&g->head, size, emission)) return false;
    g->lattice = (VertexLattice){g->head.level, 4};
    *out = vertex_tree_dense(geodesic, g->lattice, emission->components, arena);
    Arena scratch = *arena;
    if (!read_grid(data, &scratch, g)) return false;
    g->vertices = vertex_count(g->lattice);
    g->value = ARENA_NEW(&scratch, float, g->vertices *(size_t)g->head.components);
    const float *cells = light_of_cells(g, &scratch);
    factor_loadings(g, &scratch);
    panel_profiles_start(&g->axes, emission->channels, cells, (double)g->head.least_share, &scratch,
                         &g->profiles);
    if (emission->has_black) g->profiles.lit -= 3;
    panel_profiles_make(&g->profiles, cells, (double)g->head.rest, &scratch);
    memcpy(g->profiles.follows, g->follows, g->head.phis);
    fill_vertices(g, &scratch);
    for (int i = 0; i < SETTLE_ROUNDS && settle_cells(g, geodesic); i++) continue;
    vertex_tree_fill(out, g->value);
    return true;
}
