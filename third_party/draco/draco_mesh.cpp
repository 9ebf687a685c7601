/* SPDX-License-Identifier: Apache-2.0 */
#include "draco/draco_mesh.h"

#include "guarded/guarded.hpp"

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <cstring>
#include <memory>

struct DracoMesh {
    std::unique_ptr<draco::Mesh> mesh;
};

namespace {

struct Counts {
    uint32_t triangles, vertices; /* the latter before seams double some */
};

/* The beginning as Draco's bitstream specification 2.2 has it (sections 4 to 6). */
bool read_counts(draco::DecoderBuffer *in, Counts *out, Error *err) {
    char magic[5];
    uint8_t major = 0, minor = 0, type = 0, method = 0, traversal = 0;
    uint16_t flags = 0;
    bool ok = in->Decode(magic, sizeof magic) && std::memcmp(magic, "DRACO", 5) == 0 &&
              in->Decode(&major) && in->Decode(&minor) && in->Decode(&type) &&
              in->Decode(&method) && in->Decode(&flags);
    if (!ok) return error_set(err, ERROR_INPUT, "the packed bytes are no Draco mesh");
    if (major != 2 || minor != 2)
        return error_set(err, ERROR_INPUT, "Draco's bitstream is %d.%d, 2.2 is required", major,
                         minor);
    if (type != draco::TRIANGULAR_MESH)
        return error_set(err, ERROR_INPUT, "Draco's bytes are no mesh, but points");
    in->set_bitstream_version(DRACO_BITSTREAM_VERSION(major, minor));
    if (flags & METADATA_FLAG_MASK) {
        draco::GeometryMetadata skipped;
        draco::MetadataDecoder metadata;
        ok = metadata.DecodeGeometryMetadata(in, &skipped);
    }
    bool is_sequential = method == draco::MESH_SEQUENTIAL_ENCODING;
    uint32_t *first = is_sequential ? &out->triangles : &out->vertices;
    uint32_t *second = is_sequential ? &out->vertices : &out->triangles;
    ok = ok && (is_sequential || in->Decode(&traversal)) && draco::DecodeVarint(first, in) &&
         draco::DecodeVarint(second, in);
    return ok || error_set(err, ERROR_INPUT, "Draco's bytes end in their header");
}

template <typename T>
bool convert(const draco::Mesh &mesh, const draco::PointAttribute &attribute, int components,
             void *out) {
    T *to = static_cast<T *>(out);
    if (!attribute.is_mapping_identity() && attribute.indices_map_size() < mesh.num_points())
        return false;
    for (draco::PointIndex i(0); i < mesh.num_points(); ++i, to += components) {
        draco::AttributeValueIndex at = attribute.mapped_index(i);
        if (at >= static_cast<uint32_t>(attribute.size()) ||
            !attribute.ConvertValue<T>(at, static_cast<int8_t>(components), to))
            return false;
    }
    return true;
}

bool convert_to(int component_type, const draco::Mesh &mesh, const draco::PointAttribute &attribute,
                int components, void *out) {
    switch (component_type) {
    case 5120: return convert<int8_t>(mesh, attribute, components, out);
    case 5121: return convert<uint8_t>(mesh, attribute, components, out);
    case 5122: return convert<int16_t>(mesh, attribute, components, out);
    case 5123: return convert<uint16_t>(mesh, attribute, components, out);
    case 5125: return convert<uint32_t>(mesh, attribute, components, out);
    case 5126: return convert<float>(mesh, attribute, components, out);
    default: return false;
    }
}

} // namespace

extern "C" bool draco_mesh_decode(const void *bytes, size_t size, size_t most_triangles,
                                  size_t most_vertices, DracoMesh **out, Error *err) {
    return guarded(err, ERROR_LIBRARY, "unpacking a mesh", [&] {
        Counts counts = {0, 0};
        draco::DecoderBuffer beginning, all;
        beginning.Init(static_cast<const char *>(bytes), size);
        all.Init(static_cast<const char *>(bytes), size);
        if (!read_counts(&beginning, &counts, err)) return false;
        if (counts.triangles > most_triangles || counts.vertices > most_vertices)
            return error_set(err, ERROR_INPUT,
                             "%u triangles and %u vertices are packed, at most %zu and %zu are "
                             "required",
                             counts.triangles, counts.vertices, most_triangles, most_vertices);
        draco::Decoder decoder;
        auto found = decoder.DecodeMeshFromBuffer(&all);
        if (!found.ok())
            return error_set(err, ERROR_INPUT, "damaged Draco mesh: %s",
                             found.status().error_msg());
        *out = new DracoMesh{std::move(found).value()};
        return true;
    });
}

extern "C" size_t draco_mesh_vertices(const DracoMesh *mesh) {
    return mesh->mesh->num_points();
}

extern "C" size_t draco_mesh_triangles(const DracoMesh *mesh) {
    return mesh->mesh->num_faces();
}

extern "C" bool draco_mesh_corners(const DracoMesh *mesh, uint32_t *out, Error *err) {
    const draco::Mesh &from = *mesh->mesh;
    for (draco::FaceIndex i(0); i < from.num_faces(); ++i)
        for (int c = 0; c < 3; c++) {
            uint32_t corner = from.face(i)[c].value();
            if (corner >= from.num_points())
                return error_set(err, ERROR_INPUT,
                                 "damaged Draco mesh: triangle %u has vertex %u of %u", i.value(),
                                 corner, from.num_points());
            *out++ = corner;
        }
    return true;
}

extern "C" bool draco_mesh_values(const DracoMesh *mesh, uint32_t id, int component_type,
                                  int components, void *out, Error *err) {
    return guarded(err, ERROR_LIBRARY, "unpacking a mesh", [&] {
        const draco::PointAttribute *attribute = mesh->mesh->GetAttributeByUniqueId(id);
        if (!attribute)
            return error_set(err, ERROR_INPUT, "the packed mesh has no attribute %u", id);
        if (attribute->num_components() != components)
            return error_set(err, ERROR_INPUT,
                             "attribute %u of the packed mesh has %d components, %d are "
                             "required",
                             id, attribute->num_components(), components);
        return convert_to(component_type, *mesh->mesh, *attribute, components, out) ||
               error_set(err, ERROR_INPUT,
                         "attribute %u of the packed mesh has values that the accessor cannot "
                         "hold",
                         id);
    });
}

extern "C" void draco_mesh_destroy(DracoMesh *mesh) {
    delete mesh;
}
