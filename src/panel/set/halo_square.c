/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/halo_square.h"

#include <math.h>

#include "panel/query/panel_place.h"
#include "panel/zones/backlight_at.h"

#define FINEST 4096 /* pixels a side of the test picture */

static void square_codes(const void *user, const float place[2], float codes[3]) {
    const float *half = user; /* of the square, shares of width and height */
    bool inside = fabsf(place[0] - 0.5f) <= half[0] && fabsf(place[1] - 0.5f) <= half[1];
    for (int p = 0; p < 3; p++) codes[p] = inside ? 255 : 0;
}

/* Pixels of half a millimetre, or an eighth of a zone. */
static int pixels(const DimmingZones *zones, int k) {
    double wanted = fmax(2 * zones->size_mm[k], 8.0 * zones->count[k]);
    return (int)fmin(wanted, FINEST);
}

HaloSquare halo_square_make(const Panel *panel, Arena *arena) {
    const DimmingZones *zones = panel_zones(panel);
    HaloSquare out = {.panel = panel};
    LevelShares levels;
    float half[2];
    double *drive = ARENA_NEW(arena, double, zones->count[0] * zones->count[1]);
    out.side_mm = fmin(HALO_SQUARE_MM, 0.5 * fmin(zones->size_mm[0], zones->size_mm[1]));
    panel_level_shares(panel, &levels);
    ShownPicture picture = {pixels(zones, 0), pixels(zones, 1), square_codes, half};
    half[0] = half[1] = -1;
    out.black_drive = backlight_drives(zones, &levels, &picture, drive);
    for (int k = 0; k < 2; k++) half[k] = (float)(0.5 * out.side_mm / zones->size_mm[k]);
    backlight_drives(zones, &levels, &picture, drive);
    out.backlight = backlight_make(zones, &levels, drive, arena);
    out.full_black = halo_square_black(&out, 0, vec3(0, 0, 1));
    double b = halo_square_backlight(&out, 0);
    out.full_black = b > 0 ? out.full_black / b : 0;
    return out;
}

static void place_at(const HaloSquare *halo, double mm, float place[2]) {
    place[0] = (float)(0.5 + mm / panel_zones(halo->panel)->size_mm[0]);
    place[1] = 0.5f;
}

double halo_square_backlight(const HaloSquare *halo, double mm) {
    float place[2];
    place_at(halo, mm, place);
    return (double)backlight_at(halo->backlight, place);
}

double halo_square_black(const HaloSquare *halo, double mm, Vec3 direction) {
    static const float black[3] = {0, 0, 0};
    float place[2], xyz[3];
    place_at(halo, mm, place);
    panel_place_emission_xyz(halo->panel, place, direction, black, xyz);
    return (double)(backlight_at(halo->backlight, place) * xyz[1]);
}
