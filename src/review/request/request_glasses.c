/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_glasses.h"

#include "base/file.h"

#define CATEGORIES 5
#define NOT_FOR_DRIVING 4
#define EXTINCTION 100.0 /* unless said: of good lenses */

/* The middles of their ranges. */
static const double TRANSMITTANCE[CATEGORIES] = {0.9, 0.615, 0.305, 0.13, 0.055};

static bool read_category(RequestReading *reading, const JsonView *view, ReviewGlasses *out,
                          Error *err)
{
    int category = 0;
    if (!field_integer(view, "category", (FieldBounds){0, CATEGORIES - 1}, &category, err))
        return false;
    out->transmittance = TRANSMITTANCE[category];
    out->words = arena_format(view->arena, "sunglasses of category %d (ISO 12312-1, as quoted; "
                              "%.3g %%, the middle of its range)", category,
                              100 * out->transmittance);
    if (category == NOT_FOR_DRIVING)
        problems_add(reading->problems, SEVERITY_WARNING, view->file, view->path,
                     "sunglasses of category 4 are not for driving (ISO 12312-1)");
    return true;
}

static bool read_curve(RequestReading *reading, const JsonView *view, ReviewGlasses *out,
                       Error *err)
{
    const char *path = NULL;
    FileBytes   bytes;
    Arena      *arena = view->arena;
    Curve      *curve = ARENA_NEW(arena, Curve, 1);
    double      beyond;
    if (!field_file(view, "transmittance", &path, err) ||
        !file_read(path, CURVE_FILE_BYTES_MAX, arena, &bytes, err) ||
        !curve_parse(arena_string(arena, (const char *)bytes.data, bytes.size), path,
                     CURVE_SHARES, curve, &beyond, err) ||
        !request_note_file(reading, path, err))
        return false;
    bool lets_some = false;
    for (int i = 0; i < CURVE_COUNT; i++) lets_some |= curve->value[i] > 0;
    if (!lets_some)
        return field_fails(view, "transmittance", err, "lets no light through, required: some");
    if (beyond > 0)
        problems_add(reading->problems, SEVERITY_WARNING, path, "", CURVE_BEYOND_WARNING,
                     path_name(path), 100 * beyond, CURVE_WHOLE_FIRST_NM, CURVE_WHOLE_LAST_NM);
    out->curve = curve;
    out->words = arena_format(arena, "sunglasses as %s has them", path_name(path));
    return true;
}

static bool read_transmittance(RequestReading *reading, const JsonView *view,
                               ReviewGlasses *out, Error *err)
{
    if (json_is_string(json_object_get(view->object, "transmittance")))
        return read_curve(reading, view, out, err);
    if (!json_view_number(view, "transmittance", 0.001, 1, &out->transmittance, err))
        return false;
    out->words = arena_format(view->arena, "grey sunglasses of %.3g %%",
                              100 * out->transmittance);
    return true;
}

/* Of unpolarised light half is lost, but for what comes through across the axis. */
static bool check_share(const JsonView *view, const ReviewGlasses *out, Error *err)
{
    double most = 0.5 * (1 + 1 / out->extinction);
    return out->curve || out->transmittance <= most ||
           field_fails(view, "polarising", err, "lets through at most %.3g of unpolarised "
                       "light, required: 'transmittance' or a 'category' below that", most);
}

static bool read_polariser(const JsonView *view, ReviewGlasses *out, Error *err)
{
    static const char *const keys[] = {"axis_deg", "extinction"};
    JsonView polariser;
    if (!json_object_get(view->object, "polarising")) return true;
    if (!json_view_child(view, "polarising", true, &polariser, err) ||
        !json_view_check_keys(&polariser, keys, COUNT_OF(keys), err))
        return false;
    out->is_polarising = true;
    out->extinction = EXTINCTION;
    if (!json_view_number(&polariser, "axis_deg", -360, 360, &out->axis_deg, err) ||
        !json_view_number(&polariser, "extinction", 1, 1e9, &out->extinction, err) ||
        !check_share(view, out, err))
        return false;
    out->words = arena_format(view->arena, "%s, polarising along %.4g degrees from upright, "
                              "%.4g : 1", out->words, out->axis_deg, out->extinction);
    return true;
}

bool request_glasses_read(RequestReading *reading, const JsonView *view,
                          ReviewCondition *condition, Error *err)
{
    static const char *const keys[] = {"category", "transmittance", "polarising"};
    JsonView       own;
    ReviewGlasses *out = ARENA_NEW(view->arena, ReviewGlasses, 1);
    if (!json_object_get(view->object, "sunglasses")) return true;
    if (!json_view_child(view, "sunglasses", true, &own, err) ||
        !json_view_check_keys(&own, keys, COUNT_OF(keys), err))
        return false;
    bool has_category = json_object_get(own.object, "category") != NULL;
    if (has_category == (json_object_get(own.object, "transmittance") != NULL))
        return field_fails(view, "sunglasses", err,
                           "has %s, required: one of 'category' and 'transmittance'",
                           has_category ? "both" : "neither");
    if (!(has_category ? read_category : read_transmittance)(reading, &own, out, err) ||
        !read_polariser(&own, out, err))
        return false;
    if ((out->curve || out->is_polarising) && condition->kind != CONDITION_MOMENT)
        return field_fails(view, "sunglasses", err, "is coloured or polarising beside a sweep "
                           "or a route, required: a grey one, or a moment");
    condition->glasses = out;
    return true;
}
