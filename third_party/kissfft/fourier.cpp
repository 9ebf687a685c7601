/* SPDX-License-Identifier: Apache-2.0 */
#include "kissfft/fourier.h"

#include <kissfft/kissfft.hh>

#include <exception>

struct Fourier {
    kissfft<double> transform;
};

extern "C" bool fourier_create(int length, bool is_backwards, Fourier **out, Error *err) {
    try {
        *out = new Fourier{kissfft<double>((std::size_t)length, is_backwards)};
        return true;
    } catch (const std::exception &e) {
        return error_set(err, ERROR_MEMORY, "a Fourier transform of %d numbers: %s", length,
                         e.what());
    }
}

extern "C" void fourier_transform(const Fourier *fourier, const double *in, double *out) {
    /* The standard lets an array of complex numbers be seen as one of pairs. */
    fourier->transform.transform(reinterpret_cast<const std::complex<double> *>(in),
                                 reinterpret_cast<std::complex<double> *>(out));
}

extern "C" void fourier_destroy(Fourier *fourier) {
    delete fourier;
}
