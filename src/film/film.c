/* SPDX-License-Identifier: Apache-2.0 */
#include "film/film.h"

#include <assert.h>
#include <math.h>

#include "base/mathf.h"
#include "film/film_add.h"
#include "film/pixels.h"
#include "spectrum/spectral_table.h"

/* ---- layout ------------------------------------------------------------------------------ */

static size_t pixel_bytes(unsigned layers, int light_count) {
    size_t numbers = layers & LAYER_LIGHT ? 3 * (size_t)light_count : 0;
    for (int i = 0; i < SUMS_COUNT; i++)
        if (layers & sums_rows[i].users) numbers += (size_t)sums_rows[i].size;
    return sizeof(PixelSums) + numbers * sizeof(Fixed);
}

static size_t pixel_count(FilmRect crop) {
    return (size_t)(crop.x1 - crop.x0) * (size_t)(crop.y1 - crop.y0);
}

size_t film_bytes(FilmRect crop, unsigned layers, int light_count) {
    return sizeof(Film) + pixel_count(crop) * pixel_bytes(layers, light_count);
}

static void place_arrays(Film *film, Arena *arena) {
    size_t count = pixel_count(film->crop), apart;
    for (int i = 0; i < SUMS_END_DISPLAY; i++) {
        if (film->first[i] < 0) continue;
        if (i < SUMS_FIRST_DISPLAY) film->first_display += sums_rows[i].size;
        else film->display_numbers += sums_rows[i].size;
    }
    apart = (size_t)film->display_numbers * sizeof(Fixed);
    film->pixels = arena_untouched(arena, film->stride - apart, _Alignof(PixelSums), count);
    film->displays = arena_untouched(arena, apart, _Alignof(Fixed), count);
}

Film *film_create(int width, int height, FilmRect crop, unsigned layers, const FilmLights *lights,
                  Arena *arena) {
    assert(crop.x0 >= 0 && crop.x0 < crop.x1 && crop.x1 <= width);
    assert(crop.y0 >= 0 && crop.y0 < crop.y1 && crop.y1 <= height);
    Film *film = ARENA_NEW(arena, Film, 1);
    film->width = width;
    film->height = height;
    film->crop = crop;
    film->layers = layers;
    if (lights && (layers & LAYER_LIGHT)) film->lights = *lights;
    assert(film->lights.count <= FILM_LIGHTS_MAX);
    film->stride = pixel_bytes(layers, film->lights.count);
    int next = 0;
    for (int i = 0; i < SUMS_COUNT; i++) {
        bool is_kept = (layers & sums_rows[i].users) != 0;
        film->first[i] = is_kept ? next : -1;
        if (is_kept) next += sums_rows[i].size;
    }
    film->first_light = next;
    place_arrays(film, arena);
    pthread_mutex_init(&film->lock, NULL);
    return film;
}

void film_set_blind(Film *film) {
    film->has_blind = true;
}

/* ---- adding ------------------------------------------------------------------------------ */

/* Nearest step; scaled: the value in steps. Halves go away from zero. */
static inline Fixed fixed_from_scaled(double scaled) {
    double moved = scaled + (scaled < 0 ? -0.5 : 0.5);
    return fabs(moved) < 0x1p62 ? (Fixed)(int64_t)moved : (Fixed)moved;
}

static inline Fixed fixed_from_float(float value) {
    return fixed_from_scaled((double)value * 0x1p48);
}

/* Also false for NaN. */
static bool in_range(const float *values, int count) {
    for (int i = 0; i < count; i++)
        if (!(fabsf(values[i]) <= VALUE_LIMIT)) return false;
    return true;
}

static void drop_sample(Film *film, int x, int y, uint32_t sample) {
    const FilmDropped dropped = {.count = 1, .kept = 1, .first = {{sample, x, y}}};
    pthread_mutex_lock(&film->lock);
    film_add_dropped(film, &dropped);
    pthread_mutex_unlock(&film->lock);
}

/* The square of linear Rec.709 R, G or B, made in double precision. */
static double square_of(const float xyz[3], int i) {
    const float *row = rgb_from_xyz_matrix + 3 * i;
    double value = (double)row[0] * (double)xyz[0] + (double)row[1] * (double)xyz[1] +
                   (double)row[2] * (double)xyz[2];
    return value * value;
}

/* The sums the variance needs. squares: small and large ones of R, then of G and B. */
static void add_squares(Fixed *squares, const float xyz[3]) {
    for (int i = 0; i < 3; i++) {
        double square = square_of(xyz, i);
        if (square < SQUARE_SPLIT) squares[2 * i] += fixed_from_scaled(square * 0x1p61);
        else squares[2 * i + 1] += fixed_from_scaled(square * 0x1p-5);
    }
}

/* A pixel in both arrays. */
typedef struct PixelPlace {
    PixelSums *sums;
    Fixed *displays;
} PixelPlace;

/* Where the sums of a layer begin; NULL: they are not kept. */
static Fixed *sums_of(const Film *film, PixelPlace to, LayerSums layer) {
    int first = film->first[layer];
    if (first < 0) return NULL;
    if (layer < SUMS_FIRST_DISPLAY) return to.sums->layers + first;
    return layer < SUMS_END_DISPLAY ? to.displays + first - film->first_display
                                    : to.sums->layers + first - film->display_numbers;
}

static void add_layer(const Film *film, PixelPlace to, LayerSums layer, const float *values) {
    Fixed *sums = sums_of(film, to, layer);
    for (int i = 0; i < sums_rows[layer].size; i++) sums[i] += fixed_from_float(values[i]);
}

/* The sample's values that these sums add as they are; NULL: none, or the film has none. */
static const float *values_of(const Film *film, LayerSums layer, const FilmSample *sample) {
    size_t member = sums_rows[layer].member;
    if (film->first[layer] < 0 || member == NO_MEMBER) return NULL;
    return (const float *)(const void *)((const char *)sample + member);
}

static bool layers_in_range(const Film *film, LayerSums first, LayerSums end,
                            const FilmSample *sample) {
    for (LayerSums i = first; i < end; i++) {
        const float *values = values_of(film, i, sample);
        if (values && !in_range(values, sums_rows[i].size)) return false;
    }
    return true;
}

static void add_layers(const Film *film, PixelPlace to, LayerSums first, LayerSums end,
                       const FilmSample *sample) {
    for (LayerSums i = first; i < end; i++) {
        const float *values = values_of(film, i, sample);
        if (values) add_layer(film, to, i, values);
    }
}

/* An id times its light is a sum, too. */
static bool shared_in_range(const FilmSample *sample) {
    const float most = VALUE_LIMIT / (1 + (float)sample->display_id);
    return fabsf(sample->xyz[0]) <= most && fabsf(sample->xyz[1]) <= most &&
           fabsf(sample->xyz[2]) <= most;
}

static bool display_in_range(const Film *film, const FilmSample *sample) {
    return layers_in_range(film, SUMS_FIRST_DISPLAY, SUMS_END_DISPLAY, sample) &&
           (film->first[SUMS_REFLECTED] < 0 || in_range(sample->emitted, 3)) &&
           (film->first[SUMS_SHARED] < 0 || shared_in_range(sample)) &&
           (film->first[SUMS_DIRECTION] < 0 ||
            (fabsf(sample->theta) <= 4 && fabsf(sample->phi) <= 8));
}

static bool is_odd(const FilmSample *sample) {
    return sample->sample_index / BLOCK_SAMPLES % 2;
}

static void add_reflected(Fixed *sums, Fixed *odd, const FilmSample *sample) {
    for (int i = 0; i < 3; i++) {
        Fixed reflected = fixed_from_float(sample->xyz[i]) - fixed_from_float(sample->emitted[i]);
        sums[i] += reflected;
        if (odd && is_odd(sample)) odd[i] += reflected;
    }
    if (odd && is_odd(sample)) odd[3] += fixed_from_float(1);
}

static void add_shared(Fixed *sums, const FilmSample *sample) {
    Fixed id = sample->display_id, power = 1;
    for (int i = 0; i < 3; i++) sums[i] += power *= id;
    for (int i = 0; i < 3; i++) {
        double square = square_of(sample->xyz, i);
        Fixed *squares = sums + 6 + 2 * i;
        sums[3 + i] += id * fixed_from_float(sample->xyz[i]);
        if (square < SQUARE_SPLIT) squares[0] += id * fixed_from_scaled(square * 0x1p45);
        else squares[1] += id * fixed_from_scaled(square * 0x1p-5);
    }
}

static void add_display(const Film *film, PixelPlace to, const FilmSample *sample) {
    if (!display_in_range(film, sample)) return;
    Fixed *reflected = sums_of(film, to, SUMS_REFLECTED), *odd = sums_of(film, to, SUMS_ODD);
    Fixed *squares = sums_of(film, to, SUMS_SQUARES), *shared = sums_of(film, to, SUMS_SHARED);
    if (!to.sums->display_hits++ || sample->sample_index < to.sums->display_sample) {
        to.sums->display_sample = sample->sample_index;
        to.sums->display_id = sample->display_id;
    }
    add_layers(film, to, SUMS_FIRST_DISPLAY, SUMS_END_DISPLAY, sample);
    if (reflected) add_reflected(reflected, odd, sample);
    if (squares) add_squares(squares, sample->xyz);
    if (shared) add_shared(shared, sample);
    if (film->first[SUMS_DIRECTION] >= 0) {
        const float turns = 0.159154943f; /* 1 / (2 pi) */
        float sin_theta, cos_theta, sin_phi, cos_phi;
        sincos_turns(sample->theta * turns, &sin_theta, &cos_theta);
        sincos_turns(sample->phi * turns, &sin_phi, &cos_phi);
        float direction[3] = {sin_theta * cos_phi, sin_theta * sin_phi, cos_theta};
        add_layer(film, to, SUMS_DIRECTION, direction);
    }
}

static void add_features(const Film *film, PixelPlace to, const FilmSample *sample) {
    if (sample->display_id >= 0) add_display(film, to, sample);
    if (!layers_in_range(film, SUMS_DEPTH, SUMS_FIRST_DISPLAY, sample)) return;
    if (!to.sums->hits++ || sample->sample_index < to.sums->part_sample) {
        to.sums->part_sample = sample->sample_index;
        to.sums->part_id = sample->part_id;
    }
    add_layers(film, to, SUMS_DEPTH, SUMS_FIRST_DISPLAY, sample);
}

/* ---- groups of lights -------------------------------------------------------------------- */

static bool lights_in_range(const FilmSample *sample) {
    for (int i = 0; i < sample->light_count; i++)
        if (!in_range(sample->lights[i].xyz, 3)) return false;
    return true;
}

static const FilmLight *brightest_light(const FilmSample *sample) {
    const FilmLight *most = sample->lights;
    for (int i = 1; i < sample->light_count; i++)
        if (sample->lights[i].xyz[1] > most->xyz[1]) most = &sample->lights[i];
    return most;
}

/* The brightest group gets what the others leave of the sample, so that all add up to it;
 * where one of them is out of range, it gets everything. */
static void add_lights(const Film *film, PixelSums *sums, const FilmSample *sample) {
    const FilmLight *most = brightest_light(sample);
    Fixed *groups = sums->layers + film->first_light - film->display_numbers;
    bool is_good = lights_in_range(sample);
    Fixed left[3];
    for (int i = 0; i < 3; i++) left[i] = fixed_from_float(sample->xyz[i]);
    for (int k = 0; k < sample->light_count && is_good; k++) {
        const FilmLight *light = &sample->lights[k];
        Fixed *to = groups + 3 * light->group;
        for (int i = 0; i < 3 && light != most; i++) {
            Fixed steps = fixed_from_float(light->xyz[i]);
            to[i] += steps;
            left[i] -= steps;
        }
    }
    Fixed *to = groups + 3 * most->group;
    for (int i = 0; i < 3; i++) to[i] += left[i];
}

void film_add_sample(Film *film, int x, int y, const FilmSample *sample) {
    if (!in_range(sample->xyz, 3)) {
        drop_sample(film, x, y, sample->sample_index);
        return;
    }
    const size_t index = film_index(film, x, y);
    const PixelPlace to = {film_sums_at(film, index), film_displays_at(film, index)};
    PixelSums *sums = to.sums;
    assert(sums->samples < FILM_SAMPLES_MAX);
    sums->samples++;
    for (int i = 0; i < 3; i++) sums->xyz[i] += fixed_from_float(sample->xyz[i]);
    add_squares(&sums->squares[0][0], sample->xyz);
    if (is_odd(sample)) {
        for (int i = 0; i < 3; i++) sums->odd_xyz[i] += fixed_from_float(sample->xyz[i]);
        sums->odd_samples++;
    }
    if (film->first[SUMS_STOKES] >= 0 && in_range(sample->stokes, 3))
        add_layer(film, to, SUMS_STOKES, sample->stokes);
    if (film->first[SUMS_SOURCES] >= 0 && in_range(sample->sources, 3))
        add_layer(film, to, SUMS_SOURCES, sample->sources);
    if (sample->light_count && film->lights.count) add_lights(film, sums, sample);
    if (sample->hit) add_features(film, to, sample);
}

FilmDropped film_dropped(const Film *film) {
    return film->dropped;
}

/* ---- reading ----------------------------------------------------------------------------- */

uint64_t film_kept_samples(const Film *film) {
    FilmRect crop = film->crop;
    uint64_t kept = 0;
    for (int y = crop.y0; y < crop.y1; y++)
        for (int x = crop.x0; x < crop.x1; x++) kept += film_sums(film, x, y)->samples;
    return kept;
}

FilmPixel film_pixel(const Film *film, int x, int y) {
    const PixelSums *sums = film_sums(film, x, y);
    FilmPixel pixel = {.samples = sums->samples,
                       .display_id = sums->display_hits ? sums->display_id : -1};
    for (int i = 0; i < 3 && sums->samples; i++)
        pixel.mean_xyz[i] = double_from_fixed(sums->xyz[i], FIXED_BITS) / (double)sums->samples;
    pixel_variance(sums, pixel.variance_rgb);
    pixel_noise_y(sums, pixel.variance_rgb, &pixel.sigma_y, &pixel.square_y);
    return pixel;
}

/* Half the geometric mean of the luminances above zero, cd m^-2. */
static double lowest_luminance(const Film *film) {
    double log_sum = 0;
    int64_t count = 0;
    for (int y = film->crop.y0; y < film->crop.y1; y++)
        for (int x = film->crop.x0; x < film->crop.x1; x++) {
            const PixelSums *sums = film_sums(film, x, y);
            if (sums->xyz[1] <= 0) continue;
            double mean = double_from_fixed(sums->xyz[1], FIXED_BITS) / (double)sums->samples;
            log_sum += (double)log_f((float)mean);
            count++;
        }
    return count ? 0.5 * (double)exp_f((float)(log_sum / (double)count)) : 0;
}

static double pixel_error(const FilmPixel *pixel, double lowest) {
    if (pixel->samples < 2) return 1;
    double luminance = pixel->mean_xyz[1] > lowest ? pixel->mean_xyz[1] : lowest;
    return luminance > 0 ? pixel->sigma_y / luminance : 0;
}

static bool is_seen(const Film *film, const FilmPixel *pixel) {
    return pixel->samples || !film->has_blind;
}

static bool shows(const FilmPixel *pixel, int display) {
    if (display == FILM_ALL_PIXELS) return true;
    return display == FILM_ANY_DISPLAY ? pixel->display_id >= 0 : pixel->display_id == display;
}

/* One pixel's figure, given Y_low. */
typedef double PixelFigure(const FilmPixel *pixel, double lowest);

static double mean_of(const Film *film, FilmArea area, double lowest, PixelFigure *figure) {
    FilmRect crop = film->crop, rect = area.rect;
    double sum = 0;
    int64_t count = 0;
    for (int y = rect.y0 > crop.y0 ? rect.y0 : crop.y0; y < rect.y1 && y < crop.y1; y++)
        for (int x = rect.x0 > crop.x0 ? rect.x0 : crop.x0; x < rect.x1 && x < crop.x1; x++) {
            FilmPixel pixel = film_pixel(film, x, y);
            if (!is_seen(film, &pixel) || !shows(&pixel, area.display)) continue;
            sum += figure(&pixel, lowest);
            count++;
        }
    return count ? sum / (double)count : (double)NAN;
}

double film_area_error(const Film *film, FilmArea area) {
    return mean_of(film, area, lowest_luminance(film), pixel_error);
}

static double pixel_spike(const FilmPixel *pixel, double lowest) {
    double s = sqrt(pixel->square_y), others = fmax(pixel->mean_xyz[1] - s, lowest);
    bool is_spike = pixel->samples > 1 && s > FILM_SPIKE * pixel->mean_xyz[1] && others > 0;
    return is_spike ? s / others : 0;
}

static double pixel_spike_square(const FilmPixel *pixel, double lowest) {
    double spike = pixel_spike(pixel, lowest);
    return spike * spike;
}

FilmSpikes film_area_spikes(const Film *film, FilmArea area) {
    double lowest = lowest_luminance(film);
    return (FilmSpikes){mean_of(film, area, lowest, pixel_spike),
                        mean_of(film, area, lowest, pixel_spike_square)};
}

double film_rare_error(const Film *film, double error) {
    FilmSpikes spikes = film_area_spikes(film, (FilmArea){film->crop, FILM_ALL_PIXELS});
    double may_be = sqrt(error * error + spikes.square) / (1 + spikes.mean);
    return may_be > FILM_RARE * error ? may_be : (double)NAN;
}

/* Both by one look at each pixel: all passes that are shown ask for it. */
FilmError film_relative_error(const Film *film) {
    double lowest = lowest_luminance(film), all = 0, displays = 0;
    int64_t seen = 0, shown = 0;
    for (int y = film->crop.y0; y < film->crop.y1; y++)
        for (int x = film->crop.x0; x < film->crop.x1; x++) {
            FilmPixel pixel = film_pixel(film, x, y);
            double error = pixel_error(&pixel, lowest);
            if (!is_seen(film, &pixel)) continue;
            all += error;
            seen++;
            if (!shows(&pixel, FILM_ANY_DISPLAY)) continue;
            displays += error;
            shown++;
        }
    return (FilmError){.frame = seen ? all / (double)seen : (double)NAN,
                       .displays = shown ? displays / (double)shown : (double)NAN};
}

/* Puts a pixel where it belongs among the `kept` worst; returns how many are kept then. */
static int keep_worst(FilmWorst *worst, int kept, int most, FilmWorst pixel) {
    int place = kept;
    while (place > 0 && pixel.error > worst[place - 1].error) place--;
    if (place == most) return kept;
    if (kept < most) kept++;
    for (int i = kept - 1; i > place; i--) worst[i] = worst[i - 1];
    worst[place] = pixel;
    return kept;
}

int film_worst_pixels(const Film *film, int count, FilmWorst *out) {
    double lowest = lowest_luminance(film);
    int kept = 0;
    for (int y = film->crop.y0; y < film->crop.y1; y++)
        for (int x = film->crop.x0; x < film->crop.x1; x++) {
            FilmPixel pixel = film_pixel(film, x, y);
            FilmWorst worst = {x, y, pixel.mean_xyz[1], pixel_error(&pixel, lowest)};
            if (is_seen(film, &pixel)) kept = keep_worst(out, kept, count, worst);
        }
    return kept;
}
