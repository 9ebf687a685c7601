/* SPDX-License-Identifier: Apache-2.0 */
#include "opencolorio/view_transform.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <sstream>
#include <string>

namespace OCIO = OCIO_NAMESPACE;

namespace {

/* Messages of the library may have several lines. */
std::string one_line(std::string text)
{
    while (!text.empty() && isspace((unsigned char)text.back())) text.pop_back();
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

OCIO::ConstConfigRcPtr load(const ViewRequest *request)
{
    if (request->config_path) return OCIO::Config::CreateFromFile(request->config_path);
    std::istringstream text(request->own_config);
    return OCIO::Config::CreateFromStream(text);
}

/* The library prints warnings to stderr by itself otherwise; they belong to no one there. */
void keep_quiet()
{
    OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
}

} // namespace

struct ViewTransform {
    OCIO::ConstConfigRcPtr       config;
    OCIO::ConstCPUProcessorRcPtr to_config; /* may be empty */
    OCIO::ConstCPUProcessorRcPtr to_display;
    std::string                  description, display, view;
};

static std::string displays_of(const OCIO::ConstConfigRcPtr &config)
{
    std::string names;
    for (int i = 0; i < config->getNumDisplays(); i++)
        names += (i ? ", " : "") + std::string(config->getDisplay(i));
    return names;
}

static std::string views_of(const OCIO::ConstConfigRcPtr &config, const char *display)
{
    std::string names;
    for (int i = 0; i < config->getNumViews(display); i++)
        names += (i ? ", " : "") + std::string(config->getView(display, i));
    return names;
}

static bool has_display(const OCIO::ConstConfigRcPtr &config, const std::string &display)
{
    for (int i = 0; i < config->getNumDisplays(); i++)
        if (display == config->getDisplay(i)) return true;
    return false;
}

static bool has_view(const OCIO::ConstConfigRcPtr &config, const char *display,
                     const std::string &view)
{
    for (int i = 0; i < config->getNumViews(display); i++)
        if (view == config->getView(display, i)) return true;
    return false;
}

static bool choose_names(ViewTransform *t, const ViewRequest *request, Error *err)
{
    t->display = request->display ? request->display : t->config->getDefaultDisplay();
    if (!has_display(t->config, t->display)) {
        return error_set(err, ERROR_USAGE, "display \"%s\" is not in %s, which has: %s",
                         t->display.c_str(), t->description.c_str(),
                         displays_of(t->config).c_str());
    }
    const char *display = t->display.c_str();
    t->view = request->view ? request->view : t->config->getDefaultView(display);
    if (has_view(t->config, display, t->view)) return true;
    return error_set(err, ERROR_USAGE, "view \"%s\" is not among those of display \"%s\": %s",
                     t->view.c_str(), display, views_of(t->config, display).c_str());
}

/* The space of a user's configuration that light enters by, "" if there is none; *own_name is
 * the same space in our own configuration. */
static std::string entrance(const OCIO::ConstConfigRcPtr &config, const char **own_name)
{
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

static bool connect(ViewTransform *t, const ViewRequest *request, Error *err)
{
    std::string source = "Linear Rec.709";
    if (request->config_path) {
        const char        *own_name = nullptr;
        std::istringstream text(request->own_config);
        source = entrance(t->config, &own_name);
        if (source.empty()) {
            return error_at(err, ERROR_INPUT, request->config_path, "",
                            "has no role aces_interchange and no scene-referred "
                            "cie_xyz_d65_interchange, so that the meaning of its colours "
                            "cannot be told; one of them is wanted");
        }
        auto own = OCIO::Config::CreateFromStream(text);
        t->to_config = own->getProcessor("Linear Rec.709", own_name)->getDefaultCPUProcessor();
    }
    auto processor = t->config->getProcessor(source.c_str(), t->display.c_str(),
                                             t->view.c_str(), OCIO::TRANSFORM_DIR_FORWARD);
    t->to_display = processor->getDefaultCPUProcessor();
    return true;
}

static std::string describe(const OCIO::ConstConfigRcPtr &config, const char *path)
{
    std::string name = path ? path : config->getName();
    return name + " (" + config->getCacheID() + ")";
}

bool view_transform_create(const ViewRequest *request, ViewTransform **out, Error *err)
{
    keep_quiet();
    bool ok = guarded(err, ERROR_INPUT, "OpenColorIO configuration", [&] {
        auto t = std::make_unique<ViewTransform>();
        t->config = load(request);
        t->config->validate();
        t->description = describe(t->config, request->config_path);
        if (!choose_names(t.get(), request, err) || !connect(t.get(), request, err))
            return false;
        *out = t.release();
        return true;
    });
    if (!ok && request->config_path && err->code != ERROR_USAGE)
        error_in_file(err, request->config_path);
    return ok;
}

const char *view_transform_config(const ViewTransform *transform)
{
    return transform->description.c_str();
}

const char *view_transform_display(const ViewTransform *transform)
{
    return transform->display.c_str();
}

const char *view_transform_view(const ViewTransform *transform)
{
    return transform->view.c_str();
}

bool view_transform_apply(const ViewTransform *transform, float *rgb, size_t pixel_count,
                          Error *err)
{
    return guarded(err, ERROR_LIBRARY, "OpenColorIO", [&] {
        if (pixel_count == 0) return true;
        OCIO::PackedImageDesc pixels(rgb, (long)pixel_count, 1, 3);
        if (transform->to_config) transform->to_config->apply(pixels);
        transform->to_display->apply(pixels);
        return true;
    });
}

void view_transform_destroy(ViewTransform *transform)
{
    delete transform;
}
