/* Animations are skipped, but a report of a file says what is wrong in them too. */
#include "scene/check/check_animation.h"

#include <string.h>

/* What a channel of this path is made of, and how many outputs a key frame has. */
typedef struct ChannelPath {
    const char *name, *type;
    bool may_be_integer; /* normalised */
} ChannelPath;

static const ChannelPath PATHS[] = {{"translation", "VEC3", false},
                                    {"rotation", "VEC4", true},
                                    {"scale", "VEC3", false},
                                    {"weights", "SCALAR", true}};

static const GltfValue *accessor_of(const DocumentCheck *check, const GltfValue *sampler,
                                    const char *name)
{
    return tree_element(check->file->root, "accessors", tree_int(sampler, name, NO_ID));
}

static bool has_stride(const DocumentCheck *check, const GltfValue *accessor)
{
    const GltfValue *view =
        tree_element(check->file->root, "bufferViews", tree_int(accessor, "bufferView", NO_ID));
    return tree_member(view, "byteStride") != NULL;
}

static void check_sampler(const DocumentCheck *check, const GltfValue *sampler)
{
    const GltfValue *input = accessor_of(check, sampler, "input");
    const GltfValue *output = accessor_of(check, sampler, "output");
    bool is_cubic = strcmp(tree_text(sampler, "interpolation", "LINEAR"), "CUBICSPLINE") == 0;
    if (has_stride(check, input) || has_stride(check, output))
        check_warns(check, sampler, "the buffer view of an animation has a byteStride");
    if (input && (!tree_member(input, "min") || !tree_member(input, "max")))
        check_warns(check, sampler, "the accessor of the times has no min and max");
    if (input && (strcmp(tree_text(input, "type", ""), "SCALAR") != 0 ||
                  tree_int(input, "componentType", 0) != 5126))
        check_warns(check, sampler, "the times are no SCALAR floats");
    if (input && is_cubic && tree_number(input, "count", 2) < 2)
        check_warns(check, sampler, "a cubic spline has %g key frame, at least 2 are wanted",
                    tree_number(input, "count", 2));
}

static int morph_targets(const DocumentCheck *check, const GltfValue *node)
{
    const GltfValue *mesh =
        tree_element(check->file->root, "meshes", tree_int(node, "mesh", NO_ID));
    return tree_count(tree_item(tree_member(mesh, "primitives"), 0), "targets");
}

static void check_output(const DocumentCheck *check, const GltfValue *channel,
                         const GltfValue *sampler, const ChannelPath *path, int values)
{
    const GltfValue *input = accessor_of(check, sampler, "input");
    const GltfValue *output = accessor_of(check, sampler, "output");
    int component = tree_int(output, "componentType", 5126);
    bool is_cubic = strcmp(tree_text(sampler, "interpolation", "LINEAR"), "CUBICSPLINE") == 0;
    if (!input || !output) return;
    if (strcmp(tree_text(output, "type", ""), path->type) != 0 ||
        (component != 5126 &&
         !(path->may_be_integer && tree_boolean(output, "normalized", false))))
        check_warns(check, channel,
                    "the values of a %s are %s of component type %d, %s is wanted", path->name,
                    tree_text(output, "type", "?"), component, path->type);
    double wanted = tree_number(input, "count", 0) * (is_cubic ? 3 : 1) * values;
    if (values && tree_number(output, "count", 0) != wanted)
        check_warns(check, channel, "%g values for %g key frames, %g are wanted",
                    tree_number(output, "count", 0), tree_number(input, "count", 0), wanted);
}

static void check_channel(const DocumentCheck *check, const GltfValue *animation,
                          const GltfValue *channel)
{
    const GltfValue *target = tree_member(channel, "target");
    const GltfValue *node =
        tree_element(check->file->root, "nodes", tree_int(target, "node", NO_ID));
    const GltfValue *sampler =
        tree_item(tree_member(animation, "samplers"), tree_int(channel, "sampler", NO_ID));
    const char *name = tree_text(target, "path", "");
    bool is_weights = strcmp(name, "weights") == 0;
    if (!sampler) {
        check_warns(check, channel, "refers to no sampler of the animation");
        return;
    }
    if (!is_weights && tree_member(node, "matrix"))
        check_warns(check, target, "moves a node that has a matrix");
    int targets = morph_targets(check, node);
    if (is_weights && node && !targets)
        check_warns(check, target, "moves morph weights of a node without morph targets");
    for (int i = 0; i < 4; i++)
        if (strcmp(PATHS[i].name, name) == 0)
            check_output(check, channel, sampler, &PATHS[i], is_weights ? targets : 1);
}

/* glTF 2.0, 3.11: a property of a node moves in one way at most. */
static void check_targets(const DocumentCheck *check, const GltfValue *channels)
{
    for (int i = 1; channels && i < channels->count; i++) {
        const GltfValue *own = tree_member(&channels->items[i], "target");
        int node = tree_int(own, "node", NO_ID);
        for (int k = 0; k < i && node != NO_ID; k++) {
            const GltfValue *other = tree_member(&channels->items[k], "target");
            if (tree_int(other, "node", NO_ID) != node ||
                strcmp(tree_text(other, "path", ""), tree_text(own, "path", "")) != 0)
                continue;
            check_warns(check, own, "moves what channel %d moves", k);
            break;
        }
    }
}

void check_animation(const DocumentCheck *check, const GltfValue *animation)
{
    const GltfValue *samplers = tree_member(animation, "samplers");
    const GltfValue *channels = tree_member(animation, "channels");
    for (int i = 0; samplers && i < samplers->count; i++)
        check_sampler(check, &samplers->items[i]);
    for (int i = 0; channels && i < channels->count; i++)
        check_channel(check, animation, &channels->items[i]);
    check_targets(check, channels);
}
