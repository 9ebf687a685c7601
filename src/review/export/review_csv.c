/* SPDX-License-Identifier: Apache-2.0 */
#include "review/export/review_csv.h"

#include "page/page.h"
#include "review/output/review_json.h"

/* Columns are the templates': assets/pages/cases.csv and the others. */
bool review_csv_write(const Review *review, const char *path, Error *err)
{
    return page_write_values("cases.csv", review_json(review), NULL, path, err);
}

bool review_csv_write_false_suns(const Review *review, const char *path, Error *err)
{
    return page_write_values("false_suns.csv", review_json(review), NULL, path, err);
}

bool review_csv_write_gazes(const Review *review, const char *path, Error *err)
{
    return page_write_values("gazes.csv", review_json(review), NULL, path, err);
}
