/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/sun_position.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/calendar.h"
#include "base/mathd.h"
#include "base/number.h"
#include "base/units.h"
#include "sky/sky_degrees.h"

#define EARTH_RADIUS_M 6378140.0

/* ---- periodic terms of the Earth's motion ---------------------------------------------- */

/* a cos(b + c JME); a in 1e-8 rad (distance: 1e-8 au), b in rad, c in rad per millennium. */
typedef struct OrbitTerm {
    double a, b, c;
} OrbitTerm;

/* Terms that are multiplied by the same power of time. */
typedef struct OrbitSeries {
    const OrbitTerm *term;
    int count;
} OrbitSeries;

/* multiple: of the five arguments X0..X4; the rest in 1/36e6 degrees (per century). */
typedef struct NutationTerm {
    int multiple[5];
    double psi, psi_rate, epsilon, epsilon_rate;
} NutationTerm;

#define NUTATION_TERMS 63

/* NREL/TP-560-34302, tables A4.2 and A4.3, after VSOP87 and the IAU 1980 nutation: heliocentric
 * for powers 0, 1, ... of JME. */
static const OrbitTerm l0[] = {{175347046, 0, 0},           {3341656, 4.6692568, 6283.07585},
                               {34894, 4.6261, 12566.1517}, {3497, 2.7441, 5753.3849},
                               {3418, 2.8289, 3.5231},      {3136, 3.6277, 77713.7715},
                               {2676, 4.4181, 7860.4194},   {2343, 6.1352, 3930.2097},
                               {1324, 0.7425, 11506.7698},  {1273, 2.0371, 529.691},
                               {1199, 1.1096, 1577.3435},   {990, 5.233, 5884.927},
                               {902, 2.045, 26.298},        {857, 3.508, 398.149},
                               {780, 1.179, 5223.694},      {753, 2.533, 5507.553},
                               {505, 4.583, 18849.228},     {492, 4.205, 775.523},
                               {357, 2.92, 0.067},          {317, 5.849, 11790.629},
                               {284, 1.899, 796.298},       {271, 0.315, 10977.079},
                               {243, 0.345, 5486.778},      {206, 4.806, 2544.314},
                               {205, 1.869, 5573.143},      {202, 2.458, 6069.777},
                               {156, 0.833, 213.299},       {132, 3.411, 2942.463},
                               {126, 1.083, 20.775},        {115, 0.645, 0.98},
                               {103, 0.636, 4694.003},      {102, 0.976, 15720.839},
                               {102, 4.267, 7.114},         {99, 6.21, 2146.17},
                               {98, 0.68, 155.42},          {86, 5.98, 161000.69},
                               {85, 1.3, 6275.96},          {85, 3.67, 71430.7},
                               {80, 1.81, 17260.15},        {79, 3.04, 12036.46},
                               {75, 1.76, 5088.63},         {74, 3.5, 3154.69},
                               {74, 4.68, 801.82},          {70, 0.83, 9437.76},
                               {62, 3.98, 8827.39},         {61, 1.82, 7084.9},
                               {57, 2.78, 6286.6},          {56, 4.39, 14143.5},
                               {56, 3.47, 6279.55},         {52, 0.19, 12139.55},
                               {52, 1.33, 1748.02},         {51, 0.28, 5856.48},
                               {49, 0.49, 1194.45},         {41, 5.37, 8429.24},
                               {41, 2.4, 19651.05},         {39, 6.17, 10447.39},
                               {37, 6.04, 10213.29},        {37, 2.57, 1059.38},
                               {36, 1.71, 2352.87},         {36, 1.78, 6812.77},
                               {33, 0.59, 17789.85},        {30, 0.44, 83996.85},
                               {30, 2.74, 1349.87},         {25, 3.16, 4690.48}};

static const OrbitTerm l1[] = {{628331966747, 0, 0},       {206059, 2.678235, 6283.07585},
                               {4303, 2.6351, 12566.1517}, {425, 1.59, 3.523},
                               {119, 5.796, 26.298},       {109, 2.966, 1577.344},
                               {93, 2.59, 18849.23},       {72, 1.14, 529.69},
                               {68, 1.87, 398.15},         {67, 4.41, 5507.55},
                               {59, 2.89, 5223.69},        {56, 2.17, 155.42},
                               {45, 0.4, 796.3},           {36, 0.47, 775.52},
                               {29, 2.65, 7.11},           {21, 5.34, 0.98},
                               {19, 1.85, 5486.78},        {19, 4.97, 213.3},
                               {17, 2.99, 6275.96},        {16, 0.03, 2544.31},
                               {16, 1.43, 2146.17},        {15, 1.21, 10977.08},
                               {12, 2.83, 1748.02},        {12, 3.26, 5088.63},
                               {12, 5.27, 1194.45},        {12, 2.08, 4694},
                               {11, 0.77, 553.57},         {10, 1.3, 6286.6},
                               {10, 4.24, 1349.87},        {9, 2.7, 242.73},
                               {9, 5.64, 951.72},          {8, 5.3, 2352.87},
                               {6, 2.65, 9437.76},         {6, 4.67, 4690.48}};

static const OrbitTerm l2[] = {
    {52919, 0, 0},     {8720, 1.0721, 6283.0758}, {309, 0.867, 12566.152}, {27, 0.05, 3.52},
    {16, 5.19, 26.3},  {16, 3.68, 155.42},        {10, 0.76, 18849.23},    {9, 2.06, 77713.77},
    {7, 0.83, 775.52}, {5, 4.66, 1577.34},        {4, 1.03, 7.11},         {4, 3.44, 5573.14},
    {3, 5.14, 796.3},  {3, 6.05, 5507.55},        {3, 1.19, 242.73},       {3, 6.12, 529.69},
    {3, 0.31, 398.15}, {3, 2.28, 553.57},         {2, 4.38, 5223.69},      {2, 3.75, 0.98}};

static const OrbitTerm l3[] = {{289, 5.844, 6283.076}, {35, 0, 0},      {17, 5.49, 12566.15},
                               {3, 5.2, 155.42},       {1, 4.72, 3.52}, {1, 5.3, 18849.23},
                               {1, 5.97, 242.73}};

static const OrbitTerm l4[] = {{114, 3.142, 0}, {8, 4.13, 6283.08}, {1, 3.84, 12566.15}};

static const OrbitTerm l5[] = {{1, 3.14, 0}};

static const OrbitTerm b0[] = {{280, 3.199, 84334.662},
                               {102, 5.422, 5507.553},
                               {80, 3.88, 5223.69},
                               {44, 3.7, 2352.87},
                               {32, 4, 1577.34}};

static const OrbitTerm b1[] = {{9, 3.9, 5507.55}, {6, 1.73, 5223.69}};

static const OrbitTerm r0[] = {{100013989, 0, 0},
                               {1670700, 3.0984635, 6283.07585},
                               {13956, 3.05525, 12566.1517},
                               {3084, 5.1985, 77713.7715},
                               {1628, 1.1739, 5753.3849},
                               {1576, 2.8469, 7860.4194},
                               {925, 5.453, 11506.77},
                               {542, 4.564, 3930.21},
                               {472, 3.661, 5884.927},
                               {346, 0.964, 5507.553},
                               {329, 5.9, 5223.694},
                               {307, 0.299, 5573.143},
                               {243, 4.273, 11790.629},
                               {212, 5.847, 1577.344},
                               {186, 5.022, 10977.079},
                               {175, 3.012, 18849.228},
                               {110, 5.055, 5486.778},
                               {98, 0.89, 6069.78},
                               {86, 5.69, 15720.84},
                               {86, 1.27, 161000.69},
                               {65, 0.27, 17260.15},
                               {63, 0.92, 529.69},
                               {57, 2.01, 83996.85},
                               {56, 5.24, 71430.7},
                               {49, 3.25, 2544.31},
                               {47, 2.58, 775.52},
                               {45, 5.54, 9437.76},
                               {43, 6.01, 6275.96},
                               {39, 5.36, 4694},
                               {38, 2.39, 8827.39},
                               {37, 0.83, 19651.05},
                               {37, 4.9, 12139.55},
                               {36, 1.67, 12036.46},
                               {35, 1.84, 2942.46},
                               {33, 0.24, 7084.9},
                               {32, 0.18, 5088.63},
                               {32, 1.78, 398.15},
                               {28, 1.21, 6286.6},
                               {28, 1.9, 6279.55},
                               {26, 4.59, 10447.39}};

static const OrbitTerm r1[] = {{103019, 1.10749, 6283.07585},
                               {1721, 1.0644, 12566.1517},
                               {702, 3.142, 0},
                               {32, 1.02, 18849.23},
                               {31, 2.84, 5507.55},
                               {25, 1.32, 5223.69},
                               {18, 1.42, 1577.34},
                               {10, 5.91, 10977.08},
                               {9, 1.42, 6275.96},
                               {9, 0.27, 5486.78}};

static const OrbitTerm r2[] = {
    {4359, 5.7846, 6283.0758}, {124, 5.579, 12566.152}, {12, 3.14, 0},
    {9, 3.63, 77713.77},       {6, 1.87, 5573.14},      {3, 5.47, 18849.23}};

static const OrbitTerm r3[] = {{145, 4.273, 6283.076}, {7, 3.92, 12566.15}};

static const OrbitTerm r4[] = {{4, 2.56, 6283.08}};

static const OrbitSeries orbit_longitude[6] = {{l0, 64}, {l1, 34}, {l2, 20},
                                               {l3, 7},  {l4, 3},  {l5, 1}};

static const OrbitSeries orbit_latitude[2] = {{b0, 5}, {b1, 2}};

static const OrbitSeries orbit_distance[5] = {{r0, 40}, {r1, 10}, {r2, 6}, {r3, 2}, {r4, 1}};

static const NutationTerm nutation_terms[NUTATION_TERMS] = {
    {{0, 0, 0, 0, 1}, -171996, -174.2, 92025, 8.9},
    {{-2, 0, 0, 2, 2}, -13187, -1.6, 5736, -3.1},
    {{0, 0, 0, 2, 2}, -2274, -0.2, 977, -0.5},
    {{0, 0, 0, 0, 2}, 2062, 0.2, -895, 0.5},
    {{0, 1, 0, 0, 0}, 1426, -3.4, 54, -0.1},
    {{0, 0, 1, 0, 0}, 712, 0.1, -7, 0},
    {{-2, 1, 0, 2, 2}, -517, 1.2, 224, -0.6},
    {{0, 0, 0, 2, 1}, -386, -0.4, 200, 0},
    {{0, 0, 1, 2, 2}, -301, 0, 129, -0.1},
    {{-2, -1, 0, 2, 2}, 217, -0.5, -95, 0.3},
    {{-2, 0, 1, 0, 0}, -158, 0, 0, 0},
    {{-2, 0, 0, 2, 1}, 129, 0.1, -70, 0},
    {{0, 0, -1, 2, 2}, 123, 0, -53, 0},
    {{2, 0, 0, 0, 0}, 63, 0, 0, 0},
    {{0, 0, 1, 0, 1}, 63, 0.1, -33, 0},
    {{2, 0, -1, 2, 2}, -59, 0, 26, 0},
    {{0, 0, -1, 0, 1}, -58, -0.1, 32, 0},
    {{0, 0, 1, 2, 1}, -51, 0, 27, 0},
    {{-2, 0, 2, 0, 0}, 48, 0, 0, 0},
    {{0, 0, -2, 2, 1}, 46, 0, -24, 0},
    {{2, 0, 0, 2, 2}, -38, 0, 16, 0},
    {{0, 0, 2, 2, 2}, -31, 0, 13, 0},
    {{0, 0, 2, 0, 0}, 29, 0, 0, 0},
    {{-2, 0, 1, 2, 2}, 29, 0, -12, 0},
    {{0, 0, 0, 2, 0}, 26, 0, 0, 0},
    {{-2, 0, 0, 2, 0}, -22, 0, 0, 0},
    {{0, 0, -1, 2, 1}, 21, 0, -10, 0},
    {{0, 2, 0, 0, 0}, 17, -0.1, 0, 0},
    {{2, 0, -1, 0, 1}, 16, 0, -8, 0},
    {{-2, 2, 0, 2, 2}, -16, 0.1, 7, 0},
    {{0, 1, 0, 0, 1}, -15, 0, 9, 0},
    {{-2, 0, 1, 0, 1}, -13, 0, 7, 0},
    {{0, -1, 0, 0, 1}, -12, 0, 6, 0},
    {{0, 0, 2, -2, 0}, 11, 0, 0, 0},
    {{2, 0, -1, 2, 1}, -10, 0, 5, 0},
    {{2, 0, 1, 2, 2}, -8, 0, 3, 0},
    {{0, 1, 0, 2, 2}, 7, 0, -3, 0},
    {{-2, 1, 1, 0, 0}, -7, 0, 0, 0},
    {{0, -1, 0, 2, 2}, -7, 0, 3, 0},
    {{2, 0, 0, 2, 1}, -7, 0, 3, 0},
    {{2, 0, 1, 0, 0}, 6, 0, 0, 0},
    {{-2, 0, 2, 2, 2}, 6, 0, -3, 0},
    {{-2, 0, 1, 2, 1}, 6, 0, -3, 0},
    {{2, 0, -2, 0, 1}, -6, 0, 3, 0},
    {{2, 0, 0, 0, 1}, -6, 0, 3, 0},
    {{0, -1, 1, 0, 0}, 5, 0, 0, 0},
    {{-2, -1, 0, 2, 1}, -5, 0, 3, 0},
    {{-2, 0, 0, 0, 1}, -5, 0, 3, 0},
    {{0, 0, 2, 2, 1}, -5, 0, 3, 0},
    {{-2, 0, 2, 0, 1}, 4, 0, 0, 0},
    {{-2, 1, 0, 2, 1}, 4, 0, 0, 0},
    {{0, 0, 1, -2, 0}, 4, 0, 0, 0},
    {{-1, 0, 1, 0, 0}, -4, 0, 0, 0},
    {{-2, 1, 0, 0, 0}, -4, 0, 0, 0},
    {{1, 0, 0, 0, 0}, -4, 0, 0, 0},
    {{0, 0, 1, 2, 0}, 3, 0, 0, 0},
    {{0, 0, -2, 2, 2}, -3, 0, 0, 0},
    {{-1, -1, 1, 0, 0}, -3, 0, 0, 0},
    {{0, 1, 1, 0, 0}, -3, 0, 0, 0},
    {{0, -1, 1, 2, 2}, -3, 0, 0, 0},
    {{2, -1, -1, 2, 2}, -3, 0, 0, 0},
    {{0, 0, 3, 2, 2}, -3, 0, 0, 0},
    {{2, -1, 0, 2, 2}, -3, 0, 0, 0}};

/* ---- time ------------------------------------------------------------------------------ */

double sky_julian_day(const SkyTime *time) {
    double year = time->year, month = time->month;
    double hours = time->hour - time->zone_h + (time->minute + time->second / 60) / 60;
    double day = time->day + hours / 24;
    if (month <= 2) {
        year -= 1;
        month += 12;
    }
    double jd = floor(365.25 * (year + 4716)) + floor(30.6001 * (month + 1)) + day - 1524.5;
    double century = floor(year / 100);
    return jd > 2299160 ? jd + 2 - century + floor(century / 4) : jd;
}

double sky_delta_t_s(double julian_day) {
    /* every five years from 1900 to 2025 */
    static const double measured[] = {-2.72, 3.86,  10.54, 17.20, 21.16, 23.62, 24.02, 23.93, 24.33,
                                      26.77, 29.15, 31.07, 33.15, 35.73, 40.18, 45.48, 50.54, 54.34,
                                      56.86, 60.79, 63.83, 64.69, 66.07, 67.64, 69.36, 69.14};
    double year = 2000 + (julian_day - J2000) / 365.25, u = (year - 1820) / 100;
    if (year < 1900) return -20 + 32 * u * u;
    if (year >= 2050) return -20 + 32 * u * u - 0.5628 * fmax(0, 2150 - year);
    double at = fmin((year - 1900) / 5, 24.9999);
    int i = (int)at;
    return measured[i] + (at - i) * (measured[i + 1] - measured[i]);
}

SkyTime sky_time_later(SkyTime when, double seconds) {
    double second = when.hour * 3600 + when.minute * 60 + when.second + seconds;
    double days = floor(second / 86400), rest = second - days * 86400;
    when.hour = (int)(rest / 3600);
    when.minute = (int)((rest - when.hour * 3600) / 60);
    when.second = fmax(0, rest - when.hour * 3600 - when.minute * 60);
    for (when.day += (int)days; when.day > calendar_days_of_month(when.year, when.month);) {
        when.day -= calendar_days_of_month(when.year, when.month);
        when.year += when.month == 12;
        when.month = when.month % 12 + 1;
    }
    return when;
}

static bool time_in_range(const SkyTime *t) {
    return t->year >= -2000 && t->year <= 6000 && t->month >= 1 && t->month <= 12 && t->day >= 1 &&
           t->day <= calendar_days_of_month(t->year, t->month) && t->hour >= 0 && t->hour <= 23 &&
           t->minute >= 0 && t->minute <= 59 && t->second >= 0 && t->second < 60 &&
           fabs(t->zone_h) <= 14;
}

/* One or two digits at *at, which moves behind them; before: what stands in front, 0: nothing. */
static bool take_digits(const char **at, char before, int *out) {
    const char *digit = *at + (before != 0);
    if ((before && **at != before) || !isdigit((unsigned char)*digit)) return false;
    *out = *digit++ - '0';
    if (isdigit((unsigned char)*digit)) *out = 10 * *out + *digit++ - '0';
    *at = digit;
    return true;
}

/* "Z", "+02:00" or "-0330" at `text`; false: anything else. */
static bool parse_zone(const char *text, double *zone_h) {
    int hours, minutes;
    if (!strcmp(text, "Z")) return true;
    const char *at = text + 1;
    if ((*text != '+' && *text != '-') || !take_digits(&at, 0, &hours) ||
        !take_digits(&at, *at == ':' ? ':' : 0, &minutes) || *at || minutes > 59)
        return false;
    *zone_h = (*text == '-' ? -1 : 1) * (hours + minutes / 60.0);
    return true;
}

bool sky_time_parse(const char *text, const char *place, SkyTime *out, Error *err) {
    SkyTime t = {0};
    uint64_t year = 0;
    const char *at = number_read_count(text + (*text == '-' || *text == '+'), &year);
    bool ok = at && year <= 9999 && take_digits(&at, '-', &t.month) &&
              take_digits(&at, '-', &t.day) && take_digits(&at, 'T', &t.hour) &&
              take_digits(&at, ':', &t.minute);
    t.year = *text == '-' ? -(int)year : (int)year;
    if (ok && *at == ':' && isdigit((unsigned char)at[1])) at = number_read(at + 1, &t.second);
    if (!ok || !at || !parse_zone(at, &t.zone_h) || !time_in_range(&t))
        return error_at(err, ERROR_INPUT, place, "",
                        "'%s' is no moment, required: a date, time and zone such as "
                        "2026-06-21T08:30+02:00",
                        text);
    *out = t;
    return true;
}

/* ---- the report's steps ------------------------------------------------------------------ */

/* sum over powers of time of the series' cosines, in 1e-8 units. */
static double orbit_sum(const OrbitSeries *series, int powers, double millennium) {
    double total = 0;
    for (int p = powers - 1; p >= 0; p--) {
        double sum = 0;
        for (int i = 0; i < series[p].count; i++) {
            const OrbitTerm *term = &series[p].term[i];
            sum += term->a * cos_d(term->b + term->c * millennium);
        }
        total = total * millennium + sum;
    }
    return total * 1e-8;
}

static double polynomial(const double *coefficient, int count, double x) {
    double value = 0;
    for (int i = count - 1; i >= 0; i--) value = value * x + coefficient[i];
    return value;
}

/* 3.1 and 3.2: the Earth as seen from the Sun, and turned about. */
static void heliocentric(SunPosition *p) {
    double t = p->ephemeris_millennium;
    p->heliocentric_longitude_deg =
        turn_deg(degrees_from_radians(orbit_sum(orbit_longitude, 6, t)));
    p->heliocentric_latitude_deg = degrees_from_radians(orbit_sum(orbit_latitude, 2, t));
    p->distance_au = orbit_sum(orbit_distance, 5, t);
    p->geocentric_longitude_deg = turn_deg(p->heliocentric_longitude_deg + 180);
    p->geocentric_latitude_deg = -p->heliocentric_latitude_deg;
}

/* 3.4: nutation in longitude and obliquity. */
static void nutate(SunPosition *p) {
    static const double argument[5][4] = {{297.85036, 445267.111480, -0.0019142, 1 / 189474.0},
                                          {357.52772, 35999.050340, -0.0001603, -1 / 300000.0},
                                          {134.96298, 477198.867398, 0.0086972, 1 / 56250.0},
                                          {93.27191, 483202.017538, -0.0036825, 1 / 327270.0},
                                          {125.04452, -1934.136261, 0.0020708, 1 / 450000.0}};
    double t = p->ephemeris_century, psi = 0, epsilon = 0;
    for (int j = 0; j < 5; j++) p->nutation_argument_deg[j] = polynomial(argument[j], 4, t);
    for (int i = 0; i < NUTATION_TERMS; i++) {
        const NutationTerm *term = &nutation_terms[i];
        double sum = 0;
        for (int j = 0; j < 5; j++) sum += term->multiple[j] * p->nutation_argument_deg[j];
        psi += (term->psi + term->psi_rate * t) * sin_deg(sum);
        epsilon += (term->epsilon + term->epsilon_rate * t) * cos_deg(sum);
    }
    p->nutation_longitude_deg = psi / 36e6;
    p->nutation_obliquity_deg = epsilon / 36e6;
}

/* 3.5 to 3.8: obliquity, aberration, sidereal time. */
static void orient(SunPosition *p) {
    static const double mean[11] = {84381.448, -4680.93, -1.55, 1999.25, -51.38, -249.67,
                                    -39.05,    7.12,     27.87, 5.79,    2.45};
    double days = p->julian_day - J2000, t = p->julian_century;
    p->mean_obliquity_arcsec = polynomial(mean, 11, p->ephemeris_millennium / 10);
    p->obliquity_deg = p->mean_obliquity_arcsec / 3600 + p->nutation_obliquity_deg;
    p->aberration_deg = -20.4898 / (3600 * p->distance_au);
    p->apparent_longitude_deg =
        p->geocentric_longitude_deg + p->nutation_longitude_deg + p->aberration_deg;
    p->mean_sidereal_deg =
        turn_deg(280.46061837 + 360.98564736629 * days + t * t * (0.000387933 - t / 38710000));
    p->apparent_sidereal_deg =
        p->mean_sidereal_deg + p->nutation_longitude_deg * cos_deg(p->obliquity_deg);
}

/* 3.9 and 3.10: geocentric right ascension and declination. */
static void equatorial(SunPosition *p) {
    double lambda = radians_from_degrees(p->apparent_longitude_deg);
    double beta = radians_from_degrees(p->geocentric_latitude_deg);
    double se = sin_deg(p->obliquity_deg), ce = cos_deg(p->obliquity_deg);
    p->right_ascension_deg = turn_deg(
        degrees_from_radians(atan2_d(sin_d(lambda) * ce - tan_d(beta) * se, cos_d(lambda))));
    p->declination_deg =
        degrees_from_radians(asin_d(sin_d(beta) * ce + cos_d(beta) * se * sin_d(lambda)));
}

/* 3.11 to 3.13: as seen from the place and not from the Earth's centre. */
static void topocentric(SunPosition *p, const SkyPlace *place) {
    double latitude = radians_from_degrees(place->latitude_deg);
    p->hour_angle_deg =
        turn_deg(p->apparent_sidereal_deg + place->longitude_deg - p->right_ascension_deg);
    p->parallax_deg = 8.794 / (3600 * p->distance_au);
    double reduced = atan2_d(EARTH_FLATNESS * sin_d(latitude), cos_d(latitude));
    double height = place->altitude_m / EARTH_RADIUS_M, xi = sin_deg(p->parallax_deg);
    double x = cos_d(reduced) + height * cos_d(latitude);
    double y = EARTH_FLATNESS * sin_d(reduced) + height * sin_d(latitude);
    double h = radians_from_degrees(p->hour_angle_deg);
    double delta = radians_from_degrees(p->declination_deg);
    double nearer = cos_d(delta) - x * xi * cos_d(h);
    double shift = atan2_d(-x * xi * sin_d(h), nearer);
    p->parallax_right_ascension_deg = degrees_from_radians(shift);
    p->topocentric_right_ascension_deg = p->right_ascension_deg + degrees_from_radians(shift);
    p->topocentric_declination_deg =
        degrees_from_radians(atan2_d((sin_d(delta) - y * xi) * cos_d(shift), nearer));
    p->topocentric_hour_angle_deg = p->hour_angle_deg - degrees_from_radians(shift);
}

/* 3.14 and 3.15, without refraction. */
static void horizontal(SunPosition *p, const SkyPlace *place) {
    double sl = sin_deg(place->latitude_deg), cl = cos_deg(place->latitude_deg);
    double sd = sin_deg(p->topocentric_declination_deg);
    double cd = cos_deg(p->topocentric_declination_deg);
    double sh = sin_deg(p->topocentric_hour_angle_deg);
    double ch = cos_deg(p->topocentric_hour_angle_deg);
    double sine = sl * sd + cl * cd * ch;
    p->elevation_deg = degrees_from_radians(asin_d(fmax(-1, fmin(1, sine))));
    p->azimuth_deg = turn_deg(180 + degrees_from_radians(atan2_d(sh * cd, ch * cd * sl - sd * cl)));
}

SunPosition sun_position(double julian_day, double delta_t_s, const SkyPlace *place) {
    SunPosition p = {.julian_day = julian_day};
    p.julian_century = (julian_day - J2000) / 36525;
    p.ephemeris_day = julian_day + delta_t_s / 86400;
    p.ephemeris_century = (p.ephemeris_day - J2000) / 36525;
    p.ephemeris_millennium = p.ephemeris_century / 10;
    heliocentric(&p);
    nutate(&p);
    orient(&p);
    equatorial(&p);
    topocentric(&p, place);
    horizontal(&p, place);
    return p;
}

/* ---- the air and the horizon ------------------------------------------------------------- */

double sun_refraction_deg(double true_elevation_deg, double pressure_mbar, double celsius) {
    double e = fmax(true_elevation_deg, -1);
    double bend = pressure_mbar / 1010 * 283 / (273 + celsius) * 1.02 /
                  (60 * tan_d(radians_from_degrees(e + 10.3 / (e + 5.11))));
    double fade = fmax(0, fmin(1, (true_elevation_deg + 5) / 4));
    return fmax(0, bend) * fade;
}

void standard_atmosphere(double altitude_m, double *pressure_mbar, double *celsius) {
    /* troposphere to 11 km with -6.5 K/km, then isothermal */
    double low = fmax(-500, fmin(altitude_m, 11000)), kelvin = 288.15 - 0.0065 * low;
    double pressure = 1013.25 * pow_d(kelvin / 288.15, 5.255876);
    if (altitude_m > 11000) pressure *= exp_d(-(fmin(altitude_m, 20000) - 11000) / 6341.62);
    *pressure_mbar = pressure;
    *celsius = kelvin - 273.15;
}

double horizon_dip_deg(double altitude_m) {
    const double radius = 6371000;
    return degrees_from_radians(acos_d(radius / (radius + fmax(0, altitude_m))));
}
