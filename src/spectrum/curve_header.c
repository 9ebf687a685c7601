/* SPDX-License-Identifier: Apache-2.0 */
#include "spectrum/curve_header.h"

#include <ctype.h>
#include <string.h>

#include "base/count.h"

enum { WAVELENGTH, INDEX_N, INDEX_K, ROLES };
enum { WORDS_MAX = 64, LINE_MAX = 600 };

/* What a word says of its column. */
typedef enum WordKind { NAMES, IS_UNIT, SCALES, IS_SHARE, IS_N, IS_K, NO_AMOUNT, REFUSED } WordKind;

/* Where in a cell it says so: a letter may be a part of a sample's name. */
typedef enum WordPlace { ANYWHERE, FIRST, LATER, BRACKETED, ALONE } WordPlace;

#define PERMITTIVITY "a permittivity, required: n and k, of which it is the square (n + ik)^2"
#define ABSORBANCE "an absorbance A, required: the share of the light that is left, 10^-A"
#define ABSORBED "what is absorbed, required: the share that is let through or reflected"
#define LENGTHS "no wavelengths, required: nm (1e7 / cm-1, 1239.84 / eV, 299792 / THz)"
#define UNIT "values with a unit, required: none (shares from 0 to 1; n and k)"
#define PHOTONS "a number of photons, required: energy a nm (a photon's is 1 / wavelength)"

/* The words of the wavelength's cell, then those of others; a star: what begins so. */
static const struct WordRow {
    bool of_wavelength;
    WordKind kind;
    WordPlace place;
    double scale;
    const char *words, *why;
} ROWS[] = {
    {true, NAMES, ANYWHERE, 0, "wavelength* wave wl lambda", 0},
    {true, IS_UNIT, ANYWHERE, 1, "nm nanomet*", 0},
    {true, IS_UNIT, ANYWHERE, 1e3, "um micron* micromet*", 0},
    {true, IS_UNIT, ANYWHERE, 0.1, "angstrom* ang", 0},
    {true, IS_UNIT, LATER, 0.1, "a", 0},
    {true, IS_UNIT, LATER, 1e9, "m metre* meter*", 0},
    {true, REFUSED, ANYWHERE, 0, "cm wavenumber* ev energy thz hz frequency", LENGTHS},
    {false, SCALES, ANYWHERE, 1e-2, "% percent* pct prozent", 0},
    {false, SCALES, LATER, 1e-2, "cent", 0},
    {false, SCALES, BRACKETED, 1e-2, "100 x100", 0},
    {false, SCALES, ANYWHERE, 1e-3, "permil* promille", 0},
    {false, IS_SHARE, FIRST, 0, "r t reflect* transmit* transmiss*", 0},
    {false, IS_K, ANYWHERE, 0, "kappa extinction imag*", 0},
    {false, IS_K, FIRST, 0, "k", 0},
    {false, IS_N, ANYWHERE, 0, "refractive index", 0},
    {false, IS_N, FIRST, 0, "n real", 0},
    {false, NO_AMOUNT, LATER, 0, "w mw uw sr cd cm", UNIT},
    {false, NO_AMOUNT, ANYWHERE, 0, "counts", UNIT},
    {false, REFUSED, ANYWHERE, 0, "eps eps1 eps2 epsilon epsilon1 epsilon2 epsr epsi permittivity",
     PERMITTIVITY},
    {false, REFUSED, FIRST, 0, "e1 e2", PERMITTIVITY},
    {false, REFUSED, ANYWHERE, 0, "absorbance* absorbancy opticaldensity", ABSORBANCE},
    {false, REFUSED, ALONE, 0, "a abs od", ABSORBANCE},
    {false, REFUSED, ANYWHERE, 0, "absorpt* attenuation loss opacity emissivity emittance",
     ABSORBED},
    {false, REFUSED, FIRST, 0, "alpha", ABSORBED},
    {false, REFUSED, ANYWHERE, 0, "db decibel* log log10 ln logarithm*",
     "a logarithm, required: the values themselves"},
    {false, REFUSED, ANYWHERE, 0, "photon photons quanta umol mol ppfd", PHOTONS},
    {false, REFUSED, BRACKETED, 0, "10 x10 1000 x1000 10000 ppm",
     "scaled, required: shares from 0 to 1, or percent"},
    {false, NAMES, ANYWHERE, 0, "fraction share ratio factor relative normali* none unitless", 0},
    {false, NAMES, ANYWHERE, 0, "dimensionless au arb* sci sce specular diffuse total sample", 0},
};

/* Signs beyond ASCII, of UTF-8 and of Latin-1. */
static const struct Sign {
    const char *bytes, *text;
} SIGNS[] = {
    {"\xc2\xb5", "u"},
    {"\xce\xbc", "u"},
    {"\xc3\x85", "angstrom"},
    {"\xe2\x84\xab", "angstrom"},
    {"\xce\xbb", "lambda"},
    {"\xce\xb5", "eps"},
    {"\xcf\xb5", "eps"},
    {"\xce\xba", "kappa"},
    {"\xce\xb1", "alpha"},
    {"\xe2\x80\xb0", "permille"},
    {"\xef\xbc\x85", "%"},
    {"\xc3\x97", "*"},
    {"\xb5", "u"},
    {"\xc5", "angstrom"},
};

typedef struct HeaderWord {
    char text[24];
    int cell;
    bool is_first, is_alone, is_bracketed;
} HeaderWord;

typedef struct HeaderWords {
    HeaderWord list[WORDS_MAX];
    int count;
    bool has_cells; /* one a column */
} HeaderWords;

/* ---- words ------------------------------------------------------------------------------- */

/* In small letters, and signs by their names. */
static void fold(const char *line, char out[LINE_MAX]) {
    size_t length = 0;
    line += strspn(line, " \t");
    while (*line && *line != '\n' && *line != '\r' && length + 16 < LINE_MAX) {
        const struct Sign *sign = NULL;
        for (int i = 0; i < COUNT_OF(SIGNS) && !sign; i++)
            if (!strncmp(line, SIGNS[i].bytes, strlen(SIGNS[i].bytes))) sign = &SIGNS[i];
        if (!sign) out[length++] = (char)tolower((unsigned char)*line++);
        if (!sign) continue;
        memcpy(out + length, sign->text, strlen(sign->text));
        length += strlen(sign->text);
        line += strlen(sign->bytes);
    }
    out[length] = '\0';
}

/* A cell ends before this character: at the separator, and white space does not part a name
 * and its brackets. */
static bool is_end(const char *at, char separator) {
    if (separator != ' ') return *at == separator;
    return isspace((unsigned char)*at) && !isspace((unsigned char)at[1]) && at[1] &&
           !strchr("([{<", at[1]);
}

/* Splits at what is outside of brackets and quotes; the number of cells. */
static int split(const char *line, char separator, HeaderWords *out) {
    int depth = 0, cell = 0;
    bool is_quoted = false;
    out->count = 0;
    for (const char *at = line; *at;) {
        size_t length = 0;
        while (isalnum((unsigned char)at[length])) length++;
        if (*at == '%') length = 1;
        if (length && out->count < WORDS_MAX) {
            HeaderWord *word = &out->list[out->count++];
            bool is_times = at > line && at[-1] == '*';
            *word = (HeaderWord){.cell = cell, .is_bracketed = depth > 0 || is_times};
            memcpy(word->text, at, length < sizeof word->text ? length : sizeof word->text - 1);
        }
        is_quoted ^= !length && *at == '"';
        if (!length && strchr("([{<", *at)) depth++;
        if (!length && strchr(")]}>", *at)) depth--;
        cell += !length && depth <= 0 && !is_quoted && is_end(at, separator);
        at += length ? length : 1;
    }
    return cell + 1;
}

/* One cell a column, or two where a comma stands before each unit; else all are one. */
static void find_words(const char *line, int columns, HeaderWords *out) {
    int cells = 0;
    for (const char *separator = ";\t, "; *separator && !out->has_cells; separator++) {
        cells = split(line, *separator, out);
        out->has_cells = cells == columns || (cells == 2 * columns && *separator != ' ');
    }
    for (int i = 0; i < out->count; i++) {
        HeaderWord *word = &out->list[i];
        word->cell = out->has_cells ? word->cell * columns / cells : 0;
        word->is_first = !i || word[-1].cell != word->cell;
        word->is_alone = out->has_cells;
        if (i && !strcmp(word->text, "density") && !strcmp(word[-1].text, "optical"))
            strcpy(word->text, "opticaldensity");
    }
    for (int i = 0; i < out->count; i++)
        for (int k = 0; k < out->count; k++)
            if (k != i && out->list[k].cell == out->list[i].cell && !out->list[k].is_bracketed)
                out->list[i].is_alone = false;
}

static bool is_among(const char *word, const char *list) {
    while (*list) {
        size_t length = strcspn(list, " ");
        bool is_stem = list[length - 1] == '*';
        if (!strncmp(word, list, length - is_stem) && (is_stem || !word[length])) return true;
        list += length + (list[length] == ' ');
    }
    return false;
}

static const struct WordRow *row_of(const HeaderWord *word, bool of_wavelength) {
    for (int i = 0; i < COUNT_OF(ROWS); i++) {
        const struct WordRow *row = &ROWS[i];
        bool is_there = row->place == ANYWHERE || (row->place == FIRST && word->is_first) ||
                        (row->place == LATER && !word->is_first) ||
                        (row->place == BRACKETED && word->is_bracketed) ||
                        (row->place == ALONE && word->is_alone);
        if (row->of_wavelength == of_wavelength && is_there && is_among(word->text, row->words))
            return row;
    }
    return NULL;
}

/* ---- what they say ----------------------------------------------------------------------- */

/* The cell that has the wavelength's name, else that which begins with a unit of it, else that
 * which has nothing else in brackets. */
static int wavelength_cell(const HeaderWords *words, bool *is_named) {
    *is_named = true;
    for (int attempt = 0; attempt < 3; attempt++)
        for (int i = 0; i < words->count; i++) {
            const HeaderWord *word = &words->list[i];
            const struct WordRow *row = row_of(word, true);
            bool is_whole = word->is_bracketed && i && !word[-1].is_bracketed &&
                            (i + 1 == words->count || !word[1].is_bracketed);
            bool is_it = attempt == 0   ? !word->is_bracketed && row && row->kind == NAMES
                         : attempt == 1 ? !word->is_bracketed && row && word->is_first
                                        : is_whole && row && row->kind == IS_UNIT;
            if (is_it) return word->cell;
        }
    *is_named = false;
    return 0;
}

typedef struct HeaderScan {
    int columns;
    bool is_amount, has_unit;
    int at[ROLES]; /* cell, or word where there are none; -1: not named */
    CurveHeader header;
} HeaderScan;

/* A word of a column of values. */
static const char *take_value(HeaderScan *scan, const HeaderWord *word, int at) {
    const struct WordRow *row = row_of(word, false);
    bool is_index = scan->columns == 3;
    if (!row && word->is_bracketed && isalpha((unsigned char)word->text[0]) && word->text[1] &&
        !scan->is_amount && !row_of(word, true))
        memcpy(scan->header.unknown, word->text, sizeof word->text);
    if (!row || (row->place == ALONE && scan->is_amount)) return NULL;
    if (row->kind == REFUSED || (row->kind == NO_AMOUNT && !scan->is_amount)) return row->why;
    if (is_index && (row->kind == SCALES || row->kind == IS_SHARE))
        return "a share of the light, required: n and k";
    if (!is_index && (row->kind == IS_N || row->kind == IS_K))
        return word->is_alone || row->place == ANYWHERE
                   ? "a refractive index, required: the share of the light, 0 to 1"
                   : NULL;
    if (row->kind == SCALES && !word->is_first && !word->is_bracketed &&
        isdigit((unsigned char)word[-1].text[0]))
        return "a number of percent, which may be a name or a unit, required: a unit as (%)";
    if (row->kind == SCALES) scan->header.value = row->scale;
    if (row->kind == IS_K && scan->at[INDEX_K] < 0) scan->at[INDEX_K] = at;
    if (row->kind == IS_K && scan->at[INDEX_N] == at) scan->at[INDEX_N] = -1;
    if (row->kind == IS_N && scan->at[INDEX_N] < 0 && scan->at[INDEX_K] != at)
        scan->at[INDEX_N] = at;
    return NULL;
}

static const char *take_words(HeaderScan *scan, const HeaderWords *words) {
    int wave = wavelength_cell(words, &scan->header.names_wavelength);
    const char *why = NULL;
    scan->header.names_wavelength &= words->has_cells;
    for (int i = 0; i < words->count && !why; i++) {
        const HeaderWord *word = &words->list[i];
        const struct WordRow *row = row_of(word, true);
        int at = words->has_cells ? word->cell : i;
        if (words->has_cells ? word->cell != wave : !row || scan->has_unit) {
            why = take_value(scan, word, at);
            continue;
        }
        if (scan->at[WAVELENGTH] < 0) scan->at[WAVELENGTH] = at;
        if (!row || row->kind == NAMES || scan->has_unit) continue;
        why = row->kind == REFUSED ? row->why : NULL;
        scan->has_unit = true;
        scan->header.nm = row->scale;
    }
    return why;
}

/* Columns as they are named; one that is not is the one that is left. */
static void set_places(HeaderScan *scan, bool has_cells) {
    int *at = scan->at;
    bool is_named = at[WAVELENGTH] >= 0 && at[INDEX_N] >= 0 && at[INDEX_K] >= 0;
    if (!has_cells && !is_named) return;
    if (at[WAVELENGTH] < 0) at[WAVELENGTH] = 0;
    for (int role = 0; role < scan->columns; role++) {
        int place = 0;
        while (has_cells && at[role] < 0 && (place == at[0] || place == at[1] || place == at[2]))
            place++;
        if (at[role] < 0) at[role] = place;
    }
    for (int role = 0; role < scan->columns; role++) {
        int before = 0;
        for (int k = 0; k < scan->columns; k++) before += at[k] < at[role];
        scan->header.place[role] = before;
    }
}

CurveHeader curve_header_none(void) {
    return (CurveHeader){.place = {0, 1, 2}, .nm = 1, .value = 1};
}

const char *curve_header_read(const char *line, int columns, bool is_amount, CurveHeader *out) {
    char text[LINE_MAX];
    HeaderWords words = {.count = 0};
    HeaderScan scan = {columns, is_amount, false, {-1, -1, -1}, curve_header_none()};
    fold(line, text);
    find_words(text, columns, &words);
    const char *why = take_words(&scan, &words);
    set_places(&scan, words.has_cells);
    *out = scan.header;
    return why;
}
