/* SPDX-License-Identifier: Apache-2.0 */
/* exr_attribute.hpp -- attributes of OpenEXR files as ExrAttribute, and back; private to
 * exr_file.cpp. */
#pragma once
#include "openexr/exr_file.h"
#include "openexr/memory_stream.hpp"

#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfHeader.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <list>
#include <string>
#include <vector>

namespace {

std::vector<char> bytes_of(const Imf::Attribute &attribute)
{
    std::vector<char> bytes;
    MemoryOutput      stream(&bytes);
    attribute.writeValueTo(stream, 2);
    return bytes;
}

/* "envmap 01"; of many bytes their number and a hash. */
std::string other_text(const Imf::Attribute &attribute)
{
    static const char       DIGITS[] = "0123456789abcdef";
    const size_t            most = 32;
    const std::vector<char> bytes = bytes_of(attribute);
    std::string             text = std::string(attribute.typeName()) + " ";
    if (bytes.size() > most)
        return text + std::to_string(bytes.size()) + " bytes, hash " +
               std::to_string(XXH3_64bits(bytes.data(), bytes.size()));
    for (char byte : bytes) {
        text += DIGITS[(unsigned char)byte >> 4];
        text += DIGITS[(unsigned char)byte & 15];
    }
    return text;
}

/* texts: keeps what the attribute itself does not have as a text. */
void describe_attribute(const Imf::Attribute &from, std::list<std::string> *texts,
                        ExrAttribute *to)
{
    if (auto s = dynamic_cast<const Imf::StringAttribute *>(&from)) {
        to->kind = EXR_STRING;
        texts->push_back(s->value());
        /* a zero byte ends no text: what stands behind it counts */
        std::replace(texts->back().begin(), texts->back().end(), '\0', '\1');
        to->text = texts->back().c_str();
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
        to->kind = EXR_OTHER;
        texts->push_back(other_text(from));
        to->text = texts->back().c_str();
    }
}

void insert_attribute(Imf::Header *header, const ExrAttribute &a)
{
    const double *v = a.values;
    auto          xy = [v](int k) { return Imath::V2f((float)v[k], (float)v[k + 1]); };
    switch (a.kind) {
    case EXR_OTHER: break;
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
