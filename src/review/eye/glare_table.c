/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/glare_table.h"

#include <math.h>

#include "base/count.h"

GlareTally *glare_table_add(GlareTable *table, Arena *arena)
{
    size_t size = sizeof *table->list, count = (size_t)table->count;
    table->list = arena_grow(arena, table->list, count * size, (count + 1) * size,
                             _Alignof(GlareTally));
    return &table->list[table->count++];
}

/* ---- sums -------------------------------------------------------------------------------- */

static void add(GlareSum *to, const GlareSum *sum, double times)
{
    to->sr += times * sum->sr;
    to->cd_sr_m2 += times * sum->cd_sr_m2;
    to->lx += times * sum->lx;
    to->weight_sr += times * sum->weight_sr;
}

#define NO_GROUP (-1)

/* The others stand for the group that is left out. */
static double times_of(int group, int left_out)
{
    if (left_out == NO_GROUP) return 1;
    return group == left_out ? 0 : (double)GLARE_GROUPS / (GLARE_GROUPS - 1);
}

static GlareFigures figures_without(const GlareTable *table, const GlareSettings *settings,
                                    int left_out, GlareSource *sources)
{
    GlareView view = {.sources = sources};
    for (int i = 0; i < table->count; i++) {
        GlareSum sum = {0};
        for (int g = 0; g < GLARE_GROUPS; g++)
            add(&sum, &table->list[i].group[g], times_of(g, left_out));
        if (!(sum.sr > 0)) continue;
        sources[view.count++] = glare_sum_source(&sum, table->list[i].area_m2);
        view.source_lx += sum.lx;
    }
    for (int g = 0; g < GLARE_GROUPS; g++)
        view.background_lx += times_of(g, left_out) * table->background_lx[g];
    return discomfort_figures(settings, &view);
}

/* ---- how sure ---------------------------------------------------------------------------- */

static MeanInterval interval_of(double value, const double without[GLARE_GROUPS])
{
    double mean = 0, squares = 0;
    for (int g = 0; g < GLARE_GROUPS; g++) mean += without[g] / GLARE_GROUPS;
    for (int g = 0; g < GLARE_GROUPS; g++)
        squares += (without[g] - mean) * (without[g] - mean);
    double error = sqrt(squares * (GLARE_GROUPS - 1) / GLARE_GROUPS);
    double half = student_quantile(GLARE_GROUPS - 1) * error;
    if (!isfinite(half) || !isfinite(value)) return (MeanInterval){(double)NAN, (double)NAN};
    return (MeanInterval){value - half, value + half};
}

static void describe(const GlareSource *sources, GlareReading *out)
{
    out->smallest_sr = out->largest_sr = (double)NAN;
    for (int i = 0; i < out->source_count; i++) {
        out->smallest_sr = fmin(sources[i].solid_angle_sr, out->smallest_sr);
        out->largest_sr = fmax(sources[i].solid_angle_sr, out->largest_sr);
    }
}

static int seen_count(const GlareTable *table, double *lux)
{
    int count = 0;
    *lux = 0;
    for (int i = 0; i < table->count; i++) {
        GlareSum sum = {0};
        for (int g = 0; g < GLARE_GROUPS; g++) add(&sum, &table->list[i].group[g], 1);
        count += sum.sr > 0;
        *lux += sum.lx;
    }
    return count;
}

GlareReading glare_table_read(const GlareTable *table, const GlareSettings *settings,
                              double threshold_cd_m2, Arena scratch)
{
    double       ugr[GLARE_GROUPS], dgp[GLARE_GROUPS], dgi[GLARE_GROUPS];
    GlareSource *sources = ARENA_NEW(&scratch, GlareSource, table->count);
    GlareReading out = {.threshold_cd_m2 = threshold_cd_m2};
    for (int g = 0; g < GLARE_GROUPS; g++) {
        GlareFigures without = figures_without(table, settings, g, sources);
        ugr[g] = without.ugr;
        dgp[g] = without.dgp;
        dgi[g] = without.dgi;
    }
    out.figures = figures_without(table, settings, NO_GROUP, sources);
    out.source_count = seen_count(table, &out.source_lx);
    describe(sources, &out);
    out.ugr = interval_of(out.figures.ugr, ugr);
    out.dgi = interval_of(out.figures.dgi, dgi);
    out.dgp = interval_of(out.figures.dgp, dgp);
    out.dgp = (MeanInterval){fmax(out.dgp.low, 0), fmin(out.dgp.high, 1)};
    if (isnan(out.figures.dgp)) out.dgp = (MeanInterval){(double)NAN, (double)NAN};
    return out;
}
