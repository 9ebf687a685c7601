/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/vertex/vertex_judge.h"


#include <math.h>

static float distance(const VertexJudge *judge, uint32_t vertex, const float *row)
{
    const float *value = judge->values + (size_t)vertex * (size_t)judge->options->components;
    float        most = 0;
    for (int i = 0; i < judge->options->components; i++)
        most = fmaxf(most, fabsf(row[i] - value[i]) / judge->unit[i]);
    return most;
}

static void go_beyond(const VertexJudge *judge, uint32_t vertex, const float *row, float factor,
                      float *farther)
{
    const float *value = judge->values + (size_t)vertex * (size_t)judge->options->components;
    for (int i = 0; i < judge->options->components; i++)
        farther[i] = value[i] + factor * (row[i] - value[i]);
}

static bool ask(const VertexJudge *judge, uint32_t vertex, const float *row)
{
    return judge->options->accepts(judge->options->context, vertex, row);
}

/* Queries add up in another order than the coder: what is near the bound is refused where that
 * happened to matter. */
static bool ask_strictly(const VertexJudge *judge, uint32_t vertex, const float *row)
{
    float farther[TREE_MAX_COMPONENTS];
    go_beyond(judge, vertex, row, 1.001f, farther);
    return ask(judge, vertex, row) && ask(judge, vertex, farther);
}

bool vertex_accepts(VertexJudge *judge, uint32_t vertex, const float *row)
{
    if (judge->safe[vertex] < 0) return ask_strictly(judge, vertex, row);
    if (judge->is_exact) return ask(judge, vertex, row);
    float reach = distance(judge, vertex, row);
    if (reach <= 0.5f * judge->safe[vertex]) return true;
    if (!ask(judge, vertex, row)) return false;
    judge->safe[vertex] = fmaxf(judge->safe[vertex], reach);
    return true;
}

bool vertex_accepts_beyond(VertexJudge *judge, uint32_t vertex, const float *row, float factor)
{
    float farther[TREE_MAX_COMPONENTS];
    go_beyond(judge, vertex, row, factor, farther);
    return vertex_accepts(judge, vertex, farther);
}
