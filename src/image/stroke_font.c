/* SPDX-License-Identifier: Apache-2.0 */
#include "image/stroke_font.h"

#include <ctype.h>

#include "base/mathf.h"
#include "base/vec.h"

/* The grid: baseline y = 0, a digit is 6 high, a small letter 4; y points up. */
typedef enum StrokeKind { LINE, ARC } StrokeKind;

typedef struct FontStroke {
    char glyph;
    StrokeKind kind;
    float v[6]; /* LINE: x0 y0 x1 y1. ARC: centre x y, radii x y, from and to in degrees */
} FontStroke;

static const FontStroke STROKES[] = {
    {'0', ARC, {2, 3, 1.9f, 3, 0, 360}},
    {'1', LINE, {0.7f, 4.7f, 2.2f, 6}},
    {'1', LINE, {2.2f, 6, 2.2f, 0}},
    {'2', ARC, {2, 4.2f, 1.8f, 1.8f, 165, -35}},
    {'2', LINE, {3.47f, 3.17f, 0.2f, 0}},
    {'2', LINE, {0.2f, 0, 3.9f, 0}},
    {'3', ARC, {1.9f, 4.5f, 1.5f, 1.5f, 150, -90}},
    {'3', ARC, {1.9f, 1.5f, 1.8f, 1.5f, 90, -150}},
    {'4', LINE, {3, 0, 3, 6}},
    {'4', LINE, {3, 6, 0, 1.8f}},
    {'4', LINE, {0, 1.8f, 4, 1.8f}},
    {'5', LINE, {3.5f, 6, 0.8f, 6}},
    {'5', LINE, {0.8f, 6, 0.52f, 3.33f}},
    {'5', ARC, {1.9f, 1.95f, 1.95f, 1.95f, 135, -150}},
    {'6', ARC, {2, 1.9f, 1.85f, 1.9f, 0, 360}},
    {'6', ARC, {3.9f, 1.9f, 3.75f, 4.1f, 180, 102}},
    {'7', LINE, {0.2f, 6, 3.8f, 6}},
    {'7', LINE, {3.8f, 6, 1.4f, 0}},
    {'8', ARC, {2, 4.5f, 1.5f, 1.5f, 0, 360}},
    {'8', ARC, {2, 1.5f, 1.85f, 1.5f, 0, 360}},
    {'9', ARC, {2, 4.1f, 1.85f, 1.9f, 0, 360}},
    {'9', ARC, {0.1f, 4.1f, 3.75f, 4.1f, 0, -78}},
    {'.', LINE, {0.4f, 0.1f, 0.4f, 0.2f}},
    {':', LINE, {0.4f, 0.6f, 0.4f, 0.7f}},
    {':', LINE, {0.4f, 3.4f, 0.4f, 3.5f}},
    {'-', LINE, {0.3f, 3, 2.5f, 3}},
    {'+', LINE, {0.2f, 3, 3.4f, 3}},
    {'+', LINE, {1.8f, 1.4f, 1.8f, 4.6f}},
    {'\'', LINE, {0.6f, 6.2f, 0.4f, 4.8f}},
    {'/', LINE, {0.1f, -0.9f, 2.5f, 6.7f}},
    {'%', ARC, {1, 4.9f, 0.9f, 1.1f, 0, 360}},
    {'%', ARC, {4, 1.1f, 0.9f, 1.1f, 0, 360}},
    {'%', LINE, {0.9f, 0, 4.1f, 6}},
    {'(', ARC, {3, 3, 2.6f, 4.4f, 125, 235}},
    {')', ARC, {-1.4f, 3, 2.6f, 4.4f, 55, -55}},
    {'a', ARC, {1.9f, 2, 1.7f, 2, 0, 360}},
    {'a', LINE, {3.6f, 4, 3.6f, 0}},
    {'b', ARC, {1.9f, 2, 1.7f, 2, 0, 360}},
    {'b', LINE, {0.2f, 6.3f, 0.2f, 0}},
    {'c', ARC, {2, 2, 1.8f, 2, 48, 312}},
    {'d', ARC, {1.9f, 2, 1.7f, 2, 0, 360}},
    {'d', LINE, {3.6f, 6.3f, 3.6f, 0}},
    {'e', ARC, {1.9f, 2, 1.75f, 2, 2, 315}},
    {'e', LINE, {0.15f, 2.1f, 3.65f, 2.1f}},
    {'f', ARC, {2.3f, 5, 1.3f, 1.3f, 70, 180}},
    {'f', LINE, {1, 5, 1, 0}},
    {'f', LINE, {0, 3.9f, 2.2f, 3.9f}},
    {'g', ARC, {1.9f, 2, 1.7f, 2, 0, 360}},
    {'g', LINE, {3.6f, 4, 3.6f, -0.4f}},
    {'g', ARC, {1.9f, -0.4f, 1.7f, 1.5f, 0, -150}},
    {'h', LINE, {0.3f, 6.3f, 0.3f, 0}},
    {'h', ARC, {1.9f, 2.4f, 1.6f, 1.6f, 180, 0}},
    {'h', LINE, {3.5f, 2.4f, 3.5f, 0}},
    {'i', LINE, {0.4f, 4, 0.4f, 0}},
    {'i', LINE, {0.4f, 5.7f, 0.4f, 5.8f}},
    {'j', LINE, {1, 4, 1, -0.6f}},
    {'j', LINE, {1, 5.7f, 1, 5.8f}},
    {'j', ARC, {0, -0.6f, 1, 1.2f, 0, -100}},
    {'k', LINE, {0.3f, 6.3f, 0.3f, 0}},
    {'k', LINE, {3.2f, 4, 0.3f, 1.6f}},
    {'k', LINE, {1.4f, 2.5f, 3.4f, 0}},
    {'l', LINE, {0.4f, 6.3f, 0.4f, 0}},
    {'m', LINE, {0.3f, 4, 0.3f, 0}},
    {'m', ARC, {1.6f, 2.7f, 1.3f, 1.3f, 180, 0}},
    {'m', LINE, {2.9f, 2.7f, 2.9f, 0}},
    {'m', ARC, {4.2f, 2.7f, 1.3f, 1.3f, 180, 0}},
    {'m', LINE, {5.5f, 2.7f, 5.5f, 0}},
    {'n', LINE, {0.3f, 4, 0.3f, 0}},
    {'n', ARC, {1.9f, 2.4f, 1.6f, 1.6f, 180, 0}},
    {'n', LINE, {3.5f, 2.4f, 3.5f, 0}},
    {'o', ARC, {1.9f, 2, 1.8f, 2, 0, 360}},
    {'p', ARC, {1.9f, 2, 1.7f, 2, 0, 360}},
    {'p', LINE, {0.2f, 4, 0.2f, -1.9f}},
    {'q', ARC, {1.9f, 2, 1.7f, 2, 0, 360}},
    {'q', LINE, {3.6f, 4, 3.6f, -1.9f}},
    {'r', LINE, {0.3f, 4, 0.3f, 0}},
    {'r', ARC, {2, 2.2f, 1.7f, 1.8f, 180, 70}},
    {'s', ARC, {1.6f, 3, 1.3f, 1, 40, 270}},
    {'s', ARC, {1.6f, 1, 1.45f, 1, 90, -140}},
    {'t', LINE, {1, 5.6f, 1, 1.1f}},
    {'t', ARC, {2.1f, 1.1f, 1.1f, 1.1f, 180, 300}},
    {'t', LINE, {0, 4, 2.3f, 4}},
    {'u', LINE, {0.3f, 4, 0.3f, 1.6f}},
    {'u', ARC, {1.9f, 1.6f, 1.6f, 1.6f, 180, 360}},
    {'u', LINE, {3.5f, 4, 3.5f, 0}},
    {'v', LINE, {0.1f, 4, 1.8f, 0}},
    {'v', LINE, {1.8f, 0, 3.5f, 4}},
    {'w', LINE, {0.1f, 4, 1.3f, 0}},
    {'w', LINE, {1.3f, 0, 2.6f, 3.6f}},
    {'w', LINE, {2.6f, 3.6f, 3.9f, 0}},
    {'w', LINE, {3.9f, 0, 5.1f, 4}},
    {'x', LINE, {0.2f, 4, 3.2f, 0}},
    {'x', LINE, {0.2f, 0, 3.2f, 4}},
    {'y', LINE, {0.1f, 4, 1.8f, 0}},
    {'y', LINE, {3.5f, 4, 1, -1.9f}},
    {'z', LINE, {0.3f, 4, 3.3f, 4}},
    {'z', LINE, {3.3f, 4, 0.2f, 0}},
    {'z', LINE, {0.2f, 0, 3.4f, 0}},
    {'?', LINE, {0.3f, 0, 0.3f, 4}},
    {'?', LINE, {3.3f, 0, 3.3f, 4}}, /* the unknown one */
    {'?', LINE, {0.3f, 0, 3.3f, 0}},
    {'?', LINE, {0.3f, 4, 3.3f, 4}},
};
enum { STROKE_COUNT = sizeof STROKES / sizeof *STROKES, ARC_PIECES = 20 };

#define SPACE_WIDTH 2.4f
#define GAP 1.1f        /* between letters */
#define PEN_RADIUS 0.4f /* of the stroke, grid units */
#define RAISED 0.62f    /* size of a raised two */

static char glyph_of(char c) {
    char lower = (char)tolower((unsigned char)c);
    for (int i = 0; i < STROKE_COUNT; i++)
        if (STROKES[i].glyph == lower) return lower;
    return '?';
}

static Vec2 stroke_point(const FontStroke *s, float t) {
    if (s->kind == LINE) return (Vec2){lerpf(s->v[0], s->v[2], t), lerpf(s->v[1], s->v[3], t)};
    float sine, cosine;
    sincos_turns(lerpf(s->v[4], s->v[5], t) / 360, &sine, &cosine);
    return (Vec2){s->v[0] + s->v[2] * cosine, s->v[1] + s->v[3] * sine};
}

static float segment_distance(Vec2 p, Vec2 a, Vec2 b) {
    float dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
    float t = ((p.x - a.x) * dx + (p.y - a.y) * dy) / (length2 > 0 ? length2 : 1);
    t = clampf(t, 0, 1);
    dx = p.x - a.x - t * dx;
    dy = p.y - a.y - t * dy;
    return sqrtf(dx * dx + dy * dy);
}

static float glyph_distance(char glyph, Vec2 p) {
    float nearest = 100;
    for (int i = 0; i < STROKE_COUNT; i++) {
        if (STROKES[i].glyph != glyph) continue;
        int pieces = STROKES[i].kind == LINE ? 1 : ARC_PIECES;
        for (int k = 0; k < pieces; k++) {
            Vec2 from = stroke_point(&STROKES[i], (float)k / (float)pieces);
            Vec2 to = stroke_point(&STROKES[i], (float)(k + 1) / (float)pieces);
            float distance = segment_distance(p, from, to);
            if (distance < nearest) nearest = distance;
        }
    }
    return nearest;
}

static float glyph_width(char glyph) {
    float right = 0;
    for (int i = 0; i < STROKE_COUNT; i++) {
        if (STROKES[i].glyph != glyph) continue;
        for (int k = 0; k <= ARC_PIECES; k++) {
            float x = stroke_point(&STROKES[i], (float)k / ARC_PIECES).x;
            if (x > right) right = x;
        }
    }
    return glyph >= '0' && glyph <= '9' ? 4 : right; /* figures stand in columns */
}

/* scale: pixels a grid unit; (x, y): where the grid's origin lies. */
static void draw_glyph(Picture *picture, char glyph, float scale, float x, float y,
                       const float colour[3]) {
    int x0 = (int)floorf(x - scale), x1 = (int)ceilf(x + 7 * scale);
    int y0 = (int)floorf(y - 7.5f * scale), y1 = (int)ceilf(y + 3 * scale);
    for (int j = y0 < 0 ? 0 : y0; j < y1 && j < picture->height; j++) {
        for (int i = x0 < 0 ? 0 : x0; i < x1 && i < picture->width; i++) {
            Vec2 p = {((float)i + 0.5f - x) / scale, (y - (float)j - 0.5f) / scale};
            float cover = (PEN_RADIUS - glyph_distance(glyph, p)) * scale + 0.5f;
            float *pixel = picture_pixel(picture, i, j);
            for (int c = 0; c < 3 && cover > 0; c++)
                pixel[c] = lerpf(pixel[c], colour[c], clampf(cover, 0, 1));
        }
    }
}

float stroke_font_draw(Picture *picture, StrokeFont font, float x, float y, const char *text) {
    float scale = font.height / 6, start = x;
    for (; *text; text++) {
        bool raised = text[0] == '^' && text[1] != '\0';
        if (raised) text++;
        float size = raised ? scale * RAISED : scale, lift = raised ? 3.2f * scale : 0;
        char glyph = glyph_of(*text);
        if (*text != ' ' && picture)
            draw_glyph(picture, glyph, size, x, y + 3 * scale - lift, font.colour);
        x += *text == ' ' ? SPACE_WIDTH * size : (glyph_width(glyph) + GAP) * size;
    }
    return x - start;
}
