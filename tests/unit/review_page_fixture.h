/* SPDX-License-Identifier: Apache-2.0 */
/* review_page_fixture.h -- a review's page as text, for tests of what stands on it. */
#pragma once
#include "check.h"

#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/file_write.h"
#include "verdict_fixture.h"

static Arena arena;

static inline const char *fresh_name(const char *ending)
{
    char name[64];
    snprintf(name, sizeof name, "test_review_page_XXXXXX%s", ending);
    int handle = mkstemps(name, (int)strlen(ending));
    assert_true(handle >= 0);
    close(handle);
    return arena_format(&arena, "%s", name);
}

static inline const char *page_of(const ReviewPage *page)
{
    Error       err = {0};
    FileBytes   bytes;
    const char *path = fresh_name(".html");
    if (!review_page_write(page, path, &err)) fail_msg("%s", err.text);
    assert_true(file_read(path, (size_t)1 << 28, &arena, &bytes, &err));
    remove(path);
    assert_int_equal(bytes.size, strlen((const char *)bytes.data));
    return (const char *)bytes.data;
}

static inline int count_of(const char *text, const char *part)
{
    int count = 0;
    for (const char *p = text; (p = strstr(p, part)); p++) count++;
    return count;
}
