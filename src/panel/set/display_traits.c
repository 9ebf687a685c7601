/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/display_traits.h"

#include <math.h>
#include <string.h>

#include "base/count.h"

static const char *const KEYS[] = {"polarisation", "subpixels"};
static const char *const LAYOUTS[] = {"none", "stripe", "pentile"};

const char *display_traits_key(const JsonView *root)
{
    for (int i = 0; i < COUNT_OF(KEYS); i++)
        if (json_object_get(root->object, KEYS[i])) return KEYS[i];
    return NULL;
}

const char *display_traits_layout(SubpixelLayout layout)
{
    return LAYOUTS[layout];
}

static bool need_key(const JsonView *view, const char *key, Error *err)
{
    return json_object_get(view->object, key) ||
           error_at(err, ERROR_INPUT, view->file, view->path, "key '%s' is missing", key);
}

static bool read_polarisation(const JsonView *root, DisplayTraits *out, Error *err)
{
    static const char *const keys[] = {"degree", "azimuth_deg"};
    JsonView view;
    if (!json_view_child(root, "polarisation", false, &view, err)) return false;
    if (!view.object) return true;
    return json_view_check_keys(&view, keys, COUNT_OF(keys), err) &&
           json_view_number(&view, "degree", 0, 1, &out->polarisation_degree, err) &&
           json_view_number(&view, "azimuth_deg", -360, 360, &out->polarisation_azimuth_deg,
                            err) &&
           need_key(&view, "degree", err) && need_key(&view, "azimuth_deg", err);
}

/* ---- sub-pixels -------------------------------------------------------------------------- */

static bool read_layout(const JsonView *view, SubpixelLayout *out, Error *err)
{
    const char *word = NULL;
    if (!json_view_text(view, "layout", &word, err) || !need_key(view, "layout", err))
        return false;
    for (int i = SUBPIXELS_STRIPE; i < COUNT_OF(LAYOUTS); i++) {
        *out = (SubpixelLayout)i;
        if (strcmp(word, LAYOUTS[i]) == 0) return true;
    }
    return error_at(err, ERROR_INPUT, view->file, json_view_path(view, "layout"),
                    "is \"%.40s\", wanted \"stripe\" or \"pentile\"", word);
}

/* A number of pixels stands here and under "pixels": it must be the same. */
static bool read_count(const JsonView *root, const JsonView *view, const char *key,
                       double *pixels, Error *err)
{
    double count = 0;
    if (!json_view_number(view, key, 1, 65536, &count, err)) return false;
    if (count != floor(count))
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                        "is %g, wanted a whole number", count);
    if (json_object_get(root->object, "pixels") && count != *pixels)
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                        "is %g, but 'pixels' says %g", count, *pixels);
    *pixels = count;
    return true;
}

static bool read_counts(const JsonView *root, const JsonView *view, double pixels[2],
                        Error *err)
{
    bool has_columns = json_object_get(view->object, "columns") != NULL;
    bool has_rows = json_object_get(view->object, "rows") != NULL;
    if (has_columns != has_rows)
        return error_at(err, ERROR_INPUT, view->file,
                        json_view_path(view, has_columns ? "columns" : "rows"),
                        "is there without '%s'", has_columns ? "rows" : "columns");
    return !has_columns || (read_count(root, view, "columns", &pixels[0], err) &&
                            read_count(root, view, "rows", &pixels[1], err));
}

static bool check_pixels(const JsonView *root, const double pixels[2], Error *err)
{
    if (!json_object_get(root->object, "pixels")) return true;
    for (int k = 0; k < 2; k++)
        if (pixels[k] != floor(pixels[k]))
            return error_at(err, ERROR_INPUT, root->file, json_view_path(root, "pixels"),
                            "holds %g, wanted whole numbers: 'subpixels' divides them",
                            pixels[k]);
    return true;
}

static bool read_subpixels(const JsonView *root, double pixels[2], Subpixels *out, Error *err)
{
    static const char *const keys[] = {"layout", "fill", "columns", "rows"};
    JsonView view;
    double   fill = 1;
    if (!json_view_child(root, "subpixels", false, &view, err)) return false;
    if (!view.object) return true;
    if (!json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        !read_layout(&view, &out->layout, err) ||
        !json_view_number(&view, "fill", 0.01, 1, &fill, err) ||
        !check_pixels(root, pixels, err) || !read_counts(root, &view, pixels, err))
        return false;
    out->fill = (float)fill;
    return true;
}

bool display_traits_read(const JsonView *root, double pixels[2], DisplayTraits *out,
                         Error *err)
{
    return read_polarisation(root, out, err) &&
           read_subpixels(root, pixels, &out->subpixels, err);
}
