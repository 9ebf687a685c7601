#include "shaders/clear_film.h"

#include "base/mathf.h"

/* An index beyond this is a perfect mirror in single precision. */
#define MOST_ROOT 0.99999f

typedef struct ComplexLanes {
    Spectrum re, im;
} ComplexLanes;

static Spectrum root_of(Spectrum a)
{
    for (int i = 0; i < SPECTRUM_LANES; i++) a[i] = safe_sqrtf(a[i]);
    return a;
}

Spectrum clear_film_body(Spectrum reflectance)
{
    Spectrum root = spectrum_clamp(root_of(reflectance), 0, MOST_ROOT);
    return (spectrum_all(1) + root) / (spectrum_all(1) - root);
}

static ComplexLanes times(ComplexLanes a, ComplexLanes b)
{
    return (ComplexLanes){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/* (a - b) / (a + b). */
static ComplexLanes amplitude(ComplexLanes a, ComplexLanes b)
{
    Spectrum     re = a.re + b.re, im = a.im + b.im, size = re * re + im * im;
    ComplexLanes up = times((ComplexLanes){a.re - b.re, a.im - b.im}, (ComplexLanes){re, -im});
    size = spectrum_max(size, spectrum_all(1e-30f));
    return (ComplexLanes){up.re / size, up.im / size};
}

/* |outer + inner turn|^2 / |1 + outer inner turn|^2. */
static Spectrum airy(float outer, ComplexLanes inner, ComplexLanes turn)
{
    Spectrum     front = spectrum_all(outer), one = spectrum_all(1);
    ComplexLanes z = times(inner, turn);
    Spectrum     up = (front + z.re) * (front + z.re) + z.im * z.im;
    Spectrum     down = (one + front * z.re) * (one + front * z.re) +
                    front * z.im * front * z.im;
    return up / spectrum_max(down, spectrum_all(1e-30f));
}

Spectrum clear_film_at(const ThinFilm *film, const Wavelengths *wavelengths, float cosine,
                       Spectrum n, Spectrum k)
{
    if (!(cosine > 0)) return spectrum_all(1);
    float        n2 = film->ior, sine2 = 1 - cosine * cosine;
    float        inside = safe_sqrtf(1 - sine2 / (n2 * n2)), along = n2 * inside;
    ComplexLanes square = {n * n - k * k, n * k + n * k}, turn, q;
    Spectrum     a = square.re - spectrum_all(sine2), zero = spectrum_all(0);
    Spectrum     size = root_of(a * a + square.im * square.im);
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
    float        outer_s = (cosine - along) / (cosine + along);
    float        outer_p = (n2 * cosine - inside) / (n2 * cosine + inside);
    Spectrum     s = airy(outer_s, amplitude(film_s, q), turn);
    Spectrum     p = airy(outer_p, amplitude(film_p, body_p), turn);
    return spectrum_clamp((s + p) * spectrum_all(0.5f), 0, 1);
}
