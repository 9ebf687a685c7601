/* SPDX-License-Identifier: Apache-2.0 */
/* path_collector.h -- takes results from a path besides its light.
 *
 * A path calls its collectors, one after the other, at the places named below. Paths of plain
 * frames have none and pay nothing. A collector is a structure that begins with PathCollector;
 * where a path is followed two ways (path/windows.h) each way has its own copy, so what both
 * add to is pointed at.
 *
 * Threads  one thread's, like the path.
 */
#pragma once
#include "path/path_state.h"
#include "surface/plates.h"

#define SHADOW_HITS 16 /* that a shadow ray keeps */

/* A ray from a surface to what lights it, and the sheets and plates that it passed. */
typedef struct ShadowRay {
    const PathState *path;
    const LightSample *light;
    Spectrum passed;
    float step;              /* by which it starts off its surface, m */
    float end;               /* m along it, to the emitter */
    float rounding;          /* uncertainty of `end`, m across the emitter's plane */
    int hit_count;           /* sheets met; may exceed SHADOW_HITS */
    Hit recent[SHADOW_HITS]; /* the last ones: number i at i % SHADOW_HITS; unordered */
    PlateWay plates;         /* its count and `from` are set always, the rest if it met any */
} ShadowRay;

/* Light by one point of a mirror. */
typedef struct MirrorLight {
    LightSample light;  /* the mirror's point as a light */
    LightSample source; /* the light that shines on it */
    Spectrum radiance;  /* that it sends, divided by the density of its direction */
    float share;        /* of a smooth mirror: of light that it turns, the lanes' mean */
    Surface surface;    /* the mirror's; both lie in front of it */
} MirrorLight;

/* Light that a path has found, and how. */
typedef struct PathFound {
    LightSet set;
    int source_id; /* emitters: scene part; punctual: scene light; else 0 */
    Vec3 from;     /* where it began, m, scene; is_distant: unit, towards it */
    bool is_distant;
    Vec3 way;                   /* unit: its direction where it left its source */
    Spectrum radiance;          /* per lane, as it comes to the eye; 0 where xyz is set */
    const float *xyz;           /* of a display that counts by its measured XYZ; NULL: `radiance`
                                   counts */
    float share;                /* of xyz that counts */
    float weight;               /* of an emitter that the path met itself: its MIS weight */
    uint32_t triangle;          /* of an emitter, where `point` is set */
    const TrianglePoint *point; /* on the emitter; NULL: no emitter */
    const Surface *by;          /* the surface that scatters a light sample towards wo; else NULL */
    Vec3 wo, local_wi;
    const ShadowRay *shadow;   /* from `by` to the light, or to the mirror */
    const MirrorLight *mirror; /* NULL: it came directly */
    const ShadowRay *beyond;   /* from the mirror to the light */
    bool by_rough;             /* reflected by facets of a rough mirror */
    bool is_sampled;           /* an eye met it, in a mirror in which pupils sample it */
} PathFound;

typedef struct PathCollector PathCollector;

/* How a collector steers a path: these calls decide where it goes, or what counts. NULL: as
 * without it. The first collector that answers true decides. */
typedef struct PathSteering {
    /* At a vertex, before light samples. True: none are taken there. */
    bool (*vertex)(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                   const Guiding *guiding);
    /* True: the path goes on by *next, not by a choice of the surface. */
    bool (*choose)(PathCollector *c, PathState *path, const Surface *surface, BsdfSample *next);
    /* True: it ends instead of being turned there. */
    bool (*refuse)(PathCollector *c, PathState *path, const Surface *surface,
                   const BsdfSample *next);
    bool (*escape)(PathCollector *c, PathState *path); /* it leaves the scene. True: sun and sky
                                                          do not count */
    void (*sky)(PathCollector *c, PathState *path, Spectrum *radiance); /* may change it */
    void (*count)(PathCollector *c, PathState *path, PathFound *light); /* may change it */
} PathSteering;

/* What a collector is, and its calls; NULL: not called. Those of `steer` change the path; the
 * others take results, and at most weigh the throughput. */
typedef struct CollectorKind {
    size_t size;   /* of the whole structure */
    bool of_first; /* light samples of the eye's own surface alone are of use to it */
    PathSteering steer;
    void (*start)(PathCollector *c, PathState *path); /* its first ray is known */
    void (*meet)(PathCollector *c, PathState *path);  /* the ray meets a surface */
    /* The surface that the eye itself sees, before it is shaded. */
    void (*see)(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                uint32_t triangle);
    /* It leaves by `next`, straight on included; the throughput has its weight. */
    void (*leave)(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                  const BsdfSample *next);
    void (*turn)(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                 const BsdfSample *next); /* it is turned; the segment before is still there */
    void (*pass)(PathCollector *c, PathState *path, const Surface *pane, Vec3 wo); /* it is
                  followed straight through a window whose own light is followed besides */
    void (*behind)(PathCollector *c, PathState *path, const Surface *surface);     /* it goes on
                      straight behind, through a hole or a window */
    void (*on_light)(PathCollector *c, PathState *path, const PathFound *light);   /* it counts */
    void (*finish)(PathCollector *c, PathState *path); /* all is found */
} CollectorKind;

struct PathCollector {
    const CollectorKind *kind;
    PathCollector *next;
};

/* Room for copies of all collectors of one path, each from a multiple of 64 bytes on. */
#define COLLECTORS_MAX_BYTES 4096
#define COLLECTOR_ROOM(Type) ((sizeof(Type) + 63) / 64 * 64)

/* A `vertex` at which no light samples are taken. */
static inline bool collector_no_lights(PathCollector *c, PathState *path, const Surface *surface,
                                       Vec3 wo, const Guiding *guiding) {
    (void)c, (void)path, (void)surface, (void)wo, (void)guiding;
    return true;
}

/* Each collector's call, if it has one; args begin with (c, path. */
#define COLLECT(call, args) \
    for (PathCollector *c = path->collector; c; c = c->next) \
        if (c->kind->call) c->kind->call args

/* The same until one answers true. */
#define STEER(call, args) \
    for (PathCollector *c = path->collector; c; c = c->next) \
        if (c->kind->steer.call && c->kind->steer.call args) return true; \
    return false

static inline bool collect_vertex(PathState *path, const Surface *surface, Vec3 wo,
                                  const Guiding *guiding) {
    STEER(vertex, (c, path, surface, wo, guiding));
}

static inline bool collect_choose(PathState *path, const Surface *surface, BsdfSample *next) {
    STEER(choose, (c, path, surface, next));
}

static inline bool collect_refuse(PathState *path, const Surface *surface, const BsdfSample *next) {
    STEER(refuse, (c, path, surface, next));
}

static inline bool collect_escape(PathState *path) {
    STEER(escape, (c, path));
}

static inline void collect_sky(PathState *path, Spectrum *radiance) {
    COLLECT(steer.sky, (c, path, radiance));
}

static inline void collect_start(PathState *path) {
    COLLECT(start, (c, path));
}

static inline void collect_meet(PathState *path) {
    COLLECT(meet, (c, path));
}

static inline void collect_see(PathState *path, const Surface *surface, Vec3 wo,
                               uint32_t triangle) {
    COLLECT(see, (c, path, surface, wo, triangle));
}

static inline void collect_leave(PathState *path, const Surface *surface, Vec3 wo,
                                 const BsdfSample *next) {
    COLLECT(leave, (c, path, surface, wo, next));
}

static inline void collect_turn(PathState *path, const Surface *surface, Vec3 wo,
                                const BsdfSample *next) {
    COLLECT(turn, (c, path, surface, wo, next));
}

static inline void collect_pass(PathState *path, const Surface *pane, Vec3 wo) {
    COLLECT(pass, (c, path, pane, wo));
}

static inline void collect_behind(PathState *path, const Surface *surface) {
    COLLECT(behind, (c, path, surface));
}

/* Has any collector a use for a light sample? */
static inline bool collect_takes_sample(const PathState *path) {
    for (const PathCollector *c = path->collector; c; c = c->next)
        if ((c->kind->steer.count || c->kind->on_light) &&
            (!c->kind->of_first || path->first.is_awaited))
            return true;
    return false;
}

/* The path has found light: it counts as collectors leave it. */
static inline void path_gather(PathState *path, PathFound *light) {
    COLLECT(steer.count, (c, path, light));
    path->gathered.radiance += light->radiance;
    for (int i = 0; i < 3 && light->xyz; i++) path->gathered.xyz[i] += light->share * light->xyz[i];
    COLLECT(on_light, (c, path, light));
}

static inline void collect_finish(PathState *path) {
    COLLECT(finish, (c, path));
}

#undef COLLECT
#undef STEER
