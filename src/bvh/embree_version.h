/* SPDX-License-Identifier: Apache-2.0 */
/* embree_version.h -- what differs between Embree 3 and 4, in one place.
 *
 * EMBREE_MAJOR comes from the build. Only the two inline queries and the context type below are
 * used elsewhere; no struct of Embree is stored.
 */
#pragma once
#if EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
typedef struct RTCRayQueryContext EmbreeContext;

static inline void embree_intersect(RTCScene scene, EmbreeContext *context,
                                    struct RTCRayHit *rayhit)
{
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = context;
    rtcIntersect1(scene, rayhit, &arguments);
}

static inline void embree_occluded(RTCScene scene, EmbreeContext *context, struct RTCRay *ray)
{
    struct RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = context;
    rtcOccluded1(scene, ray, &arguments);
}

static inline void embree_context_init(EmbreeContext *context)
{
    rtcInitRayQueryContext(context);
}
#else
#include <embree3/rtcore.h>
typedef struct RTCIntersectContext EmbreeContext;

static inline void embree_intersect(RTCScene scene, EmbreeContext *context,
                                    struct RTCRayHit *rayhit)
{
    rtcIntersect1(scene, context, rayhit);
}

static inline void embree_occluded(RTCScene scene, EmbreeContext *context, struct RTCRay *ray)
{
    rtcOccluded1(scene, context, ray);
}

static inline void embree_context_init(EmbreeContext *context)
{
    rtcInitIntersectContext(context);
}
#endif
