/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/import_lights.h"

#include <math.h>

#include "import/set/import_join.h"
#include "import/set/import_rows.h"
#include "panel/set/measurement.h"

/* Light that has an azimuth, and light along the normal. */
static bool is_oblique(const ImportTable *table) {
    return table->source == IMPORT_REFLECTION && table->incidence_deg >= SAME_ANGLE_DEG;
}

static bool is_normal(const ImportTable *table) {
    return table->source == IMPORT_REFLECTION && table->incidence_deg < SAME_ANGLE_DEG;
}

static const ImportTable *first_that(const ImportSet *set, bool (*fits)(const ImportTable *)) {
    for (int i = 0; i < set->count; i++)
        if (fits(&set->table[i])) return &set->table[i];
    return NULL;
}

void import_find_anisotropy(ImportSet *set) {
    double first = -1;
    bool several = false;
    for (int i = 0; i < set->count; i++) {
        const ImportTable *table = &set->table[i];
        if (!is_oblique(table)) continue;
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

/* ---- mirrors ----------------------------------------------------------------------------- */

/* Azimuths reflect about a plane through the normal: phi becomes 2 m - phi, or turn by 180. */
typedef struct MirrorImage {
    bool is_turn;
    double plane_deg;
} MirrorImage;

static double image_of(MirrorImage image, double phi_deg) {
    double phi = fmod(image.is_turn ? phi_deg + 180 : 2 * image.plane_deg - phi_deg, 360);
    return phi < 0 ? phi + 360 : phi;
}

static int images_of(ImportSymmetry symmetry, MirrorImage image[2]) {
    static const MirrorImage left_right = {false, 90}, up_down = {false, 0}, turn = {true, 0};
    switch (symmetry) {
    case IMPORT_LEFT_RIGHT: image[0] = left_right; return 1;
    case IMPORT_UP_DOWN: image[0] = up_down; return 1;
    case IMPORT_HALF_TURN: image[0] = turn; return 1;
    case IMPORT_BOTH:
        image[0] = left_right;
        image[1] = up_down;
        return 2;
    default: return 0;
    }
}

/* The table's rows at their images; what was measured itself stays as it is. */
static void mirror_rows(ImportSet *set, ImportTable *table, MirrorImage image) {
    ImportTable mirrored = *table;
    ImportRows all = import_rows(set->arena, 2 * table->rows, table->masked, table->channels);
    double *phi = ARENA_NEW(set->arena, double, table->rows);
    for (int i = 0; i < table->rows; i++) phi[i] = image_of(image, table->phi_deg[i]);
    mirrored.phi_deg = phi;
    int *match = import_match_rows(&mirrored, table, set->arena);
    import_rows_append(&all, table);
    for (int i = 0; i < table->rows; i++)
        if (match[i] < 0 && table->theta_deg[i] >= SAME_ANGLE_DEG)
            import_rows_put(&all, table->theta_deg[i], phi[i],
                            table->value + (size_t)table->channels * (size_t)i);
    import_rows_give_measured(&all, table);
}

static bool has_light(const ImportSet *set, double incidence, double azimuth) {
    for (int i = 0; i < set->count; i++) {
        const ImportTable *table = &set->table[i];
        if (table->source == IMPORT_REFLECTION &&
            fabs(table->incidence_deg - incidence) < SAME_ANGLE_DEG &&
            fabs(remainder(table->incidence_phi_deg - azimuth, 360)) < SAME_ANGLE_DEG)
            return true;
    }
    return false;
}

/* Light from the image of an azimuth: phi counts from the mirror direction, so a reflection
 * turns its sign, and half a turn leaves it. */
static bool mirror_light(ImportSet *set, const ImportTable *table, MirrorImage image, Error *err) {
    ImportTable mirrored = *table;
    double *phi = ARENA_NEW(set->arena, double, table->rows);
    mirrored.incidence_phi_deg = image_of(image, table->incidence_phi_deg);
    if (has_light(set, mirrored.incidence_deg, mirrored.incidence_phi_deg)) return true;
    for (int i = 0; i < table->rows; i++)
        phi[i] = image.is_turn ? table->phi_deg[i] : -table->phi_deg[i];
    mirrored.phi_deg = phi;
    return import_add(set, &mirrored, err);
}

bool import_mirror(ImportSet *set, Error *err) {
    MirrorImage image[2];
    int images = images_of(set->symmetry, image);
    for (int k = 0; k < images; k++) {
        int count = set->count;
        for (int i = 0; i < count; i++) {
            ImportTable *table = &set->table[i];
            if (table->source != IMPORT_REFLECTION) mirror_rows(set, table, image[k]);
            else if (set->is_anisotropic && !mirror_light(set, table, image[k], err)) return false;
        }
    }
    if (images)
        import_note(set, "directions that were not measured are filled by the declared "
                         "symmetry");
    return true;
}

/* ---- normal incidence -------------------------------------------------------------------- */

static int collect_angles(const ImportSet *set, bool of_azimuth, double *angle, int most) {
    int count = 0;
    for (int i = 0; i < set->count; i++) {
        const ImportTable *table = &set->table[i];
        if (table->source != IMPORT_REFLECTION) continue;
        double value = of_azimuth ? table->incidence_phi_deg : table->incidence_deg;
        bool known = false;
        for (int k = 0; k < count && !known; k++) known = fabs(angle[k] - value) < SAME_ANGLE_DEG;
        if (!known && count < most) angle[count++] = value;
    }
    return count;
}

static const ImportTable *find_light(const ImportSet *set, double incidence, double azimuth) {
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
static void turn_light(const ImportSet *set, ImportTable *table, double azimuth) {
    double *phi = ARENA_NEW(set->arena, double, table->rows);
    for (int i = 0; i < table->rows; i++)
        phi[i] = fmod(table->phi_deg[i] + table->incidence_phi_deg - azimuth + 720, 360);
    table->phi_deg = phi;
    table->incidence_phi_deg = azimuth;
}

static bool turn_normal(ImportSet *set, const ImportTable *normal, double azimuth, Error *err) {
    ImportTable turned = *normal;
    turn_light(set, &turned, azimuth);
    import_note(set, "normal incidence serves every azimuth of the light");
    return import_add(set, &turned, err);
}

/* A table of normal incidence whose azimuth no other light has moves to one that they have. */
static void move_normal(ImportSet *set) {
    const ImportTable *other = first_that(set, is_oblique);
    for (int i = 0; i < set->count && other; i++) {
        ImportTable *table = &set->table[i];
        bool is_known = false;
        if (!is_normal(table)) continue;
        for (int k = 0; k < set->count; k++)
            is_known |=
                is_oblique(&set->table[k]) &&
                fabs(set->table[k].incidence_phi_deg - table->incidence_phi_deg) < SAME_ANGLE_DEG;
        if (!is_known) turn_light(set, table, other->incidence_phi_deg);
    }
}

bool import_complete_lights(ImportSet *set, Error *err) {
    double azimuth[IMPORT_TABLES_MAX];
    move_normal(set);
    int count = collect_angles(set, true, azimuth, IMPORT_TABLES_MAX);
    const ImportTable *normal = first_that(set, is_normal);
    for (int k = 0; normal && k < count; k++)
        if (!find_light(set, normal->incidence_deg, azimuth[k]) &&
            !turn_normal(set, normal, azimuth[k], err))
            return false;
    return true;
}

/* ---- every light ------------------------------------------------------------------------- */

bool import_check_lights(const ImportSet *set, Error *err) {
    double incidence[IMPORT_TABLES_MAX], azimuth[IMPORT_TABLES_MAX];
    int incidences = collect_angles(set, false, incidence, IMPORT_TABLES_MAX);
    int azimuths = collect_angles(set, true, azimuth, IMPORT_TABLES_MAX);
    const ImportTable *first = incidences ? find_light(set, incidence[0], azimuth[0]) : NULL;
    if (incidences > MEASUREMENT_INCIDENCES_MAX)
        return error_at(err, ERROR_INPUT, first->file, "",
                        "gives %d angles of incidence with the other files, required: at most "
                        "%d",
                        incidences, MEASUREMENT_INCIDENCES_MAX);
    if (azimuths > MEASUREMENT_AZIMUTHS_MAX || incidences * azimuths > MEASUREMENT_TABLES_MAX)
        return error_at(err, ERROR_INPUT, first->file, "",
                        "gives light from %d incidences and %d azimuths with the other files, "
                        "required: at most %d azimuths and %d tables",
                        incidences, azimuths, MEASUREMENT_AZIMUTHS_MAX, MEASUREMENT_TABLES_MAX);
    for (int i = 0; i < incidences; i++)
        for (int k = 0; k < azimuths; k++) {
            const ImportTable *table = find_light(set, incidence[i], azimuth[k]);
            if (!table)
                return error_set(err, ERROR_INPUT,
                                 "no file has light from incidence %g, azimuth %g degrees; a "
                                 "material that depends on the azimuth is required at every "
                                 "incidence (%d) and azimuth (%d) of the light — or say "
                                 "--isotropic when the azimuth makes no difference",
                                 incidence[i], azimuth[k], incidences, azimuths);
            if (!import_same_channels(first, table))
                return error_at(err, ERROR_INPUT, table->file, "",
                                "has other wavelengths than %s, required: the same in every "
                                "table",
                                first->file);
        }
    return true;
}
