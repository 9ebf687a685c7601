/* panel import: the files of a laboratory as one measurement set. */
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/panel_commands.h"
#include "import/import.h"

#define ARENA_BYTES ((size_t)256 << 30) /* address space; pages cost nothing until touched */
#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

static bool read_files(const Cli *cli, const ImportOptions *options, ImportSet *set, Error *err)
{
    Progress progress = progress_start(cli->progress, "import", "files", cli->argument_count);
    bool     ok = true;
    for (int i = 0; i < cli->argument_count && ok; i++) {
        ok = import_file(cli->arguments[i], options, set, err);
        progress_update(&progress, i + 1);
    }
    progress_end(&progress, ok ? cli->argument_count : 0);
    return ok;
}

/* ---- the summary --------------------------------------------------------------------------- */

static json_t *table_summary(const ImportSet *set, const ImportTable *table, Arena *arena)
{
    json_t *one = json_pack("{s:s, s:o, s:i, s:i, s:i}", "file",
        import_table_file(set, table, arena), "from", cli_json_text(table->file), "rows",
        table->rows, "channels", table->channels, "masked", table->masked);
    json_t *list = json_array();
    for (int i = 0; table->masked_theta_deg && i < table->masked; i++)
        json_array_append_new(list, json_pack("[f,f]", table->masked_theta_deg[i],
                                              table->masked_phi_deg[i]));
    json_object_set_new(one, "not_measured", list);
    return one;
}

static json_t *summary(const ImportSet *set, const char *manifest, Arena *arena)
{
    json_t *tables = json_array(), *notes = json_array();
    double  rows = 0, masked = 0;
    for (int i = 0; i < set->count; i++) {
        json_array_append_new(tables, table_summary(set, &set->table[i], arena));
        rows += set->table[i].rows;
        masked += set->table[i].masked;
    }
    for (int i = 0; i < set->note_count; i++)
        json_array_append_new(notes, cli_json_text(set->note[i]));
    return json_pack("{s:o, s:o, s:f, s:f, s:o}", "manifest", cli_json_text(manifest), "tables",
                     tables, "rows", rows, "masked", masked, "notes", notes);
}

static void print_summary(const ImportSet *set, const char *manifest, Arena *arena)
{
    double rows = 0, masked = 0;
    printf("%-32s %10s %9s %7s  %s\n", "table", "directions", "values", "masked", "from");
    for (int i = 0; i < set->count; i++) {
        const ImportTable *table = &set->table[i];
        printf("%-32s %10d %9.0f %7d  %s\n", import_table_file(set, table, arena), table->rows,
               (double)table->rows * table->channels, table->masked, table->file);
        rows += table->rows;
        masked += table->masked;
    }
    for (int i = 0; i < set->note_count; i++) printf("note: %s\n", set->note[i]);
    printf("%s: %d tables, %.0f directions, %.0f masked\n", manifest, set->count, rows, masked);
}

/* ---- the command --------------------------------------------------------------------------- */

static bool run(const Cli *cli, const ImportOptions *options, ImportSet *set,
                const char *manifest, Error *err)
{
    if (!read_files(cli, options, set, err) || !import_complete(set, err) ||
        !import_write(set, manifest, err))
        return false;
    if (cli->json) return cli_print_json(summary(set, manifest, set->arena), err);
    print_summary(set, manifest, set->arena);
    return true;
}

bool cmd_panel_import(int argc, char **argv, Error *err)
{
    Arena         arena = arena_reserve(ARENA_BYTES);
    Cli           cli;
    const char   *output = NULL;
    ImportSet     set = import_set(&arena);
    ImportOptions import = {0};
    const Option  options[] = {
        {"-o", OPTION_TEXT, "MANIFEST.json", "the set to write, with its tables beside it",
         &output, .given = NULL},
        {"--format", OPTION_TEXT, "NAME", "the files' format (default: told by each file)",
         &import.format, .given = NULL},
        {"--wavelength", OPTION_NUMBER, "NM", "for files that do not say theirs",
         &import.wavelength_nm, 360, 830, .given = NULL},
        {"--panel", OPTION_TEXT, "NAME", "the panel's name in the manifest", &set.panel,
         .given = NULL},
        {"--instrument", OPTION_TEXT, "NAME", "the instrument's name in the manifest",
         &set.instrument, .given = NULL},
    };
    const CliCommand command = {"panel import",
        "the files that laboratories have as one measurement set",
        "FILE... -o MANIFEST.json [options]",
        "parhelion panel import lab/*.csv -o measured/MANIFEST.json", options, COUNT(options),
        1, -1};
    if (!cli_parse(&command, argc, argv, &arena, &cli, err)) return false;
    if (cli.help_shown) return true;
    if (!output) return error_set(err, ERROR_USAGE, "panel import wants -o MANIFEST.json");
    bool ok = run(&cli, &import, &set, output, err);
    arena_release(&arena);
    return ok;
}
