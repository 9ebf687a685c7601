/* SPDX-License-Identifier: Apache-2.0 */
/* A category of ISO 12312-1 stands for the middle of its range of luminous transmittance: 0: 80
 * to 100 %, 1: 43 to 80, 2: 18 to 43, 3: 8 to 18, 4: 3 to 8 (ISO 12312-1:2013, table 1, as it
 * is commonly quoted). */
#include "base/file.h"
#include "record/rows.h"
#include "review/request/request_format.h"

#define CATEGORIES 5
#define NOT_FOR_DRIVING 4

/* The middles of their ranges. */
static const double TRANSMITTANCE[CATEGORIES] = {0.9, 0.615, 0.305, 0.13, 0.055};

static bool read_category(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    ReviewGlasses *out = item;
    int category;
    if (!record_read_kind(view, row, &category, err)) return false;
    out->transmittance = TRANSMITTANCE[category];
    out->words = arena_format(view->arena,
                              "sunglasses of category %d (ISO 12312-1, as quoted; "
                              "%.3g %%, the middle of its range)",
                              category, 100 * out->transmittance);
    if (category == NOT_FOR_DRIVING)
        problems_add(view->problems, SEVERITY_WARNING, view->file, view->path,
                     "sunglasses of category 4 are not for driving (ISO 12312-1)");
    return true;
}

static bool read_grey(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    ReviewGlasses *out = item;
    if (!record_read_kind(view, row, out, err)) return false;
    out->words = arena_format(view->arena, "grey sunglasses of %.3g %%", 100 * out->transmittance);
    return true;
}

static bool read_curve(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    ReviewGlasses *out = item;
    const char *path;
    FileBytes bytes;
    Curve *curve = ARENA_NEW(view->arena, Curve, 1);
    CurveNotes notes;
    bool lets_some = false;
    if (!record_read_kind(view, row, &path, err) ||
        !file_read(path, CURVE_FILE_BYTES_MAX, view->arena, &bytes, err) ||
        !curve_parse(arena_string(view->arena, (const char *)bytes.data, bytes.size), path,
                     CURVE_SHARES, curve, &notes, err) ||
        !request_note_file(view, path, err))
        return false;
    for (int i = 0; i < CURVE_COUNT; i++) lets_some |= curve->value[i] > 0;
    if (!lets_some)
        return record_fails(view, row->key, err, "lets no light through, required: some");
    if (notes.beyond > 0)
        problems_add(view->problems, SEVERITY_WARNING, path, "", CURVE_BEYOND_WARNING,
                     path_name(path), 100 * notes.beyond, CURVE_WHOLE_FIRST_NM,
                     CURVE_WHOLE_LAST_NM);
    if (notes.unknown[0])
        problems_add(view->problems, SEVERITY_WARNING, path, "", CURVE_UNIT_WARNING,
                     path_name(path), notes.unknown);
    out->curve = curve;
    out->words = arena_format(view->arena, "sunglasses as %s has them", path_name(path));
    return true;
}

#define OWNER ReviewGlasses

static const RecordRow TRANSMITTANCES[] = {
    {"a number", RECORD_NUMBER, RECORD_AT(OWNER, transmittance), RECORD_RANGE(0.001, 1),
     .read = read_grey, .doc = "Luminous: grey lenses."},
    {"a file", RECORD_FILE, .read = read_curve, .doc = "A CSV, nm,value from 0 to 1. Of moments."},
    {0}};

static const RecordRow POLARISER[] = {
    NUMBER("axis_deg", 0, axis_deg, -360, 360,
           "Along which light comes through, from upright towards the right."),
    NUMBER("extinction", 0, extinction, 1, 1e9, "Light along the axis over light across it."),
    {0}};
static const RecordFormat polariser_format = {"polariser", sizeof(OWNER), POLARISER, .doc = NULL};

static const RecordRow GLASSES[] = {
    {"category", RECORD_INTEGER, RECORD_RANGE(0, CATEGORIES - 1), .read = read_category,
     .doc = "Of ISO 12312-1: the middle of its range, 0.9, 0.615, 0.305, 0.13, 0.055."},
    {"transmittance", RECORD_EITHER, .forms = TRANSMITTANCES},
    {"polarising", RECORD_OBJECT, .count = offsetof(OWNER, is_polarising), .of = &polariser_format,
     .doc = "They polarise, too. Of moments."},
    {0}};

static void start_glasses(void *item) {
    *(ReviewGlasses *)item = (ReviewGlasses){.extinction = 100}; /* of good lenses */
}

/* Of unpolarised light half is lost, but for what comes through across the axis. */
static bool check_glasses(const JsonView *view, void *item, Error *err) {
    ReviewGlasses *out = item;
    double most = 0.5 * (1 + 1 / out->extinction);
    if (!record_one_of(view, "category", "transmittance", err)) return false;
    if (!out->is_polarising) return true;
    if (!out->curve && !(out->transmittance <= most))
        return record_fails(view, "polarising", err,
                            "lets through at most %.3g of unpolarised light, required: "
                            "'transmittance' or a 'category' below that",
                            most);
    out->words = arena_format(view->arena,
                              "%s, polarising along %.4g degrees from upright, "
                              "%.4g : 1",
                              out->words, out->axis_deg, out->extinction);
    return true;
}

const RecordFormat review_glasses_format = {"sunglasses",
                                            sizeof(OWNER),
                                            GLASSES,
                                            .start = start_glasses,
                                            .check = check_glasses,
                                            .rules = "{'oneOf': [{'required': ['category']}, "
                                                     "{'required': ['transmittance']}]}"};
