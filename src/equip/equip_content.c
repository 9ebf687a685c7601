/* SPDX-License-Identifier: Apache-2.0 */
#include "equip/equip_content.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/number.h"
#include "equip/equip_picture.h"
#include "equip/equip_shipped.h"
#include "panel/query/panel_open.h"
#include "review/symbol/text_find.h"
#include "text/json_text.h"
#include "text/text.h"

#define TEXTS_FOUND_MOST 12
#define SEARCH_PIXELS 1024 /* a picture's longer side, when texts are searched for */
#define CROP_PIXELS 220    /* a text's longer side */
#define WORDS_BYTES ((size_t)1 << 20)

/* ---- what a text says -------------------------------------------------------------------- */

/* A line of NAME.words: shares of the content, then the word. */
typedef struct Word {
    double left, top, right, bottom;
    char text[80];
} Word;

static bool is_in(const Word *word, const double box[4]) {
    double x = 0.5 * (word->left + word->right), y = 0.5 * (word->top + word->bottom);
    return x > box[0] && x < box[2] && y > box[1] && y < box[3];
}

static int by_left(const void *a, const void *b) {
    double x = ((const Word *)a)->left, y = ((const Word *)b)->left;
    return (x > y) - (x < y);
}

/* The words whose middles lie in the box, from left to right; "": none does. */
static const char *words_in(const char *lines, const double box[4], Arena *arena) {
    Word *found = ARENA_NEW(arena, Word, 64);
    Text text = {.arena = arena};
    int count = 0;
    for (const char *at = lines; *at && count < 64; at += strcspn(at, "\n"), at += *at != 0) {
        Word *w = &found[count];
        double *const sides[4] = {&w->left, &w->top, &w->right, &w->bottom};
        const char *behind = at;
        for (int k = 0; k < 4 && behind; k++) behind = number_read(behind, sides[k]);
        size_t blanks = behind ? strspn(behind, " ") : 0, length;
        if (!blanks || !(length = strcspn(behind + blanks, "\n"))) continue;
        snprintf(w->text, sizeof w->text, "%.*s", (int)length, behind + blanks);
        count += is_in(w, box);
    }
    qsort(found, (size_t)count, sizeof *found, by_left);
    for (int i = 0; i < count; i++) text_format(&text, "%s%s", i ? " " : "", found[i].text);
    return count ? text.data : "";
}

/* "" where there is no such list. */
static const char *read_words(const char *picture, Arena *arena) {
    FileBytes bytes;
    Error none;
    size_t stem = strlen(picture) - strlen(path_ending(picture));
    const char *path = arena_format(arena, "%.*s.words", (int)stem, picture);
    if (!file_exists(path) || !file_read(path, WORDS_BYTES, arena, &bytes, &none)) return "";
    return arena_string(arena, (const char *)bytes.data, bytes.size);
}

/* ---- texts ------------------------------------------------------------------------------- */

/* As the panel that the page proposes shows it: others order lightness alike. */
static const Panel *usual_panel(Arena *arena) {
    int count;
    Panel *panel = NULL;
    const char *path;
    Error none;
    const char **names = equip_shipped_names(&shipped_panels, &count, arena);
    for (int i = 0; i < count && !panel; i++)
        if (!equip_shipped_find(&shipped_panels, names[i], arena, &path, &none) ||
            !panel_open(path, arena, &panel, &none))
            panel = NULL;
    return panel;
}

static json_t *crop_json(const Image *image, PixelBox box, Arena scratch) {
    int wide = box.right - box.left, high = box.bottom - box.top;
    int longer = wide > high ? wide : high, by = (longer + CROP_PIXELS - 1) / CROP_PIXELS;
    return equip_picture_json(image, box, (PixelSize){(wide + by - 1) / by, (high + by - 1) / by},
                              scratch);
}

static json_t *text_json(const Image *image, const TextProposal *text, const char *words,
                         Arena scratch) {
    const double at[4] = {text->uv[0] * image->width, text->uv[1] * image->height,
                          text->uv[2] * image->width, text->uv[3] * image->height};
    const PixelBox box = {(int)at[0], (int)at[1], (int)ceil(at[2]), (int)ceil(at[3])};
    json_t *crop = crop_json(image, box, scratch);
    return json_pack(
        "{s:[f,f,f,f], s:s, s:o, s:o}", "uv", text->uv[0], text->uv[1], text->uv[2], text->uv[3],
        "polarity", text->is_light_on_dark ? "light-on-dark" : "dark-on-light", "crop",
        crop ? crop : json_null(), "name", json_text(words_in(words, text->uv, &scratch)));
}

/* Every so many pixels of each row and column are one: the largest texts, which are listed, are
 * found as well, several times as fast. */
static Image smaller(const Image *image, Arena *arena) {
    int longer = image->width > image->height ? image->width : image->height;
    int by = (longer + SEARCH_PIXELS - 1) / SEARCH_PIXELS;
    Image out = {image->width / by, image->height / by, IMAGE_RGBA8, NULL};
    uint8_t *to = ARENA_NEW(arena, uint8_t, 4 * (size_t)out.width * (size_t)out.height);
    const uint8_t *from = image->pixels;
    out.pixels = to;
    if (by == 1) return *image;
    for (int y = 0; y < out.height; y++)
        for (int x = 0; x < out.width; x++)
            for (int c = 0; c < 4; c++) {
                int sum = 0;
                for (int i = 0; i < by * by; i++) {
                    size_t row = (size_t)(y * by + i / by), column = (size_t)(x * by + i % by);
                    sum += from[4 * (row * (size_t)image->width + column) + (size_t)c];
                }
                *to++ = (uint8_t)((sum + by * by / 2) / (by * by));
            }
    return out;
}

static json_t *texts_json(const Image *image, const Panel *panel, const char *path, Arena scratch) {
    const double all[4] = {0, 0, 1, 1};
    const Image small = smaller(image, &scratch);
    ContentLight light;
    TextProposal *found;
    Error none;
    json_t *list = json_array();
    if (!panel || !content_light(panel, &small, all, &scratch, &light, &none)) return list;
    int count = text_find(&light, TEXTS_FOUND_MOST, &scratch, &found);
    const char *words = read_words(path, &scratch);
    for (int i = 0; i < count; i++)
        json_array_append_new(list, text_json(image, &found[i], words, scratch));
    return list;
}

/* ---- contents ---------------------------------------------------------------------------- */

/* One that is no usual picture is offered without it. */
static json_t *content_json(const char *name, const Panel *panel, Arena scratch) {
    const char *path;
    Image image;
    Error none;
    json_t *out = json_pack("{s:o}", "name", json_text(name));
    if (!equip_shipped_find(&shipped_contents, name, &scratch, &path, &none) ||
        !image_read(path, &scratch, &image, &none))
        return out;
    int longer = image.width > image.height ? image.width : image.height;
    int by = (longer + THUMB_PIXELS - 1) / THUMB_PIXELS;
    PixelSize size = {(image.width + by - 1) / by, (image.height + by - 1) / by};
    json_t *picture = equip_picture_json(&image, equip_picture_box(&image), size, scratch);
    if (!picture) return out;
    json_object_set_new(out, "picture", picture);
    json_object_set_new(out, "width", json_integer(image.width));
    json_object_set_new(out, "height", json_integer(image.height));
    json_object_set_new(out, "texts", texts_json(&image, panel, path, scratch));
    return out;
}

json_t *equip_contents_json(Arena *arena) {
    int count;
    const char **names = equip_shipped_names(&shipped_contents, &count, arena);
    const Panel *panel = usual_panel(arena);
    json_t *list = json_array();
    for (int i = 0; i < count; i++)
        json_array_append_new(list, content_json(names[i], panel, *arena));
    return list;
}
