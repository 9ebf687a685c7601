/* SPDX-License-Identifier: Apache-2.0 */
#include "tinygltf/gltf_json.h"

#include "guarded/guarded.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/* Images stay undecoded, no file is opened, no stb: see README. */
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_INCLUDE_JSON
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

using Json = nlohmann::json;

template <typename T> static T *arena_array(Arena *arena, size_t count) {
    return static_cast<T *>(arena_alloc(arena, sizeof(T), alignof(T), count));
}

namespace {

/* An array or object whose end has not been read yet. */
struct Open {
    GltfValue value;
    std::vector<GltfValue> items;
    std::set<std::string> names; /* of an object: a name may stand once */
    const char *next_key = nullptr;
};

/* Builds the tree while the (iterative) parser reads: deep nesting costs no stack. */
class TreeBuilder : public nlohmann::json_sax<Json> {
  public:
    TreeBuilder(Arena *arena, Error *err) : arena_(arena), err_(err) {
    }

    GltfValue root{};

    bool null() override {
        return add(make(GLTF_NULL));
    }
    bool boolean(bool value) override {
        GltfValue v = make(GLTF_BOOLEAN);
        v.number = value;
        return add(v);
    }
    bool number_integer(number_integer_t value) override {
        return number((double)value);
    }
    bool number_unsigned(number_unsigned_t value) override {
        return number((double)value);
    }
    bool number_float(number_float_t value, const string_t &) override {
        return number(value);
    }
    bool string(string_t &value) override {
        if (!is_plain(value)) return false;
        GltfValue v = make(GLTF_STRING);
        v.text = arena_string(arena_, value.data(), value.size());
        return add(v);
    }
    bool binary(binary_t &) override {
        return false;
    }
    bool start_object(size_t) override {
        return open(GLTF_OBJECT);
    }
    bool start_array(size_t) override {
        return open(GLTF_ARRAY);
    }
    bool end_object() override {
        return close();
    }
    bool end_array() override {
        return close();
    }
    bool key(string_t &name) override {
        if (!is_plain(name)) return false;
        if (!open_.back().names.insert(name).second)
            return error_set(err_, ERROR_INPUT, "the name \"%.100s\" stands twice in one object",
                             name.c_str());
        open_.back().next_key = arena_string(arena_, name.data(), name.size());
        return true;
    }
    bool parse_error(size_t, const std::string &, const Json::exception &e) override {
        const char *what = e.what(), *end = std::strstr(what, "] ");
        return error_set(err_, ERROR_INPUT, "not valid JSON: %s", end ? end + 2 : what);
    }

  private:
    Arena *arena_;
    Error *err_;
    std::vector<Open> open_;
    int count_ = 0;

    bool is_plain(const string_t &text) {
        if (text.find('\0') == string_t::npos) return true;
        return error_set(err_, ERROR_INPUT,
                         "the text \"%.100s\" goes on behind a zero character, which is not "
                         "taken",
                         text.c_str());
    }
    static GltfValue make(GltfKind kind) {
        GltfValue v{};
        v.kind = kind;
        v.text = "";
        return v;
    }
    bool number(double value) {
        GltfValue v = make(GLTF_NUMBER);
        v.number = value;
        return add(v);
    }
    bool add(GltfValue v) {
        if (open_.empty()) {
            root = v;
            return true;
        }
        if (++count_ > GLTF_MAX_VALUES)
            return error_set(err_, ERROR_INPUT, "more than %d values in one document",
                             GLTF_MAX_VALUES);
        Open &parent = open_.back();
        v.index = (int)parent.items.size();
        v.key = parent.value.kind == GLTF_OBJECT ? parent.next_key : nullptr;
        parent.items.push_back(v);
        return true;
    }
    bool open(GltfKind kind) {
        if (open_.size() >= GLTF_MAX_DEPTH)
            return error_set(err_, ERROR_INPUT, "JSON nested deeper than %d levels",
                             GLTF_MAX_DEPTH);
        open_.emplace_back();
        open_.back().value = make(kind);
        return true;
    }
    bool close() {
        Open done = std::move(open_.back());
        size_t count = done.items.size();
        GltfValue *items = arena_array<GltfValue>(arena_, count);
        if (count) std::memcpy(items, done.items.data(), count * sizeof *items);
        done.value.items = items;
        done.value.count = (int)count;
        open_.pop_back();
        return add(done.value);
    }
};

/* Values move while the tree grows, so the way up is drawn when it stands. */
void set_parents(GltfValue *value) {
    GltfValue *items = const_cast<GltfValue *>(value->items);
    for (int i = 0; i < value->count; i++) {
        items[i].parent = value;
        set_parents(&items[i]);
    }
}

/* tinygltf takes 3.0 for no integer; the specification takes it for one. */
Json json_from_number(double number) {
    if (number == std::floor(number) && std::fabs(number) < 0x1p53)
        return static_cast<std::int64_t>(number);
    return number;
}

/* Members that tinygltf has no use for, and that may be large. */
bool is_unused(const char *key) {
    for (const char *unused : {"name", "extras", "extensions", "min", "max"})
        if (std::strcmp(key, unused) == 0) return true;
    return false;
}

Json json_from(const GltfValue &value) {
    Json out;
    switch (value.kind) {
    case GLTF_NULL: break;
    case GLTF_BOOLEAN: return value.number != 0;
    case GLTF_NUMBER: return json_from_number(value.number);
    case GLTF_STRING: return value.text;
    case GLTF_ARRAY:
        out = Json::array();
        for (int i = 0; i < value.count; i++) out.push_back(json_from(value.items[i]));
        break;
    case GLTF_OBJECT:
        out = Json::object();
        for (int i = 0; i < value.count; i++)
            if (!is_unused(value.items[i].key)) out[value.items[i].key] = json_from(value.items[i]);
        break;
    }
    return out;
}

bool is_among(const Json &object, const char *name, std::initializer_list<Json> values) {
    auto found = object.find(name);
    return found != object.end() && std::find(values.begin(), values.end(), *found) != values.end();
}

/* Types and components that an extension adds are not read, by tinygltf neither. */
bool is_known(const Json &accessor) {
    auto sparse = accessor.find("sparse");
    return is_among(accessor, "type", {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}) &&
           is_among(accessor, "componentType", {5120, 5121, 5122, 5123, 5125, 5126}) &&
           (sparse == accessor.end() ||
            is_among(sparse->at("indices"), "componentType", {5121, 5123, 5125}));
}

/* Integers stand for them: tinygltf knows those, no accessor that is_known has them. */
void make_unknown(Json &accessor) {
    accessor = Json::object();
    accessor["type"] = "SCALAR";
    accessor["componentType"] = TINYGLTF_COMPONENT_TYPE_INT;
    accessor["count"] = 1;
}

/* The part of the document that tinygltf is asked about. It gets no URI and no image, and of a
 * large document not the many values that only we read. */
std::string data_document(const GltfValue &root) {
    Json part;
    part["asset"]["version"] = "2.0";
    for (int i = 0; root.kind == GLTF_OBJECT && i < root.count; i++)
        for (const char *name : {"bufferViews", "accessors"})
            if (std::strcmp(root.items[i].key, name) == 0) part[name] = json_from(root.items[i]);
    auto accessors = part.find("accessors");
    if (accessors == part.end()) return part.dump();
    for (Json &accessor : *accessors)
        if (!is_known(accessor)) make_unknown(accessor);
    return part.dump();
}

GltfBufferView view_from(const tinygltf::BufferView &view) {
    return {view.buffer, view.byteOffset, view.byteLength, view.byteStride};
}

GltfAccessor accessor_from(const tinygltf::Accessor &accessor) {
    GltfAccessor out{};
    if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_INT) {
        out.buffer_view = -1;
        return out;
    }
    out.buffer_view = accessor.bufferView;
    out.offset = accessor.byteOffset;
    out.count = accessor.count;
    out.component_type = accessor.componentType;
    out.component_count = tinygltf::GetNumComponentsInType((uint32_t)accessor.type);
    out.matrix_rows = accessor.type == TINYGLTF_TYPE_MAT2   ? 2
                      : accessor.type == TINYGLTF_TYPE_MAT3 ? 3
                      : accessor.type == TINYGLTF_TYPE_MAT4 ? 4
                                                            : 0;
    out.is_normalized = accessor.normalized;
    if (!accessor.sparse.isSparse) return out;
    out.sparse_count = (size_t)accessor.sparse.count;
    out.sparse_index_view = accessor.sparse.indices.bufferView;
    out.sparse_index_type = accessor.sparse.indices.componentType;
    out.sparse_index_offset = (size_t)accessor.sparse.indices.byteOffset;
    out.sparse_value_view = accessor.sparse.values.bufferView;
    out.sparse_value_offset = (size_t)accessor.sparse.values.byteOffset;
    return out;
}

} // namespace

bool gltf_json_parse(const char *text, size_t size, Arena *arena, const GltfValue **root,
                     Error *err) {
    return guarded(err, ERROR_LIBRARY, "JSON", [&] {
        TreeBuilder builder(arena, err);
        if (!Json::sax_parse(text, text + size, &builder)) return false;
        GltfValue *value = arena_array<GltfValue>(arena, 1);
        *value = builder.root;
        set_parents(value);
        *root = value;
        return true;
    });
}

bool gltf_json_data(const GltfValue *root, Arena *arena, GltfData *out, Error *err) {
    return guarded(err, ERROR_LIBRARY, "tinygltf", [&] {
        tinygltf::TinyGLTF loader;
        tinygltf::Model model;
        std::string failure, warning, part = data_document(*root);
        if (!loader.LoadASCIIFromString(&model, &failure, &warning, part.data(),
                                        (unsigned)part.size(), "", tinygltf::NO_REQUIRE))
            return error_set(err, ERROR_LIBRARY, "tinygltf: %s", failure.c_str());
        GltfBufferView *views = arena_array<GltfBufferView>(arena, model.bufferViews.size());
        GltfAccessor *accessors = arena_array<GltfAccessor>(arena, model.accessors.size());
        for (size_t i = 0; i < model.bufferViews.size(); i++)
            views[i] = view_from(model.bufferViews[i]);
        for (size_t i = 0; i < model.accessors.size(); i++)
            accessors[i] = accessor_from(model.accessors[i]);
        *out =
            GltfData{views, accessors, (int)model.bufferViews.size(), (int)model.accessors.size()};
        return true;
    });
}
