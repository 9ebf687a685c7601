/* SPDX-License-Identifier: Apache-2.0 */
/* make_tables FILE -- writes, as C, the tables that energy.h, coat.h, index_tables.h,
 * lobe_facets.h and sheen.h promise. The build runs it once; each number is written exactly. */
#include <stdio.h>

#include "base/units.h"
#include "shaders/facets/coat.h"
#include "shaders/facets/index_tables.h"
#include "shaders/facets/lobe_facets.h"
#include "shaders/facets/microfacet.h"
#include "shaders/layers/sheen.h"
#include "shaders/metallic_roughness.h"

/* ---- lobe_facets.h ----------------------------------------------------------------------- */

/* Points of the midpoint rule over the unit square of facets; as energy.c they crowd where the
 * facets lie that send light below the horizon. */
#define LOBE_TURNS 48
#define LOBE_HEIGHTS 32
#define LOBE_POINTS (LOBE_TURNS * LOBE_HEIGHTS)
/* Directions of the mean, over cosine and over a quarter of a turn. */
#define MEAN_COSINES 96
#define MEAN_TURNS 12

static LobeFacets facets_of_lobe(Vec3 wo, Vec2 alpha) {
    LobeFacets out;
    double sum[LOBE_FACETS] = {0}, at[LOBE_FACETS];
    for (int i = 0; i < LOBE_POINTS; i++) {
        int row = i / LOBE_TURNS;
        float rest = ((float)row + 0.5f) / LOBE_HEIGHTS, shift = (float)row * 0.618034f;
        float turn = ((float)(i % LOBE_TURNS) + shift - (float)(int)shift) / LOBE_TURNS;
        Vec3 wi = brushed_sample_reflection(wo, alpha, turn, 1 - rest * rest);
        if (!(wi.z > 0)) continue;
        Vec3 half = vec3_normalize(vec3_add(wo, wi));
        float weight = 2 * rest * brushed_reflection(wo, wi, half, alpha) * wi.z /
                       brushed_reflection_pdf(wo, half, alpha);
        facet_polynomials((double)vec3_dot(wo, half), at);
        for (int k = 0; k < LOBE_FACETS; k++) sum[k] += (double)weight / LOBE_POINTS * at[k];
    }
    for (int k = 0; k < LOBE_FACETS; k++) out.weight[k] = (float)sum[k];
    return out;
}

static float fourth_power(int row, int count) {
    float root = lerpf(FACET_LEAST, 1, (float)row / (float)(count - 1));
    return root * root * root * root;
}

static void fill_lobes(Vec2 alpha, LobeFacets (*rows)[FACET_COSINES]) {
    for (int t = 0; t < FACET_AZIMUTHS; t++)
        for (int c = 0; c < FACET_COSINES; c++) {
            float turn = (float)t / (FACET_AZIMUTHS - 1);
            float own = lerpf(alpha.y, alpha.x, turn * turn);
            float cosine = facet_axis_cosine((float)c / (FACET_COSINES - 1), own);
            rows[t][c] = facets_of_lobe(facet_direction(cosine, own, alpha), alpha);
        }
}

/* Evenly in the cosine's fourth root: what narrow lobes lose they lose at grazing. */
static LobeFacets mean_lobe(const FacetTable *table, Vec2 alpha) {
    LobeFacets sum = {{0}};
    float all = 0;
    for (int i = 0; i < MEAN_COSINES * MEAN_TURNS; i++) {
        float root = ((float)(i % MEAN_COSINES) + 0.5f) / MEAN_COSINES, sine, cosine;
        float root3 = root * root * root, z = root3 * root, side = safe_sqrtf(1 - z * z);
        float share = root3 * z;
        all += share;
        sincos_turns(((float)(i / MEAN_COSINES) + 0.5f) / (4 * MEAN_TURNS), &sine, &cosine);
        LobeFacets lobe = lobe_facets(table, vec3(side * cosine, side * sine, z), alpha);
        for (int k = 0; k < LOBE_FACETS; k++) sum.weight[k] += share * lobe.weight[k];
    }
    for (int k = 0; k < LOBE_FACETS; k++) sum.weight[k] /= all;
    return sum;
}

/* It takes some seconds. */
static const FacetTable *facet_table_build(Arena *arena) {
    FacetTable *table = ARENA_NEW(arena, FacetTable, 1);
    for (int a = 0; a < FACET_ALPHAS; a++)
        for (int r = 0; r < FACET_RATIOS; r++) {
            float high = fourth_power(a, FACET_ALPHAS);
            fill_lobes((Vec2){high, high * fourth_power(r, FACET_RATIOS)}, table->lobe[a][r]);
        }
    for (int a = 0; a < MEAN_ALPHAS; a++)
        for (int r = 0; r < MEAN_RATIOS; r++) {
            float high = fourth_power(a, MEAN_ALPHAS);
            table->mean[a][r] = mean_lobe(table, (Vec2){high, high * fourth_power(r, MEAN_RATIOS)});
        }
    return table;
}

/* ---- sheen.h ----------------------------------------------------------------------------- */

#define HEIGHTS 160 /* of directions, evenly in sqrt(cosine) */
#define TURNS 48    /* over half a turn */
#define MEANS 512   /* cosines of a mean, evenly in the root too */

static float alpha_of(int row, int count) {
    float root = lerpf(SHEEN_LEAST, 1, (float)row / (float)(count - 1));
    return fmaxf(root * root * root * root, SHEEN_LEAST_ALPHA);
}

static float base_of(int row) {
    return energy_alpha_of_row(row, (SHEEN_BASES - 1) / ENERGY_OCTAVES);
}

static float cosine_of(int column, int count) {
    float root = (float)column / (float)(count - 1);
    return column > 0 ? root * root : 1e-6f;
}

static float height_root(int height) {
    return ((float)height + 0.5f) / HEIGHTS;
}

/* Integrates what is sent to each height. Light is thickest where it leaves on the near side:
 * turns stand closer there. Without a table it is not bounded. */
static void integrate_heights(const SheenTable *table, float cosine, float alpha,
                              double sent[HEIGHTS]) {
    Vec3 wo = vec3(safe_sqrtf(1 - cosine * cosine), 0, cosine);
    for (int i = 0; i < HEIGHTS * TURNS; i++) {
        float root = height_root(i / TURNS), z = root * root, x, y;
        float side = safe_sqrtf(1 - z * z), turn = ((float)(i % TURNS) + 0.5f) / TURNS;
        sincos_turns(0.5f * turn * turn, &y, &x);
        double area = 2 * (double)root * 2 * PI * 2 * (double)turn / (HEIGHTS * TURNS);
        Vec3 wi = vec3(side * x, side * y, z);
        if (i % TURNS == 0) sent[i / TURNS] = 0;
        sent[i / TURNS] +=
            area * (double)z *
            (double)(table ? sheen_lobe(table, wo, wi, alpha) : sheen_lobe_full(wo, wi, alpha));
    }
}

static float integrate(const SheenTable *table, float cosine, float alpha) {
    double sent[HEIGHTS], sum = 0;
    integrate_heights(table, cosine, alpha, sent);
    for (int i = 0; i < HEIGHTS; i++) sum += sent[i];
    return (float)sum;
}

/* Under coats of every alpha. */
static void fill_open(const EnergyTable *coat, int row, int column, SheenTable *table) {
    double sent[HEIGHTS];
    integrate_heights(table, cosine_of(column, SHEEN_WIDE), alpha_of(row, SHEEN_BROAD), sent);
    for (int k = 0; k < SHEEN_BASES; k++) {
        double all = 0, out = 0;
        for (int i = 0; i < HEIGHTS; i++) {
            float root = height_root(i);
            all += sent[i];
            out += sent[i] * (double)(1 - coat_reflectance(coat, root * root, base_of(k)));
        }
        table->open[row][k][column] = (float)(out / fmax(all, 1e-30));
    }
}

/* Over the facets' lobe about one direction. */
static Energy excess_of(const SheenTable *table, float ior, float cosine, int row, int base) {
    float alpha = alpha_of(row, SHEEN_BROAD), own = sheen_albedo(table, cosine, alpha);
    float light = 0, shape = 0;
    Energy sum = {0, 0};
    EnergyLobe lobe;
    if (base == 0) return sum;
    for (int i = 0; i < ENERGY_LOBE_POINTS; i++) {
        if (!energy_lobe_point(ior, cosine, base_of(base), i, &lobe)) continue;
        float more = fmaxf(sheen_albedo(table, lobe.cosine, alpha) - own, 0);
        light += lobe.weight;
        shape += lobe.weight * lobe.shape;
        sum.all += lobe.weight * more;
        sum.shape += lobe.weight * lobe.shape * more;
    }
    return (Energy){light > 0 ? sum.all / light : 0, shape > 0 ? sum.shape / shape : 0};
}

static OverlayShare mean_of_facets(const SheenTable *table, const EnergyTable *energy, int row,
                                   int base) {
    double albedo = 0, all = 0, shape = 0, light = 0, shaped = 0;
    for (int i = 0; i < MEANS; i++) {
        double root = (i + 0.5) / MEANS, weight = 4 * root * root * root / MEANS;
        float cosine = (float)(root * root);
        Energy e = energy_directional(energy, cosine, base_of(base));
        OverlayShare s = sheen_share(table, cosine, alpha_of(row, SHEEN_BROAD), base_of(base));
        albedo += weight * (double)s.albedo;
        light += weight * (double)e.all;
        shaped += weight * (double)e.shape;
        all += weight * (double)(e.all * s.all);
        shape += weight * (double)(e.shape * s.shape);
    }
    return (OverlayShare){(float)albedo, (float)(all / light), (float)(shape / shaped)};
}

static void fill_albedos(SheenTable *table) {
    for (int i = 0; i < SHEEN_ROUGHNESSES * SHEEN_COSINES; i++) {
        int r = i / SHEEN_COSINES, c = i % SHEEN_COSINES;
        table->full[r][c] =
            integrate(NULL, cosine_of(c, SHEEN_COSINES), alpha_of(r, SHEEN_ROUGHNESSES));
    }
    for (int r = 0; r < SHEEN_ROUGHNESSES; r++) {
        float most = 0;
        for (int c = 0; c < SHEEN_COSINES; c++) most = fmaxf(most, table->full[r][c]);
        for (int c = 0; c < SHEEN_COSINES; c++)
            table->albedo[r][c] = most < 0.98f ? table->full[r][c]
                                               : integrate(table, cosine_of(c, SHEEN_COSINES),
                                                           alpha_of(r, SHEEN_ROUGHNESSES));
    }
}

/* energy: of the boundary whose facets lie beneath, and of the coat above. Some 4 seconds. */
static const SheenTable *sheen_table_build(const EnergyTable *energy, Arena *arena) {
    SheenTable *table = ARENA_NEW(arena, SheenTable, 1);
    fill_albedos(table);
    for (int i = 0; i < SHEEN_BROAD * SHEEN_WIDE; i++)
        fill_open(energy, i / SHEEN_WIDE, i % SHEEN_WIDE, table);
    for (int r = 0; r < SHEEN_BROAD; r++)
        for (int b = 0; b < SHEEN_BASES; b++)
            for (int c = 0; c < SHEEN_WIDE; c++)
                table->excess[r][b][c] =
                    excess_of(table, energy->ior, cosine_of(c, SHEEN_WIDE), r, b);
    for (int r = 0; r < SHEEN_BROAD; r++)
        for (int b = 0; b < SHEEN_BASES; b++) {
            OverlayShare mean = mean_of_facets(table, energy, r, b);
            table->mean_albedo[r] = mean.albedo;
            table->mean[r][b] = (Energy){mean.all, mean.shape};
        }
    return table;
}

/* ---- the file ---------------------------------------------------------------------------- */

/* The program's usual ones stand here themselves: water 1.333, paint and lining 1.45, glTF's
 * default 1.5, window glass 1.52. */
static const float NODES[INDEX_NODES] = {1.3f, 1.333f, 1.4f,  1.45f, 1.5f, 1.52f, 1.57f, 1.63f,
                                         1.7f, 1.78f,  1.87f, 1.98f, 2.1f, 2.25f, 2.4f};

/* All members of the tables are floats. */
static void write_floats(FILE *file, const void *table, size_t size) {
    const float *values = table;
    fprintf(file, "{");
    for (size_t i = 0; i < size / sizeof *values; i++)
        fprintf(file, "%s%af,", i % 8 ? "" : "\n", (double)values[i]);
    fprintf(file, "\n}");
}

static void write_table(FILE *file, const char *head, const void *table, size_t size) {
    fprintf(file, "\nconst %s = ", head);
    write_floats(file, table, size);
    fprintf(file, ";\n");
}

static void take_shapes(const EnergyTable *table, IndexShapes *shapes) {
    for (int a = 0; a < ENERGY_ALPHAS; a++) {
        shapes->average[a] = table->average[a].shape;
        for (int c = 0; c < ENERGY_COSINES; c++)
            shapes->directional[a][c] = table->directional[a][c].shape;
    }
}

static void write_shapes(FILE *file, Arena *arena) {
    IndexShapes *shapes = ARENA_NEW(arena, IndexShapes, 1);
    write_table(file, "float index_nodes[INDEX_NODES]", NODES, sizeof NODES);
    fprintf(file, "\nconst IndexShapes common_index_shapes[INDEX_NODES] = {\n");
    for (int i = 0; i < INDEX_NODES; i++) {
        take_shapes(energy_table_build(NODES[i], arena), shapes);
        write_floats(file, shapes, sizeof *shapes);
        fprintf(file, ",\n");
    }
    fprintf(file, "};\n");
}

int main(int count, char **names) {
    FILE *file = count == 2 ? fopen(names[1], "w") : NULL;
    if (!file) return 1;
    Arena arena = arena_reserve((size_t)1 << 28);
    const EnergyTable *energy = energy_table_build(CLEARCOAT_IOR, &arena);
    const CoatTable *coat = coat_table_build(energy, energy, &arena);
    fprintf(file, "#include \"shaders/facets/coat.h\"\n"
                  "#include \"shaders/facets/index_tables.h\"\n"
                  "#include \"shaders/facets/lobe_facets.h\"\n"
                  "#include \"shaders/layers/sheen.h\"\n");
    write_table(file, "EnergyTable common_energy_table", energy, sizeof *energy);
    write_table(file, "CoatTable common_coat_table", coat, sizeof *coat);
    write_table(file, "FacetTable common_facet_table", facet_table_build(&arena),
                sizeof(FacetTable));
    write_table(file, "SheenTable common_sheen_table", sheen_table_build(energy, &arena),
                sizeof(SheenTable));
    write_shapes(file, &arena);
    arena_release(&arena);
    return fclose(file) == 0 ? 0 : 1;
}
