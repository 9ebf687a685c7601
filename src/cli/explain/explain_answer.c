/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/explain/explain_answer.h"

#include <math.h>
#include <stdio.h>

#include "cli/options/answer.h"
#include "review/chain/outlook_picture.h"
#include "review/output/review_json.h"
#include "review/output/review_words.h"
#include "text/interval_text.h"
#include "text/json_text.h"

/* ---- as text ----------------------------------------------------------------------------- */

static void print_where(const ReviewCase *c)
{
    if (c->symbol)
        printf("symbol     %s on %s, seen by %s, %s\n", c->symbol, c->display, c->eye,
               c->condition);
    else if (c->display) printf("display    %s\n", c->display);
    printf("eye        %.3f, %.3f, %.3f m\n", (double)c->eye_m.x, (double)c->eye_m.y,
           (double)c->eye_m.z);
}

static void print_light(const Explained *explained, Arena scratch)
{
    const ReviewCase     *c = &explained->of;
    const CaseLuminances *l = &c->luminance_cd_m2;
    const char *light = c->display ? "reflected" : "luminance";
    if (c->symbol)
        printf("sends      %.4g cd/m2 foreground, %.4g background\n", l->foreground,
               l->background);
    else if (c->display)
        printf("sends      %.4g cd/m2; white %.4g, black %.4g\n", explained->shown,
               l->foreground, l->background);
    printf("%-10s %s cd/m2", light,
           interval_text(l->reflected, c->reflected_range.low, c->reflected_range.high,
                         &scratch));
    if (c->display) printf(": mirror %.4g, scattered %.4g", l->mirror, l->scattered);
    printf("\n");
    if (c->display)
        printf("contrast   %s : 1; %.4g : 1 if nothing were reflected\n",
               interval_text(c->contrast_ratio, c->contrast_low, c->contrast_high, &scratch),
               luminance_contrast(l->foreground, l->background, 0));
}

static void print_cause(const CaseCause *cause, bool has_contrast, Arena scratch)
{
    printf("%6.1f %%  %8s  %8s to %-8s", 100 * cause->share,
           words_within(cause->cd_m2, cause->low, cause->high, &scratch),
           words_within(cause->low, cause->low, cause->high, &scratch),
           words_within(cause->high, cause->low, cause->high, &scratch));
    if (has_contrast) printf("  %7.3g : 1", cause->contrast_without);
    for (int i = 0; i < cause->links; i++)
        printf("%s%s", i ? " > " : "  ", cause->chain[i]);
    printf("\n");
}

/* Each adds up to all of the light. */
static void print_groups(const ReviewCase *c)
{
    static const char *const NAMES[CAUSE_GROUPS] = {"began at", "came by", "met at"};
    for (int g = 0; g < CAUSE_GROUPS; g++) {
        const CaseGroup *group = &c->groups[g];
        for (int i = 0; i < group->count; i++)
            printf("%s%.3g %% %s", i ? ", " : g ? "\n" : "", 100 * group->list[i].share,
                   group->list[i].what);
        if (group->count) printf(" (%s)", NAMES[g]);
    }
    printf("\n");
}

static void print_causes(const ReviewCase *c, Arena scratch)
{
    bool has_contrast = c->display != NULL;
    if (!c->cause_count) return;
    printf("\n   share     cd/m2   95 %% interval     %s  by way of\n",
           has_contrast ? "without it " : "");
    for (int i = 0; i < c->cause_count; i++) print_cause(&c->causes[i], has_contrast, scratch);
}

static void print_remedies(const ReviewCase *c)
{
    if (c->remedy_count) printf("\n");
    for (int i = 0; i < c->remedy_count; i++)
        printf("would mend %s: contrast %.3g : 1\n", c->remedies[i].what,
               c->remedies[i].contrast_ratio);
}

static void print_text(const Explained *explained, Arena *arena)
{
    print_where(&explained->of);
    if (explained->of.hider_count)
        printf("hidden     %s\n", words_hiders(&explained->of, arena));
    if (!(explained->of.visible_share > 0)) {
        printf("not visible\n");
        return;
    }
    print_light(explained, *arena);
    print_groups(&explained->of);
    print_causes(&explained->of, *arena);
    print_remedies(&explained->of);
    if (explained->has_outlook) printf("\nsees       %s\n", outlook_words(&explained->outlook,
                                                                          arena));
}

/* ---- as JSON ----------------------------------------------------------------------------- */

/* JSON has no NaN. */
static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *text_or_null(const char *text)
{
    return text ? json_text(text) : json_null();
}

static json_t *point(Vec3 p)
{
    return json_pack("[f,f,f]", (double)p.x, (double)p.y, (double)p.z);
}

static json_t *json_rays(const CaseCause *cause)
{
    json_t *out = json_array();
    for (int i = 0; i < cause->ray_count; i++) {
        json_t *ray = json_array();
        for (int k = 0; k < cause->rays[i].count; k++)
            json_array_append_new(ray, point(cause->rays[i].points[k]));
        json_array_append_new(out, ray);
    }
    return out;
}

static json_t *json_chains(const ReviewCase *c)
{
    json_t *out = json_array();
    for (int i = 0; i < c->cause_count; i++) {
        const CaseCause *cause = &c->causes[i];
        double lost = cause->contrast_without - c->contrast_ratio;
        json_array_append_new(out, json_pack(
            "{s:o, s:o, s:o, s:[o,o], s:o, s:o, s:o}", "chain",
            json_texts(cause->chain, cause->links), "share", number(cause->share), "cd_m2",
            number(cause->cd_m2), "interval", number(cause->low), number(cause->high),
            "contrast_without", number(cause->contrast_without), "contrast_lost", number(lost),
            "rays", json_rays(cause)));
    }
    return out;
}

static json_t *json_light(const Explained *explained)
{
    const CaseLuminances *l = &explained->of.luminance_cd_m2;
    if (!explained->of.display) return json_pack("{s:o}", "all", number(l->reflected));
    json_t *out = json_pack("{s:o, s:o, s:o}", "reflected", number(l->reflected), "mirror",
                            number(l->mirror), "scattered", number(l->scattered));
    bool is_symbol = explained->of.symbol != NULL;
    json_object_set_new(out, is_symbol ? "foreground" : "white", number(l->foreground));
    json_object_set_new(out, is_symbol ? "background" : "black", number(l->background));
    if (!is_symbol) json_object_set_new(out, "emitted", number(explained->shown));
    return out;
}

static json_t *json_remedies(const ReviewCase *c)
{
    json_t *out = json_array();
    for (int i = 0; i < c->remedy_count; i++)
        json_array_append_new(out, json_pack(
            "{s:o, s:o, s:o}", "what", json_text(c->remedies[i].what), "contrast_ratio",
            number(c->remedies[i].contrast_ratio), "level", number(c->remedies[i].level)));
    return out;
}

static json_t *json_outlook(const Explained *explained)
{
    const Outlook *o = &explained->outlook;
    if (!explained->has_outlook) return json_null();
    json_t *shares = json_array();
    for (int i = 0; i < o->share_count; i++)
        json_array_append_new(shares, json_pack("{s:o, s:o, s:o}", "what",
                                                json_text(o->shares[i].what), "share",
                                                number(o->shares[i].share), "lux",
                                                number(o->shares[i].lux)));
    return json_pack("{s:o, s:o, s:o, s:{s:o, s:o}}", "lux", number(o->lux), "shares", shares,
                     "rest", number(o->rest), "mirror", "what", text_or_null(o->mirror_what),
                     "cd_m2", number(o->mirror_cd_m2));
}

static bool print_json(const Explained *explained, Error *err)
{
    const ReviewCase *c = &explained->of;
    json_t *out = json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:[o,o], s:I}", "condition",
        text_or_null(c->condition), "eye", text_or_null(c->eye), "symbol",
        text_or_null(c->symbol), "display", text_or_null(c->display), "eye_m", point(c->eye_m),
        "luminance_cd_m2", json_light(explained), "contrast_ratio", number(c->contrast_ratio),
        "contrast_interval", number(c->contrast_low), number(c->contrast_high), "paths",
        (json_int_t)explained->paths);
    json_object_set_new(out, "visible_share", number(c->visible_share));
    json_object_set_new(out, "hidden_by", review_hiders_json(c));
    json_object_set_new(out, "reflected_interval",
                        json_pack("[o,o]", number(c->reflected_range.low),
                                  number(c->reflected_range.high)));
    json_object_set_new(out, "cause_groups", review_groups_json(c));
    json_object_set_new(out, "chains", json_chains(c));
    json_object_set_new(out, "remedies", json_remedies(c));
    json_object_set_new(out, "outlook", json_outlook(explained));
    return cli_print_json(out, err);
}

bool explain_answer(const Cli *cli, const Explained *explained, Arena *arena, Error *err)
{
    if (cli->json) return print_json(explained, err);
    print_text(explained, arena);
    return true;
}
