/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request.h"

#include "base/sampler.h"

int review_eye_count(const ReviewEye *eye)
{
    return eye->kind == EYE_BOX ? eye->grid[0] * eye->grid[1] * eye->grid[2] : 1;
}

/* Point i of n from -1 to 1; one alone is the middle. */
static double share_of(int i, int n)
{
    return n > 1 ? 2.0 * i / (n - 1) - 1 : 0;
}

void review_eye_point(const ReviewEye *eye, int i, double out_m[3])
{
    for (int axis = 0; axis < 3; axis++) {
        int n = eye->kind == EYE_BOX ? eye->grid[axis] : 1;
        out_m[axis] = eye->position_m[axis] + eye->half_size_m[axis] * share_of(i % n, n);
        i /= n;
    }
}

double review_range_value(const ReviewRange *range, int i)
{
    return i == range->count - 1 ? range->last : range->first + i * range->step;
}

uint32_t review_seed(const ReviewRequest *request, uint32_t base)
{
    return request->seed ? hash_combine(hash_u32(base), request->seed) : base;
}

int review_look_count(const ReviewRequest *request)
{
    int count = 0;
    for (int g = 0; g < request->gaze_count; g++)
        for (int e = 0; e < request->eye_count; e++)
            count += !request->gazes[g].at_symbols && request->gazes[g].for_eye[e];
    return count;
}
