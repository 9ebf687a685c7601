#include "base/count.h"
#include "cli/render/command_line.h"

#include <string.h>

#include "text/escape.h"

/* ---- words ------------------------------------------------------------------------------- */

/* How many words, this one first, leave every pixel as it is: a render that was interrupted and
 * resumed says the same command line in its frame as one that was not. */
static int idle_words(const char *word)
{
    static const struct {
        const char *name;
        bool        has_value;
    } idle[] = {{"--threads", true}, {"--json", false}, {"--quiet", false},
                {"--progress", true}, {"--checkpoint", true},
                {"--checkpoint-interval", true}, {"--resume", false}};
    size_t length = strcspn(word, "=");
    for (int i = 0; i < COUNT_OF(idle); i++)
        if (strlen(idle[i].name) == length && !strncmp(word, idle[i].name, length))
            return idle[i].has_value && !word[length] ? 2 : 1;
    return 0;
}

const char *command_line_join(int argc, char **argv, bool with_idle, Arena *arena)
{
    const char *line = "parhelion";
    bool        has_options = true;
    for (int i = 0; i < argc; i++) {
        int idle = with_idle || !has_options ? 0 : idle_words(argv[i]);
        if (!strcmp(argv[i], "--")) has_options = false;
        if (idle)
            i += idle - 1;
        else
            line = arena_format(arena, "%s %s", line, escape_shell(argv[i], arena));
    }
    return line;
}

/* The next word as it is written, with its quotes; NULL at the end. Inside quotes nothing has a
 * meaning but the quote that ends them; outside a backslash takes it from what follows. */
static const char *next_word(const char **rest, Arena *arena)
{
    const char *begin = *rest + strspn(*rest, " "), *at = begin;
    bool        quoted = false;
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
    const char     *output;
    Arena          *arena;
    bool            is_impossible;
} Rewriting;

typedef const char *Rewrite(Rewriting *to); /* "": the option is left out */

static const char *write_output(Rewriting *to)
{
    return arena_format(to->arena, " -o %s", escape_shell(to->output, to->arena));
}

static const char *write_samples(Rewriting *to)
{
    const FilmPart *whole = to->whole;
    return whole->first_sample ? arena_format(to->arena, " --samples %u:%u",
                                              whole->first_sample, whole->end_sample)
                               : arena_format(to->arena, " --spp %u", whole->end_sample);
}

static const char *write_crop(Rewriting *to)
{
    const FilmRect crop = to->whole->crop;
    if (crop.x0 == 0 && crop.y0 == 0 && crop.x1 == to->whole->width &&
        crop.y1 == to->whole->height)
        return "";
    return arena_format(to->arena, " --crop %d,%d,%d,%d", crop.x0, crop.y0, crop.x1, crop.y1);
}

static const char *leave_out(Rewriting *to)
{
    (void)to;
    return "";
}

static const char *give_up(Rewriting *to)
{
    to->is_impossible = true;
    return "";
}

/* All of them take a value. */
static const struct {
    const char *name;
    Rewrite    *rewrite;
} options[] = {
    {"-o", write_output}, {"--samples", write_samples}, {"--spp", write_samples},
    {"--crop", write_crop}, {"--noise", give_up}, {"--png", leave_out},
    {"--exposure", leave_out}, {"--config", leave_out}, {"--display", leave_out},
    {"--view", leave_out}, {"--false-colour", leave_out},
};

static Rewrite *find_rewrite(const char *word)
{
    size_t length = strcspn(word, "=");
    for (int i = 0; i < COUNT_OF(options); i++)
        if (strlen(options[i].name) == length && !strncmp(options[i].name, word, length))
            return options[i].rewrite;
    return NULL;
}

const char *command_line_of_whole(const char *line, const FilmPart *whole, const char *output,
                                  Arena *arena)
{
    Rewriting   to = {whole, output, arena, false};
    const char *word, *result = "", *rest = line;
    bool        only_arguments = false;
    while ((word = next_word(&rest, arena))) {
        Rewrite *rewrite = only_arguments ? NULL : find_rewrite(word);
        only_arguments = only_arguments || !strcmp(word, "--");
        if (rewrite && !strchr(word, '=')) next_word(&rest, arena); /* its value */
        const char *written = rewrite ? rewrite(&to) : arena_format(arena, " %s", word);
        result = arena_format(arena, "%s%s", result, written);
    }
    return to.is_impossible ? NULL : result + (*result == ' ');
}
