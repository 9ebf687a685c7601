/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/layers/clear_film.h"

#include "base/mathf.h"

/* An index beyond this is a perfect mirror in single precision. */
#define MOST_ROOT 0.99999f

typedef struct ComplexLanes {
    Spectrum re, im;
} ComplexLanes;

static Spectrum root_of(Spectrum a) {
    for (int i = 0; i < SPECTRUM_LANES; i++) a[i] = safe_sqrtf(a[i]);
    return a;
}

Spectrum clear_film_body(Spectrum reflectance) {
    Spectrum root = spectrum_clamp(root_of(reflectance), 0, MOST_ROOT);
    return (spectrum_all(1) + root) / (spectrum_all(1) - root);
}

static ComplexLanes times(ComplexLanes a, ComplexLanes b) {
    return (ComplexLanes){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/* (a - b) / (a + b). */
static ComplexLanes amplitude(ComplexLanes a, ComplexLanes b) {
    Spectrum re = a.re + b.re, im = a.im + b.im, size = re * re + im * im;
    ComplexLanes up = times((ComplexLanes){a.re - b.re, a.im - b.im}, (ComplexLanes){re, -im});
    size = spectrum_max(size, spectrum_all(1e-30f));
    return (ComplexLanes){up.re / size, up.im / size};
}

/* |outer + inner turn|^2 / |1 + outer inner turn|^2. */
static Spectrum airy(float outer, ComplexLanes inner, ComplexLanes turn) {
    Spectrum front = spectrum_all(outer), one = spectrum_all(1);
    ComplexLanes z = times(inner, turn);
    Spectrum up = (front + z.re) * (front + z.re) + z.im * z.im;
    Spectrum down = (one + front * z.re) * (one + front * z.re) + front * z.im * front * z.im;
    return up / spectrum_max(down, spectrum_all(1e-30f));
}

void clear_film_waves(const ThinFilm *film, const Wavelengths *wavelengths, float cosine,
                      const ClearFilmBody *body, Spectrum out[2]) {
    out[0] = out[1] = spectrum_all(1);
    if (!(cosine > 0)) return;
    Spectrum n = body->n, k = body->k;
    float n2 = film->ior, sine2 = 1 - cosine * cosine;
    float inside = safe_sqrtf(1 - sine2 / (n2 * n2)), along = n2 * inside;
    ComplexLanes square = {n * n - k * k, n * k + n * k}, turn, q;
    Spectrum a = square.re - spectrum_all(sine2), zero = spectrum_all(0);
    Spectrum size = root_of(a * a + square.im * square.im);
    q.re = root_of((size + a) * spectrum_all(0.5f)); /* the body's part along z */
    q.im = root_of((size - a) * spectrum_all(0.5f));
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        float sin, cos;
        sincos_turns(2 * along * film->thickness_nm / wavelengths->nm[i], &sin, &cos);
        turn.re[i] = cos;
        turn.im[i] = sin;
    }
    ComplexLanes film_s = {spectrum_all(along), zero};
    ComplexLanes film_p = {square.re * film_s.re, square.im * film_s.re};
    ComplexLanes body_p = {q.re * spectrum_all(n2 * n2), q.im * spectrum_all(n2 * n2)};
    float outer_s = (cosine - along) / (cosine + along);
    float outer_p = (n2 * cosine - inside) / (n2 * cosine + inside);
    out[0] = airy(outer_s, amplitude(film_s, q), turn);
    out[1] = airy(outer_p, amplitude(film_p, body_p), turn);
}

Spectrum clear_film_at(const ThinFilm *film, const Wavelengths *wavelengths, float cosine,
                       Spectrum n, Spectrum k) {
    ClearFilmBody body = {n, k};
    Spectrum waves[2];
    clear_film_waves(film, wavelengths, cosine, &body, waves);
    return spectrum_clamp((waves[0] + waves[1]) * spectrum_all(0.5f), 0, 1);
}

/* ---- on clear bodies -------------------------------------------------------------------- */

/* All amplitudes are real: a at the film's face to the air, b at that to the body. With c the
 * cosine of the phase of one turn in the film R = (a^2 + b^2 + 2 a b c) / (1 + a^2 b^2 +
 * 2 a b c), which is the same if a and b change places and signs: seen from the body. */
typedef struct FilmFaces {
    float squares[2], product[2]; /* a^2 + b^2, a b; of light s and p */
    float path_nm;                /* of one turn */
} FilmFaces;

static FilmFaces film_faces(const ThinFilm *film, const FilmCrossing *ray) {
    FilmFaces faces;
    float n2 = film->ior, air = ray->in_air, body = ray->in_body, n = ray->n;
    float in_film = safe_sqrtf(1 - (1 - air * air) / (n2 * n2)), along = n2 * in_film;
    const float a[2] = {(air - along) / (air + along), (n2 * air - in_film) / (n2 * air + in_film)};
    const float b[2] = {(along - n * body) / (along + n * body),
                        (n * in_film - n2 * body) / (n * in_film + n2 * body)};
    for (int i = 0; i < 2; i++) {
        faces.squares[i] = a[i] * a[i] + b[i] * b[i];
        faces.product[i] = a[i] * b[i];
    }
    faces.path_nm = 2 * along * film->thickness_nm;
    return faces;
}

static float faces_reflect(const FilmFaces *faces, float nm) {
    float sine, cosine, sum = 0;
    sincos_turns(faces->path_nm / nm, &sine, &cosine);
    for (int i = 0; i < 2; i++) {
        float ab = faces->product[i], turn = 2 * ab * cosine;
        sum += (faces->squares[i] + turn) / max_f(1 + ab * ab + turn, 1e-30f);
    }
    return clampf(0.5f * sum, 0, 1);
}

float clear_film_lane(const ThinFilm *film, float nm, const FilmCrossing *ray) {
    if (!(ray->in_air > 0 && ray->in_body > 0)) return 1;
    FilmFaces faces = film_faces(film, ray);
    return faces_reflect(&faces, nm);
}

Spectrum clear_film_between(const ThinFilm *film, const Wavelengths *wavelengths,
                            const FilmCrossing *ray) {
    Spectrum r = spectrum_all(1);
    if (!(ray->in_air > 0 && ray->in_body > 0)) return r;
    FilmFaces faces = film_faces(film, ray);
    for (int i = 0; i < SPECTRUM_LANES; i++) r[i] = faces_reflect(&faces, wavelengths->nm[i]);
    return r;
}
