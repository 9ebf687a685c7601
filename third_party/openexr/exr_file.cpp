#include "openexr/exr_file.h"

#include "openexr/memory_stream.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/OpenEXRConfig.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace {

const float NONE_FROM_FILE = 4294967040.0f; /* the float below 2^32: whole "none" */

/* Messages of the library may have several lines. */
std::string one_line(std::string text)
{
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

/* No exception crosses into C, and none loses its message on the way. */
template <typename Body>
bool guarded(Error *err, ErrorCode code, const char *doing, Body body) noexcept
{
    try {
        return body();
    } catch (const std::bad_alloc &) {
        return error_set(err, ERROR_MEMORY, "%s: out of memory", doing);
    } catch (const std::exception &e) {
        return error_set(err, code, "%s: %s", doing, one_line(e.what()).c_str());
    } catch (...) {
        return error_set(err, code, "%s: unknown C++ exception", doing);
    }
}

/* The library's own threads, for as long as one picture is encoded; how many makes no
 * difference to the bytes. */
struct EncodingThreads {
    EncodingThreads()
    {
        Imf::setGlobalThreadCount(std::min((int)std::thread::hardware_concurrency(), 8));
    }
    ~EncodingThreads() { Imf::setGlobalThreadCount(0); }
};

ExrWindow half_open(const Imath::Box2i &box)
{
    return {box.min.x, box.min.y, box.max.x + 1, box.max.y + 1};
}

Imath::Box2i closed(ExrWindow w)
{
    return {{w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}};
}

/* False for kinds that ExrAttribute does not know. */
bool describe_attribute(const Imf::Attribute &from, ExrAttribute *to)
{
    if (auto s = dynamic_cast<const Imf::StringAttribute *>(&from)) {
        to->kind = EXR_STRING;
        to->text = s->value().c_str();
    } else if (auto i = dynamic_cast<const Imf::IntAttribute *>(&from)) {
        to->kind = EXR_INT;
        to->values[0] = i->value();
    } else if (auto f = dynamic_cast<const Imf::FloatAttribute *>(&from)) {
        to->kind = EXR_FLOAT;
        to->values[0] = (double)f->value();
    } else if (auto d = dynamic_cast<const Imf::DoubleAttribute *>(&from)) {
        to->kind = EXR_DOUBLE;
        to->values[0] = d->value();
    } else if (auto c = dynamic_cast<const Imf::ChromaticitiesAttribute *>(&from)) {
        const Imath::V2f points[4] = {c->value().red, c->value().green, c->value().blue,
                                      c->value().white};
        to->kind = EXR_CHROMATICITIES;
        for (int k = 0; k < 8; k++) to->values[k] = (double)points[k / 2][k % 2];
    } else if (auto m = dynamic_cast<const Imf::M44fAttribute *>(&from)) {
        to->kind = EXR_MATRIX44;
        for (int k = 0; k < 16; k++) to->values[k] = (double)m->value()[k / 4][k % 4];
    } else {
        return false;
    }
    return true;
}

void insert_attribute(Imf::Header *header, const ExrAttribute &a)
{
    const double *v = a.values;
    auto          xy = [v](int k) { return Imath::V2f((float)v[k], (float)v[k + 1]); };
    switch (a.kind) {
    case EXR_STRING: header->insert(a.name, Imf::StringAttribute(a.text)); break;
    case EXR_INT: header->insert(a.name, Imf::IntAttribute((int)v[0])); break;
    case EXR_FLOAT: header->insert(a.name, Imf::FloatAttribute((float)v[0])); break;
    case EXR_DOUBLE: header->insert(a.name, Imf::DoubleAttribute(v[0])); break;
    case EXR_CHROMATICITIES:
        header->insert(a.name, Imf::ChromaticitiesAttribute({xy(0), xy(2), xy(4), xy(6)}));
        break;
    case EXR_MATRIX44: {
        Imath::M44f matrix;
        for (int k = 0; k < 16; k++) matrix[k / 4][k % 4] = (float)v[k];
        header->insert(a.name, Imf::M44fAttribute(matrix));
        break;
    }
    }
}

} // namespace

struct ExrReader {
    MemoryInput                              memory;
    std::unique_ptr<Imf::MultiPartInputFile> file;
    std::vector<ExrChannel>                  channels;
    std::vector<ExrAttribute>                attributes;
    ExrPicture                               picture{};

    ExrReader(const char *name, const void *bytes, size_t size) : memory(name, bytes, size) {}
};

static bool check_window(const ExrPicture &p, Error *err)
{
    long long width = (long long)p.data.x1 - p.data.x0;
    long long height = (long long)p.data.y1 - p.data.y0;
    if (width < 1 || height < 1 || width > EXR_MAX_SIDE || height > EXR_MAX_SIDE
        || width * height > EXR_MAX_PIXELS) {
        return error_set(err, ERROR_INPUT,
                         "a data window of %lld x %lld pixels; at most %d along a side and %d "
                         "in all are supported",
                         width, height, EXR_MAX_SIDE, EXR_MAX_PIXELS);
    }
    if (p.channel_count < 1 || p.channel_count > EXR_MAX_CHANNELS) {
        return error_set(err, ERROR_INPUT, "%d channels, 1 to %d are supported",
                         p.channel_count, EXR_MAX_CHANNELS);
    }
    return true;
}

static bool describe(ExrReader *reader, Error *err)
{
    const Imf::Header &header = reader->file->header(0);
    if (header.hasType() && header.type().rfind("deep", 0) == 0)
        return error_set(err, ERROR_INPUT, "a deep picture, a flat one is wanted");
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
            return error_set(err, ERROR_INPUT,
                             "channel %s is sampled every %d x %d pixels (luminance-chroma "
                             "coding), one value for each pixel is wanted",
                             c.name(), c.channel().xSampling, c.channel().ySampling);
        reader->channels.push_back({c.name(), c.channel().type == Imf::UINT, nullptr});
    }
    for (auto a = header.begin(); a != header.end(); ++a) {
        ExrAttribute attribute = {a.name(), EXR_STRING, nullptr, {}};
        if (describe_attribute(a.attribute(), &attribute))
            reader->attributes.push_back(attribute);
    }
    reader->picture = {half_open(header.displayWindow()), half_open(header.dataWindow()),
                       (int)reader->channels.size(),      reader->channels.data(),
                       (int)reader->attributes.size(),    reader->attributes.data(), 0, 0};
    return check_window(reader->picture, err);
}

bool exr_reader_create(const char *name, const void *bytes, size_t size, ExrReader **out,
                       Error *err)
{
    if (size < 4 || memcmp(bytes, "\x76\x2f\x31\x01", 4) != 0)
        return error_set(err, ERROR_INPUT, "not an OpenEXR file");
    return guarded(err, ERROR_INPUT, "damaged OpenEXR file", [&] {
        Imf::Header::setMaxImageSize(EXR_MAX_SIDE, EXR_MAX_SIDE);
        Imf::Header::setMaxTileSize(EXR_MAX_SIDE / 4, EXR_MAX_SIDE / 4);
        auto reader = std::make_unique<ExrReader>(name, bytes, size);
        reader->file = std::make_unique<Imf::MultiPartInputFile>(reader->memory, 0, false);
        if (!describe(reader.get(), err)) return false;
        *out = reader.release();
        return true;
    });
}

const ExrPicture *exr_reader_picture(const ExrReader *reader)
{
    return &reader->picture;
}

static void read_planes(ExrReader *reader, float *const *planes)
{
    const Imath::Box2i &window = reader->file->header(0).dataWindow();
    Imf::FrameBuffer    buffer;
    for (size_t i = 0; i < reader->channels.size(); i++) {
        if (planes[i])
            buffer.insert(reader->channels[i].name,
                          Imf::Slice::Make(Imf::FLOAT, planes[i], window));
    }
    Imf::InputPart part(*reader->file, 0);
    part.setFrameBuffer(buffer);
    part.readPixels(window.min.y, window.max.y);
}

bool exr_reader_read(ExrReader *reader, float *const *planes, Error *err)
{
    return guarded(err, ERROR_INPUT, "damaged OpenEXR file", [&] {
        read_planes(reader, planes);
        const ExrPicture &p = reader->picture;
        size_t            count = (size_t)(p.data.x1 - p.data.x0) * (p.data.y1 - p.data.y0);
        for (int i = 0; i < p.channel_count; i++) {
            if (!planes[i] || !p.channels[i].is_whole) continue;
            std::replace_if(planes[i], planes[i] + count,
                            [](float v) { return v >= NONE_FROM_FILE; }, -1.0f);
        }
        return true;
    });
}

void exr_reader_destroy(ExrReader *reader)
{
    delete reader;
}

struct ExrBytes {
    std::vector<char> bytes;
};

static std::vector<unsigned> whole_values(const float *values, size_t count)
{
    std::vector<unsigned> whole(count);
    for (size_t i = 0; i < count; i++)
        whole[i] = values[i] >= 0 && values[i] < NONE_FROM_FILE ? (unsigned)values[i]
                                                                : 0xffffffffu;
    return whole;
}

static void write_picture(const ExrPicture &p, Imf::OStream *stream)
{
    const Imath::Box2i window = closed(p.data);
    const size_t       width = (size_t)(p.data.x1 - p.data.x0);
    const size_t       count = width * (size_t)(p.data.y1 - p.data.y0);
    Imf::Header        header(closed(p.display), window);
    Imf::FrameBuffer   buffer;
    std::vector<std::vector<unsigned>> whole((size_t)p.channel_count);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (int i = 0; i < p.attribute_count; i++) insert_attribute(&header, p.attributes[i]);
    for (int i = 0; i < p.channel_count; i++) {
        const ExrChannel &c = p.channels[i];
        Imf::PixelType    type = c.is_whole ? Imf::UINT : Imf::FLOAT;
        if (c.is_whole) whole[(size_t)i] = whole_values(c.values, count);
        const void *values = c.is_whole ? (const void *)whole[(size_t)i].data() : c.values;
        header.channels().insert(c.name, Imf::Channel(type));
        buffer.insert(c.name, Imf::Slice::Make(type, values, window));
    }
    Imf::OutputFile file(*stream, header, Imf::globalThreadCount());
    file.setFrameBuffer(buffer);
    file.writePixels((int)(p.data.y1 - p.data.y0));
}

bool exr_encode(const ExrPicture *p, ExrBytes **out, Error *err)
{
    if (!check_window(*p, err)) return false;
    if (p->data.x0 < p->display.x0 || p->data.y0 < p->display.y0 || p->data.x1 > p->display.x1
        || p->data.y1 > p->display.y1) {
        return error_set(err, ERROR_OUTPUT,
                         "the data window %d,%d,%d,%d is not inside the display window "
                         "%d,%d,%d,%d",
                         p->data.x0, p->data.y0, p->data.x1, p->data.y1, p->display.x0,
                         p->display.y0, p->display.x1, p->display.y1);
    }
    return guarded(err, ERROR_LIBRARY, "encoding OpenEXR", [&] {
        EncodingThreads threads;
        auto            encoded = std::make_unique<ExrBytes>();
        MemoryOutput    stream(&encoded->bytes);
        write_picture(*p, &stream);
        *out = encoded.release();
        return true;
    });
}

const void *exr_bytes(const ExrBytes *encoded, size_t *size)
{
    *size = encoded->bytes.size();
    return encoded->bytes.data();
}

void exr_bytes_destroy(ExrBytes *encoded)
{
    delete encoded;
}
