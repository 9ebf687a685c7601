/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/panel/panel_level.h"

#include "print/print.h"
#include "panel/query/panel_open.h"

static bool refuse(const char *path, const PanelLevel *level, int finest, Error *err) {
    return error_at(err, ERROR_USAGE, path, "",
                    "--level is %ld, required: 0 to "
                    "%d",
                    level->asked, finest);
}

static bool refuse_any(const char *path, const PanelLevel *level, Error *err) {
    return error_at(err, ERROR_USAGE, path, "",
                    "--level is %ld, required: none: it has no %s, "
                    "and so no tree of it",
                    level->asked,
                    level->parts == PANEL_COARSE_EMISSION ? "emission" : "reflection data");
}

static bool read_down(const char *path, PanelLevel *level, Arena *arena, Panel *panel, Error *err) {
    int finest = panel_coarse_finest(panel);
    PanelCoarse *found = &level->found;
    if (!level->is_asked) return true;
    if (level->asked < 0 || level->asked > finest) return refuse(path, level, finest, err);
    panel_coarse_compare(panel, (int)level->asked, level->parts, *arena, found);
    if (!found->emission.is_asked && !found->reflection.is_asked)
        return refuse_any(path, level, err);
    panel_coarsen(panel, (int)level->asked, level->parts, arena);
    return true;
}

bool panel_level_open(const char *path, PanelLevel *level, Arena *arena, Panel **out, Error *err) {
    if (!panel_open(path, arena, out, err)) return false;
    if (read_down(path, level, arena, *out, err)) return true;
    panel_close(*out);
    *out = NULL;
    return false;
}

/* ---- one level --------------------------------------------------------------------------- */

const char *panel_level_words(const PanelLevel *level, Arena *arena) {
    if (!level->is_asked) return NULL;
    return arena_format(arena, "read down to level %ld", level->asked);
}

static void print_part(const PanelCoarsePart *part, const char *name, FILE *to) {
    if (!part->is_asked) return;
    if (part->level == part->finest)
        print_to(to, "level %d: %s is whole, its tree ends there\n", part->level, name);
    else
        print_to(to, "level %d of %d: %s at most %.3g %% off the whole panel's, rms %.3g %%\n",
                 part->level, part->finest, name, 100 * part->max, 100 * part->rms);
}

void panel_level_print(const PanelLevel *level, FILE *to) {
    if (!level->is_asked) return;
    print_part(&level->found.emission, "emission", to);
    print_part(&level->found.reflection, "reflection", to);
}

static void add_part(const PanelCoarsePart *part, const char *name, json_t *to) {
    if (part->is_asked)
        json_object_set_new(to, name,
                            json_pack("{s:i, s:i, s:f, s:f}", "level", part->level, "finest",
                                      part->finest, "max_error", part->max, "rms_error",
                                      part->rms));
}

static json_t *level_json(const PanelCoarse *found) {
    json_t *out = json_pack("{s:i}", "level", found->level);
    add_part(&found->emission, "emission", out);
    add_part(&found->reflection, "reflection", out);
    return out;
}

void panel_level_add(const PanelLevel *level, json_t *answer) {
    if (level->is_asked) json_object_set_new(answer, "level", level_json(&level->found));
}

/* ---- all levels -------------------------------------------------------------------------- */

json_t *panel_level_list(const Panel *panel, Arena *arena) {
    json_t *list = json_array();
    for (int level = 0; level <= panel_coarse_finest(panel); level++) {
        PanelCoarse found;
        panel_coarse_compare(panel, level, PANEL_COARSE_ALL, *arena, &found);
        json_array_append_new(list, level_json(&found));
    }
    return list;
}

static const Column LEVELS[] = {COLUMN_TEXT("level", "level"),
                                COLUMN_SHARE("emission.max_error", "emission, largest error"),
                                COLUMN_SHARE("emission.rms_error", "emission, rms error"),
                                COLUMN_SHARE("reflection.max_error", "reflection, largest error"),
                                COLUMN_SHARE("reflection.rms_error", "reflection, rms error"),
                                COLUMN_KEY("emission", "`level` that was read, `finest` of its "
                                                       "tree; errors are relative to the whole "
                                                       "panel"),
                                COLUMN_KEY("reflection", "likewise")};
const TableKind panel_level_kind = TABLE_KIND("levels", NULL, LEVELS);
