/* SPDX-License-Identifier: Apache-2.0 */
#include "import/scatter/half_angle.h"

#include <math.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"

/* Incidences at which a BRDF that is known everywhere is read. */
#define INCIDENCE_STEP_DEG 10
#define INCIDENCE_LAST_DEG 80
#define RING_GAP_DEG 2.5
#define RING_LEAST 12
#define RING_MOST 72

HalfAngles half_angles(Direction light, Direction leaving) {
    Direction half = direction_unit(direction_scaled_sum(light, 1, leaving, 1));
    HalfAngles out;
    direction_to_degrees(half, &out.half_theta, &out.half_phi);
    double theta = radians_from_degrees(out.half_theta);
    double phi = radians_from_degrees(out.half_phi);
    Direction down = {cos_d(theta) * cos_d(phi), cos_d(theta) * sin_d(phi), -sin_d(theta)};
    Direction around = {-sin_d(phi), cos_d(phi), 0};
    double x = direction_dot(light, down), y = direction_dot(light, around);
    out.diff_theta = degrees_from_radians(atan2_d(hypot_d(x, y), direction_dot(light, half)));
    out.diff_phi = degrees_from_radians(atan2_d(y, x));
    if (out.half_phi > 180) out.half_phi -= 360;
    return out;
}

Direction half_angle_mirror(Direction light, Direction half) {
    return direction_scaled_sum(half, 2 * direction_dot(light, half), light, -1);
}

/* The source's rings and, between two that are far apart, more. */
static double *fill_rings(const BrdfSource *source, Arena *arena, int *count) {
    double *ring = ARENA_NEW(arena, double, source->rings + (int)(90 / RING_GAP_DEG) + 2);
    double last = 0;
    *count = 0;
    for (int i = 0; i <= source->rings; i++) {
        double next = i < source->rings ? source->half_theta_deg[i] : 90;
        int parts = (int)ceil((next - last) / RING_GAP_DEG - 1e-9);
        for (int k = 1; k < parts; k++) ring[(*count)++] = last + (next - last) * k / parts;
        if (i < source->rings && next < 90) ring[(*count)++] = next;
        last = next;
    }
    return ring;
}

/* About as far apart along the ring as two rings are across, a multiple of 4. */
static int ring_points(const double *ring, int count, int i) {
    double low = i ? ring[i - 1] : 0, high = i + 1 < count ? ring[i + 1] : 90;
    if (ring[i] <= 0) return 1;
    double points = 360 * sin_d(radians_from_degrees(ring[i])) / fmax(high - low, 1e-6);
    points = fmin(fmax(points, RING_LEAST), RING_MOST);
    return 4 * (int)ceil(points / 4);
}

/* The light at its azimuth; rows count phi from its mirror direction. */
static bool add_light(const BrdfSource *source, ScatterLight at, const double *ring, int count,
                      ImportSet *set, Error *err) {
    ImportRows rows = scatter_rows(set->arena, count * RING_MOST, source->channels);
    Direction light = direction_from_degrees(at.incidence_deg, at.azimuth_deg);
    double *value = ARENA_NEW(set->arena, double, source->channels);
    for (int i = 0; i < count; i++) {
        int points = ring_points(ring, count, i);
        for (int k = 0; k < points; k++) {
            double phi = at.azimuth_deg + 180 + 360.0 * k / points, theta_deg, phi_deg;
            Direction leaving = half_angle_mirror(light, direction_from_degrees(ring[i], phi));
            if (leaving.z <= 0) continue;
            bool is_known = source->function(source->data, light, leaving, value);
            direction_to_degrees(leaving, &theta_deg, &phi_deg);
            phi_deg = fmod(phi_deg + 540 - at.azimuth_deg, 360);
            if (is_known) scatter_put(&rows, theta_deg, phi_deg, value);
            else scatter_mask(&rows, theta_deg, phi_deg);
        }
    }
    if (!rows.rows) {
        import_note(set, "%s: incidence %g is left out, for no direction is measured there",
                    path_name(source->file), at.incidence_deg);
        return true;
    }
    return scatter_add(set, source->file, &rows, at, source->wavelength_nm, err);
}

bool brdf_source_add(const BrdfSource *source, ImportSet *set, Error *err) {
    int count, tables = set->count;
    double *ring = fill_rings(source, set->arena, &count);
    for (int lean = 0; lean <= INCIDENCE_LAST_DEG; lean += INCIDENCE_STEP_DEG)
        if (!add_light(source, (ScatterLight){lean, 180}, ring, count, set, err)) return false;
    if (set->count == tables)
        return error_at(err, ERROR_INPUT, source->file, "", "has no value of reflection");
    import_note(set,
                "%s: is evaluated at incidences 0, %d, ... %d degrees, where half vectors "
                "on its own rings mirror the light to",
                path_name(source->file), INCIDENCE_STEP_DEG, INCIDENCE_LAST_DEG);
    return true;
}
