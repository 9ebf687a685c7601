/* SPDX-License-Identifier: Apache-2.0 */
#include "openimageio/image_file.h"

#include <dlfcn.h>
#include <stdint.h>

#include "base/machine.h"
#include "base/parallel.h"
#include "base/program.h"
#include "openimageio/image_file_module.h"

static const ProgramPart module_part = {"the program's part for pictures", PICTURES_MODULE,
                                        INSTALLED_MODULES "/" PICTURES_MODULE};

#define THREADS 4 /* of one of the libraries, as long as it is loaded */

/* A library that finds no memory or thread while it is loaded ends the program, so there must
 * be enough: 370 MB are mapped. */
static void *load_first(const char *path, Error *err) {
    const size_t wanted = (size_t)512 << 20, left = machine_address_space_left();
    if (left < wanted) {
        error_set(err, ERROR_MEMORY,
                  "the libraries for pictures want %zu MB of memory, %zu "
                  "are left of the address space (ulimit -v)",
                  wanted >> 20, left >> 20);
        return NULL;
    }
    int granted = parallel_grantable_threads(1 + THREADS) - 1;
    if (granted < THREADS) {
        error_set(err, ERROR_LIBRARY,
                  "the libraries for pictures start %d threads, the system "
                  "grants %d (ulimit -u, pids.max)",
                  THREADS, granted);
        return NULL;
    }
    void *module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!module)
        error_set(err, ERROR_LIBRARY, "the program's part for pictures cannot be loaded: %s",
                  dlerror());
    return module;
}

/* Loading again is a lookup by name, so that nothing has to be remembered here; the module
 * stays until the program ends. */
static const ImageFileModule *load(Error *err) {
    char path[PATH_MAX];
    if (!program_find(&module_part, path, err)) return NULL;
    void *module = dlopen(path, RTLD_NOW | RTLD_NOLOAD);
    if (!module) module = load_first(path, err);
    return module ? dlsym(module, "image_file_module") : NULL;
}

void image_file_take_share(void) {
    Error not_yet;
    if (machine_address_space_left() != SIZE_MAX) load(&not_yet);
}

bool image_decoder_create(const char *format, const char *name, const void *bytes, size_t size,
                          ImageDecoder **out, Error *err) {
    const ImageFileModule *module = load(err);
    return module && module->decoder_create(format, name, bytes, size, out, err);
}

bool image_encode(const char *format, const ImageToEncode *image, EncodedImage **out, Error *err) {
    const ImageFileModule *module = load(err);
    return module && module->encode(format, image, out, err);
}

/* For what holds a handle, and so has loaded the module before. */
static const ImageFileModule *loaded(void) {
    Error never;
    return load(&never);
}

ImageFileInfo image_decoder_info(const ImageDecoder *decoder) {
    return loaded()->decoder_info(decoder);
}

bool image_decoder_read(ImageDecoder *decoder, void *pixels, Error *err) {
    return loaded()->decoder_read(decoder, pixels, err);
}

void image_decoder_destroy(ImageDecoder *decoder) {
    if (decoder) loaded()->decoder_destroy(decoder);
}

const void *encoded_image_bytes(const EncodedImage *encoded, size_t *size) {
    return loaded()->encoded_bytes(encoded, size);
}

void encoded_image_destroy(EncodedImage *encoded) {
    if (encoded) loaded()->encoded_destroy(encoded);
}
