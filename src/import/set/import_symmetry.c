/* Directions and lights that a laboratory did not measure because its sample is symmetric, and
 * the sum of the primaries beside the white that was measured. */
#include <math.h>
#include <string.h>

#include "import/set/import_parts.h"

/* ---- mirrors ----------------------------------------------------------------------------- */

/* Azimuths reflect about a plane through the normal: phi becomes 2 m - phi, or turn by 180. */
typedef struct Image {
    bool   is_turn;
    double plane_deg;
} Image;

static double image_of(Image image, double phi_deg)
{
    double phi = fmod(image.is_turn ? phi_deg + 180 : 2 * image.plane_deg - phi_deg, 360);
    return phi < 0 ? phi + 360 : phi;
}

static int images_of(ImportSymmetry symmetry, Image image[2])
{
    static const Image left_right = {false, 90}, up_down = {false, 0}, turn = {true, 0};
    switch (symmetry) {
    case IMPORT_LEFT_RIGHT: image[0] = left_right; return 1;
    case IMPORT_UP_DOWN:    image[0] = up_down; return 1;
    case IMPORT_HALF_TURN:  image[0] = turn; return 1;
    case IMPORT_BOTH:
        image[0] = left_right;
        image[1] = up_down;
        return 2;
    default: return 0;
    }
}

/* The table's rows at their images; what was measured itself stays as it is. */
static void mirror_rows(ImportSet *set, ImportTable *table, Image image)
{
    ImportTable mirrored = *table;
    size_t      size = (size_t)table->channels;
    int         rows = table->rows;
    double     *phi = ARENA_NEW(set->arena, double, 2 * (size_t)rows);
    double     *theta = ARENA_NEW(set->arena, double, 2 * (size_t)rows);
    double     *value = ARENA_NEW(set->arena, double, 2 * size * (size_t)rows);
    for (int i = 0; i < rows; i++) phi[i] = image_of(image, table->phi_deg[i]);
    mirrored.phi_deg = phi;
    int *match = import_match_rows(&mirrored, table, set->arena);
    memcpy(theta, table->theta_deg, sizeof *theta * (size_t)rows);
    memcpy(value, table->value, sizeof *value * size * (size_t)rows);
    double *all = ARENA_NEW(set->arena, double, 2 * (size_t)rows);
    memcpy(all, table->phi_deg, sizeof *all * (size_t)rows);
    int count = rows;
    for (int i = 0; i < rows; i++) {
        if (match[i] >= 0 || table->theta_deg[i] < SAME_ANGLE_DEG) continue;
        theta[count] = table->theta_deg[i];
        all[count] = phi[i];
        memcpy(value + size * (size_t)count++, table->value + size * (size_t)i,
               sizeof *value * size);
    }
    table->theta_deg = theta;
    table->phi_deg = all;
    table->value = value;
    table->rows = count;
}

static bool has_light(const ImportSet *set, double incidence, double azimuth)
{
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
static bool mirror_light(ImportSet *set, const ImportTable *table, Image image, Error *err)
{
    ImportTable mirrored = *table;
    double     *phi = ARENA_NEW(set->arena, double, table->rows);
    mirrored.incidence_phi_deg = image_of(image, table->incidence_phi_deg);
    if (has_light(set, mirrored.incidence_deg, mirrored.incidence_phi_deg)) return true;
    for (int i = 0; i < table->rows; i++)
        phi[i] = image.is_turn ? table->phi_deg[i] : -table->phi_deg[i];
    mirrored.phi_deg = phi;
    return import_add(set, &mirrored, err);
}

bool import_mirror(ImportSet *set, Error *err)
{
    Image image[2];
    int   images = images_of(set->symmetry, image);
    for (int k = 0; k < images; k++) {
        int count = set->count;
        for (int i = 0; i < count; i++) {
            ImportTable *table = &set->table[i];
            if (table->source != IMPORT_REFLECTION) mirror_rows(set, table, image[k]);
            else if (set->is_anisotropic && !mirror_light(set, table, image[k], err))
                return false;
        }
    }
    if (images) import_note(set, "directions that were not measured are filled by the declared "
                            "symmetry");
    return true;
}

/* ---- white ------------------------------------------------------------------------------- */

static const ImportTable *full(const ImportSet *set, ImportSource source)
{
    const ImportTable *found = NULL;
    for (int i = 0; i < set->count; i++)
        if (set->table[i].source == source && (!found || set->table[i].level > found->level))
            found = &set->table[i];
    return found;
}

void import_note_white(ImportSet *set)
{
    const ImportTable *white = full(set, IMPORT_WHITE);
    double worst = 0, at[2] = {0, 0}, normal = NAN;
    const ImportTable *part[4];
    int               *match[4], compared = 0;
    for (int p = 0; p < 4; p++) {
        part[p] = full(set, p < 3 ? (ImportSource)p : IMPORT_BLACK);
        if (!white || !part[p] || (p < 3 && part[p]->level != 255)) return;
        match[p] = import_match_rows(white, part[p], set->arena);
    }
    for (int i = 0; i < white->rows; i++) {
        double sum = 0, luminance = white->value[3 * i + 1];
        bool   all = luminance > 0;
        for (int p = 0; p < 4 && all; p++) {
            all = match[p][i] >= 0;
            if (all) sum += (p < 3 ? 1 : -2) * part[p]->value[3 * match[p][i] + 1];
        }
        if (!all) continue;
        double away = luminance / sum - 1;
        compared++;
        if (white->theta_deg[i] < SAME_ANGLE_DEG && isnan(normal)) normal = away;
        if (fabs(away) <= fabs(worst)) continue;
        worst = away;
        at[0] = white->theta_deg[i];
        at[1] = white->phi_deg[i];
    }
    if (compared)
        import_note(set,
                    "white is %+.2f%% of red + green + blue - 2 black on the normal and "
                    "%+.2f%% at theta %g, phi %g, where it is furthest from the sum",
                    100 * normal, 100 * worst, at[0], at[1]);
}
