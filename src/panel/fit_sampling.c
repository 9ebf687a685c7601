/* Sampling: one tree of directions for every slice of incidence. */
#include <math.h>

#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "panel/fit_parts.h"

#define SAMPLING_CELLS 512

/* The luminous mean of f cos theta_o, a little of it uniform so that every direction and
 * wavelength can be chosen. */
bool fit_sampling(const FitSampling *shared, const float *logs, double theta, Arena *arena,
                  const void **tree, Error *err)
{
    const FitPlaces *places = shared->places;
    SamplingOptions options = {places->level, places->octants, SAMPLING_CELLS, 0.02f};
    float         *integral = ARENA_NEW(arena, float, places->leaves);
    SpecularFrame  frame = specular_frame((float)fabs(theta), shared->frame_exponent);
    for (int i = 0; i < places->leaves; i++) {
        int    from = theta < 0 ? (i + places->leaves / 2) % places->leaves : i;
        Vec3   outer = specular_frame_outer(&frame, places->direction[i]);
        double sum = 0;
        const float *row = logs + (size_t)from * (size_t)shared->wavelengths;
        for (int w = 0; w < shared->wavelengths; w++)
            sum += shared->luminous[w] * exp((double)row[w]);
        double jacobian = (double)specular_frame_jacobian(&frame, places->direction[i]);
        integral[from] = (float)(sum * fmax(0, (double)outer.z) * places->area[i] * jacobian);
    }
    return sampling_tree_build(&options, integral, arena, tree, err) ||
           error_prefix(err, "sampling of the slice at %.0f degrees",
                        degrees_from_radians(fabs(theta)));
}
