/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/detail.h"

#include "base/parallel.h"

typedef struct Detail {
    const DetailPicture *picture;
    DetailDifference *pixel; /* each pixel's own, */
    DetailDifference *line;  /* and the sum over it and its neighbours to the left and right */
} Detail;

static int first_of(int at) {
    return at > DETAIL_REACH ? at - DETAIL_REACH : 0;
}

static int end_of(int at, int count) {
    return at + DETAIL_REACH < count ? at + DETAIL_REACH + 1 : count;
}

static void sum_row(void *context, int y, int worker) {
    const Detail *detail = context;
    const int width = detail->picture->width;
    const size_t row = (size_t)y * (size_t)width;
    (void)worker;
    for (int x = 0; x < width; x++)
        detail->picture->difference(detail->picture->user, row + (size_t)x,
                                    &detail->pixel[row + (size_t)x]);
    for (int x = 0; x < width; x++) {
        DetailDifference sum = {0, 0};
        for (int k = first_of(x); k < end_of(x, width); k++) {
            sum.square += detail->pixel[row + (size_t)k].square;
            sum.variance += detail->pixel[row + (size_t)k].variance;
        }
        detail->line[row + (size_t)x] = sum;
    }
}

static void give_back_row(void *context, int y, int worker) {
    const Detail *detail = context;
    const DetailPicture *picture = detail->picture;
    const size_t width = (size_t)picture->width;
    (void)worker;
    for (size_t x = 0; x < width; x++) {
        DetailDifference sum = {0, 0};
        for (int k = first_of(y); k < end_of(y, picture->height); k++) {
            sum.square += detail->line[(size_t)k * width + x].square;
            sum.variance += detail->line[(size_t)k * width + x].variance;
        }
        const size_t at = (size_t)y * width + x;
        if (sum.square > sum.variance && !(detail->pixel[at].square > DETAIL_SPECK * sum.square))
            picture->give_back(picture->user, at, 1 - sum.variance / sum.square);
    }
}

void detail_run(const DetailPicture *picture, int threads, Arena scratch) {
    const size_t count = (size_t)picture->width * (size_t)picture->height;
    Detail detail = {picture, ARENA_NEW(&scratch, DetailDifference, count),
                     ARENA_NEW(&scratch, DetailDifference, count)};
    parallel_for(threads, picture->height, sum_row, &detail);
    parallel_for(threads, picture->height, give_back_row, &detail);
}
