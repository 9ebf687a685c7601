/* SPDX-License-Identifier: Apache-2.0 */
#include "openimageio/image_file_module.h"

#include "guarded/guarded.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace {

/* The library ends some messages with a newline, and joins several by newlines. */
std::string one_line(std::string text) {
    while (!text.empty() && isspace((unsigned char)text.back())) text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ';');
    return text.empty() ? "no reason given" : text;
}

PixelType smallest_type(OIIO::TypeDesc format) {
    if (format.is_floating_point()) return PIXEL_F32;
    return format.basesize() == 1 ? PIXEL_U8 : PIXEL_U16;
}

OIIO::TypeDesc library_type(PixelType type) {
    return type == PIXEL_U8    ? OIIO::TypeDesc::UINT8
           : type == PIXEL_U16 ? OIIO::TypeDesc::UINT16
                               : OIIO::TypeDesc::FLOAT;
}

} // namespace

struct ImageDecoder {
    OIIO::Filesystem::IOMemReader memory;
    std::unique_ptr<OIIO::ImageInput> input; /* declared last: goes before its memory */
    ImageFileInfo info{};

    ImageDecoder(const void *bytes, size_t size) : memory(bytes, size) {
    }
};

static bool open_input(ImageDecoder *decoder, const char *format, const char *name, Error *err) {
    decoder->input = OIIO::ImageInput::create(format);
    if (!decoder->input) {
        return error_set(err, ERROR_LIBRARY, "OpenImageIO was built without a %s reader: %s",
                         format, one_line(OIIO::geterror()).c_str());
    }
    decoder->input->threads(1); /* a pool that finds no thread would end the program */
    OIIO::ImageSpec hints, spec;
    hints.attribute("oiio:UnassociatedAlpha", 1);
    decoder->input->set_ioproxy(&decoder->memory);
    if (!decoder->input->open(name, spec, hints)) {
        return error_set(err, ERROR_INPUT, "damaged %s picture: %s", format,
                         one_line(decoder->input->geterror()).c_str());
    }
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1) {
        return error_set(err, ERROR_INPUT,
                         "%d x %d x %d pixels of %d channels, a flat picture is required",
                         spec.width, spec.height, spec.depth, spec.nchannels);
    }
    const int colours = spec.nchannels - (spec.alpha_channel >= 0);
    if (colours != 1 && colours != 3)
        return error_set(err, ERROR_INPUT,
                         "%d channels besides alpha, greys or red, green and blue are required",
                         colours);
    ImageFileInfo *info = &decoder->info;
    info->width = spec.width;
    info->height = spec.height;
    info->channels = std::min(spec.nchannels, 4);
    info->alpha_channel = spec.alpha_channel < info->channels ? spec.alpha_channel : -1;
    info->type = smallest_type(spec.format);
    return true;
}

static bool decoder_create(const char *format, const char *name, const void *bytes, size_t size,
                           ImageDecoder **out, Error *err) {
    return guarded(err, ERROR_LIBRARY, "reading a picture", [&] {
        auto decoder = std::make_unique<ImageDecoder>(bytes, size);
        if (!open_input(decoder.get(), format, name, err)) return false;
        *out = decoder.release();
        return true;
    });
}

static ImageFileInfo decoder_info(const ImageDecoder *decoder) {
    return decoder->info;
}

static bool decoder_read(ImageDecoder *decoder, void *pixels, Error *err) {
    return guarded(err, ERROR_LIBRARY, "reading a picture", [&] {
        const ImageFileInfo &info = decoder->info;
        if (decoder->input->read_image(0, 0, 0, info.channels, library_type(info.type), pixels))
            return true;
        return error_set(err, ERROR_INPUT, "damaged %s picture: %s", decoder->input->format_name(),
                         one_line(decoder->input->geterror()).c_str());
    });
}

static void decoder_destroy(ImageDecoder *decoder) {
    delete decoder;
}

struct EncodedImage {
    std::vector<unsigned char> bytes;
};

static OIIO::ImageSpec output_spec(const char *format, const ImageToEncode *image) {
    OIIO::ImageSpec spec(image->width, image->height, image->channels, library_type(image->type));
    /* The library would write the time of day otherwise, and no two runs would agree. */
    spec.attribute("DateTime", "");
    spec.attribute("Software", "parhelion");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("oiio:dither", 0);
    spec.attribute("Compression", "zip");
    if (image->jpeg_quality > 0) {
        spec.attribute("Compression", "jpeg:" + std::to_string(image->jpeg_quality));
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    if (image->description) spec.attribute("ImageDescription", image->description);
    if (image->icc_profile)
        spec.attribute("ICCProfile",
                       OIIO::TypeDesc(OIIO::TypeDesc::UINT8, (int)image->icc_profile_size),
                       image->icc_profile);
    /* For a TIFF the library would state it in an Exif directory, and 2.4.7 writes a file that
     * cannot be read when it does so in memory. */
    if (image->is_srgb && std::string(format) != "tiff") spec.attribute("oiio:ColorSpace", "sRGB");
    return spec;
}

static bool encode(const char *format, const ImageToEncode *image, EncodedImage **out, Error *err) {
    return guarded(err, ERROR_LIBRARY, "encoding a picture", [&] {
        auto encoded = std::make_unique<EncodedImage>();
        OIIO::Filesystem::IOVecOutput sink(encoded->bytes);
        auto output = OIIO::ImageOutput::create(format);
        if (!output || !output->supports("ioproxy")) {
            return error_set(err, ERROR_LIBRARY, "OpenImageIO cannot encode %s in memory", format);
        }
        output->threads(1);
        output->set_ioproxy(&sink);
        OIIO::ImageSpec spec = output_spec(format, image);
        std::string name = std::string("picture.") + format;
        if (!output->open(name, spec) ||
            !output->write_image(library_type(image->type), image->pixels) || !output->close()) {
            return error_set(err, ERROR_LIBRARY, "encoding a %s picture: %s", format,
                             one_line(output->geterror()).c_str());
        }
        *out = encoded.release();
        return true;
    });
}

static const void *encoded_bytes(const EncodedImage *encoded, size_t *size) {
    *size = encoded->bytes.size();
    return encoded->bytes.data();
}

static void encoded_destroy(EncodedImage *encoded) {
    delete encoded;
}

extern "C" const ImageFileModule image_file_module = {
    decoder_create, decoder_info,  decoder_read,    decoder_destroy,
    encode,         encoded_bytes, encoded_destroy,
};
