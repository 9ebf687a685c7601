/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/dealt_part.h"

#include <string.h>

#include "base/number.h"
#include "text/text.h"

bool dealt_part_parse(const char *text, DealtPart *out) {
    uint64_t number, count;
    const char *at = number_read_count(text, &number);
    at = at && *at == '/' ? number_read_count(at + 1, &count) : NULL;
    if (!at || *at || number < 1 || number > count || count > DEALT_PARTS_MAX) return false;
    *out = (DealtPart){(uint32_t)number, (uint32_t)count};
    return true;
}

bool dealt_part_samples(DealtPart part, uint32_t *first, uint32_t *end, Error *err) {
    uint64_t samples = *end;
    if (part.count > samples)
        return error_set(err, ERROR_USAGE,
                         "--part %u/%u: there are only %u samples a pixel to "
                         "deal",
                         part.number, part.count, *end);
    *first = (uint32_t)(samples * (part.number - 1) / part.count);
    *end = (uint32_t)(samples * part.number / part.count);
    return true;
}

/* "3,5-9,12" as Slurm's --array has it: the numbers from 1 to count that are not there. */
static const char *missing_numbers(const bool *is_there, uint32_t count, Arena *arena) {
    Text text = {.arena = arena};
    for (uint32_t i = 1; i <= count; i++) {
        uint32_t first = i;
        if (is_there[i]) continue;
        while (i < count && !is_there[i + 1]) i++;
        text_format(&text, "%s%u", text.size ? "," : "", first);
        if (i > first) text_format(&text, "-%u", i);
    }
    return text.size ? text.data : NULL;
}

static bool same_deal(const DealtPart *dealt, const FilmPart *parts, int a, int b) {
    return dealt[a].count == dealt[b].count &&
           !memcmp(&parts[a].crop, &parts[b].crop, sizeof parts[a].crop);
}

/* Those that were dealt with the first. */
static bool check_deal(const DealtPart *dealt, const FilmPart *parts, int count, int first,
                       Arena scratch, Error *err) {
    uint32_t of = dealt[first].count;
    int *files = ARENA_NEW(&scratch, int, of + 1); /* by number, counted from 1 */
    bool *is_there = ARENA_NEW(&scratch, bool, of + 1);
    for (int i = first; i < count; i++) {
        uint32_t number = dealt[i].number;
        if (!same_deal(dealt, parts, first, i)) continue;
        if (is_there[number])
            return error_at(err, ERROR_INPUT, parts[i].name, "",
                            "is part %u of %u, and so is %s — leave one of the two out", number, of,
                            parts[files[number]].name);
        files[number] = i;
        is_there[number] = true;
    }
    const char *missing = missing_numbers(is_there, of, &scratch);
    if (!missing) return true;
    bool is_one = !missing[strspn(missing, "0123456789")];
    return error_set(err, ERROR_INPUT,
                     "part%s %.700s of %u %s missing — the command that made the others makes "
                     "%s with --part %s/%u",
                     is_one ? "" : "s", missing, of, is_one ? "is" : "are", is_one ? "it" : "each",
                     is_one ? missing : "K", of);
}

bool dealt_parts_check(const DealtPart *dealt, const FilmPart *parts, int count, Arena scratch,
                       Error *err) {
    for (int i = 0; i < count; i++) {
        bool is_checked = !dealt[i].count;
        for (int j = 0; j < i; j++) is_checked = is_checked || same_deal(dealt, parts, i, j);
        if (!is_checked && !check_deal(dealt, parts, count, i, scratch, err)) return false;
    }
    return true;
}
