/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/glare_found.h"

CaseGlare glare_found(const GlareReading *reading, const GlareSettings *settings)
{
    const GlareFigures *f = &reading->figures;
    return (CaseGlare){.dgp = f->dgp, .ugr = f->ugr, .dgi = f->dgi, .dgp_range = reading->dgp,
                       .ugr_range = reading->ugr, .dgi_range = reading->dgi,
                       .threshold_cd_m2 = reading->threshold_cd_m2,
                       .background_cd_m2 = f->background_cd_m2,
                       .source_lx = reading->source_lx, .smallest_sr = reading->smallest_sr,
                       .largest_sr = reading->largest_sr, .source_count = reading->source_count,
                       .low_light = settings->low_light,
                       .small_sources = settings->small_sources,
                       .none = discomfort_none_words(f->none)};
}
