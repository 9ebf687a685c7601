/* SPDX-License-Identifier: Apache-2.0 */
#include "opencolorio/view_transform.h"

#include "guarded/guarded.hpp"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace OCIO = OCIO_NAMESPACE;

namespace {

/* Messages of the library may have several lines. */
std::string one_line(std::string text) {
    while (!text.empty() && isspace((unsigned char)text.back())) text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

OCIO::ConstConfigRcPtr load(const ViewRequest *request) {
    if (request->config_path) return OCIO::Config::CreateFromFile(request->config_path);
    std::istringstream text(request->own_config);
    return OCIO::Config::CreateFromStream(text);
}

using Files = std::set<std::string>;

/* A file that is not there stays out: the library tells of it where it is needed. */
void add_files(const OCIO::ConstContextRcPtr &context, const OCIO::ConstTransformRcPtr &from,
               Files &files) {
    if (auto group = OCIO::DynamicPtrCast<const OCIO::GroupTransform>(from))
        for (int i = 0; i < group->getNumTransforms(); i++)
            add_files(context, group->getTransform(i), files);
    auto file = OCIO::DynamicPtrCast<const OCIO::FileTransform>(from);
    if (!file) return;
    try {
        files.insert(context->resolveFileLocation(file->getSrc()));
    } catch (const OCIO::Exception &) {
    }
}

/* Of all transforms, whether this view takes them or not. */
Files files_of(const OCIO::ConstConfigRcPtr &config) {
    Files files;
    auto context = config->getCurrentContext();
    auto add = [&](const OCIO::ConstTransformRcPtr &transform) {
        add_files(context, transform, files);
    };
    const auto all = OCIO::SEARCH_REFERENCE_SPACE_ALL;
    for (int i = 0; i < config->getNumColorSpaces(all, OCIO::COLORSPACE_ALL); i++) {
        auto space =
            config->getColorSpace(config->getColorSpaceNameByIndex(all, OCIO::COLORSPACE_ALL, i));
        add(space->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE));
        add(space->getTransform(OCIO::COLORSPACE_DIR_FROM_REFERENCE));
    }
    for (int i = 0; i < config->getNumLooks(); i++) {
        auto look = config->getLook(config->getLookNameByIndex(i));
        add(look->getTransform());
        add(look->getInverseTransform());
    }
    for (int i = 0; i < config->getNumViewTransforms(); i++) {
        auto view = config->getViewTransform(config->getViewTransformNameByIndex(i));
        add(view->getTransform(OCIO::VIEWTRANSFORM_DIR_TO_REFERENCE));
        add(view->getTransform(OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE));
    }
    for (int i = 0; i < config->getNumNamedTransforms(OCIO::NAMEDTRANSFORM_ALL); i++) {
        auto named = config->getNamedTransform(
            config->getNamedTransformNameByIndex(OCIO::NAMEDTRANSFORM_ALL, i));
        add(named->getTransform(OCIO::TRANSFORM_DIR_FORWARD));
        add(named->getTransform(OCIO::TRANSFORM_DIR_INVERSE));
    }
    return files;
}

bool may_open_all(const ViewRequest *request, const OCIO::ConstConfigRcPtr &config, Error *err) {
    for (const std::string &path : files_of(config))
        if (!request->may_open(path.c_str(), err)) return false;
    return true;
}

} // namespace

struct ViewTransform {
    OCIO::ConstConfigRcPtr config;
    OCIO::ConstCPUProcessorRcPtr to_config; /* may be empty */
    OCIO::ConstCPUProcessorRcPtr to_display;
    std::string description, display, view;
};

using Names = std::vector<std::string>;

static Names displays_of(const OCIO::ConstConfigRcPtr &config) {
    Names names;
    for (int i = 0; i < config->getNumDisplays(); i++) names.push_back(config->getDisplay(i));
    return names;
}

static Names views_of(const OCIO::ConstConfigRcPtr &config, const char *display) {
    Names names;
    for (int i = 0; i < config->getNumViews(display); i++)
        names.push_back(config->getView(display, i));
    return names;
}

static bool have(const Names &names, const std::string &name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

static std::string listed(const Names &names) {
    std::string list;
    for (const std::string &name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

static bool choose_names(ViewTransform *t, const ViewRequest *request, Error *err) {
    t->display = request->display ? request->display : t->config->getDefaultDisplay();
    Names displays = displays_of(t->config);
    if (!have(displays, t->display)) {
        return error_set(err, ERROR_USAGE, "display \"%s\" is not in %s, which has: %s",
                         t->display.c_str(), t->description.c_str(), listed(displays).c_str());
    }
    const char *display = t->display.c_str();
    t->view = request->view ? request->view : t->config->getDefaultView(display);
    Names views = views_of(t->config, display);
    if (have(views, t->view)) return true;
    return error_set(err, ERROR_USAGE, "view \"%s\" is not among those of display \"%s\": %s",
                     t->view.c_str(), display, listed(views).c_str());
}

/* The space of a user's configuration that light enters by, "" if there is none; *own_name is
 * the same space in our own configuration. */
static std::string entrance(const OCIO::ConstConfigRcPtr &config, const char **own_name) {
    if (config->hasRole("aces_interchange")) {
        *own_name = "ACES2065-1";
        return config->getColorSpace("aces_interchange")->getName();
    }
    *own_name = "Linear CIE-XYZ-D65";
    if (!config->hasRole("cie_xyz_d65_interchange")) return "";
    auto space = config->getColorSpace("cie_xyz_d65_interchange");
    bool is_scene = space->getReferenceSpaceType() == OCIO::REFERENCE_SPACE_SCENE;
    return is_scene ? space->getName() : "";
}

static bool connect(ViewTransform *t, const ViewRequest *request, Error *err) {
    std::string source = "Linear Rec.709";
    if (request->config_path) {
        const char *own_name = nullptr;
        std::istringstream text(request->own_config);
        source = entrance(t->config, &own_name);
        if (source.empty()) {
            return error_at(err, ERROR_INPUT, request->config_path, "",
                            "has no role aces_interchange and no scene-referred "
                            "cie_xyz_d65_interchange, so that the meaning of its colours "
                            "cannot be told; one of them is required");
        }
        auto own = OCIO::Config::CreateFromStream(text);
        t->to_config = own->getProcessor("Linear Rec.709", own_name)->getDefaultCPUProcessor();
    }
    auto processor = t->config->getProcessor(source.c_str(), t->display.c_str(), t->view.c_str(),
                                             OCIO::TRANSFORM_DIR_FORWARD);
    t->to_display = processor->getDefaultCPUProcessor();
    return true;
}

static std::string describe(const OCIO::ConstConfigRcPtr &config, const char *path) {
    std::string name = path ? path : config->getName();
    return name + " (" + config->getCacheID() + ")";
}

bool view_transform_create(const ViewRequest *request, ViewTransform **out, Error *err) {
    /* The library would print warnings to stderr by itself; they belong to no one there. */
    OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
    bool ok = guarded(
        err, ERROR_INPUT, "OpenColorIO configuration",
        [&] {
            auto t = std::make_unique<ViewTransform>();
            const char *path = request->config_path;
            if (path && !request->may_open(path, err)) return false;
            t->config = load(request);
            if (path && !may_open_all(request, t->config, err)) return false;
            t->config->validate();
            t->description = describe(t->config, request->config_path);
            if (!choose_names(t.get(), request, err) || !connect(t.get(), request, err))
                return false;
            *out = t.release();
            return true;
        },
        one_line);
    if (!ok && request->config_path && err->code != ERROR_USAGE)
        error_in_file(err, request->config_path);
    return ok;
}

const char *view_transform_config(const ViewTransform *transform) {
    return transform->description.c_str();
}

const char *view_transform_display(const ViewTransform *transform) {
    return transform->display.c_str();
}

const char *view_transform_view(const ViewTransform *transform) {
    return transform->view.c_str();
}

bool view_transform_apply(const ViewTransform *transform, float *rgb, size_t pixel_count,
                          Error *err) {
    return guarded(
        err, ERROR_LIBRARY, "OpenColorIO",
        [&] {
            if (pixel_count == 0) return true;
            OCIO::PackedImageDesc pixels(rgb, (long)pixel_count, 1, 3);
            if (transform->to_config) transform->to_config->apply(pixels);
            transform->to_display->apply(pixels);
            return true;
        },
        one_line);
}

void view_transform_destroy(ViewTransform *transform) {
    delete transform;
}
