/* SPDX-License-Identifier: Apache-2.0 */
#include "film/film_part.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "film/film_add.h"
#include "film/pixels.h"

#define PART_NAME "film"
#define BAND_BYTES ((size_t)64 << 20)

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "words are named by their weight");

uint64_t film_part_volume(const FilmPart *part) {
    return (uint64_t)(part->crop.x1 - part->crop.x0) * (uint64_t)(part->crop.y1 - part->crop.y0) *
           (part->end_sample - part->first_sample);
}

FilmPart film_part_of(const Film *film, uint32_t first_sample, uint32_t end_sample) {
    return (FilmPart){.name = "",
                      .width = film->width,
                      .height = film->height,
                      .crop = film->crop,
                      .layers = film->layers,
                      .lights = film->lights,
                      .first_sample = first_sample,
                      .end_sample = end_sample,
                      .asked_end = end_sample,
                      .dropped = film->dropped};
}

/* ---- names of the words ------------------------------------------------------------------ */

/* The members of PixelSums as they lie in memory. */
static const char *const sum_names[] = {"xyz.X",          "xyz.Y",          "xyz.Z",
                                        "squares.R.low",  "squares.R.high", "squares.G.low",
                                        "squares.G.high", "squares.B.low",  "squares.B.high",
                                        "odd.X",          "odd.Y",          "odd.Z"};
static const char *const count_names[] = {"samples",     "hits",       "displayHits",
                                          "part.sample", "part.id",    "display.sample",
                                          "display.id",  "odd.samples"};

#define SUM_NAMES (sizeof sum_names / sizeof *sum_names)
#define COUNT_NAMES (sizeof count_names / sizeof *count_names)
_Static_assert(SUM_NAMES * sizeof(Fixed) == offsetof(PixelSums, samples) &&
                   SUM_NAMES * sizeof(Fixed) + COUNT_NAMES * 4 == sizeof(PixelSums),
               "a new member of PixelSums has no name here, and is not added in film_add.c");

typedef struct NameList {
    const char **names;
    int count;
    Arena *arena;
} NameList;

static void add_name(NameList *list, const char *name) {
    list->names[list->count++] = name;
}

static void add_sum(NameList *list, const char *name) {
    for (int word = 0; word < 4; word++)
        add_name(list, arena_format(list->arena, "%s.%d", name, word));
}

/* Names of a pixel's words in their order; the room is that of all layers. */
static ExrWords name_words(const FilmPart *part, Arena *arena) {
    unsigned layers = part->layers;
    size_t sums = SUM_NAMES + 4 * SUMS_COUNT + 3 * (size_t)part->lights.count;
    size_t most = 4 * sums + COUNT_NAMES;
    NameList list = {ARENA_NEW(arena, const char *, most), 0, arena};
    for (size_t i = 0; i < SUM_NAMES; i++) add_sum(&list, sum_names[i]);
    for (size_t i = 0; i < COUNT_NAMES; i++) add_name(&list, count_names[i]);
    for (int i = 0; i < SUMS_COUNT; i++)
        for (int k = 0; (layers & sums_rows[i].users) && k < sums_rows[i].size; k++)
            add_sum(&list,
                    arena_format(arena, "%s.%c", sums_rows[i].name, sums_rows[i].letters[k]));
    for (int i = 0; i < 3 * part->lights.count; i++)
        add_sum(&list, arena_format(arena, "light.%d.%c", i / 3, "XYZ"[i % 3]));
    return (ExrWords){.name = PART_NAME, .count = list.count, .names = list.names};
}

/* ---- attributes -------------------------------------------------------------------------- */

/* The meaning of the sums: those of another program are refused when it differs. */
static const char *layout_text(Arena *arena) {
    return arena_format(arena,
                        "1: sums in steps of 2^%d, squares of 2^%d and from %a on 2^%d, "
                        "blocks of %d samples",
                        -FIXED_BITS, -SQUARE_LOW_BITS, SQUARE_SPLIT, -SQUARE_HIGH_BITS,
                        BLOCK_SAMPLES);
}

static const char *range_text(uint32_t first, uint32_t end, Arena *arena) {
    return arena_format(arena, "%u:%u", first, end);
}

/* "COUNT SAMPLE,X,Y SAMPLE,X,Y ..." */
static const char *dropped_text(const FilmDropped *dropped, Arena *arena) {
    const char *text = arena_format(arena, "%llu", (unsigned long long)dropped->count);
    for (int i = 0; i < dropped->kept; i++)
        text = arena_format(arena, "%s %u,%d,%d", text, dropped->first[i].sample_index,
                            dropped->first[i].x, dropped->first[i].y);
    return text;
}

static const char *cost_text(const FilmPart *part, Arena *arena) {
    return arena_format(arena, "%llu paths, %llu camera, %llu bounce, %llu shadow rays",
                        (unsigned long long)part->paths, (unsigned long long)part->camera_rays,
                        (unsigned long long)part->bounce_rays,
                        (unsigned long long)part->shadow_rays);
}

/* One name a line. */
static const char *lights_text(const FilmLights *lights, Arena *arena) {
    const char *text = "";
    for (int i = 0; i < lights->count; i++)
        text = arena_format(arena, "%s%s\n", text, lights->names[i]);
    return text;
}

enum { TEXT_LAYOUT, TEXT_SAMPLES, TEXT_ASKED, TEXT_DROPPED, TEXT_COST, TEXT_LIGHTS, TEXT_COUNT };

static const char *const text_names[TEXT_COUNT] = {"parhelion:sums",         "parhelion:samples",
                                                   "parhelion:askedSamples", "parhelion:dropped",
                                                   "parhelion:cost",         "parhelion:lights"};

/* Only a part with LAYER_LIGHT has the last. */
static int text_count(const FilmPart *part) {
    return part->layers & LAYER_LIGHT ? TEXT_COUNT : TEXT_LIGHTS;
}

static void make_texts(const FilmPart *part, const char *texts[TEXT_COUNT], Arena *arena) {
    texts[TEXT_LAYOUT] = layout_text(arena);
    texts[TEXT_SAMPLES] = range_text(part->first_sample, part->end_sample, arena);
    texts[TEXT_ASKED] = range_text(part->first_sample, part->asked_end, arena);
    texts[TEXT_DROPPED] = dropped_text(&part->dropped, arena);
    texts[TEXT_COST] = cost_text(part, arena);
    texts[TEXT_LIGHTS] = lights_text(&part->lights, arena);
}

/* ---- the checksum ------------------------------------------------------------------------ */

/* Checksum of the attributes; those of the rows are added to it, in any order. */
static uint64_t checksum_of_texts(const FilmPart *part, const char *const texts[TEXT_COUNT]) {
    uint64_t checksum = part->layers;
    for (int i = 0; i < text_count(part); i++)
        checksum = XXH3_64bits_withSeed(texts[i], strlen(texts[i]), checksum);
    return checksum;
}

/* rows: `count` rows of `bytes` bytes each, the first is row y of the frame. */
static uint64_t checksum_of_rows(const char *rows, size_t bytes, int y, int count) {
    uint64_t checksum = 0;
    for (int i = 0; i < count; i++)
        checksum += XXH3_64bits_withSeed(rows + (size_t)i * bytes, bytes, (uint64_t)(y + i));
    return checksum;
}

/* ---- into a file ------------------------------------------------------------------------- */

static size_t row_bytes(const FilmPart *part, size_t pixel_bytes) {
    return (size_t)(part->crop.x1 - part->crop.x0) * pixel_bytes;
}

/* Rows of a film as they are written. */
typedef struct GatheredRows {
    ExrRows rows;
    const Film *film;
    char *values;
} GatheredRows;

static void gather_rows(void *from, int y0, int y1) {
    const GatheredRows *to = from;
    size_t begin = film_index(to->film, to->film->crop.x0, y0);
    film_gather(to->film, begin, film_index(to->film, to->film->crop.x0, y1) - begin, to->values);
}

static GatheredRows *prepare_rows(const Film *film, size_t row, int all, Arena *arena) {
    GatheredRows *to = ARENA_NEW(arena, GatheredRows, 1);
    int count = exr_rows_in(BAND_BYTES, row, all);
    *to = (GatheredRows){{count, gather_rows, to},
                         film,
                         arena_alloc(arena, row, _Alignof(PixelSums), (size_t)count)};
    return to;
}

static uint64_t checksum_of_film(GatheredRows *from, size_t row) {
    uint64_t checksum = 0;
    for (int y = from->film->crop.y0; y < from->film->crop.y1; y++) {
        gather_rows(from, y, y + 1);
        checksum += checksum_of_rows(from->values, row, y, 1);
    }
    return checksum;
}

void film_part_attach(FrameImage *frame, const Film *film, const FilmPart *part, Arena *arena) {
    ExrWords *words = ARENA_NEW(arena, ExrWords, 1);
    ExrAttribute *attributes = ARENA_NEW(arena, ExrAttribute, TEXT_COUNT + 2);
    const char *texts[TEXT_COUNT];
    size_t row = row_bytes(part, film->stride);
    GatheredRows *rows = prepare_rows(film, row, part->crop.y1 - part->crop.y0, arena);
    int count = text_count(part);
    make_texts(part, texts, arena);
    for (int i = 0; i < count; i++)
        attributes[i] = (ExrAttribute){text_names[i], EXR_STRING, texts[i], {0}};
    uint64_t checksum = checksum_of_texts(part, texts) + checksum_of_film(rows, row);
    attributes[count] = (ExrAttribute){"parhelion:layers", EXR_INT, "", {part->layers}};
    attributes[count + 1] =
        (ExrAttribute){"parhelion:checksum",
                       EXR_STRING,
                       arena_format(arena, "%016llx", (unsigned long long)checksum),
                       {0}};
    *words = name_words(part, arena);
    words->values = rows->values;
    words->rows = &rows->rows;
    words->attribute_count = count + 2;
    words->attributes = attributes;
    assert((size_t)words->count * 4 == film->stride);
    frame->words = words;
}

/* ---- and back ---------------------------------------------------------------------------- */

static bool read_range(const char *text, uint32_t *first, uint32_t *end) {
    return sscanf(text, "%u:%u", first, end) == 2 && *first <= *end && *end <= FILM_SAMPLES_MAX;
}

static bool read_dropped(const char *text, FilmDropped *dropped) {
    unsigned long long count;
    int length;
    if (sscanf(text, "%llu%n", &count, &length) != 1) return false;
    dropped->count = count;
    for (text += length; *text; text += length) {
        int i = dropped->kept;
        if (i == FILM_DROPPED_KEPT ||
            sscanf(text, " %u,%d,%d%n", &dropped->first[i].sample_index, &dropped->first[i].x,
                   &dropped->first[i].y, &length) != 3)
            return false;
        dropped->kept++;
    }
    return (uint64_t)dropped->kept <= dropped->count;
}

static bool read_cost(const char *text, FilmPart *part) {
    unsigned long long n[4];
    if (sscanf(text, "%llu paths, %llu camera, %llu bounce, %llu shadow", &n[0], &n[1], &n[2],
               &n[3]) != 4)
        return false;
    part->paths = n[0];
    part->camera_rays = n[1];
    part->bounce_rays = n[2];
    part->shadow_rays = n[3];
    return true;
}

#define LIGHT_BYTES_MAX 96 /* of a name */

static bool is_there(const char *name, const FilmLights *lights) {
    for (int i = 0; i < lights->count; i++)
        if (!strcmp(name, lights->names[i])) return true;
    return false;
}

/* One name a line, none twice. */
static bool read_lights(const char *text, Arena *arena, FilmLights *out) {
    const char **names = ARENA_NEW(arena, const char *, FILM_LIGHTS_MAX);
    *out = (FilmLights){0, names};
    for (size_t length; *text; text += length + (text[length] == '\n')) {
        length = strcspn(text, "\n");
        const char *name = arena_string(arena, text, length);
        if (out->count == FILM_LIGHTS_MAX || !length || length > LIGHT_BYTES_MAX ||
            is_there(name, out))
            return false;
        names[out->count++] = name;
    }
    return true;
}

static bool damaged(const char *what, Error *err) {
    return error_set(err, ERROR_INPUT, "damaged sums: %s cannot be read", what);
}

/* Everything is written again and compared, so that only what we write is read. */
static bool read_texts(const FrameImage *words, FilmPart *part, uint64_t *checksum, Arena scratch,
                       Error *err) {
    const char *texts[TEXT_COUNT], *again[TEXT_COUNT];
    uint32_t asked_first;
    for (int i = 0; i < text_count(part); i++) {
        texts[i] = frame_string(words, text_names[i]);
        if (!texts[i]) return damaged(text_names[i], err);
    }
    if (strcmp(texts[TEXT_LAYOUT], layout_text(&scratch)) != 0)
        return error_set(err, ERROR_MACHINE,
                         "its sums are of another version: \"%.200s\", required: \"%s\"",
                         texts[TEXT_LAYOUT], layout_text(&scratch));
    if (!read_range(texts[TEXT_SAMPLES], &part->first_sample, &part->end_sample))
        return damaged(text_names[TEXT_SAMPLES], err);
    if (!read_range(texts[TEXT_ASKED], &asked_first, &part->asked_end) ||
        part->asked_end < part->end_sample)
        return damaged(text_names[TEXT_ASKED], err);
    if (!read_dropped(texts[TEXT_DROPPED], &part->dropped))
        return damaged(text_names[TEXT_DROPPED], err);
    if (!read_cost(texts[TEXT_COST], part)) return damaged(text_names[TEXT_COST], err);
    make_texts(part, again, &scratch);
    for (int i = 0; i < text_count(part); i++)
        if (strcmp(texts[i], again[i]) != 0) return damaged(text_names[i], err);
    *checksum = checksum_of_texts(part, texts);
    return true;
}

static bool describe(FilmPartReader *from, const ExrWords *found, Arena *arena, Error *err) {
    const ExrPicture *picture = exr_reader_picture(from->file);
    const FrameImage words = {.attribute_count = found->attribute_count,
                              .attributes = (ExrAttribute *)found->attributes};
    const ExrAttribute *layers = frame_attribute(&words, "parhelion:layers");
    const char *checksum = frame_string(&words, "parhelion:checksum");
    unsigned long long wanted;
    FilmPart *part = &from->part;
    if (!layers || layers->kind != EXR_INT ||
        ((unsigned)layers->values[0] & ~(unsigned)LAYER_EVERY))
        return damaged("parhelion:layers", err);
    if (!checksum || sscanf(checksum, "%16llx", &wanted) != 1)
        return damaged("parhelion:checksum", err);
    if (picture->display.x0 || picture->display.y0 || picture->data.x0 < 0 ||
        picture->data.y0 < 0 || picture->data.x1 > picture->display.x1 ||
        picture->data.y1 > picture->display.y1)
        return damaged("the windows", err);
    part->width = picture->display.x1;
    part->height = picture->display.y1;
    part->crop = (FilmRect){picture->data.x0, picture->data.y0, picture->data.x1, picture->data.y1};
    part->layers = (unsigned)layers->values[0];
    const char *lights = frame_string(&words, text_names[TEXT_LIGHTS]);
    if ((part->layers & LAYER_LIGHT) && (!lights || !read_lights(lights, arena, &part->lights)))
        return damaged(text_names[TEXT_LIGHTS], err);
    Arena scratch = *arena;
    int words_wanted = name_words(part, &scratch).count;
    if (words_wanted != found->count)
        return error_set(err, ERROR_INPUT, "damaged sums: %d words a pixel, its layers have %d",
                         found->count, words_wanted);
    from->wanted_checksum = wanted;
    from->next_y = part->crop.y0;
    return read_texts(&words, part, &from->checksum, scratch, err);
}

bool film_part_open(const char *path, Arena *arena, FilmPartReader *out, Error *err) {
    FilmPartReader from = {.part.name = path};
    const ExrWords *found = NULL;
    if (!exr_reader_open(path, &from.file, err)) return false;
    bool done = exr_reader_words(from.file, PART_NAME, &found, err) &&
                (found ? describe(&from, found, arena, err)
                       : error_set(err, ERROR_INPUT,
                                   "carries no sums, only means: it cannot be merged — "
                                   "required: a frame of `render --samples A:B`, `render "
                                   "--crop` or `merge --part`"));
    if (done) *out = from;
    else exr_reader_destroy(from.file);
    return done;
}

static bool check_checksum(const FilmPartReader *from, Error *err) {
    if (from->checksum == from->wanted_checksum) return true;
    return error_set(err, ERROR_INPUT,
                     "damaged sums: their checksum is %016llx, the file says %016llx",
                     (unsigned long long)from->checksum, (unsigned long long)from->wanted_checksum);
}

bool film_part_add_band(FilmPartReader *from, Film *to, Arena scratch, Error *err) {
    const FilmPart *part = &from->part;
    size_t row = row_bytes(part, to->stride);
    int rows = exr_rows_in(BAND_BYTES, row, part->crop.y1 - from->next_y);
    FilmRect rect = {part->crop.x0, from->next_y, part->crop.x1, from->next_y + rows};
    ExrWords words = name_words(part, &scratch);
    char *values = arena_alloc(&scratch, row, _Alignof(PixelSums), (size_t)rows);
    assert(part->layers == to->layers);
    if (!exr_reader_read_words(from->file, &words, rect.y0, rect.y1, values, err) ||
        !film_add_pixels(to, rect, values, part->end_sample - part->first_sample, err))
        return false;
    from->checksum += checksum_of_rows(values, row, rect.y0, rows);
    from->next_y = rect.y1;
    if (rect.y1 < part->crop.y1) return true;
    film_add_dropped(to, &part->dropped);
    return check_checksum(from, err);
}

void film_part_close(FilmPartReader *from) {
    exr_reader_destroy(from->file);
    from->file = NULL;
}
