/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/frame_area.h"

#include <math.h>
#include <string.h>

#include "cli/options/cli.h"
#include "text/nearest_word.h"

FrameArea frame_area_all(FilmRect rect) {
    return (FrameArea){.area = {rect, FILM_ALL_PIXELS}};
}

static bool is_inside(const double corner[4], FilmRect rect) {
    for (int i = 0; i < 4; i++)
        if (corner[i] != floor(corner[i])) return false;
    return corner[0] >= rect.x0 && corner[0] < corner[2] && corner[2] <= rect.x1 &&
           corner[1] >= rect.y0 && corner[1] < corner[3] && corner[3] <= rect.y1;
}

bool frame_area_parse(const char *text, const char *more, FrameArea *out, Error *err) {
    FilmRect within = out->area.rect;
    double corner[4];
    out->text = text;
    if (!strcmp(text, "display") || !strncmp(text, "display:", 8)) {
        out->area.display = FILM_ANY_DISPLAY;
        out->display = text[7] ? text + 8 : NULL;
        return true;
    }
    if (!cli_numbers(text, 4, corner) || !is_inside(corner, within))
        return error_set(err, ERROR_USAGE,
                         "%s %s%s: required: %sdisplay, display:NAME or whole numbers "
                         "X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 inside %d,%d,%d,%d",
                         out->option, text, more, out->instead ? out->instead : "", within.x0,
                         within.y0, within.x1, within.y1);
    out->is_rect = true;
    out->area.rect = (FilmRect){(int)corner[0], (int)corner[1], (int)corner[2], (int)corner[3]};
    return true;
}

static bool no_such_display(const Scene *scene, const FrameArea *area, Arena scratch, Error *err) {
    int count = scene->display_count;
    const char **names = ARENA_NEW(&scratch, const char *, count);
    char advice[512];
    for (int i = 0; i < count; i++) names[i] = scene->displays[i].name;
    return error_set(
        err, ERROR_USAGE, "%s display:%s: no display has this name — %s", area->option,
        area->display,
        count ? nearest_word_advice(area->display, names, count, advice, (int)sizeof advice)
              : "the scene has none");
}

bool frame_area_find(const Scene *scene, Arena scratch, FrameArea *area, Error *err) {
    if (!area->display) return true;
    for (int i = 0; i < scene->display_count; i++) {
        if (strcmp(scene->displays[i].name, area->display)) continue;
        area->area.display = i;
        return true;
    }
    return no_such_display(scene, area, scratch, err);
}

const char *frame_area_words(const FrameArea *area, Arena *arena) {
    if (area->display) return arena_format(arena, "display %s", area->display);
    if (area->area.display == FILM_ANY_DISPLAY) return "the displays";
    if (!area->is_rect) return "the frame";
    FilmRect rect = area->area.rect;
    return arena_format(arena, "pixels %d,%d,%d,%d", rect.x0, rect.y0, rect.x1, rect.y1);
}
