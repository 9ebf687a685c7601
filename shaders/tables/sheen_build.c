/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/tables/sheen_build.h"

#include "base/units.h"
#include "shaders/facets/coat.h"

#define HEIGHTS 160 /* of directions, evenly in sqrt(cosine) */
#define TURNS 48    /* over half a turn */
#define MEANS 512   /* cosines of a mean, evenly in the root too */

static float alpha_of(int row, int count)
{
    float root = lerpf(SHEEN_LEAST, 1, (float)row / (float)(count - 1));
    return fmaxf(root * root * root * root, SHEEN_LEAST_ALPHA);
}

static float base_of(int row)
{
    const int per_octave = (SHEEN_BASES - 1) / ENERGY_OCTAVES;
    float octave = (float)(1 << row / per_octave) * 0x1p-10f;
    return row > 0 ? octave * (1 + (float)(row % per_octave) / per_octave) : 0;
}

static float cosine_of(int column, int count)
{
    float root = (float)column / (float)(count - 1);
    return column > 0 ? root * root : 1e-6f;
}

static float height_root(int height)
{
    return ((float)height + 0.5f) / HEIGHTS;
}

/* Integrates what is sent to each height. Light is thickest where it leaves on the near side:
 * turns stand closer there. Without a table it is not bounded. */
static void integrate_heights(const SheenTable *table, float cosine, float alpha,
                              double sent[HEIGHTS])
{
    Vec3 wo = vec3(safe_sqrtf(1 - cosine * cosine), 0, cosine);
    for (int i = 0; i < HEIGHTS * TURNS; i++) {
        float  root = height_root(i / TURNS), z = root * root, x, y;
        float  side = safe_sqrtf(1 - z * z), turn = ((float)(i % TURNS) + 0.5f) / TURNS;
        sincos_turns(0.5f * turn * turn, &y, &x);
        double area = 2 * (double)root * 2 * PI * 2 * (double)turn / (HEIGHTS * TURNS);
        Vec3   wi = vec3(side * x, side * y, z);
        if (i % TURNS == 0) sent[i / TURNS] = 0;
        sent[i / TURNS] += area * (double)z *
                           (double)(table ? sheen_lobe(table, wo, wi, alpha) :
                                            sheen_lobe_full(wo, wi, alpha));
    }
}

static float integrate(const SheenTable *table, float cosine, float alpha)
{
    double sent[HEIGHTS], sum = 0;
    integrate_heights(table, cosine, alpha, sent);
    for (int i = 0; i < HEIGHTS; i++) sum += sent[i];
    return (float)sum;
}

/* Under coats of every alpha. */
static void fill_open(const EnergyTable *coat, int row, int column, SheenTable *table)
{
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
static SheenExcess excess_of(const SheenTable *table, float ior, float cosine, int row,
                             int base)
{
    float      alpha = alpha_of(row, SHEEN_BROAD), own = sheen_albedo(table, cosine, alpha);
    float      light = 0, shape = 0;
    SheenExcess sum = {0, 0};
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
    return (SheenExcess){light > 0 ? sum.all / light : 0, shape > 0 ? sum.shape / shape : 0};
}

static SheenShare mean_of_facets(const SheenTable *table, const EnergyTable *energy, int row,
                                 int base)
{
    double albedo = 0, all = 0, shape = 0, light = 0, shaped = 0;
    for (int i = 0; i < MEANS; i++) {
        double     root = (i + 0.5) / MEANS, weight = 4 * root * root * root / MEANS;
        float      cosine = (float)(root * root);
        Energy     e = energy_directional(energy, cosine, base_of(base));
        SheenShare s = sheen_share(table, cosine, alpha_of(row, SHEEN_BROAD), base_of(base));
        albedo += weight * (double)s.albedo;
        light += weight * (double)e.all;
        shaped += weight * (double)e.shape;
        all += weight * (double)(e.all * s.all);
        shape += weight * (double)(e.shape * s.shape);
    }
    return (SheenShare){(float)albedo, (float)(all / light), (float)(shape / shaped)};
}

static void fill_albedos(SheenTable *table)
{
    for (int i = 0; i < SHEEN_ROUGHNESSES * SHEEN_COSINES; i++) {
        int r = i / SHEEN_COSINES, c = i % SHEEN_COSINES;
        table->full[r][c] = integrate(NULL, cosine_of(c, SHEEN_COSINES),
                                      alpha_of(r, SHEEN_ROUGHNESSES));
    }
    for (int r = 0; r < SHEEN_ROUGHNESSES; r++) {
        float most = 0;
        for (int c = 0; c < SHEEN_COSINES; c++) most = fmaxf(most, table->full[r][c]);
        for (int c = 0; c < SHEEN_COSINES; c++)
            table->albedo[r][c] = most < 0.98f ? table->full[r][c] :
                                  integrate(table, cosine_of(c, SHEEN_COSINES),
                                            alpha_of(r, SHEEN_ROUGHNESSES));
    }
}

const SheenTable *sheen_table_build(const EnergyTable *energy, Arena *arena)
{
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
            SheenShare mean = mean_of_facets(table, energy, r, b);
            table->mean_albedo[r] = mean.albedo;
            table->mean[r][b] = (SheenExcess){mean.all, mean.shape};
        }
    return table;
}
