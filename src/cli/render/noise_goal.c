/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/noise_goal.h"

#include <math.h>
#include <string.h>

#include "cli/options/cli.h"
#include "text/nearest_word.h"

static bool is_inside(const double corner[4], FilmRect crop)
{
    for (int i = 0; i < 4; i++)
        if (corner[i] != floor(corner[i])) return false;
    return corner[0] >= crop.x0 && corner[0] < corner[2] && corner[2] <= crop.x1 &&
           corner[1] >= crop.y0 && corner[1] < corner[3] && corner[3] <= crop.y1;
}

/* area: the text before the last colon. */
static bool parse_area(const char *area, FilmRect crop, NoiseGoal *goal, Error *err)
{
    double corner[4];
    if (!strcmp(area, "display") || !strncmp(area, "display:", 8)) {
        goal->area.display = FILM_ANY_DISPLAY;
        goal->display = area[7] ? area + 8 : NULL;
        return true;
    }
    if (!cli_numbers(area, 4, corner) || !is_inside(corner, crop))
        return error_set(err, ERROR_USAGE,
                         "--noise %s:R: wanted display, display:NAME or whole numbers "
                         "X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 inside %d,%d,%d,%d",
                         area, crop.x0, crop.y0, crop.x1, crop.y1);
    goal->is_rect = true;
    goal->area.rect =
        (FilmRect){(int)corner[0], (int)corner[1], (int)corner[2], (int)corner[3]};
    return true;
}

bool noise_goal_parse(const char *text, FilmRect crop, Arena *arena, NoiseGoal *out, Error *err)
{
    const char *colon = strrchr(text, ':');
    NoiseGoal   goal = {.area = {crop, FILM_ALL_PIXELS}};
    if (!cli_numbers(colon ? colon + 1 : text, 1, &goal.error) ||
        !(goal.error > 0 && goal.error < 1))
        return error_set(err, ERROR_USAGE,
                         "--noise %s: wanted a relative error above 0 and below 1, such as "
                         "0.05, display:0.01, display:NAME:0.01 or X0,Y0,X1,Y1:0.02",
                         text);
    *out = goal;
    return !colon ||
           parse_area(arena_string(arena, text, (size_t)(colon - text)), crop, out, err);
}

static bool no_such_display(const Scene *scene, const char *wanted, Arena scratch, Error *err)
{
    int          count = scene->display_count;
    const char **names = ARENA_NEW(&scratch, const char *, count);
    char         advice[512];
    for (int i = 0; i < count; i++) names[i] = scene->displays[i].name;
    return error_set(err, ERROR_USAGE, "--noise display:%s: no display has this name — %s",
                     wanted,
                     count ? nearest_word_advice(wanted, names, count, advice,
                                                 (int)sizeof advice)
                           : "the scene has none");
}

bool noise_goal_find(const Scene *scene, Arena scratch, NoiseGoal *goal, Error *err)
{
    if (!goal->display) return true;
    for (int i = 0; i < scene->display_count; i++) {
        if (strcmp(scene->displays[i].name, goal->display)) continue;
        goal->area.display = i;
        return true;
    }
    return no_such_display(scene, goal->display, scratch, err);
}

const char *noise_goal_words(const NoiseGoal *goal, Arena *arena)
{
    if (goal->display) return arena_format(arena, "display %s", goal->display);
    if (goal->area.display == FILM_ANY_DISPLAY) return "the displays";
    if (!goal->is_rect) return "the frame";
    FilmRect rect = goal->area.rect;
    return arena_format(arena, "pixels %d,%d,%d,%d", rect.x0, rect.y0, rect.x1, rect.y1);
}
