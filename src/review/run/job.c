/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/job.h"

ReviewRun review_run_of(const ReviewRun *run, const ReviewRequest *request, const Review *base)
{
    ReviewRun own = *run;
    own.request = request;
    own.base = base;
    own.identity = NULL;
    own.news.on_condition = NULL;
    own.share = (ReviewShare){0};
    own.rider_count = 0;
    return own;
}
