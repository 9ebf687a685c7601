/* SPDX-License-Identifier: Apache-2.0 */
#include "base/count.h"
#include "cli/render/command_line.h"

#include <string.h>

#include "cli/options/cli.h"
#include "cli/options/look_options.h"
#include "text/text.h"

/* ---- words ------------------------------------------------------------------------------- */

/* How many words, this one first, leave every pixel as it is, since they only name files, make
 * a picture of the frame as well, or control the run: equal frames have equal words, under any
 * name and however often the render was interrupted. */
static int idle_words(const char *word) {
    static const struct {
        const char *name;
        bool has_value;
    } idle[] = {{"-o", true},         {"--png", true},        {"--false-colour", true},
                {"--threads", true},  {"--json", false},      {"--quiet", false},
                {"--progress", true}, {"--checkpoint", true}, {"--checkpoint-interval", true},
                {"--resume", false},  {"--live", true}};
    DevelopOptions look;
    const Option looks[] = {LOOK_OPTIONS(&look)};
    for (int i = 0; i < COUNT_OF(idle); i++)
        if (cli_is_option(word, idle[i].name)) return cli_option_words(word, idle[i].has_value);
    for (int i = 0; i < COUNT_OF(looks); i++) /* --denoise is not idle: it adds layers */
        if (looks[i].out != &look.is_denoised && cli_is_option(word, looks[i].name))
            return cli_option_words(word, looks[i].kind != OPTION_FLAG);
    return 0;
}

const char *command_line_join(int argc, char **argv, bool with_idle, Arena *arena) {
    const char *line = "parhelion";
    bool has_options = true;
    for (int i = 0; i < argc; i++) {
        int idle = with_idle || !has_options ? 0 : idle_words(argv[i]);
        if (!strcmp(argv[i], "--")) has_options = false;
        if (idle) i += idle - 1;
        else line = arena_format(arena, "%s %s", line, escape_shell(argv[i], arena));
    }
    return line;
}

/* The next word as it is written, with its quotes; NULL at the end. Inside quotes nothing has a
 * meaning but the quote that ends them; outside a backslash takes it from what follows. */
static const char *next_word(const char **rest, Arena *arena) {
    const char *begin = *rest + strspn(*rest, " "), *at = begin;
    bool quoted = false;
    if (!*begin) return NULL;
    for (; *at && (quoted || *at != ' '); at++) {
        if (*at == '\'') quoted = !quoted;
        if (*at == '\\' && !quoted && at[1]) at++;
    }
    *rest = at;
    return arena_string(arena, begin, (size_t)(at - begin));
}

/* ---- what stands in for an option of a part ---------------------------------------------- */

typedef struct Rewriting {
    const FilmPart *whole;
    Arena *arena;
    bool is_dealt; /* the part's line is that of one run, and --part */
    bool is_impossible;
} Rewriting;

typedef const char *Rewrite(Rewriting *to); /* "": the option is left out */

static const char *write_samples(Rewriting *to) {
    const FilmPart *whole = to->whole;
    return whole->first_sample
               ? arena_format(to->arena, " --samples %u:%u", whole->first_sample, whole->end_sample)
               : arena_format(to->arena, " --spp %u", whole->end_sample);
}

static const char *write_crop(Rewriting *to) {
    const FilmRect crop = to->whole->crop;
    if (crop.x0 == 0 && crop.y0 == 0 && crop.x1 == to->whole->width && crop.y1 == to->whole->height)
        return "";
    return arena_format(to->arena, " --crop %d,%d,%d,%d", crop.x0, crop.y0, crop.x1, crop.y1);
}

static const char *leave_out(Rewriting *to) {
    (void)to;
    return "";
}

static const char *give_up(Rewriting *to) {
    to->is_impossible = true;
    return "";
}

/* All of them take a value. */
static const struct {
    const char *name;
    Rewrite *rewrite;
} options[] = {{"--samples", write_samples},
               {"--spp", write_samples},
               {"--crop", write_crop},
               {"--part", leave_out},
               {"--noise", give_up}};

static Rewrite *find_rewrite(const Rewriting *to, const char *word) {
    for (int i = 0; i < COUNT_OF(options); i++)
        if (cli_is_option(word, options[i].name))
            return to->is_dealt && options[i].rewrite != leave_out ? NULL : options[i].rewrite;
    return NULL;
}

static bool is_dealt(const char *line, Arena *arena) {
    const char *word;
    while ((word = next_word(&line, arena)) && strcmp(word, "--") != 0)
        if (cli_is_option(word, "--part")) return true;
    return false;
}

const char *command_line_of_whole(const char *line, const FilmPart *whole, Arena *arena) {
    Rewriting to = {whole, arena, is_dealt(line, arena), false};
    const char *word, *result = "", *rest = line;
    bool only_arguments = false;
    while ((word = next_word(&rest, arena))) {
        Rewrite *rewrite = only_arguments ? NULL : find_rewrite(&to, word);
        int idle = only_arguments ? 0 : idle_words(word); /* in parts of older versions */
        only_arguments = only_arguments || !strcmp(word, "--");
        if ((rewrite ? cli_option_words(word, true) : idle) == 2) next_word(&rest, arena);
        if (idle) continue;
        const char *written = rewrite ? rewrite(&to) : arena_format(arena, " %s", word);
        result = arena_format(arena, "%s%s", result, written);
    }
    return to.is_impossible ? NULL : result + (*result == ' ');
}
