/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/uniformity_map.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "image/image.h"
#include "openexr/exr_file.h"
#include "record/rows.h"
#include "text/csv_table.h"

/* Planes as a file has them; channels 0: none. */
typedef struct MapPlanes {
    int channels; /* 1 or 3 */
    float *value[3];
} MapPlanes;

typedef struct MapFile {
    const char *path;
    int width, height;
    MapPlanes white, black;
} MapFile;

#define VALUE_MOST 1e9f

static const char *const axes[3] = {"X", "Y", "Z"};

static bool check_size(MapFile *file, long width, long height, Error *err) {
    if (width < 1 || height < 1 || width > UNIFORMITY_SIDE_MAX || height > UNIFORMITY_SIDE_MAX ||
        width * height > UNIFORMITY_PIXELS_MAX)
        return error_at(err, ERROR_INPUT, file->path, "",
                        "has %ld x %ld pixels, required: at "
                        "most %d a side and %d in all",
                        width, height, UNIFORMITY_SIDE_MAX, UNIFORMITY_PIXELS_MAX);
    file->width = (int)width;
    file->height = (int)height;
    return true;
}

static size_t pixels_of(const MapFile *file) {
    return (size_t)file->width * (size_t)file->height;
}

/* X, Y and Z, or Y alone: how many there are of the names that begin so. */
static bool count_channels(const MapFile *file, const char *begin, const bool has[3], int *channels,
                           Error *err) {
    *channels = has[0] && has[1] && has[2] ? 3 : has[1] && !has[0] && !has[2] ? 1 : 0;
    if (*channels || !(has[0] || has[1] || has[2])) return true;
    return error_at(err, ERROR_INPUT, file->path, "",
                    "has only some of %sX, %sY and %sZ, "
                    "required: all three or %sY alone",
                    begin, begin, begin, begin);
}

/* ---- OpenEXR ----------------------------------------------------------------------------- */

static int exr_channel(const ExrPicture *picture, const char *begin, const char *axis) {
    char name[32];
    snprintf(name, sizeof name, "%s%s", begin, axis);
    for (int i = 0; i < picture->channel_count; i++)
        if (!strcmp(picture->channels[i].name, name)) return i;
    return -1;
}

/* A picture, and where the planes of its channels go. */
typedef struct MapPicture {
    const ExrPicture *picture;
    float **plane; /* NULL: not read */
    Arena *arena;
} MapPicture;

static bool exr_planes(const MapFile *file, const MapPicture *exr, const char *begin,
                       MapPlanes *out, Error *err) {
    const ExrPicture *picture = exr->picture;
    bool has[3];
    for (int j = 0; j < 3; j++) has[j] = exr_channel(picture, begin, axes[j]) >= 0;
    if (!count_channels(file, begin, has, &out->channels, err)) return false;
    for (int k = 0; k < out->channels; k++) {
        int at = exr_channel(picture, begin, axes[out->channels == 3 ? k : 1]);
        exr->plane[at] = out->value[k] = ARENA_NEW(exr->arena, float, pixels_of(file));
    }
    return true;
}

static bool read_exr(MapFile *file, Arena *arena, Error *err) {
    ExrReader *reader;
    if (!exr_reader_open(file->path, &reader, err)) return error_in_file(err, file->path);
    const ExrPicture *picture = exr_reader_picture(reader);
    const ExrWindow *data = &picture->data;
    MapPicture exr = {picture, ARENA_NEW(arena, float *, picture->channel_count), arena};
    bool ok = check_size(file, data->x1 - data->x0, data->y1 - data->y0, err) &&
              exr_planes(file, &exr, "", &file->white, err) &&
              exr_planes(file, &exr, "black.", &file->black, err);
    if (ok && file->white.channels && !exr_reader_read(reader, exr.plane, err))
        ok = error_in_file(err, file->path);
    exr_reader_destroy(reader);
    return ok;
}

/* ---- text -------------------------------------------------------------------------------- */

static int csv_channel(const CsvTable *csv, const char *begin, const char *axis) {
    char name[32];
    snprintf(name, sizeof name, "%s%s", begin, axis);
    return csv_table_column(csv, name);
}

static bool csv_planes(const MapFile *file, const CsvTable *csv, const char *begin, Arena *arena,
                       MapPlanes *out, Error *err) {
    bool has[3];
    for (int j = 0; j < 3; j++) has[j] = csv_channel(csv, begin, axes[j]) >= 0;
    if (!count_channels(file, begin, has, &out->channels, err)) return false;
    for (int k = 0; k < out->channels; k++)
        out->value[k] = ARENA_NEW(arena, float, pixels_of(file));
    return true;
}

static bool csv_index(const CsvTable *csv, int row, int column, Arena *arena, int *out,
                      Error *err) {
    float value = csv->cell[(size_t)row * (size_t)csv->columns + (size_t)column];
    *out = value >= 0 && value < UNIFORMITY_SIDE_MAX ? (int)value : -1;
    if (*out >= 0 && (float)*out == value) return true;
    return error_at(err, ERROR_INPUT, csv->file, csv_table_place(csv, row, arena),
                    "%s is %g, required: a whole number from 0 to %d", csv->name[column],
                    (double)value, UNIFORMITY_SIDE_MAX - 1);
}

/* Where every row stands; every pixel must be there once. */
static bool csv_places(MapFile *file, const CsvTable *csv, Arena *arena, size_t **out, Error *err) {
    int at[2] = {csv_table_column(csv, "column"), csv_table_column(csv, "row")};
    int most[2] = {0, 0},
        (*place)[2] = arena_alloc(arena, sizeof *place, sizeof(int), (size_t)csv->rows);
    if (at[0] < 0 || at[1] < 0)
        return error_at(err, ERROR_INPUT, csv->file, "header line", "has no column '%s'",
                        at[0] < 0 ? "column" : "row");
    for (int i = 0; i < csv->rows; i++)
        for (int k = 0; k < 2; k++) {
            if (!csv_index(csv, i, at[k], arena, &place[i][k], err)) return false;
            if (place[i][k] > most[k]) most[k] = place[i][k];
        }
    if (!check_size(file, most[0] + 1, most[1] + 1, err)) return false;
    bool *is_there = ARENA_NEW(arena, bool, pixels_of(file));
    *out = ARENA_NEW(arena, size_t, csv->rows);
    for (int i = 0; i < csv->rows; i++) {
        size_t pixel = (size_t)place[i][1] * (size_t)file->width + (size_t)place[i][0];
        if (is_there[pixel])
            return error_at(err, ERROR_INPUT, csv->file, csv_table_place(csv, i, arena),
                            "pixel %d,%d is there twice", place[i][0], place[i][1]);
        is_there[pixel] = true;
        (*out)[i] = pixel;
    }
    if ((size_t)csv->rows == pixels_of(file)) return true;
    return error_at(err, ERROR_INPUT, csv->file, "",
                    "has %d pixels of %d x %d, required: all "
                    "of them",
                    csv->rows, file->width, file->height);
}

static void csv_fill(const CsvTable *csv, const size_t *pixel, const char *begin,
                     const MapPlanes *to) {
    for (int k = 0; k < to->channels; k++) {
        int column = csv_channel(csv, begin, axes[to->channels == 3 ? k : 1]);
        for (int i = 0; i < csv->rows; i++)
            to->value[k][pixel[i]] = csv->cell[(size_t)i * (size_t)csv->columns + (size_t)column];
    }
}

static bool read_csv(MapFile *file, Arena *arena, Error *err) {
    static const char *const known[] = {"column", "row",     "X",       "Y",
                                        "Z",      "black_X", "black_Y", "black_Z"};
    CsvTable csv;
    size_t *pixel = NULL;
    if (!csv_table_read(file->path, arena, &csv, err) ||
        !csv_table_check_columns(&csv, known, COUNT_OF(known), err) ||
        !csv_places(file, &csv, arena, &pixel, err) ||
        !csv_planes(file, &csv, "", arena, &file->white, err) ||
        !csv_planes(file, &csv, "black_", arena, &file->black, err))
        return false;
    csv_fill(&csv, pixel, "", &file->white);
    csv_fill(&csv, pixel, "black_", &file->black);
    return true;
}

/* ---- pictures ---------------------------------------------------------------------------- */

static bool read_picture(MapFile *file, Arena *arena, Error *err) {
    Image image;
    if (!image_read(file->path, arena, &image, err)) return error_in_file(err, file->path);
    if (image.format != IMAGE_RGBA16)
        return error_at(err, ERROR_INPUT, file->path, "", "has %s, required: 16 bits a channel",
                        image.format == IMAGE_RGBA8 ? "8 bits a channel, whose steps show"
                                                    : "floating-point numbers");
    if (!check_size(file, image.width, image.height, err)) return false;
    const uint16_t *code = image.pixels;
    file->white.channels = 3;
    for (int j = 0; j < 3; j++) {
        float *plane = file->white.value[j] = ARENA_NEW(arena, float, pixels_of(file));
        for (size_t i = 0; i < pixels_of(file); i++) plane[i] = code[4 * i + (size_t)j];
    }
    return true;
}

/* ---- any file ---------------------------------------------------------------------------- */

static bool check_values(const MapFile *file, const MapPlanes *planes, const char *name,
                         Error *err) {
    for (int k = 0; k < planes->channels; k++) {
        const char *axis = axes[planes->channels == 3 ? k : 1];
        float most = 0;
        for (size_t i = 0; i < pixels_of(file); i++) {
            float value = planes->value[k][i];
            char place[64];
            if (value > most) most = value;
            if (value >= 0 && value <= VALUE_MOST) continue;
            snprintf(place, sizeof place, "pixel %d,%d", (int)(i % (size_t)file->width),
                     (int)(i / (size_t)file->width));
            return error_at(err, ERROR_INPUT, file->path, place,
                            "%s's %s is %g, required: a "
                            "number from 0 to %g",
                            name, axis, (double)value, (double)VALUE_MOST);
        }
        if (!(most > 0))
            return error_at(err, ERROR_INPUT, file->path, "", "%s's %s is 0 everywhere", name,
                            axis);
    }
    return true;
}

/* Grey: one plane suffices. */
static void fold_grey(const MapFile *file, MapPlanes *planes) {
    size_t bytes = pixels_of(file) * sizeof(float);
    if (planes->channels == 3 && !memcmp(planes->value[0], planes->value[1], bytes) &&
        !memcmp(planes->value[0], planes->value[2], bytes))
        planes->channels = 1;
}

static bool read_file(MapFile *file, Arena *arena, Error *err) {
    const char *ending = path_ending(file->path);
    bool is_exr = !strcasecmp(ending, ".exr"), is_csv = !strcasecmp(ending, ".csv");
    bool ok = is_exr   ? read_exr(file, arena, err)
              : is_csv ? read_csv(file, arena, err)
                       : read_picture(file, arena, err);
    if (!ok) return false;
    if (!file->white.channels)
        return error_at(err, ERROR_INPUT, file->path, "",
                        "has no %s Y, required: X, Y and Z, "
                        "or Y",
                        is_exr ? "channel" : "column");
    if (!check_values(file, &file->white, "white", err) ||
        !check_values(file, &file->black, "black", err))
        return false;
    fold_grey(file, &file->white);
    fold_grey(file, &file->black);
    return true;
}

/* ---- the key ----------------------------------------------------------------------------- */

#define OWNER UniformityFiles
static const RecordRow UNIFORMITY[] = {
    {"file", RECORD_PATH, MUST | RECORD_FILLED, RECORD_AT(OWNER, file),
     .doc = "EXR (X, Y, Z or Y; black.X ...), CSV (column, row, X, Y, Z or Y; black_X ...) or "
            "a 16-bit PNG or TIFF (linear)."},
    {"black", RECORD_PATH, RECORD_FILLED, RECORD_AT(OWNER, black),
     .doc = "Black's own file, of as many pixels. Without any black, black goes with white."},
    NUMBER("camera_mm", 0, camera_mm, 10, 1e6,
           "Distance of the camera before the middle, where it saw all places from one point; "
           "needs size_mm."),
    NUMBER("bend_deg", RECORD_RADIANS, bend, -170, 170,
           "Of a display bent about its vertical axis: the angle between the normals of its "
           "left and right edge; above 0: concave."),
    {0}};
#undef OWNER

const RecordFormat uniformity_format = {"uniformity", sizeof(UniformityFiles), UNIFORMITY,
                                        .doc = NULL};

static bool join_black(const char *manifest, MapFile *white, const MapFile *black, Error *err) {
    if (!black->path) return true;
    if (white->black.channels)
        return error_at(err, ERROR_INPUT, manifest, "/uniformity/black",
                        "names a file, but '%s' holds black too: required: one of them",
                        white->path);
    if (black->black.channels)
        return error_at(err, ERROR_INPUT, black->path, "",
                        "is named as \"black\" and has "
                        "channels of black beside its own, required: X, Y and Z, or Y, alone");
    if (black->width != white->width || black->height != white->height)
        return error_at(err, ERROR_INPUT, black->path, "",
                        "has %d x %d pixels, required: %d "
                        "x %d as in "
                        "'%s'",
                        black->width, black->height, white->width, white->height, white->path);
    white->black = black->white; /* in a file of its own it has no other name */
    return true;
}

bool uniformity_map_read(const UniformityFiles *files, const char *manifest, Arena *arena,
                         const UniformityMap **out, Error *err) {
    MapFile white = {.path = files->file}, black = {.path = files->black};
    if (!files->file) return true;
    if (!read_file(&white, arena, err) || (black.path && !read_file(&black, arena, err)) ||
        !join_black(manifest, &white, &black, err))
        return false;
    UniformityMap *map = ARENA_NEW(arena, UniformityMap, 1);
    *map = (UniformityMap){.file = white.path,
                           .width = white.width,
                           .height = white.height,
                           .white_channels = white.white.channels,
                           .black_channels = white.black.channels,
                           .is_seen = files->camera_mm > 0 || files->bend != 0,
                           .camera_mm = files->camera_mm,
                           .bend = files->bend};
    int planes = 0;
    for (int k = 0; k < white.white.channels; k++) map->value[planes++] = white.white.value[k];
    for (int k = 0; k < white.black.channels; k++) map->value[planes++] = white.black.value[k];
    *out = map;
    return true;
}
