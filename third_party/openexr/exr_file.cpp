/* SPDX-License-Identifier: Apache-2.0 */
#include "openexr/exr_file.h"

#include <sys/stat.h>

#include "base/file.h"
#include "base/parallel.h"
#include "guarded/guarded.hpp"
#include "openexr/exr_attribute.hpp"
#include "openexr/exr_header.h"
#include "openexr/memory_stream.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/OpenEXRConfig.h>

#include <algorithm>
#include <list>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace {

const char MAGIC[] = "\x76\x2f\x31\x01";
const char DAMAGED[] = "damaged OpenEXR file";
const char OWN_WORDS[] = "parhelion:layers"; /* an attribute of a part of words */
const float NONE_FROM_FILE = 4294967040.0f;  /* the float below 2^32: whole "none" */

/* Messages of the library may have several lines. */
std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

/* 0: this thread alone, which is also what a single processor does best. */
int coding_threads() {
    int processors = (int)std::thread::hardware_concurrency();
    int granted = parallel_grantable_threads(1 + std::min(processors, 8)) - 1;
    return granted > 1 ? granted : 0;
}

/* The library's own threads, for as long as pixels are coded; how many makes no difference to
 * the bytes. */
struct CodingThreads {
    CodingThreads() {
        Imf::setGlobalThreadCount(coding_threads());
    }
    ~CodingThreads() {
        Imf::setGlobalThreadCount(0);
    }
};

ExrWindow half_open(const Imath::Box2i &box) {
    return {box.min.x, box.min.y, box.max.x + 1, box.max.y + 1};
}

Imath::Box2i closed(ExrWindow w) {
    return {{w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}};
}

} // namespace

struct ExrReader {
    std::unique_ptr<MemoryInput> memory; /* none for a file on disk */
    std::unique_ptr<Imf::MultiPartInputFile> file;
    std::vector<ExrChannel> channels;
    std::vector<ExrAttribute> attributes;
    ExrPicture picture{};
    int words_part = 0; /* 0: not asked for */
    std::vector<const char *> word_names;
    std::vector<ExrAttribute> word_attributes;
    ExrWords words{};
    std::vector<int> more_parts;  /* their places */
    std::list<std::string> texts; /* of attributes */
};

static bool check_window(const char *which, const ExrWindow &window, Error *err) {
    long long width = (long long)window.x1 - window.x0;
    long long height = (long long)window.y1 - window.y0;
    if (width < 1 || height < 1 || width > EXR_MAX_SIDE || height > EXR_MAX_SIDE ||
        width * height > EXR_MAX_PIXELS) {
        return error_set(err, ERROR_INPUT,
                         "a %s window of %lld x %lld pixels; at most %d along a side and %d "
                         "in all are supported",
                         which, width, height, EXR_MAX_SIDE, EXR_MAX_PIXELS);
    }
    return true;
}

static bool check_picture(const ExrPicture &p, Error *err) {
    if (!check_window("data", p.data, err) || !check_window("display", p.display, err))
        return false;
    if (p.channel_count < 1 || p.channel_count > EXR_MAX_CHANNELS) {
        return error_set(err, ERROR_INPUT, "%d channels, 1 to %d are supported", p.channel_count,
                         EXR_MAX_CHANNELS);
    }
    return true;
}

static bool is_one_of(const std::string &name, std::initializer_list<const char *> list) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

/* Attributes of how a part is stored, not of what the picture is. */
static bool is_of_storage(const std::string &name) {
    return is_one_of(name, {"name", "type", "chunkCount", "version", "channels", "compression",
                            "dwaCompressionLevel", "lineOrder", "tiles", "preview", "dataWindow",
                            "displayWindow", "maxSamplesPerPixel"});
}

static std::vector<ExrAttribute> describe_attributes(const Imf::Header &header,
                                                     std::list<std::string> *texts) {
    std::vector<ExrAttribute> list;
    for (auto a = header.begin(); a != header.end(); ++a) {
        if (is_of_storage(a.name())) continue;
        list.push_back({a.name(), EXR_STRING, nullptr, {}});
        describe_attribute(a.attribute(), texts, &list.back());
    }
    return list;
}

static bool describe(ExrReader *reader, Error *err) {
    const Imf::Header &header = reader->file->header(0);
    if (header.hasType() && header.type().rfind("deep", 0) == 0)
        return error_set(err, ERROR_INPUT, "a deep picture, a flat one is required");
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        if (is_one_of(c.name(), {"RY", "BY"}))
            return error_set(err, ERROR_INPUT,
                             "channel %s: luminance and chroma (Y, RY, BY), channels R, G and B "
                             "are required",
                             c.name());
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
            return error_set(err, ERROR_INPUT,
                             "channel %s is sampled every %d x %d pixels, one value for each "
                             "pixel is required",
                             c.name(), c.channel().xSampling, c.channel().ySampling);
        reader->channels.push_back({c.name(), c.channel().type == Imf::UINT, nullptr});
    }
    for (int part = 1; part < reader->file->parts(); part++)
        if (!reader->file->header(part).findTypedAttribute<Imf::IntAttribute>(OWN_WORDS))
            reader->more_parts.push_back(part);
    reader->attributes = describe_attributes(header, &reader->texts);
    reader->picture = {half_open(header.displayWindow()),
                       half_open(header.dataWindow()),
                       (int)reader->channels.size(),
                       reader->channels.data(),
                       (int)reader->attributes.size(),
                       reader->attributes.data(),
                       0,
                       0,
                       nullptr,
                       nullptr,
                       (int)reader->more_parts.size()};
    return check_picture(reader->picture, err);
}

static void set_limits() {
    Imf::Header::setMaxImageSize(EXR_MAX_SIDE, EXR_MAX_SIDE);
    Imf::Header::setMaxTileSize(EXR_MAX_SIDE / 4, EXR_MAX_SIDE / 4);
}

static bool check_start(const void *bytes, size_t size, size_t file_size, Error *err) {
    if (size < 4 || memcmp(bytes, MAGIC, 4) != 0)
        return error_set(err, ERROR_INPUT, "not an OpenEXR file");
    return exr_check_header((const unsigned char *)bytes, size, file_size, err);
}

static bool check_file(const char *path, Error *err) {
    struct stat info;
    FileBytes start;
    Arena arena = arena_reserve(EXR_HEADER_BYTES + (1 << 16));
    bool ok = file_read_start(path, EXR_HEADER_BYTES, &arena, &start, err) &&
              check_start(start.data, start.size,
                          stat(path, &info) ? start.size : (size_t)info.st_size, err);
    arena_release(&arena);
    return ok;
}

/* open: sets the reader's file. */
template <typename OpenFile> static bool make_reader(OpenFile open, ExrReader **out, Error *err) {
    return guarded(
        err, ERROR_INPUT, DAMAGED,
        [&] {
            set_limits();
            auto reader = std::make_unique<ExrReader>();
            open(reader.get());
            if (!describe(reader.get(), err)) return false;
            *out = reader.release();
            return true;
        },
        one_line);
}

bool exr_reader_create(const char *name, const void *bytes, size_t size, ExrReader **out,
                       Error *err) {
    if (!check_start(bytes, size, size, err)) return false;
    return make_reader(
        [&](ExrReader *reader) {
            reader->memory = std::make_unique<MemoryInput>(name, bytes, size);
            reader->file = std::make_unique<Imf::MultiPartInputFile>(*reader->memory, 0, false);
        },
        out, err);
}

bool exr_reader_open(const char *path, ExrReader **out, Error *err) {
    if (!check_file(path, err)) return false;
    return make_reader(
        [&](ExrReader *reader) {
            reader->file = std::make_unique<Imf::MultiPartInputFile>(path, coding_threads(), false);
        },
        out, err);
}

const ExrPicture *exr_reader_picture(const ExrReader *reader) {
    return &reader->picture;
}

static void read_planes(ExrReader *reader, float *const *planes) {
    const Imath::Box2i &window = reader->file->header(0).dataWindow();
    Imf::FrameBuffer buffer;
    for (size_t i = 0; i < reader->channels.size(); i++) {
        if (planes[i])
            buffer.insert(reader->channels[i].name,
                          Imf::Slice::Make(Imf::FLOAT, planes[i], window));
    }
    Imf::InputPart part(*reader->file, 0);
    part.setFrameBuffer(buffer);
    part.readPixels(window.min.y, window.max.y);
}

bool exr_reader_read(ExrReader *reader, float *const *planes, Error *err) {
    return guarded(
        err, ERROR_INPUT, DAMAGED,
        [&] {
            read_planes(reader, planes);
            const ExrPicture &p = reader->picture;
            size_t count = (size_t)(p.data.x1 - p.data.x0) * (p.data.y1 - p.data.y0);
            for (int i = 0; i < p.channel_count; i++) {
                if (!planes[i] || !p.channels[i].is_whole) continue;
                std::replace_if(
                    planes[i], planes[i] + count, [](float v) { return v >= NONE_FROM_FILE; },
                    -1.0f);
            }
            return true;
        },
        one_line);
}

/* ---- further parts ----------------------------------------------------------------------- */

static bool is_flat_part(const Imf::Header &header) {
    if (header.type() != Imf::SCANLINEIMAGE && header.type() != Imf::TILEDIMAGE) return false;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1) return false;
    return true;
}

/* Names, windows, and what else decides what a part shows. */
static void digest_header(const Imf::Header &header, XXH3_state_t *state) {
    for (auto a = header.begin(); a != header.end(); ++a) {
        if (!is_one_of(a.name(), {"chromaticities", "whiteLuminance", "envmap", "view",
                                  "pixelAspectRatio", "dataWindow", "displayWindow"}))
            continue;
        const std::vector<char> bytes = bytes_of(a.attribute());
        XXH3_64bits_update(state, a.name(), strlen(a.name()));
        XXH3_64bits_update(state, bytes.data(), bytes.size());
    }
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        XXH3_64bits_update(state, c.name(), strlen(c.name()) + 1);
}

#define BAND_VALUES 16000000 /* of some rows of all channels */

static void digest_pixels(Imf::InputPart *part, XXH3_state_t *state) {
    const Imath::Box2i &window = part->header().dataWindow();
    const Imf::ChannelList &channels = part->header().channels();
    const long long width = (long long)window.max.x - window.min.x + 1;
    long long count = 0;
    for (auto c = channels.begin(); c != channels.end(); ++c) count++;
    const int rows = (int)std::clamp(BAND_VALUES / (width * (count + 1)), 1LL, 256LL);
    std::vector<float> values((size_t)(width * rows * count));
    for (long long y = window.min.y; y <= window.max.y; y += rows) {
        const int last = (int)std::min(y + rows - 1, (long long)window.max.y);
        Imf::FrameBuffer buffer;
        float *plane = values.data();
        for (auto c = channels.begin(); c != channels.end(); ++c, plane += width * rows)
            buffer.insert(c.name(),
                          Imf::Slice::Make(c.channel().type == Imf::UINT ? Imf::UINT : Imf::FLOAT,
                                           plane, Imath::V2i(window.min.x, (int)y), width,
                                           last - y + 1));
        part->setFrameBuffer(buffer);
        part->readPixels((int)y, last);
        plane = values.data();
        for (long long c = 0; c < count; c++, plane += width * rows)
            XXH3_64bits_update(state, plane, sizeof *plane * (size_t)(width * (last - y + 1)));
    }
}

bool exr_reader_part(ExrReader *reader, int i, ExrPart *out, Error *err) {
    return guarded(
        err, ERROR_INPUT, DAMAGED,
        [&] {
            const int place = reader->more_parts[(size_t)i];
            const Imf::Header &header = reader->file->header(place);
            XXH3_state_t state;
            *out = {header.name().c_str(), is_flat_part(header), 0};
            if (!out->is_flat) return true;
            if (!check_window("data", half_open(header.dataWindow()), err)) return false;
            Imf::InputPart part(*reader->file, place);
            XXH3_64bits_reset(&state);
            digest_header(header, &state);
            digest_pixels(&part, &state);
            out->digest = XXH3_64bits_digest(&state);
            return true;
        },
        one_line);
}

/* ---- words ------------------------------------------------------------------------------- */

static bool describe_words(ExrReader *reader, int part, Error *err) {
    const Imf::Header &header = reader->file->header(part);
    const Imf::Header &first = reader->file->header(0);
    bool holds_words = header.type() == Imf::SCANLINEIMAGE &&
                       header.dataWindow() == first.dataWindow() &&
                       header.displayWindow() == first.displayWindow();
    reader->word_names.clear();
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        const Imf::Channel &channel = c.channel();
        holds_words = holds_words && channel.type == Imf::UINT && channel.xSampling == 1 &&
                      channel.ySampling == 1;
        reader->word_names.push_back(c.name());
    }
    if (!holds_words || reader->word_names.size() > EXR_MAX_WORDS)
        return error_set(err, ERROR_INPUT,
                         "its part \"%s\" does not hold 32-bit words of the picture's pixels",
                         header.name().c_str());
    reader->words_part = part;
    reader->word_attributes = describe_attributes(header, &reader->texts);
    reader->words = {header.name().c_str(),
                     (int)reader->word_names.size(),
                     reader->word_names.data(),
                     nullptr,
                     (int)reader->word_attributes.size(),
                     reader->word_attributes.data(),
                     nullptr};
    return true;
}

bool exr_reader_words(ExrReader *reader, const char *name, const ExrWords **out, Error *err) {
    return guarded(
        err, ERROR_INPUT, DAMAGED,
        [&] {
            int part = 1;
            while (part < reader->file->parts() && reader->file->header(part).name() != name)
                part++;
            bool is_there = part < reader->file->parts();
            if (is_there && !describe_words(reader, part, err)) return false;
            *out = is_there ? &reader->words : nullptr;
            return true;
        },
        one_line);
}

/* A slice of a frame buffer for some rows of the words' part: word i of `count`. */
static Imf::Slice word_slice(const void *values, int i, int count, ExrWindow rows) {
    const size_t pixel = 4 * (size_t)count;
    return Imf::Slice::Make(Imf::UINT, (const char *)values + 4 * i, closed(rows), pixel,
                            pixel * (size_t)(rows.x1 - rows.x0));
}

bool exr_reader_read_words(ExrReader *reader, const ExrWords *wanted, int y0, int y1, void *values,
                           Error *err) {
    return guarded(
        err, ERROR_INPUT, DAMAGED,
        [&] {
            CodingThreads threads;
            Imf::FrameBuffer buffer;
            Imf::InputPart part(*reader->file, reader->words_part);
            const ExrWindow &data = reader->picture.data;
            const ExrWindow rows = {data.x0, y0, data.x1, y1};
            for (int i = 0; i < wanted->count; i++) {
                if (!part.header().channels().findChannel(wanted->names[i]))
                    return error_set(err, ERROR_INPUT, "its part \"%s\" has no words %s",
                                     reader->words.name, wanted->names[i]);
                buffer.insert(wanted->names[i], word_slice(values, i, wanted->count, rows));
            }
            part.setFrameBuffer(buffer);
            part.readPixels(y0, y1 - 1);
            return true;
        },
        one_line);
}

void exr_reader_destroy(ExrReader *reader) {
    delete reader;
}

struct ExrBytes {
    std::vector<char> bytes;
};

static std::vector<unsigned> whole_values(const float *values, size_t count) {
    std::vector<unsigned> whole(count);
    for (size_t i = 0; i < count; i++)
        whole[i] = values[i] >= 0 && values[i] < NONE_FROM_FILE ? (unsigned)values[i] : 0xffffffffu;
    return whole;
}

static Imf::Header header_of(const ExrPicture &p, const ExrAttribute *attributes, int count) {
    Imf::Header header(closed(p.display), closed(p.data));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (int i = 0; i < count; i++) insert_attribute(&header, attributes[i]);
    return header;
}

static Imf::Header picture_header(const ExrPicture &p) {
    Imf::Header header = header_of(p, p.attributes, p.attribute_count);
    for (int i = 0; i < p.channel_count; i++)
        header.channels().insert(p.channels[i].name,
                                 Imf::Channel(p.channels[i].is_whole ? Imf::UINT : Imf::FLOAT));
    return header;
}

static Imf::Header words_header(const ExrPicture &p) {
    Imf::Header header = header_of(p, p.words->attributes, p.words->attribute_count);
    for (int i = 0; i < p.words->count; i++)
        header.channels().insert(p.words->names[i], Imf::Channel(Imf::UINT));
    return header;
}

/* Rows of a picture on their way into a file: what the planes hold. */
struct PictureRows {
    const ExrPicture &p;
    std::vector<std::vector<unsigned>> whole{};

    Imf::FrameBuffer buffer(ExrWindow rows) {
        const size_t count = (size_t)(rows.x1 - rows.x0) * (size_t)(rows.y1 - rows.y0);
        Imf::FrameBuffer buffer;
        whole.assign((size_t)p.channel_count, {});
        for (int i = 0; i < p.channel_count; i++) {
            const ExrChannel &c = p.channels[i];
            if (c.is_whole) whole[(size_t)i] = whole_values(c.values, count);
            const void *values = c.is_whole ? (const void *)whole[(size_t)i].data() : c.values;
            buffer.insert(c.name, Imf::Slice::Make(c.is_whole ? Imf::UINT : Imf::FLOAT, values,
                                                   closed(rows)));
        }
        return buffer;
    }
};

struct WordRows {
    const ExrWords &words;

    Imf::FrameBuffer buffer(ExrWindow rows) {
        Imf::FrameBuffer buffer;
        for (int i = 0; i < words.count; i++)
            buffer.insert(words.names[i], word_slice(words.values, i, words.count, rows));
        return buffer;
    }
};

/* rows: NULL, all are there; else they are made band by band. */
template <class Rows, class Out>
static void write_rows(Rows from, const ExrRows *rows, ExrWindow data, Out *out) {
    const int count = rows ? rows->count : data.y1 - data.y0;
    for (int y = data.y0; y < data.y1; y += count) {
        const ExrWindow band = {data.x0, y, data.x1, std::min(y + count, data.y1)};
        if (rows) rows->make(rows->from, band.y0, band.y1);
        out->setFrameBuffer(from.buffer(band));
        out->writePixels(band.y1 - band.y0);
    }
}

/* Of its values as they are, and what else a file holds of each row. */
static size_t most_bytes(const ExrPicture &p) {
    const size_t rows = (size_t)(p.data.y1 - p.data.y0);
    const size_t width = (size_t)(p.data.x1 - p.data.x0);
    const size_t words = p.words ? (size_t)p.words->count : 0;
    return rows * (width * 4 * ((size_t)p.channel_count + words) + 64) + ((size_t)1 << 20);
}

static void write_picture(const ExrPicture &p, Imf::OStream *stream) {
    Imf::OutputFile file(*stream, picture_header(p), Imf::globalThreadCount());
    write_rows(PictureRows{p}, p.rows, p.data, &file);
}

/* The picture comes first: who knows of one part only finds it. */
static void write_both(const ExrPicture &p, Imf::OStream *stream) {
    Imf::Header headers[2] = {picture_header(p), words_header(p)};
    headers[0].setName("picture");
    headers[1].setName(p.words->name);
    for (Imf::Header &header : headers) header.setType(Imf::SCANLINEIMAGE);
    Imf::MultiPartOutputFile file(*stream, headers, 2, true, Imf::globalThreadCount());
    Imf::OutputPart picture(file, 0), words(file, 1);
    write_rows(PictureRows{p}, p.rows, p.data, &picture);
    write_rows(WordRows{*p.words}, p.words->rows, p.data, &words);
}

bool exr_encode(const ExrPicture *p, ExrBytes **out, Error *err) {
    if (!check_picture(*p, err)) return false;
    if (p->data.x0 < p->display.x0 || p->data.y0 < p->display.y0 || p->data.x1 > p->display.x1 ||
        p->data.y1 > p->display.y1) {
        return error_set(err, ERROR_OUTPUT,
                         "the data window %d,%d,%d,%d is not inside the display window "
                         "%d,%d,%d,%d",
                         p->data.x0, p->data.y0, p->data.x1, p->data.y1, p->display.x0,
                         p->display.y0, p->display.x1, p->display.y1);
    }
    return guarded(
        err, ERROR_LIBRARY, "encoding OpenEXR",
        [&] {
            CodingThreads threads;
            auto encoded = std::make_unique<ExrBytes>();
            MemoryOutput stream(&encoded->bytes, most_bytes(*p));
            if (p->words) write_both(*p, &stream);
            else write_picture(*p, &stream);
            *out = encoded.release();
            return true;
        },
        one_line);
}

const void *exr_bytes(const ExrBytes *encoded, size_t *size) {
    *size = encoded->bytes.size();
    return encoded->bytes.data();
}

void exr_bytes_destroy(ExrBytes *encoded) {
    delete encoded;
}
