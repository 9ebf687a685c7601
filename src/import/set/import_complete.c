/* From the tables of many files to one set: parts are joined, and what is missing is said. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/set/import.h"
#include "import/set/import_parts.h"
#include "panel/set/measurement.h"

/* The panel's spectra begin and end here; the manifest takes no other wavelength. */
#define FIRST_NM 360
#define LAST_NM 830
#define INCIDENCE_MAX_DEG 89

static const char *const source_names[] = {"red", "green", "blue", "black", "white",
                                           "reflection", "dark", "reference"};

const char *import_source_name(ImportSource source)
{
    return source_names[source];
}

/* ---- parts of one table ------------------------------------------------------------------ */

static bool same_light(const ImportTable *a, const ImportTable *b)
{
    if (a->source != b->source) return false;
    if (a->source != IMPORT_REFLECTION) return a->level == b->level;
    return fabs(a->incidence_deg - b->incidence_deg) < SAME_ANGLE_DEG &&
           fabs(a->incidence_phi_deg - b->incidence_phi_deg) < SAME_ANGLE_DEG;
}

static bool same_channels(const ImportTable *a, const ImportTable *b)
{
    bool same = a->channels == b->channels && a->component == b->component;
    for (int c = 0; same && a->source == IMPORT_REFLECTION && c < a->channels; c++)
        same = fabsf(a->wavelength_nm[c] - b->wavelength_nm[c]) < 1e-3f;
    return same;
}

/* Sections at several azimuths make one table. */
static bool join_sections(ImportSet *set, Error *err)
{
    int *part = ARENA_NEW(set->arena, int, IMPORT_TABLES_MAX);
    for (int i = 0; i < set->count; i++) {
        int    count = 0;
        double rows = 0;
        for (int k = i; k < set->count && set->table[i].is_section; k++)
            if (set->table[k].is_section && same_light(&set->table[i], &set->table[k]) &&
                same_channels(&set->table[i], &set->table[k])) {
                part[count++] = k;
                rows += set->table[k].rows;
            }
        if (count < 2) continue;
        if (rows > IMPORT_ROWS_MAX)
            return error_at(err, ERROR_INPUT, set->table[i].file, "",
                            "and its other sections have %g directions, wanted at most %d",
                            rows, IMPORT_ROWS_MAX);
        ImportTable joined;
        import_append_tables(set, part, count, &joined);
        set->table[i] = joined;
        import_remove_tables(set, part, count, i);
    }
    return true;
}

/* Files of X, Y and Z alone: each of them once. */
static bool join_components(ImportSet *set, int first, Error *err)
{
    static const char letters[] = "XYZ";
    int          part[3] = {-1, -1, -1};
    ImportTable *table = set->table;
    for (int i = first; i < set->count; i++) {
        if (!table[i].component || !same_light(&table[first], &table[i])) continue;
        int at = (int)(strchr(letters, table[i].component) - letters);
        if (part[at] >= 0)
            return error_at(err, ERROR_INPUT, table[i].file, "", "is %c of %s %g, and so is %s",
                            table[i].component, import_source_name(table[i].source),
                            table[i].level, table[part[at]].file);
        part[at] = i;
    }
    if (part[1] >= 0 && part[0] < 0 && part[2] < 0) {
        import_add_colour(set, &table[part[1]]);
        return true;
    }
    for (int j = 0; j < 3; j++)
        if (part[j] < 0)
            return error_at(err, ERROR_INPUT, table[first].file, "",
                            "is %c of %s %g, and no file has %c — give the missing file, or "
                            "its role as --role FILE=%s:%g:%c",
                            table[first].component, import_source_name(table[first].source),
                            table[first].level, letters[j],
                            import_source_name(table[first].source), table[first].level,
                            letters[j]);
    ImportTable joined = table[first];
    if (!import_join_tables(set, part, 3, &joined, err)) return false;
    joined.component = 0;
    table[first] = joined;
    import_remove_tables(set, part, 3, first);
    return true;
}

static bool join_wavelengths(ImportSet *set, int first, Error *err)
{
    int          part[MEASUREMENT_WAVELENGTHS_MAX], count = 0;
    ImportTable *table = set->table;
    for (int i = first; i < set->count; i++) {
        if (!same_light(&table[first], &table[i])) continue;
        if (count == MEASUREMENT_WAVELENGTHS_MAX)
            return error_at(err, ERROR_INPUT, table[i].file, "", "is one wavelength too many");
        part[count++] = i;
    }
    if (count == 1) return true;
    ImportTable joined = table[first];
    if (!import_join_tables(set, part, count, &joined, err)) return false;
    table[first] = joined;
    import_remove_tables(set, part, count, first);
    return true;
}

static bool refuse_twice(const ImportSet *set, int first, Error *err)
{
    const ImportTable *table = set->table;
    for (int i = first + 1; i < set->count; i++)
        if (same_light(&table[first], &table[i]))
            return error_at(err, ERROR_INPUT, table[i].file, "",
                            "is %s %g, and so is %s — give one of them another --role, or "
                            "leave it out",
                            import_source_name(table[i].source), table[i].level,
                            table[first].file);
    return true;
}

static bool join_parts(ImportSet *set, Error *err)
{
    for (int i = 0; i < set->count; i++) {
        bool ok = set->table[i].source == IMPORT_REFLECTION ? join_wavelengths(set, i, err)
                  : set->table[i].component ? join_components(set, i, err)
                                            : true;
        if (!ok || !refuse_twice(set, i, err)) return false;
    }
    return true;
}

/* ---- what the manifest cannot take ------------------------------------------------------- */

static bool keep_visible(ImportSet *set, ImportTable *table, Error *err)
{
    int first = 0, end = table->channels, all = table->channels;
    while (first < end && table->wavelength_nm[first] < FIRST_NM) first++;
    while (end > first && table->wavelength_nm[end - 1] > LAST_NM) end--;
    if (first == end)
        return error_at(err, ERROR_INPUT, table->file, "",
                        "has wavelengths from %g to %g nm, wanted some of %d to %d nm",
                        (double)table->wavelength_nm[0], (double)table->wavelength_nm[all - 1],
                        FIRST_NM, LAST_NM);
    if (end - first == all) return true;
    import_note(set, "%d of %d wavelengths lie outside %d to %d nm and are left out",
                all - (end - first), all, FIRST_NM, LAST_NM);
    size_t  kept = (size_t)(end - first);
    double *value = ARENA_NEW(set->arena, double, kept * (size_t)table->rows);
    for (size_t i = 0; i < (size_t)table->rows; i++)
        memcpy(value + i * kept, table->value + i * (size_t)all + first, sizeof *value * kept);
    table->value = value;
    table->wavelength_nm += first;
    table->channels = (int)kept;
    return true;
}

static bool keep_usable(ImportSet *set, Error *err)
{
    int kept = 0;
    for (int i = 0; i < set->count; i++) {
        ImportTable *table = &set->table[i];
        bool is_reflection = table->source == IMPORT_REFLECTION;
        if (is_reflection && table->incidence_deg > INCIDENCE_MAX_DEG) {
            import_note(set, "incidence %g degrees is left out: a set goes to %d degrees",
                        table->incidence_deg, INCIDENCE_MAX_DEG);
            continue;
        }
        if (is_reflection && !keep_visible(set, table, err)) return false;
        set->table[kept++] = *table;
    }
    set->count = kept;
    return true;
}

/* ---- lights at every azimuth ------------------------------------------------------------- */

static int collect_angles(const ImportSet *set, bool of_azimuth, double *angle, int most)
{
    int count = 0;
    for (int i = 0; i < set->count; i++) {
        const ImportTable *table = &set->table[i];
        if (table->source != IMPORT_REFLECTION) continue;
        double value = of_azimuth ? table->incidence_phi_deg : table->incidence_deg;
        bool   known = false;
        for (int k = 0; k < count && !known; k++)
            known = fabs(angle[k] - value) < SAME_ANGLE_DEG;
        if (!known && count < most) angle[count++] = value;
    }
    return count;
}

static const ImportTable *find_light(const ImportSet *set, double incidence, double azimuth)
{
    for (int i = 0; i < set->count; i++) {
        const ImportTable *table = &set->table[i];
        if (table->source == IMPORT_REFLECTION &&
            fabs(table->incidence_deg - incidence) < SAME_ANGLE_DEG &&
            fabs(table->incidence_phi_deg - azimuth) < SAME_ANGLE_DEG)
            return table;
    }
    return NULL;
}

/* At normal incidence the light has no azimuth: the same table serves them all, turned so that
 * its phi counts from each azimuth's mirror direction. */
static void turn_light(const ImportSet *set, ImportTable *table, double azimuth)
{
    double *phi = ARENA_NEW(set->arena, double, table->rows);
    for (int i = 0; i < table->rows; i++)
        phi[i] = fmod(table->phi_deg[i] + table->incidence_phi_deg - azimuth + 720, 360);
    table->phi_deg = phi;
    table->incidence_phi_deg = azimuth;
}

static bool turn_normal(ImportSet *set, const ImportTable *normal, double azimuth, Error *err)
{
    ImportTable turned = *normal;
    turn_light(set, &turned, azimuth);
    import_note(set, "normal incidence serves every azimuth of the light");
    return import_add(set, &turned, err);
}

static const ImportTable *first_normal(const ImportSet *set)
{
    for (int i = 0; i < set->count; i++)
        if (set->table[i].source == IMPORT_REFLECTION &&
            set->table[i].incidence_deg < SAME_ANGLE_DEG)
            return &set->table[i];
    return NULL;
}

/* A table of normal incidence whose azimuth no other light has moves to one that they have. */
static void move_normal(ImportSet *set)
{
    const ImportTable *other = NULL;
    for (int i = 0; i < set->count && !other; i++)
        if (set->table[i].source == IMPORT_REFLECTION &&
            set->table[i].incidence_deg >= SAME_ANGLE_DEG)
            other = &set->table[i];
    for (int i = 0; i < set->count && other; i++) {
        ImportTable *table = &set->table[i];
        bool is_known = false;
        if (table->source != IMPORT_REFLECTION || table->incidence_deg >= SAME_ANGLE_DEG)
            continue;
        for (int k = 0; k < set->count; k++)
            is_known |= set->table[k].source == IMPORT_REFLECTION &&
                        set->table[k].incidence_deg >= SAME_ANGLE_DEG &&
                        fabs(set->table[k].incidence_phi_deg - table->incidence_phi_deg) <
                            SAME_ANGLE_DEG;
        if (!is_known) turn_light(set, table, other->incidence_phi_deg);
    }
}

/* The azimuths of light that is not normal: several make the material anisotropic, unless the
 * user says otherwise; one is as good as any other. */
static void settle_azimuths(ImportSet *set)
{
    double first = -1;
    bool   several = false;
    for (int i = 0; i < set->count; i++) {
        const ImportTable *table = &set->table[i];
        if (table->source != IMPORT_REFLECTION || table->incidence_deg < SAME_ANGLE_DEG)
            continue;
        several |= first >= 0 && fabs(table->incidence_phi_deg - first) > SAME_ANGLE_DEG;
        first = table->incidence_phi_deg;
    }
    if (set->is_anisotropic && !several)
        import_note(set, "the material depends on the light's azimuth, but only one was "
                         "measured: it is taken for all, the same on both sides of the plane "
                         "of incidence");
    set->is_anisotropic = several && !set->is_isotropic;
    for (int i = 0; i < set->count && !set->is_anisotropic; i++)
        if (set->table[i].source == IMPORT_REFLECTION) set->table[i].incidence_phi_deg = 180;
}

static bool complete_lights(ImportSet *set, Error *err)
{
    double azimuth[IMPORT_TABLES_MAX];
    move_normal(set);
    int count = collect_angles(set, true, azimuth, IMPORT_TABLES_MAX);
    const ImportTable *normal = first_normal(set);
    for (int k = 0; normal && k < count; k++)
        if (!find_light(set, normal->incidence_deg, azimuth[k]) &&
            !turn_normal(set, normal, azimuth[k], err))
            return false;
    return true;
}

/* ---- is it a set? ------------------------------------------------------------------------ */

static const ImportTable *first_of(const ImportSet *set, ImportSource source)
{
    for (int i = 0; i < set->count; i++)
        if (set->table[i].source == source) return &set->table[i];
    return NULL;
}

static int count_of(const ImportSet *set, ImportSource source)
{
    int count = 0;
    for (int i = 0; i < set->count; i++) count += set->table[i].source == source;
    return count;
}

static void remove_source(ImportSet *set, ImportSource source)
{
    int kept = 0;
    for (int i = 0; i < set->count; i++)
        if (set->table[i].source != source) set->table[kept++] = set->table[i];
    set->count = kept;
}

/* Where the user says that black was subtracted: zeros at the directions of a red table. */
static bool add_zero_black(ImportSet *set, Error *err)
{
    ImportTable black = *first_of(set, IMPORT_RED);
    black.source = IMPORT_BLACK;
    black.level = 0;
    black.masked = 0;
    black.masked_theta_deg = black.masked_phi_deg = NULL;
    black.value = ARENA_NEW(set->arena, double, 3 * (size_t)black.rows);
    import_note(set, "the black pattern is declared to be subtracted: it is written as zero");
    return import_add(set, &black, err);
}

/* Primaries with their black, or white alone: what both have too much of is left out. */
static bool check_sources(ImportSet *set, Error *err)
{
    bool primaries = first_of(set, IMPORT_RED) || first_of(set, IMPORT_GREEN) ||
                     first_of(set, IMPORT_BLUE);
    bool white = first_of(set, IMPORT_WHITE) != NULL, black = first_of(set, IMPORT_BLACK);
    if (!primaries && !white && black)
        return error_at(err, ERROR_INPUT, first_of(set, IMPORT_BLACK)->file, "",
                        "is a black pattern alone, wanted also red, green and blue, or white");
    for (int p = IMPORT_RED; primaries && p <= IMPORT_BLUE; p++) {
        if (!first_of(set, (ImportSource)p))
            return error_set(err, ERROR_INPUT,
                             "no file is %s — name one as --role FILE=%s:LEVEL",
                             source_names[p], source_names[p]);
        if (count_of(set, (ImportSource)p) > MEASUREMENT_LEVELS_MAX)
            return error_set(err, ERROR_INPUT, "%s has %d grey levels, wanted at most %d",
                             source_names[p], count_of(set, (ImportSource)p),
                             MEASUREMENT_LEVELS_MAX);
    }
    if (primaries && black && set->black_is_zero)
        return error_at(err, ERROR_INPUT, first_of(set, IMPORT_BLACK)->file, "",
                        "is a black pattern, and --no-black says that there is none");
    if (primaries && !black && set->black_is_zero) return add_zero_black(set, err);
    if (primaries && !black)
        return error_set(err, ERROR_INPUT, "no file is the black pattern — name one as --role "
                         "FILE=black, or say --no-black when it was subtracted");
    if (primaries && white) {
        import_note_white(set);
        import_note(set, "the white table is not used: red, green and blue are there");
        remove_source(set, IMPORT_WHITE);
    }
    if (!primaries && white && black) {
        import_note(set, "the black table is not used: a set of white alone has a black of 0");
        remove_source(set, IMPORT_BLACK);
    }
    return true;
}

static bool same_wavelengths(const ImportTable *a, const ImportTable *b)
{
    bool same = a->channels == b->channels;
    for (int c = 0; same && c < a->channels; c++)
        same = fabsf(a->wavelength_nm[c] - b->wavelength_nm[c]) < 1e-3f;
    return same;
}

static bool check_lights(const ImportSet *set, Error *err)
{
    double incidence[IMPORT_TABLES_MAX], azimuth[IMPORT_TABLES_MAX];
    int    incidences = collect_angles(set, false, incidence, IMPORT_TABLES_MAX);
    int    azimuths = collect_angles(set, true, azimuth, IMPORT_TABLES_MAX);
    const ImportTable *first = first_of(set, IMPORT_REFLECTION);
    if (incidences > MEASUREMENT_INCIDENCES_MAX)
        return error_at(err, ERROR_INPUT, first->file, "",
                        "gives %d angles of incidence with the other files, wanted at most %d",
                        incidences, MEASUREMENT_INCIDENCES_MAX);
    if (azimuths > MEASUREMENT_AZIMUTHS_MAX || incidences * azimuths > MEASUREMENT_TABLES_MAX)
        return error_at(err, ERROR_INPUT, first->file, "",
                        "gives light from %d incidences and %d azimuths with the other files, "
                        "wanted at most %d azimuths and %d tables", incidences, azimuths,
                        MEASUREMENT_AZIMUTHS_MAX, MEASUREMENT_TABLES_MAX);
    for (int i = 0; i < incidences; i++)
        for (int k = 0; k < azimuths; k++) {
            const ImportTable *table = find_light(set, incidence[i], azimuth[k]);
            if (!table)
                return error_set(err, ERROR_INPUT,
                                 "no file has light from incidence %g, azimuth %g degrees; a "
                                 "material that depends on the azimuth is wanted at every "
                                 "incidence (%d) and azimuth (%d) of the light — or say "
                                 "--isotropic when the azimuth makes no difference",
                                 incidence[i], azimuth[k], incidences, azimuths);
            if (!same_wavelengths(first, table))
                return error_at(err, ERROR_INPUT, table->file, "",
                                "has other wavelengths than %s, wanted the same in every table",
                                first->file);
        }
    return true;
}

/* The fit takes noise below zero, but nothing that cannot be noise. */
static bool check_signs(const ImportTable *table, Error *err)
{
    bool   is_light = table->source == IMPORT_REFLECTION;
    size_t size = (size_t)table->channels, total = size * (size_t)table->rows, worst = 0;
    double most = 0;
    for (size_t i = 0; i < total; i++) {
        most = fmax(most, table->value[i]);
        if (table->value[i] < table->value[worst]) worst = i;
    }
    double share = is_light ? (double)MEASUREMENT_NOISE_BRDF_SHARE
                            : (double)MEASUREMENT_NOISE_CD_M2_SHARE;
    double least = is_light ? (double)MEASUREMENT_NOISE_BRDF : (double)MEASUREMENT_NOISE_CD_M2;
    double allowed = fmax(least, share * most);
    return table->value[worst] >= -allowed ||
           error_at(err, ERROR_INPUT, table->file, "",
                    "is %g at theta %g, phi %g, wanted at least %g %s (noise below zero)",
                    table->value[worst], table->theta_deg[worst / size],
                    table->phi_deg[worst / size], -allowed, is_light ? "sr^-1" : "cd/m2");
}

static int by_light(const void *a, const void *b)
{
    const ImportTable *p = a, *q = b;
    if (p->source != q->source) return p->source < q->source ? -1 : 1;
    if (p->level != q->level) return p->level < q->level ? -1 : 1;
    if (p->incidence_phi_deg != q->incidence_phi_deg)
        return p->incidence_phi_deg < q->incidence_phi_deg ? -1 : 1;
    return p->incidence_deg < q->incidence_deg ? -1 : p->incidence_deg > q->incidence_deg;
}

bool import_complete(ImportSet *set, Error *err)
{
    if (!set->count)
        return error_set(err, ERROR_INPUT, "the files hold no table of a panel");
    if (!import_apply_references(set, err)) return false;
    settle_azimuths(set);
    if (!join_sections(set, err) || !join_parts(set, err) || !keep_usable(set, err))
        return false;
    import_merge_directions(set);
    if (!import_mirror(set, err) || !complete_lights(set, err) || !check_sources(set, err) ||
        !check_lights(set, err))
        return false;
    for (int i = 0; i < set->count; i++)
        if (!check_signs(&set->table[i], err)) return false;
    qsort(set->table, (size_t)set->count, sizeof *set->table, by_light);
    return true;
}
