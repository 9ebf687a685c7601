/* SPDX-License-Identifier: Apache-2.0 */
/* response.h -- what a probe would read for light from any direction outside.
 *
 * The light that an eye sees via a surface is linear in what shines from outside. Paths
 * from the eye sample every triangle of a sphere (probe.h) once; a sky is then a sum over
 * triangles, a sun what its direction gets, and no path is traced again. The first vertex's
 * own answer to a sun is exact for any direction (response_suns.h); what comes by further
 * vertices is a mean over the triangle and those about it, as wide as the triangles are.
 *
 * Approximate  glints via a further mirror are spread over that width.
 * Spectrum     16 bands, those of the lanes of a path. Light is given by the luminance of each
 *              of its bands (sky_table.h), so that bands add up to it; a response is the
 *              share of that, a mean over the band.
 * Errors       paths come in up to RESPONSE_GROUPS independent groups, each of whole waves that
 *              sample every triangle equally often; each one's part of white light is kept:
 *              readings without one of them give the interval (a jackknife).
 * Units        shares: cd m^-2 by cd m^-2 (of a luxmeter lx by cd m^-2); of a sun cd m^-2 by
 *              lx on a plane that faces it.
 * Memory       from the arena: 256 bytes a triangle; some 20 times that while tracing.
 * Threads      starts its own; the same numbers for any count.
 */
#pragma once
#include "base/confidence.h"
#include "probe/probe.h"

#define RESPONSE_LEVEL 5 /* 8,192 triangles over the sphere, edges of about 3.4 degrees */
#define RESPONSE_BANDS SPECTRUM_LANES

typedef struct ResponseOptions {
    ProbeTools tools;
    int level;        /* subdivision of the triangles */
    int paths;        /* at most; at least RESPONSE_CHUNK: whole chunks are traced */
    double precision; /* response_trace ends when relative_error is no more; 0: never before */
} ResponseOptions;

#define RESPONSE_CHUNK 16
#define RESPONSE_GROUPS 16
/* triangles that get light are sampled by the same paths where their numbers differ by a multiple
 * of it, else by others */
#define RESPONSE_CLASSES 16

#define RESPONSE_SLABS 128

typedef struct Response {
    ProbeCells cells;      /* geometry; nothing is sampled any more */
    const Vec3 *centers;   /* [cell] directions, unit, world */
    const int *slabs;      /* cells of each of RESPONSE_SLABS equal steps of y, rising; */
    const int *slab_first; /* [RESPONSE_SLABS + 1] its place among them */
    int paths;
    const float *first;    /* [cell][band], of the whole triangle: by the first vertex */
    const float *rest;     /* by all further ones */
    const float *groups;   /* [cell][2][group] each group's part of white light, of all and of the
                              rest: they add up to it */
    double relative_error; /* standard error of the reading under a uniform white sky */
} Response;

/* A response of which nothing is known but its triangles. Its shares, all 0: first, rest, then
 * groups. */
float *response_empty(int level, Arena *arena, Response *out);

void response_trace(const ProbeAim *aim, const ResponseOptions *options, Arena *arena,
                    Response *out);

/* Reading of the further vertices for a sun in direction `towards` (unit, world) whose
 * irradiance has these band illuminances (sky_table.h), lx: cd m^-2, or lx. without: what it
 * would be without each group, with the samples that it is made of added to bright; or NULL. */
double response_sun(const Response *response, Vec3 towards, const float bands[RESPONSE_BANDS],
                    double without[RESPONSE_GROUPS], BrightSamples *bright);

/* Did the first vertex send anything that came from about there, of as many directions and
 * points as the response has paths? Where not, no sun there lights it. */
bool response_reaches(const Response *response, Vec3 towards);

/* A sum without one group and its part `of_group`, scaled to as many paths. */
double response_without(const Response *response, int group, double sum, double of_group);

/* The 95 % interval of a reading, by what it would be without each group. Of fewer paths than
 * two groups take nothing is known: all numbers. */
MeanInterval response_interval(const Response *response, double reading,
                               const double without[RESPONSE_GROUPS]);
