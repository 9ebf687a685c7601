/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/ticks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static double decade_of(double value) {
    return pow(10, floor(log10(value) + 1e-9));
}

double round_up(double value) {
    double d = decade_of(value);
    for (int i = 0; i < 3; i++) {
        double step = (double[]){1, 2, 5}[i] * d;
        if (step >= value * (1 - 1e-9)) return step;
    }
    return 10 * d;
}

double round_down(double value) {
    double d = decade_of(value);
    return value >= 5 * d * (1 - 1e-9) ? 5 * d : value >= 2 * d * (1 - 1e-9) ? 2 * d : d;
}

Ticks ticks_every(double step, double low, double high) {
    Ticks ticks = {.step = step};
    double slack = 1e-9 * (high - low), first = ceil((low - slack) / step);
    for (int i = 0; ticks.count < TICKS_MAX; i++) {
        double value = (first + i) * step;
        if (value > high + slack) break;
        ticks.is_labelled[ticks.count] = true;
        ticks.value[ticks.count++] = fabs(value) < slack ? 0 : value;
    }
    return ticks;
}

Ticks ticks_linear(double low, double high, int most) {
    static const double STEPS[] = {1, 2, 2.5, 5, 10};
    if (!(high > low)) return (Ticks){0};
    double least = (high - low) / most, decade = decade_of(least);
    for (int i = 0; i < 5; i++) {
        if (STEPS[i] * decade < least * (1 - 1e-9)) continue;
        Ticks ticks = ticks_every(STEPS[i] * decade, low, high);
        if (ticks.count <= most) return ticks;
    }
    return ticks_every(20 * decade, low, high);
}

static void add_tick(Ticks *ticks, double value, bool is_labelled) {
    if (ticks->count == TICKS_MAX) return;
    ticks->is_labelled[ticks->count] = is_labelled;
    ticks->value[ticks->count++] = value;
}

Ticks ticks_log(double low, double high, int most) {
    Ticks ticks = {0};
    double decades = log10(high / low);
    int first = (int)floor(log10(low) + 1e-9), last = (int)ceil(log10(high) - 1e-9);
    int stride = 1;
    while (decades / stride > most) stride++;
    bool has_fives = decades * 3 <= most, has_minor = decades <= 7;
    for (int e = first; e <= last; e++) {
        for (int digit = 1; digit < 10; digit++) {
            double value = digit * pow(10, e);
            bool labelled = digit == 1 ? ((e % stride) + stride) % stride == 0
                                       : has_fives && (digit == 2 || digit == 5);
            if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
            if (digit == 1 || labelled || has_minor) add_tick(&ticks, value, labelled);
        }
    }
    return ticks;
}

/* "⁻⁴" behind the text. */
static void add_exponent(int exponent, char *text, size_t size) {
    static const char *const DIGITS[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    char plain[16];
    snprintf(plain, sizeof plain, "%d", exponent);
    for (const char *c = plain; *c; c++)
        strncat(text, *c == '-' ? "⁻" : DIGITS[*c - '0'], size - strlen(text) - 1);
}

/* A true minus sign. */
static char *with_minus(char text[32]) {
    size_t length = strlen(text);
    if (text[0] != '-' || length > 29) return text;
    memmove(text + 3, text + 1, length);
    memcpy(text, "−", 3);
    return text;
}

char *tick_text(double value, double step, char text[32]) {
    if (step > 0) {
        int decimals = 0;
        for (double s = step; decimals < 9 && fabs(s - nearbyint(s)) > 1e-6 * s; s *= 10)
            decimals++;
        snprintf(text, 32, "%.*f", decimals, value);
        return with_minus(text);
    }
    int exponent = value > 0 ? (int)floor(log10(value) + 1e-9) : 0;
    double mantissa = value / pow(10, exponent);
    if (value == 0 || (exponent >= -3 && exponent < 5)) {
        snprintf(text, 32, "%g", value);
        return with_minus(text);
    }
    if (fabs(mantissa - 1) < 1e-6) snprintf(text, 32, "10");
    else snprintf(text, 32, "%g·10", mantissa);
    add_exponent(exponent, text, 32);
    return text;
}

char *figure_text(double value, char text[32]) {
    double size = fabs(value);
    int exponent = size > 0 ? (int)floor(log10(size) + 1e-9) : 0;
    if (size == 0) {
        snprintf(text, 32, "0");
    } else if (exponent < -3 || exponent > 6) {
        snprintf(text, 32, "%.3g·10", value / pow(10, exponent));
        add_exponent(exponent, text, 32);
    } else {
        snprintf(text, 32, "%.*f", exponent >= 2 ? 0 : 2 - exponent, value);
    }
    return with_minus(text);
}
