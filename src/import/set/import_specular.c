/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/import_specular.h"

static bool has_reflection(const ImportSet *set)
{
    for (int i = 0; i < set->count; i++)
        if (set->table[i].source == IMPORT_REFLECTION) return true;
    return false;
}

static bool check(const ImportSpecular *asked, const ImportSet *set, Error *err)
{
    if (asked->file && asked->gloss.count)
        return error_set(err, ERROR_USAGE, "both a specular table and gloss are given, wanted "
                         "one of them: the table says more");
    if (!asked->file && asked->aperture_deg > 0)
        return error_set(err, ERROR_USAGE, "the aperture is a specular table's, wanted with "
                         "one (--specular)");
    return has_reflection(set) || (!asked->file && !asked->gloss.count) ||
           error_set(err, ERROR_INPUT, "a specular measurement belongs to a reflection, but "
                     "the files to import hold none");
}

bool import_specular(const ImportSpecular *asked, ImportSet *set, Error *err)
{
    if (!check(asked, set, err)) return false;
    if (asked->gloss.count) {
        set->gloss = &asked->gloss;
        import_note(set, "gloss is taken as the specular reflectance within a round aperture, "
                    "the same at all wavelengths: an approximation");
    }
    if (!asked->file) return true;
    SpecularTable *table = ARENA_NEW(set->arena, SpecularTable, 1);
    if (!specular_table_read_file(asked->file, asked->aperture_deg, set->arena, table, err))
        return false;
    set->specular = table;
    set->specular_aperture_deg = asked->aperture_deg;
    if (!(asked->aperture_deg > 0))
        import_note(set, "the specular table is taken as the mirror alone: no aperture is "
                    "given");
    return true;
}
