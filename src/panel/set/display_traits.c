/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/display_traits.h"

#include <math.h>

#include "record/rows.h"

static const char *const LAYOUTS[] = {"stripe", "pentile", NULL};

const char *display_traits_layout(SubpixelLayout layout)
{
    return LAYOUTS[layout - SUBPIXELS_STRIPE];
}

#define OWNER DisplayTraits

static const RecordRow POLARISATION[] = {
    NUMBER("degree", MUST, polarisation_degree, 0, 1, "The linearly polarised share."),
    NUMBER("azimuth_deg", MUST, polarisation_azimuth_deg, -360, 360,
           "Along which its electric field swings: 0 right, 90 up."),
    {0}};
const RecordFormat polarisation_format = {"polarisation", sizeof(DisplayTraits), POLARISATION,
                                         .doc = NULL};

static const RecordRow SUBPIXELS[] = {
    {"layout", RECORD_CHOICE, RECORD_REQUIRED, RECORD_AT(DisplayTraits, layout),
     .words = LAYOUTS, .doc = "stripe: red, green and blue from left to right. pentile: "
                              "diamonds, a green and a red or blue one for each pixel."},
    NUMBER("fill", 0, fill, 0.01, 1, "Share of the area that emits."),
    NUMBER("columns", RECORD_WHOLE, columns, 1, 65536, "With rows; another way to say pixels."),
    NUMBER("rows", RECORD_WHOLE, rows, 1, 65536, "With columns."),
    {0}};

static bool check_subpixels(const JsonView *view, void *item, Error *err)
{
    const DisplayTraits *t = item;
    return (t->columns > 0) == (t->rows > 0) ||
           record_fails(view, t->columns > 0 ? "columns" : "rows", err, "is there without '%s'",
                        t->columns > 0 ? "rows" : "columns");
}

const RecordFormat subpixels_format = {
    "subpixels", sizeof(DisplayTraits), SUBPIXELS, .check = check_subpixels,
    .rules = "{\"dependentRequired\": {\"columns\": [\"rows\"], \"rows\": [\"columns\"]}}"};

/* A number of pixels stands here and under "pixels": it must be the same. */
static bool check_count(const JsonView *root, const char *key, double count, double *pixels,
                        Error *err)
{
    if (json_object_get(root->object, "pixels") && count != *pixels)
        return error_at(err, ERROR_INPUT, root->file,
                        arena_format(root->arena, "%s/subpixels/%s", root->path, key),
                        "is %g, but 'pixels' says %g", count, *pixels);
    *pixels = count;
    return true;
}

static bool check_subpixel_count(const JsonView *root, double pixels[2], DisplayTraits *traits,
                                 Error *err)
{
    if (!traits->has_subpixels) return true;
    for (int k = 0; k < 2 && json_object_get(root->object, "pixels"); k++)
        if (pixels[k] != floor(pixels[k]))
            return record_fails(root, "pixels", err, "holds %g, required: whole numbers: "
                                "'subpixels' divides them", pixels[k]);
    if (traits->columns > 0 &&
        (!check_count(root, "columns", traits->columns, &pixels[0], err) ||
         !check_count(root, "rows", traits->rows, &pixels[1], err)))
        return false;
    traits->subpixels.layout = (SubpixelLayout)(SUBPIXELS_STRIPE + traits->layout);
    traits->subpixels.fill = (float)traits->fill;
    return true;
}

bool display_traits_check(const JsonView *root, double pixels[2], const double size_mm[2],
                          DisplayTraits *traits, Error *err)
{
    return check_subpixel_count(root, pixels, traits, err) &&
           (!traits->has_zones || dimming_keys_check(root, size_mm, &traits->zones, err));
}
