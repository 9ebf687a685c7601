/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/guide_index.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"

#define HEADING 12 /* words of a text that one in a heading is worth */
#define OF_A_GUIDE 2
#define SAME_MAX 8
#define LETTERS 2 /* of a word, at least */

/* SameWords of one meaning, apart by blanks; a hyphen stands for a blank inside of one. */
static const char *const SYNONYMS[] = {
    "falsecolor falsecolour false-colour false-color pseudocolor heatmap",
    "lamp lamps light luminaire ies ldt photometry",
    "material materials gltf paint bsdf",
    "epw weather",
    "illuminance lux lx",
    "luminance cd/m2 nit nits brightness",
    "ugr dgp dgi glare evalglare",
    "veil veiling stray-light straylight disability",
    "fisheye equidistant equisolid hemisphere",
    "rvu viewer interactive live preview tev",
    "camera viewpoint eye",
    "sun solar daylight",
    "hdri environment-map envmap ibl",
    "threads nthreads cores parallel",
    "cluster slurm farm",
    "resume checkpoint restart",
    "noise fireflies variance samples spp",
    "brdf bsdf reflection scatter",
    "contrast legibility readability",
    "colour color chromaticity primaries",
    "exposure tone-mapping tonemap ev",
    "hud head-up",
    "sunglasses polariser polarizer polarised polarized",
    "gamma eotf level-curve levels",
    "error troubleshooting problem crash",
    "ci regression compare diff",
    "install package setup",
    "blender add-on addon",
    "json schema script",
    "validation accuracy verified",
    "glass window glazing pane windscreen windshield",
    "mirror reflections specular",
    "night moon dark",
    "probe measure meter luxmeter",
};

static bool is_letter(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

/* Does a text begin with a word, whatever its case? A hyphen meets a blank as well. */
static bool begins(const char *text, const char *word, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        int a = tolower((unsigned char)text[i]), b = tolower((unsigned char)word[i]);
        if (a != b && !(b == '-' && (a == ' ' || a == '\n'))) return false;
    }
    return true;
}

typedef struct SameWords {
    const char *at[SAME_MAX];
    size_t      length[SAME_MAX];
    int         count;
} SameWords;

static void add_word(SameWords *words, const char *at, size_t length)
{
    if (words->count == SAME_MAX) return;
    words->at[words->count] = at;
    words->length[words->count++] = length;
}

/* The word, then those of its meanings. */
static SameWords words_of(const char *word)
{
    SameWords  words = {.count = 0};
    size_t length = strlen(word);
    add_word(&words, word, length);
    for (int i = 0; i < COUNT_OF(SYNONYMS); i++) {
        bool is_here = false;
        for (int pass = 0; pass < 2; pass++)
            for (const char *at = SYNONYMS[i]; *at; at += strspn(at, " ")) {
                size_t size = strcspn(at, " ");
                bool   is_it = size == length && begins(at, word, length);
                if (pass && is_here && !is_it) add_word(&words, at, size);
                is_here |= is_it;
                at += size;
            }
    }
    return words;
}

/* How often words stand between two places; *first: where the first of them does. The word
 * itself counts three times as much as one of the same meaning. */
static int count_of(const SameWords *words, const char *from, const char *to,
                    const char **first)
{
    int score = 0;
    for (const char *at = from; at < to; at++) {
        if (at > from && is_letter(at[-1])) continue;
        for (int i = 0; i < words->count; i++) {
            size_t length = words->length[i];
            if (at + length > to || !begins(at, words->at[i], length)) continue;
            const char *end = at + length;
            if (end < to && (*end == 's' || *end == 'S')) end++;
            if (end < to && is_letter(*end)) continue;
            if (!*first || (!score && at < *first)) *first = at;
            score += i ? 1 : 3;
            break;
        }
    }
    return score;
}

static void keep(GuideHit *hits, int *count, int most, GuideHit hit)
{
    int of_guide = 0, place = 0;
    for (int i = 0; i < *count; i++) {
        of_guide += hits[i].guide == hit.guide;
        place += hits[i].score >= hit.score;
    }
    if (of_guide == OF_A_GUIDE) { /* the lesser of its two goes, if this is more */
        int worst = *count - 1;
        while (hits[worst].guide != hit.guide) worst--;
        if (hits[worst].score >= hit.score) return;
        memmove(hits + worst, hits + worst + 1, sizeof *hits * (size_t)(*count - worst - 1));
        (*count)--;
    }
    if (place >= most) return;
    if (*count == most) (*count)--;
    memmove(hits + place + 1, hits + place, sizeof *hits * (size_t)(*count - place));
    hits[place] = hit;
    (*count)++;
}

/* One section: from its heading to the next one. */
static GuideHit section_of(const SameWords *words, const Guide *guide, const char *from,
                           const char *to)
{
    const char *in_heading = NULL, *in_text = NULL, *heading = from + strspn(from, "# ");
    const char *text = from + strcspn(from, "\n");
    GuideHit    hit = {.guide = guide, .heading = heading, .length = (int)(text - heading)};
    hit.score = HEADING * count_of(words, heading, text, &in_heading) +
                count_of(words, text, to, &in_text);
    const char *line = in_text ? in_text : heading;
    while (line > from && line[-1] != '\n') line--;
    hit.line = line;
    hit.line_length = (int)strcspn(line, "\n");
    return hit;
}

int guide_index_find(const char *word, GuideHit *hits, int most)
{
    SameWords words = words_of(word);
    int       count = 0;
    if (strlen(word) < LETTERS) return 0;
    for (int i = 0; i < guide_count; i++) {
        const char *from = guide_table[i].text;
        while (*from) {
            const char *next = strstr(from + 1, "\n#");
            const char *to = next ? next + 1 : from + strlen(from);
            GuideHit    hit = section_of(&words, &guide_table[i], from, to);
            if (hit.score) keep(hits, &count, most, hit);
            from = to;
        }
    }
    return count;
}
