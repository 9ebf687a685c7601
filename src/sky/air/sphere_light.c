/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/air/sphere_light.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/parallel.h"
#include "base/units.h"
#include "sky/air/phase_series.h"

#define DIRECTIONS (2 * PHASE_SIDE)
#define AZIMUTHS 6     /* half a turn's, where a ray is followed */
#define TRAVEL_MODES 3 /* of azimuth, that reach other places */
#define STEPS 32       /* of a ray */
#define ORDERS_MAX 24
#define ORDER_SHARE 0.03f /* of all light: orders beyond are summed as a series */

/* Where the sun stands at a place, in the tables of the sources. */
typedef struct SunPlace {
    int angle;     /* the one below */
    float share;   /* of the way to the next */
    float azimuth; /* cosine of the ray's azimuth from the sun's */
} SunPlace;

typedef struct Sphere {
    const SphereInput *input;
    const DiffuseLight *shape;    /* whose levels all share */
    double direction[DIRECTIONS]; /* cosines of travel: up, then down */
    float phase[2][DIFFUSE_MODES][DIFFUSE_COSINES][DIRECTIONS];
    Spectrum scattering[2][SPHERE_LEVELS]; /* m^-1 */
    float beam_phase[2][DIRECTIONS][SPHERE_ANGLES_MAX][AZIMUTHS];
    Spectrum ground[SPHERE_ANGLES_MAX]; /* the last order's irradiance on the floor */
    Spectrum share[SPHERE_ANGLES_MAX];  /* of that in the order before */
    float rise[SPHERE_ANGLES_MAX];      /* of the last order's source towards the next angle */
    float fall[SPHERE_ANGLES_MAX];      /* exp(-rise) */
    double sun[SPHERE_ANGLES_MAX][AZIMUTHS][2]; /* direction at a ray's start, x and z */
    float wave[DIFFUSE_MODES][AZIMUTHS];        /* cosines of the modes, at the azimuths */
    SunPlace *place;    /* [level][direction][step, then its end][angle][azimuth] */
    Spectrum *radiance; /* [level][direction][angle][mode]: one order */
    Spectrum *source;   /* [level][cosine][angle][mode]: what it scatters, m^-1 sr^-1 */
    Spectrum *total;    /* the same of all orders */
    bool from_beam;     /* this order is the first: lit by the sun itself */
} Sphere;

/* A straight ray from a node, and where it is. Its plane is that of x and z. */
typedef struct NodeRay {
    double radius, sine, cosine, length;
    bool meets_floor;
} NodeRay;

typedef struct RayPoint {
    double up[2];            /* the local zenith's x and z */
    double altitude, cosine; /* of the ray to the local zenith */
} RayPoint;

static size_t node(int level, int direction, int angle) {
    return (((size_t)level * DIRECTIONS + (size_t)direction) * SPHERE_ANGLES_MAX + (size_t)angle) *
           DIFFUSE_MODES;
}

static size_t source_node(int level, int cosine, int angle) {
    return (((size_t)level * DIFFUSE_COSINES + (size_t)cosine) * SPHERE_ANGLES_MAX +
            (size_t)angle) *
           DIFFUSE_MODES;
}

/* The places of a ray's step; STEPS is its end. */
static SunPlace *step_places(const Sphere *s, int level, int direction, int step) {
    size_t row = ((size_t)level * DIRECTIONS + (size_t)direction) * (STEPS + 1) + (size_t)step;
    return s->place + row * (size_t)s->input->count * AZIMUTHS;
}

static double sun_angle(const Sphere *s, int angle) {
    return s->input->first_zenith + angle * s->input->step;
}

void sphere_light_weights(float t, float rise, float weight[2]) {
    weight[0] = 1 - t;
    weight[1] = t;
    if (rise == 0) return;
    weight[0] *= exp_f(rise * t);
    weight[1] *= exp_f(-rise * (1 - t));
}

/* ---- a ray ------------------------------------------------------------------------------- */

static NodeRay ray_from(const Sphere *s, int level, int direction) {
    double cosine = -s->direction[direction]; /* looking against the travel */
    double r = AIR_EARTH_M + s->shape->level_m[level], b = r * cosine;
    double floor = AIR_EARTH_M + s->shape->floor_m, top = AIR_EARTH_M + s->shape->top_m;
    double under = b * b - r * r + floor * floor;
    NodeRay ray = {r, sqrt(1 - cosine * cosine), cosine, 0, b < 0 && under > 0};
    ray.length =
        ray.meets_floor ? fmax(0, -b - sqrt(under)) : -b + sqrt(fmax(0, b * b - r * r + top * top));
    return ray;
}

static RayPoint point_at(const NodeRay *ray, double distance) {
    double x = distance * ray->sine, z = ray->radius + distance * ray->cosine;
    double r = sqrt(x * x + z * z);
    return (RayPoint){{x / r, z / r}, r - AIR_EARTH_M, (ray->sine * x + ray->cosine * z) / r};
}

static void fill_suns(Sphere *s) {
    for (int a = 0; a < s->input->count; a++)
        for (int j = 0; j < AZIMUTHS; j++) {
            double zenith = sun_angle(s, a);
            s->sun[a][j][0] = sin_d(zenith) * cos_d(PI * (j + 0.5) / AZIMUTHS);
            s->sun[a][j][1] = cos_d(zenith);
        }
}

static void fill_waves(Sphere *s) {
    for (int m = 0; m < DIFFUSE_MODES; m++)
        for (int j = 0; j < AZIMUTHS; j++)
            s->wave[m][j] = (float)cos_d(m * PI * (j + 0.5) / AZIMUTHS);
}

/* Where a sun stands at a point of the ray; gives the cosine of its angle to the zenith. The
 * same for all orders. */
static double find_sun(const Sphere *s, const NodeRay *ray, const RayPoint *at, const double sun[2],
                       SunPlace *out) {
    double c = at->up[0] * sun[0] + at->up[1] * sun[1];
    double across = ray->sine * sun[0] + ray->cosine * sun[1] - at->cosine * c;
    double norm = sqrt(fmax(0, 1 - at->cosine * at->cosine) * fmax(0, 1 - c * c));
    double x = (acos_d(fmax(-1, fmin(1, c))) - s->input->first_zenith) / s->input->step;
    x = fmax(0, fmin(x, s->input->count - 1.0001));
    out->angle = (int)x;
    out->share = (float)(x - (int)x);
    out->azimuth = clampf((float)(norm > 1e-12 ? across / norm : 1), -1, 1);
    return c;
}

/* ---- what a step adds -------------------------------------------------------------------- */

typedef struct Gather {
    const Sphere *sphere;
    NodeRay ray;
    int level, direction;
    Spectrum radiance[SPHERE_ANGLES_MAX][AZIMUTHS];
    Spectrum source[SPHERE_ANGLES_MAX][TRAVEL_MODES]; /* at the step's place, per sun angle */
} Gather;

/* The beam scattered once; seen: mean transmittance times the step's length. It is the first
 * order: the suns' places are found for those to come. */
static void add_beam(Gather *g, const RayPoint *at, const float density[AIR_PARTS],
                     const Spectrum *seen, SunPlace *place) {
    const Sphere *s = g->sphere;
    const AirOptics *o = &s->input->beam->optics;
    BeamHeight height = beam_table_height(s->input->beam, at->altitude);
    Spectrum part[2], beam;
    for (int p = 0; p < 2; p++) part[p] = *seen * o->scattering[p] * spectrum_all(density[p]);
    for (int a = 0; a < s->input->count; a++)
        for (int j = 0; j < AZIMUTHS; j++) {
            double cosine = find_sun(s, &g->ray, at, s->sun[a][j], place++);
            beam_table_sun(s->input->beam, &height, cosine, &beam);
            for (int p = 0; p < 2; p++)
                g->radiance[a][j] +=
                    part[p] * beam * spectrum_all(s->beam_phase[p][g->direction][a][j]);
        }
}

/* The sources around the step's altitude and direction, for every sun angle. */
static void read_sources(Gather *g, const RayPoint *at, const Spectrum *seen) {
    const Sphere *s = g->sphere;
    const double *level_m = s->shape->level_m;
    int k = 0, last = SPHERE_LEVELS - 2;
    while (k < last && level_m[k + 1] < at->altitude) k++;
    float t = (float)((at->altitude - level_m[k]) / (level_m[k + 1] - level_m[k]));
    float c = clampf((float)(1 - at->cosine) * 0.5f * (DIFFUSE_COSINES - 1), 0,
                     DIFFUSE_COSINES - 1.0001f);
    int i = (int)c;
    float u = c - (float)i;
    Spectrum weight[4] = {*seen * spectrum_all((1 - t) * (1 - u)),
                          *seen * spectrum_all((1 - t) * u), *seen * spectrum_all(t * (1 - u)),
                          *seen * spectrum_all(t * u)};
    for (int a = 0; a < s->input->count; a++) {
        const Spectrum *from[4] = {
            s->source + source_node(k, i, a), s->source + source_node(k, i + 1, a),
            s->source + source_node(k + 1, i, a), s->source + source_node(k + 1, i + 1, a)};
        for (int m = 0; m < TRAVEL_MODES; m++)
            g->source[a][m] = weight[0] * from[0][m] + weight[1] * from[1][m] +
                              weight[2] * from[2][m] + weight[3] * from[3][m];
    }
}

/* As sphere_light_weights. */
static void place_weights(const Sphere *s, const SunPlace *place, float weight[2]) {
    float growth = exp_f(s->rise[place->angle] * place->share);
    weight[0] = (1 - place->share) * growth;
    weight[1] = place->share * growth * s->fall[place->angle];
}

/* All azimuths' weights first: exponentials that wait for nothing overlap. */
static void add_source(Gather *g, const RayPoint *at, const Spectrum *seen, const SunPlace *place) {
    const Sphere *s = g->sphere;
    read_sources(g, at, seen);
    for (int a = 0; a < s->input->count; a++, place += AZIMUTHS) {
        float weight[AZIMUTHS][2];
        for (int j = 0; j < AZIMUTHS; j++) place_weights(s, &place[j], weight[j]);
        for (int j = 0; j < AZIMUTHS; j++) {
            int angle = place[j].angle;
            float cosine = place[j].azimuth;
            const Spectrum *low = g->source[angle], *high = g->source[angle + 1];
            float mode[TRAVEL_MODES] = {1, cosine, 2 * cosine * cosine - 1};
            for (int m = 0; m < TRAVEL_MODES; m++)
                g->radiance[a][j] += low[m] * spectrum_all(weight[j][0] * mode[m]) +
                                     high[m] * spectrum_all(weight[j][1] * mode[m]);
        }
    }
}

/* The floor at the ray's end, lit by the sun's beam: the first order. */
static void add_lit_floor(Gather *g, const Spectrum *share, SunPlace *place) {
    const Sphere *s = g->sphere;
    RayPoint at = point_at(&g->ray, g->ray.length);
    BeamHeight height = beam_table_height(s->input->beam, at.altitude);
    Spectrum light;
    for (int a = 0; a < s->input->count; a++)
        for (int j = 0; j < AZIMUTHS; j++) {
            double cosine = find_sun(s, &g->ray, &at, s->sun[a][j], place++);
            beam_table_sun(s->input->beam, &height, cosine, &light);
            g->radiance[a][j] += *share * light * spectrum_all((float)fmax(0, cosine));
        }
}

/* Lit by the last order's light. */
static void add_floor(Gather *g, const Spectrum *share, const SunPlace *place) {
    const Sphere *s = g->sphere;
    for (int a = 0; a < s->input->count; a++)
        for (int j = 0; j < AZIMUTHS; j++, place++) {
            float weight[2];
            place_weights(s, place, weight);
            g->radiance[a][j] += *share * (s->ground[place->angle] * spectrum_all(weight[0]) +
                                           s->ground[place->angle + 1] * spectrum_all(weight[1]));
        }
}

/* ---- an order ---------------------------------------------------------------------------- */

static void march(Gather *g) {
    const Sphere *s = g->sphere;
    Spectrum passing = spectrum_all(1);
    double from = 0;
    for (int i = 0; i < STEPS; i++) {
        double share = (i + 1.0) / STEPS, to = g->ray.length * share * share;
        RayPoint at = point_at(&g->ray, 0.5 * (from + to));
        float density[AIR_PARTS], step = (float)(to - from);
        Spectrum depth = spectrum_all(0), seen;
        beam_table_density(s->input->beam, at.altitude, density);
        for (int p = 0; p < AIR_PARTS; p++)
            depth += s->input->beam->optics.depth[p] * spectrum_all(density[p] * step);
        Spectrum pass = spectrum_exp(-depth);
        for (int k = 0; k < SPECTRUM_LANES; k++) /* mean transmittance inside the step */
            seen[k] = depth[k] > 0.01f ? (1 - pass[k]) / depth[k] : 1 - 0.5f * depth[k];
        seen *= passing * spectrum_all(step);
        SunPlace *place = step_places(s, g->level, g->direction, i);
        if (s->from_beam) add_beam(g, &at, density, &seen, place);
        else add_source(g, &at, &seen, place);
        passing *= pass;
        from = to;
    }
    if (!g->ray.meets_floor) return;
    Spectrum given = passing * spectrum_all((float)(s->input->floor_albedo / PI));
    SunPlace *end = step_places(s, g->level, g->direction, STEPS);
    if (s->from_beam) add_lit_floor(g, &given, end);
    else add_floor(g, &given, end);
}

/* Radiance at one node in one direction, for every sun angle, as a series in the azimuth. */
static void fill_radiance(void *context, int item, int worker) {
    Sphere *s = context;
    int level = item / DIRECTIONS, direction = item % DIRECTIONS;
    Gather g = {
        .sphere = s, .ray = ray_from(s, level, direction), .level = level, .direction = direction};
    (void)worker;
    for (int a = 0; a < s->input->count; a++)
        for (int j = 0; j < AZIMUTHS; j++) g.radiance[a][j] = spectrum_all(0);
    march(&g);
    for (int a = 0; a < s->input->count; a++)
        for (int m = 0; m < DIFFUSE_MODES; m++) {
            Spectrum sum = spectrum_all(0);
            for (int j = 0; j < AZIMUTHS; j++)
                sum += g.radiance[a][j] * spectrum_all(s->wave[m][j]);
            s->radiance[node(level, direction, a) + (size_t)m] =
                sum * spectrum_all((m ? 2.0f : 1.0f) / AZIMUTHS);
        }
}

/* A level's source from an order's radiance; adds it to the total. */
static void fill_source(void *context, int level, int worker) {
    Sphere *s = context;
    (void)worker;
    for (int i = 0; i < DIFFUSE_COSINES; i++)
        for (int a = 0; a < s->input->count; a++)
            for (int m = 0; m < DIFFUSE_MODES; m++) {
                Spectrum sum[2] = {spectrum_all(0), spectrum_all(0)};
                for (int p = 0; p < 2; p++)
                    for (int j = 0; j < DIRECTIONS; j++)
                        sum[p] += spectrum_all(s->phase[p][m][i][j] *
                                               (float)phase_weight[j % PHASE_SIDE]) *
                                  s->radiance[node(level, j, a) + (size_t)m];
                Spectrum both =
                    (s->scattering[0][level] * sum[0] + s->scattering[1][level] * sum[1]) *
                    spectrum_all(0.5f);
                size_t at = source_node(level, i, a) + (size_t)m;
                s->source[at] = both;
                s->total[at] += both;
            }
}

/* The floor's light of an order. */
static void light_floor(Sphere *s, DiffuseLight *out) {
    for (int a = 0; a < s->input->count; a++) {
        Spectrum down = spectrum_all(0);
        for (int j = 0; j < PHASE_SIDE; j++)
            down += s->radiance[node(0, PHASE_SIDE + j, a)] *
                    spectrum_all((float)(2 * PI * phase_weight[j] * phase_cosine[j]));
        s->share[a] = down / spectrum_max(s->ground[a], spectrum_all(1e-30f));
        s->ground[a] = down;
        out[a].ground_diffuse += down;
    }
}

/* How a source grows from each sun angle to the next: of the green light that all air over the
 * floor scatters upwards. */
static void fill_rise(Sphere *s, const Spectrum *source) {
    double light[SPHERE_ANGLES_MAX];
    for (int a = 0; a < s->input->count; a++) {
        light[a] = 1e-30;
        for (int k = 0; k + 1 < SPHERE_LEVELS; k++)
            light[a] += (s->shape->level_m[k + 1] - s->shape->level_m[k]) *
                        (double)source[source_node(k, DIFFUSE_COSINES / 2, a)][8];
    }
    for (int a = 0; a + 1 < s->input->count; a++)
        s->rise[a] = (float)fmax(-6, fmin(6, log_d(light[a + 1] / light[a])));
    s->rise[s->input->count - 1] = 0;
    for (int a = 0; a < s->input->count; a++) s->fall[a] = exp_f(-s->rise[a]);
}

/* ---- all orders -------------------------------------------------------------------------- */

static void fill_phase(Sphere *s) {
    double at[DIRECTIONS][PHASE_MOMENTS], outwards[DIFFUSE_COSINES][PHASE_MOMENTS];
    for (int m = 0; m < DIFFUSE_MODES; m++) {
        for (int i = 0; i < DIRECTIONS; i++) phase_legendre(m, s->direction[i], at[i]);
        for (int i = 0; i < DIFFUSE_COSINES; i++)
            phase_legendre(m, -1 + 2.0 * i / (DIFFUSE_COSINES - 1), outwards[i]);
        for (int p = 0; p < 2; p++)
            for (int i = 0; i < DIFFUSE_COSINES; i++)
                for (int j = 0; j < DIRECTIONS; j++)
                    s->phase[p][m][i][j] = phase_series_mode((AirPart)p, outwards[i], at[j], m);
    }
}

/* Phase functions at the angle between a node's ray and the sun, which is constant along a
 * straight ray. */
static void fill_beam_phase(Sphere *s) {
    for (int i = 0; i < DIRECTIONS; i++)
        for (int a = 0; a < s->input->count; a++)
            for (int j = 0; j < AZIMUTHS; j++) {
                double view = -s->direction[i], zenith = sun_angle(s, a);
                double cosine = view * cos_d(zenith) + sqrt(1 - view * view) * sin_d(zenith) *
                                                           cos_d(PI * (j + 0.5) / AZIMUTHS);
                s->beam_phase[0][i][a][j] = air_phase_molecules((float)cosine);
                s->beam_phase[1][i][a][j] = air_phase_aerosol((float)cosine);
            }
}

static Spectrum *spectra(Arena *arena, size_t count) {
    Spectrum *out = arena_alloc(arena, sizeof *out, 64, count);
    for (size_t i = 0; i < count; i++) out[i] = spectrum_all(0);
    return out;
}

static void start_lights(const SphereInput *in, Arena *arena, DiffuseLight *out) {
    const AirOptics *o = &in->beam->optics;
    BeamHeight floor = beam_table_height(in->beam, in->beam->floor_m);
    for (int a = 0; a < in->count; a++) {
        double cosine = cos_d(in->first_zenith + a * in->step);
        out[a] = (DiffuseLight){.floor_m = in->beam->floor_m,
                                .top_m = o->top_m,
                                .level_count = SPHERE_LEVELS,
                                .ground_diffuse = spectrum_all(0),
                                .top_exitance = spectrum_all(0)};
        for (int k = 0; k < SPHERE_LEVELS; k++) out[a].level_m[k] = diffuse_level_m(out, k);
        beam_table_sun(in->beam, &floor, cosine, &out[a].ground_direct);
        out[a].ground_direct *= spectrum_all((float)fmax(0, cosine));
        out[a].source = spectra(arena, (size_t)SPHERE_LEVELS * DIFFUSE_COSINES * DIFFUSE_MODES);
    }
}

static void start_sphere(Sphere *s, Arena *scratch) {
    const AirOptics *o = &s->input->beam->optics;
    for (int i = 0; i < PHASE_SIDE; i++) {
        s->direction[i] = phase_cosine[i];
        s->direction[PHASE_SIDE + i] = -phase_cosine[i];
    }
    for (int k = 0; k < SPHERE_LEVELS; k++)
        for (int p = 0; p < 2; p++)
            s->scattering[p][k] =
                o->scattering[p] *
                spectrum_all((float)air_density(o, (AirPart)p, s->shape->level_m[k]));
    s->radiance = spectra(scratch, node(SPHERE_LEVELS, 0, 0));
    s->source = spectra(scratch, source_node(SPHERE_LEVELS, 0, 0));
    s->total = spectra(scratch, source_node(SPHERE_LEVELS, 0, 0));
    s->place = ARENA_NEW(scratch, SunPlace,
                         (size_t)SPHERE_LEVELS * DIRECTIONS * (STEPS + 1) *
                             (size_t)s->input->count * AZIMUTHS);
    fill_phase(s);
    fill_suns(s);
    fill_waves(s);
    fill_beam_phase(s);
}

static void give_sources(const Sphere *s, DiffuseLight *out) {
    for (int a = 0; a < s->input->count; a++) {
        out[a].rise = s->rise[a];
        for (int k = 0; k < SPHERE_LEVELS; k++)
            for (int i = 0; i < DIFFUSE_COSINES; i++)
                for (int m = 0; m < DIFFUSE_MODES; m++)
                    out[a].source[((size_t)k * DIFFUSE_COSINES + (size_t)i) * DIFFUSE_MODES +
                                  (size_t)m] = s->total[source_node(k, i, a) + (size_t)m];
    }
}

/* The greatest share that an order still has of the floor's light. */
static float order_share(const Sphere *s, const DiffuseLight *out) {
    float most = 0;
    for (int a = 0; a < s->input->count; a++) {
        Spectrum whole = spectrum_max(out[a].ground_diffuse, spectrum_all(1e-30f));
        most = fmaxf(most, spectrum_max_lane(s->ground[a] / whole));
    }
    return most;
}

/* All orders to come, as a geometric series: high orders differ by a factor only. */
static void add_tail(Sphere *s, DiffuseLight *out) {
    for (int a = 0; a < s->input->count; a++) {
        Spectrum share = spectrum_clamp(s->share[a], 0, 0.9f);
        Spectrum tail = share / (spectrum_all(1) - share);
        out[a].ground_diffuse += s->ground[a] * tail;
        for (int k = 0; k < SPHERE_LEVELS; k++)
            for (int i = 0; i < DIFFUSE_COSINES; i++)
                for (int m = 0; m < DIFFUSE_MODES; m++) {
                    size_t at = source_node(k, i, a) + (size_t)m;
                    s->total[at] += s->source[at] * tail;
                }
    }
}

int sphere_light_build(const SphereInput *input, Arena *arena, DiffuseLight *out) {
    start_lights(input, arena, out);
    Arena scratch = *arena;
    Sphere *s = arena_alloc(&scratch, sizeof *s, 64, 1);
    s->input = input;
    s->shape = out;
    start_sphere(s, &scratch);
    int orders = input->orders > 0 ? input->orders : ORDERS_MAX, n = 0;
    while (n < orders) {
        s->from_beam = n++ == 0;
        parallel_for(input->threads, SPHERE_LEVELS * DIRECTIONS, fill_radiance, s);
        light_floor(s, out);
        parallel_for(input->threads, SPHERE_LEVELS, fill_source, s);
        if (order_share(s, out) < ORDER_SHARE) break;
        fill_rise(s, s->source);
    }
    if (input->orders <= 0) add_tail(s, out);
    fill_rise(s, s->total);
    give_sources(s, out);
    return n;
}
