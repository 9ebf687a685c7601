/* emitters.h -- emissive triangles and displays as lights, chosen by power.
 *
 * A triangle's weight is its area times its mean luminance over a few points of its texture or
 * content, plus a floor for what those points missed; positions are uniform on the triangle.
 * Units    pdf_area in m^-2. Threads: const after emitters_build.
 */
#pragma once
#include "base/alias.h"
#include "light/emission.h"

typedef struct Emitters {
    int        count;
    uint32_t  *triangles;     /* count triangle ids */
    float     *pdf_area;      /* of choosing a point on each */
    int       *first_of_part; /* emitter of a part's first triangle; NO_ID: the part is dark */
    AliasTable choice;
} Emitters;

Emitters emitters_build(const Scene *scene, Arena *arena);

/* u in [0,1)^3. */
uint32_t emitters_sample(const Emitters *emitters, const Scene *scene, const float u[3],
                         TrianglePoint *point, float *pdf_area);

/* 0 when the triangle is no emitter. */
float emitters_pdf_area(const Emitters *emitters, const Scene *scene, uint32_t triangle);
