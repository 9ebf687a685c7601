/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/job.h"

ReviewRun review_rider_run(const ReviewRun *run, const ReviewRider *rider, const Review *base)
{
    ReviewRun own = *run;
    own.request = rider->request;
    own.base = base;
    own.identity = NULL;
    own.news = (ReviewNews){NULL, NULL, NULL};
    own.rider_count = 0;
    return own;
}
