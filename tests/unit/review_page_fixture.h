/* SPDX-License-Identifier: Apache-2.0 */
/* review_page_fixture.h -- what is written of a review, as text. */
#pragma once
#include "fixture.h"
#include "verdict_fixture.h"

/* Of a group whose setup is page_begin. */
static Arena arena;

static inline int page_begin(void **state) {
    if (make_folder(state)) return -1;
    arena = test_arena(state);
    return 0;
}

/* A name that no file has. */
static inline const char *fresh_name(const char *ending) {
    static int count;
    return arena_format(&arena, "%s/%d%s", test_folder(), count++, ending);
}

/* The file's text; the file goes. */
static inline const char *taken(const char *path) {
    FileBytes bytes = read_bytes(path, &arena);
    remove(path);
    assert_int_equal(bytes.size, strlen((const char *)bytes.data));
    return (const char *)bytes.data;
}

static inline const char *page_of(const ReviewPage *page) {
    const char *path = fresh_name(".html");
    assert_done(review_page_write(page, path, &err));
    return taken(path);
}

/* ---- the same again ---------------------------------------------------------------------- */

/* To six digits; what is not finite has no number. */
static inline bool is_same(double a, double b) {
    return isfinite(a) ? fabs(b - a) <= 1e-5 * fabs(a) + 1e-300 : isnan(b);
}

static inline void assert_same(double a, double b) {
    if (!is_same(a, b)) fail_msg("%.9g became %.9g", a, b);
}
