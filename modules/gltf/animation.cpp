// SPDX-License-Identifier: MIT
//
// Animations: which property of which node a channel moves, and the values of all of them at one time
// (glTF 2.0, 3.11 and appendix C). They are written into the model's nodes, before anything is made of these.
#include "import.h"

#include <algorithm>
#include <cjson/cJSON.h>
#include <cmath>
#include <set>
#include <utility>

namespace gltf
{

namespace
{

struct path_row {
    const char *name;
    size_t components; // 0: as many as there are morph targets
    const char *accessor;
    std::vector<double> tinygltf::Node::*values;
};

// In the order of `animated`.
const path_row paths[] = {
    { "translation", 3, "VEC3", &tinygltf::Node::translation },
    { "rotation", 4, "VEC4", &tinygltf::Node::rotation },
    { "scale", 3, "VEC3", &tinygltf::Node::scale },
    { "weights", 0, "SCALAR", &tinygltf::Node::weights },
};

int index_get(const cJSON *object, const char *name)
{
    const cJSON *const value = cJSON_GetObjectItemCaseSensitive(object, name);
    return value == nullptr ? -1 : static_cast<int>(value->valuedouble);
}

// Samplers by number; what a list of channels needs again and again.
std::vector<const cJSON *> items_of(const cJSON *object, const char *name)
{
    std::vector<const cJSON *> items;
    const cJSON *item = nullptr;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(object, name)) items.push_back(item);
    return items;
}

// Channels that aim at no node, or at a property that an extension adds, move nothing that is known here.
void channel_take(importer &in, size_t animation, size_t number, const cJSON *channel,
                  const std::vector<const cJSON *> &samplers)
{
    const cJSON *const target = cJSON_GetObjectItemCaseSensitive(channel, "target");
    const std::string path = cJSON_GetObjectItemCaseSensitive(target, "path")->valuestring;
    const auto row = std::find_if(std::begin(paths), std::end(paths),
                                  [&path](const path_row &known) { return path == known.name; });
    animation_channel to;
    to.label = label("animations", animation) + "." + label("channels", number);
    to.node = index_get(target, "node");
    if (row == std::end(paths) || to.node < 0)
        return;
    const int sampler = index_get(channel, "sampler");
    if (static_cast<size_t>(sampler) >= samplers.size())
        fail("%s: sampler %d is out of range, there are %zu", to.label.c_str(), sampler, samplers.size());
    const cJSON *const from = samplers[static_cast<size_t>(sampler)];
    const cJSON *const interpolation = cJSON_GetObjectItemCaseSensitive(from, "interpolation");
    to.animation = animation;
    to.path = static_cast<animated>(row - std::begin(paths));
    to.input = index_get(from, "input");
    to.output = index_get(from, "output");
    to.interpolation = interpolation == nullptr ? "LINEAR" : interpolation->valuestring;
    in.channels.push_back(std::move(to));
}

struct curve {
    std::vector<float> times, values;
    size_t components = 0; // of one value
    bool is_cubic = false; // each key has a tangent before its value and one after it
    bool is_step = false;

    double at(size_t key, size_t part, size_t component) const
    {
        const size_t parts = is_cubic ? 3 : 1;
        return static_cast<double>(values[(key * parts + part) * components + component]);
    }
};

void times_check(const curve &c, const std::string &what)
{
    if (c.times.empty())
        fail("%s: there is no keyframe", what.c_str());
    for (size_t i = 0; i < c.times.size(); i++)
        if (!std::isfinite(c.times[i]) || (i != 0 && !(c.times[i] > c.times[i - 1])))
            fail("%s: the time of keyframe %zu does not come after the one before", what.c_str(), i);
    for (size_t i = 0; i < c.values.size(); i++)
        if (!std::isfinite(c.values[i]))
            fail("%s: value %zu is not finite", what.c_str(), i);
}

void interpolation_set(curve &c, const animation_channel &channel)
{
    c.is_cubic = channel.interpolation == "CUBICSPLINE";
    c.is_step = channel.interpolation == "STEP";
    if (!c.is_cubic && !c.is_step && channel.interpolation != "LINEAR")
        fail("%s: the interpolation '%.40s' is unknown", channel.label.c_str(),
             channel.interpolation.c_str());
}

std::vector<float> keys_read(importer &in, int accessor, int components, const std::string &what)
{
    const tinygltf::Accessor &a = accessor_get(in.model, accessor, what);
    if (accessor_components(a) != components)
        fail("%s: the accessor's type has %d components, expected %d", what.c_str(), accessor_components(a),
             components);
    bound_take(in, in.keyframe_values, a.count * static_cast<uint64_t>(components), keyframe_bound, what);
    return accessor_read_floats(in.model, accessor, what, true);
}

curve curve_read(importer &in, const animation_channel &channel)
{
    const path_row &row = paths[static_cast<size_t>(channel.path)];
    curve c;
    interpolation_set(c, channel);
    c.times = keys_read(in, channel.input, 1, channel.label + " (times)");
    c.values = keys_read(in, channel.output, std::max(1, static_cast<int>(row.components)),
                         channel.label + " (values)");
    times_check(c, channel.label);
    const size_t parts = c.times.size() * (c.is_cubic ? 3 : 1);
    c.components = row.components != 0 ? row.components : c.values.size() / parts;
    if (c.components == 0 || c.values.size() != parts * c.components)
        fail("%s: %zu keyframes, and %zu numbers for their values", channel.label.c_str(), c.times.size(),
             c.values.size());
    return c;
}

// Between unit quaternions, on the shorter way (appendix C.4); close ones are mixed.
void rotation_mix(const double a[4], const double b[4], double t, double out[4])
{
    double dot = 0;
    for (int i = 0; i < 4; i++)
        dot += a[i] * b[i];
    const double sign = dot < 0 ? -1 : 1, angle = std::acos(std::min(std::fabs(dot), 1.0));
    const double sine = std::sin(angle);
    const bool is_close = sine < 1e-6;
    const double from = is_close ? 1 - t : std::sin((1 - t) * angle) / sine;
    const double to = sign * (is_close ? t : std::sin(t * angle) / sine);
    for (int i = 0; i < 4; i++)
        out[i] = from * a[i] + to * b[i];
}

std::vector<double> rotation_linear(const curve &c, size_t key, double t)
{
    std::vector<double> out(4);
    double a[4], b[4];
    for (size_t i = 0; i < 4; i++) {
        a[i] = c.at(key, 0, i);
        b[i] = c.at(key + 1, 0, i);
    }
    rotation_mix(a, b, t, out.data());
    return out;
}

// Hermite's spline (appendix C.5); tangents are per second.
double cubic(const curve &c, size_t key, size_t component, double t, double seconds)
{
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * c.at(key, 1, component) +
           (t3 - 2 * t2 + t) * seconds * c.at(key, 2, component) +
           (3 * t2 - 2 * t3) * c.at(key + 1, 1, component) +
           (t3 - t2) * seconds * c.at(key + 1, 0, component);
}

// The value of one key, where nothing lies between two.
std::vector<double> key_value(const curve &c, size_t key)
{
    std::vector<double> out(c.components);
    for (size_t i = 0; i < c.components; i++)
        out[i] = c.at(key, c.is_cubic ? 1 : 0, i);
    return out;
}

std::vector<double> curve_sample(const curve &c, double time_s, bool is_rotation)
{
    const auto after = std::upper_bound(c.times.begin(), c.times.end(), time_s, [](double time, float key) {
        return time < static_cast<double>(key);
    });
    if (after == c.times.begin())
        return key_value(c, 0);
    const size_t key = static_cast<size_t>(after - c.times.begin()) - 1;
    if (after == c.times.end() || c.is_step)
        return key_value(c, key);
    const double start = static_cast<double>(c.times[key]), seconds = static_cast<double>(*after) - start;
    const double t = (time_s - start) / seconds;
    if (is_rotation && !c.is_cubic)
        return rotation_linear(c, key, t);
    std::vector<double> out(c.components);
    for (size_t i = 0; i < c.components; i++)
        out[i] = c.is_cubic ? cubic(c, key, i, t, seconds)
                            : c.at(key, 0, i) + t * (c.at(key + 1, 0, i) - c.at(key, 0, i));
    return out;
}

void channel_apply(importer &in, const animation_channel &channel)
{
    const bool is_weights = channel.path == animated::weights;
    if (static_cast<size_t>(channel.node) >= in.model.nodes.size())
        fail("%s: node %d is out of range, there are %zu", channel.label.c_str(), channel.node,
             in.model.nodes.size());
    tinygltf::Node &node = in.model.nodes[static_cast<size_t>(channel.node)];
    if (!is_weights && !node.matrix.empty())
        fail("%s: node %d has a matrix, which cannot be animated", channel.label.c_str(), channel.node);
    node.*paths[static_cast<size_t>(channel.path)].values =
        curve_sample(curve_read(in, channel), in.pose->time_s, channel.path == animated::rotation);
}

} // namespace

void animations_take(importer &in, const cJSON *document)
{
    const std::vector<const cJSON *> animations = items_of(document, "animations");
    for (size_t a = 0; a < animations.size(); a++) {
        const std::vector<const cJSON *> samplers = items_of(animations[a], "samplers");
        const std::vector<const cJSON *> channels = items_of(animations[a], "channels");
        for (size_t c = 0; c < channels.size(); c++)
            channel_take(in, a, c, channels[c], samplers);
    }
}

void animations_apply(importer &in)
{
    if (in.pose == nullptr)
        return;
    std::set<std::pair<int, animated>> moved;
    for (const animation_channel &channel : in.channels)
        if (moved.emplace(channel.node, channel.path).second)
            channel_apply(in, channel);
}

} // namespace gltf
