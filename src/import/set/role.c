/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/role.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"

#define WORDS_MAX 64
#define WORD_LENGTH 24

typedef struct RoleWord {
    char text[WORD_LENGTH]; /* lower case; empty for a number */
    double number;
} RoleWord;

/* ---- "red:255:X" ------------------------------------------------------------------------- */

static bool bad_role(const char *text, Error *err) {
    return error_set(err, ERROR_USAGE,
                     "the role '%s' is unknown, required: red, green or blue with :LEVEL, "
                     "black, white, brdf:INCIDENCE[:AZIMUTH[:WAVELENGTH]] or skip",
                     text);
}

/* Up to three fields behind the name; NULL where there is none. */
static int cut_fields(const char *text, char *copy, size_t size, const char *field[4]) {
    int count = 0;
    snprintf(copy, size, "%s", text);
    for (char *at = copy; at && count < 4;) {
        char *colon = strchr(at, ':');
        field[count++] = at;
        if (colon) *colon++ = 0;
        at = colon;
        if (at && count == 4) return -1;
    }
    return count;
}

static bool field_number(const char *text, double low, double high, double *out) {
    return number_is(text, out) && *out >= low && *out <= high;
}

static bool parse_light(const char *const *field, int count, Role *role) {
    if (count > 1) {
        role->has_incidence = true;
        if (!field_number(field[1], 0, 89.999, &role->incidence_deg)) return false;
    }
    if (count > 2) {
        role->has_azimuth = true;
        if (!field_number(field[2], -360, 360, &role->azimuth_deg)) return false;
    }
    return count < 4 || field_number(field[3], 100, 20000, &role->wavelength_nm);
}

static bool parse_pattern(const char *const *field, int count, double level_max, Role *role) {
    bool is_fixed = role->source == IMPORT_BLACK || role->source == IMPORT_WHITE;
    int at = 1;
    role->level = level_max;
    if (!is_fixed && count > 1) {
        if (!field_number(field[at++], 1e-9, level_max, &role->level)) return false;
        role->has_level = true;
    }
    if (at < count) {
        role->component = (char)toupper((unsigned char)field[at][0]);
        if (strlen(field[at]) != 1 || !strchr("XYZ", role->component)) return false;
        at++;
    }
    return at == count;
}

bool role_parse(const char *text, double level_max, Role *out, Error *err) {
    static const char *const names[] = {"red",   "green", "blue",
                                        "black", "white", "brdf"}; /* as ImportSource */
    char copy[128];
    const char *field[4] = {0};
    int count = cut_fields(text, copy, sizeof copy, field);
    Role role = {.is_known = true};
    if (count < 1) return bad_role(text, err);
    if (!strcmp(field[0], "skip") && count == 1) {
        *out = (Role){.is_known = true, .is_skipped = true};
        return true;
    }
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcmp(field[0], names[i]) != 0) continue;
        role.source = (ImportSource)i;
        bool ok = role.source == IMPORT_REFLECTION ? parse_light(field, count, &role)
                                                   : parse_pattern(field, count, level_max, &role);
        if (!ok) return bad_role(text, err);
        *out = role;
        return true;
    }
    return bad_role(text, err);
}

/* ---- words ------------------------------------------------------------------------------- */

static bool is_letter(char c) {
    return isalpha((unsigned char)c) || (unsigned char)c >= 0x80;
}

/* Runs of letters, and numbers with a point between digits. */
static int cut_words(const char *text, RoleWord *word) {
    int count = 0;
    while (*text && count < WORDS_MAX) {
        word[count] = (RoleWord){0};
        if (isdigit((unsigned char)*text)) {
            char digits[WORD_LENGTH] = {0};
            for (int n = 0;
                 isdigit((unsigned char)*text) || (*text == '.' && isdigit((unsigned char)text[1]));
                 text++)
                if (n < WORD_LENGTH - 1) digits[n++] = *text;
            number_read(digits, &word[count++].number);
        } else if (is_letter(*text)) {
            for (int n = 0; is_letter(*text); text++)
                if (n < WORD_LENGTH - 1) word[count].text[n++] = (char)tolower(*text);
            count++;
        } else {
            text++;
        }
    }
    return count;
}

/* The pattern that a word names; a single letter counts only before a number. */
static int colour_of(const RoleWord *word, bool before_number) {
    static const char *const words[5] = {"red", "green", "blue", "black", "white"};
    static const char letters[] = "rgbkw";
    for (int c = 0; c < 5; c++) {
        if (!strcmp(words[c], word->text)) return c;
        if (before_number && word->text[0] == letters[c] && !word->text[1]) return c;
    }
    return -1;
}

typedef struct WordReader {
    const RoleWord *word;
    int count;
    Role role;
    int colours, lights; /* how many of each were found */
} WordReader;

static bool next_is_number(const WordReader *in, int i) {
    return i + 1 < in->count && !in->word[i + 1].text[0];
}

/* A light's word with its number: incidence, azimuth or wavelength. */
static bool read_light_word(WordReader *in, int i) {
    static const char *const incidence[] = {"brdf", "bsdf", "brf",    "reflection", "reflectance",
                                            "refl", "i",    "in",     "inc",        "incidence",
                                            "aoi",  "ti",   "thetai", NULL};
    static const char *const azimuth[] = {"a", "az", "azi", "azimuth", "phi", "p", "phii", NULL};
    static const char *const wavelength[] = {"w", "wl", "wave", "wavelength", "lambda", NULL};
    const char *text = in->word[i].text;
    double number = in->word[i + 1].number;
    if (import_word_find(incidence, text) >= 0 && number < 90) {
        in->role.incidence_deg = number;
        in->role.has_incidence = true;
        in->lights++;
        return true;
    }
    if (in->lights && import_word_find(azimuth, text) >= 0 && number <= 360) {
        in->role.azimuth_deg = number;
        in->role.has_azimuth = true;
        return true;
    }
    bool is_nm = number >= 300 && number < 3000;
    if (in->lights && import_word_find(wavelength, text) >= 0 && is_nm) {
        in->role.wavelength_nm = number;
        return true;
    }
    return false;
}

/* "20-90": a second angle without a word could be anything. A date is none. */
static bool has_loose_number(const WordReader *in, int i) {
    return i < in->count && !in->word[i].text[0] && in->word[i].number <= 360;
}

static void read_words(WordReader *in) {
    for (int i = 0; i < in->count; i++) {
        const RoleWord *word = &in->word[i];
        if (!word->text[0]) {
            if (i + 1 < in->count && !strcmp(in->word[i + 1].text, "nm"))
                in->role.wavelength_nm = word->number;
            continue;
        }
        if (next_is_number(in, i) && read_light_word(in, i)) {
            in->lights += has_loose_number(in, i + 2);
            i++;
            continue;
        }
        int colour = colour_of(word, next_is_number(in, i));
        if (colour >= 0) {
            in->colours++;
            in->role.source = (ImportSource)colour;
            if (next_is_number(in, i)) {
                in->role.level = in->word[i + 1].number;
                in->role.has_level = true;
            }
        }
    }
}

Role role_from_words(const char *words, double level_max, bool *is_ambiguous) {
    RoleWord word[WORDS_MAX];
    WordReader in = {.word = word, .count = cut_words(words, word)};
    read_words(&in);
    Role *role = &in.role;
    *is_ambiguous = in.colours + in.lights > 1;
    role->is_known = in.colours + in.lights == 1;
    if (in.lights) {
        role->source = IMPORT_REFLECTION;
        return *role;
    }
    if (role->source == IMPORT_BLACK || !role->has_level) {
        *is_ambiguous |= role->source == IMPORT_BLACK && role->has_level && role->level != 0;
        role->level = level_max;
    }
    if (role->source <= IMPORT_BLUE) *is_ambiguous |= !(role->level > 0);
    *is_ambiguous |= role->level > level_max;
    *is_ambiguous |= role->source == IMPORT_WHITE && role->level != level_max;
    *is_ambiguous &= in.colours > 0;
    if (*is_ambiguous) role->is_known = false;
    return *role;
}
