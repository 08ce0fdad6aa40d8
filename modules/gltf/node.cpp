// SPDX-License-Identifier: MIT
//
// The node graph: checked to be a forest, then walked from the scene's roots with matrices in double.
#include "import.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gltf
{

namespace
{

matrix4 local_matrix(const tinygltf::Node &node, const std::string &what)
{
    if (node.matrix.size() == 16)
        return matrix_from_list(node.matrix, what);
    matrix4 out = node.rotation.size() == 4 ? rotation_matrix(node.rotation) : identity;
    for (size_t column = 0; column < 3 && node.scale.size() == 3; column++)
        for (size_t row = 0; row < 3; row++)
            out.m[4 * column + row] *= node.scale[column];
    for (size_t row = 0; row < 3 && node.translation.size() == 3; row++)
        out.m[12 + row] = node.translation[row];
    return out;
}

// The parent of each node, or -1.
std::vector<int> parents_find(const tinygltf::Model &model)
{
    std::vector<int> parents(model.nodes.size(), -1);
    for (size_t i = 0; i < model.nodes.size(); i++)
        for (const int child : model.nodes[i].children) {
            if (child < 0 || static_cast<size_t>(child) >= model.nodes.size())
                fail("%s: child %d is out of range, there are %zu nodes", label("nodes", i).c_str(), child,
                     model.nodes.size());
            if (parents[static_cast<size_t>(child)] >= 0)
                fail("%s has two parents", label("nodes", static_cast<size_t>(child)).c_str());
            parents[static_cast<size_t>(child)] = static_cast<int>(i);
        }
    return parents;
}

// With one parent each, a node is on a cycle, or below one, if its ancestors never end.
void cycles_refuse(const std::vector<int> &parents)
{
    constexpr int unvisited = -1;
    std::vector<int> visited_by(parents.size(), unvisited);
    for (size_t start = 0; start < parents.size(); start++) {
        for (int node = static_cast<int>(start); node >= 0; node = parents[static_cast<size_t>(node)]) {
            int &mark = visited_by[static_cast<size_t>(node)];
            if (mark == static_cast<int>(start))
                fail("%s is its own ancestor: the nodes are cyclic", label("nodes", start).c_str());
            if (mark != unvisited)
                break;
            mark = static_cast<int>(start);
        }
    }
}

std::vector<int> roots_find(const tinygltf::Model &model, const std::vector<int> &parents)
{
    if (!model.scenes.empty()) {
        const size_t scene = model.defaultScene < 0 ? 0 : static_cast<size_t>(model.defaultScene);
        if (scene >= model.scenes.size())
            fail("scene %zu is out of range, there are %zu", scene, model.scenes.size());
        return model.scenes[scene].nodes;
    }
    std::vector<int> roots;
    for (size_t i = 0; i < parents.size(); i++)
        if (parents[i] < 0)
            roots.push_back(static_cast<int>(i));
    return roots;
}

// What the walk collects; moved into the scene at its end.
struct collection {
    std::vector<gltf_instance> instances;
    std::vector<gltf_light> lights;
    std::vector<gltf_camera> cameras;
    std::vector<bool> visited;
    std::vector<int> order;      // of the nodes that the scene shows
    std::vector<matrix4> worlds; // of all nodes; the identity for those that it does not show

    ~collection()
    {
        for (gltf_instance &instance : instances)
            free(instance.node_name);
        for (gltf_light &light : lights)
            free(light.name);
        for (gltf_camera &camera : cameras)
            free(camera.name);
    }
};

// What moves the vertices of a node's mesh.
struct motion {
    std::vector<double> weights;
    std::vector<matrix4> joints; // empty: none
};

motion motion_read(importer &in, const collection &out, const tinygltf::Node &node, matrix4 &world,
                   const std::string &what)
{
    motion m;
    m.weights = node.weights.empty() ? in.model.meshes[static_cast<size_t>(node.mesh)].weights : node.weights;
    if (node.skin < 0)
        return m;
    double origin[3];
    m.joints = joint_matrices(in, node.skin, out.worlds, origin, what);
    world = identity; // that of the node is of no account where joints are
    std::copy_n(origin, 3, &world.m[12]);
    return m;
}

void instances_add(importer &in, collection &out, const tinygltf::Node &node, const matrix4 &world,
                   const std::string &what)
{
    if (static_cast<size_t>(node.mesh) >= in.mesh_primitives.size())
        fail("%s: mesh %d is out of range, there are %zu", what.c_str(), node.mesh,
             in.mesh_primitives.size());
    const std::vector<uint32_t> &primitives = in.mesh_primitives[static_cast<size_t>(node.mesh)];
    uint64_t count = out.instances.size();
    bound_take(in, count, primitives.size(), instance_bound, what);
    matrix4 posed = world;
    const motion moved = motion_read(in, out, node, posed, what);
    for (const uint32_t primitive : primitives) {
        const auto rigged = in.rigs.find(primitive);
        const bool is_skinned =
            rigged != in.rigs.end() && !moved.joints.empty() && !rigged->second.rest.influences.empty();
        gltf_instance instance = {};
        instance.primitive =
            rigged == in.rigs.end() ? primitive : rig_pose(in, primitive, moved.weights, moved.joints, what);
        std::copy_n((is_skinned ? posed : world).m, 16, instance.transform);
        out.instances.push_back(instance);
        out.instances.back().node_name = name_copy(node.name);
    }
}

void node_import(importer &in, collection &out, int index)
{
    const tinygltf::Node &node = in.model.nodes[static_cast<size_t>(index)];
    const matrix4 &world = out.worlds[static_cast<size_t>(index)];
    const std::string what = label("nodes", static_cast<size_t>(index));
    if (!std::all_of(std::begin(world.m), std::end(world.m), [](double v) { return std::isfinite(v); }))
        fail("%s: the transform is not finite", what.c_str());
    if (node.mesh >= 0)
        instances_add(in, out, node, world, what);
    if (node.camera >= 0)
        camera_import(in, out.cameras, node.camera, world);
    const auto light = node.extensions.find("KHR_lights_punctual");
    if (light != node.extensions.end())
        light_import(in, out.lights, light->second.Get("light").GetNumberAsInt(), world);
}

struct pending_node {
    int index;
    matrix4 parent;
};

// The transforms of a node and all below it, and in which order they come. A stack of its own: a chain of
// nodes may be deeper than the thread's.
void subtree_walk(const importer &in, collection &out, int root)
{
    std::vector<pending_node> pending = { { root, identity } };
    while (!pending.empty()) {
        const pending_node next = pending.back();
        pending.pop_back();
        if (next.index < 0 || static_cast<size_t>(next.index) >= in.model.nodes.size())
            fail("the scene's node %d is out of range, there are %zu", next.index, in.model.nodes.size());
        const size_t i = static_cast<size_t>(next.index);
        if (out.visited[i])
            fail("%s is in the scene twice", label("nodes", i).c_str());
        out.visited[i] = true;
        out.order.push_back(next.index);
        out.worlds[i] = multiply(next.parent, local_matrix(in.model.nodes[i], label("nodes", i)));
        const std::vector<int> &children = in.model.nodes[i].children;
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            pending.push_back({ *child, out.worlds[i] });
    }
}

// The box of a transformed box: each axis takes the smaller and the larger product (Arvo 1990, "Transforming
// Axis-Aligned Bounding Boxes").
void bounds_extend(gltf_scene &scene, const gltf_instance &instance)
{
    const gltf_primitive &p = scene.primitives[instance.primitive];
    for (size_t row = 0; row < 3; row++) {
        double least = instance.transform[12 + row], most = least;
        for (size_t column = 0; column < 3; column++) {
            const double a = instance.transform[4 * column + row] * static_cast<double>(p.bounds_min[column]);
            const double b = instance.transform[4 * column + row] * static_cast<double>(p.bounds_max[column]);
            least += std::min(a, b);
            most += std::max(a, b);
        }
        scene.bounds_min[row] = std::min(scene.bounds_min[row], least);
        scene.bounds_max[row] = std::max(scene.bounds_max[row], most);
        if (!std::isfinite(least) || !std::isfinite(most))
            fail("the bounds of node '%.100s' are not finite",
                 instance.node_name == nullptr ? "" : instance.node_name);
    }
}

void bounds_compute(gltf_scene &scene)
{
    const double start = scene.instance_count == 0 ? 0 : std::numeric_limits<double>::infinity();
    std::fill_n(scene.bounds_min, 3, start);
    std::fill_n(scene.bounds_max, 3, -start);
    for (uint32_t i = 0; i < scene.instance_count; i++)
        bounds_extend(scene, scene.instances[i]);
}

template <typename T> void array_hand_over(std::vector<T> &from, T *&to, uint32_t &count)
{
    to = array_copy(from);
    count = static_cast<uint32_t>(from.size());
    from.clear(); // the names belong to the scene now
}

} // namespace

void nodes_import(importer &in)
{
    const std::vector<int> parents = parents_find(in.model);
    cycles_refuse(parents);
    collection out;
    out.visited.assign(in.model.nodes.size(), false);
    out.worlds.assign(in.model.nodes.size(), identity);
    for (const int root : roots_find(in.model, parents))
        subtree_walk(in, out, root);
    for (const int node : out.order)
        node_import(in, out, node);
    gltf_scene &scene = *in.scene;
    array_hand_over(out.instances, scene.instances, scene.instance_count);
    array_hand_over(out.lights, scene.lights, scene.light_count);
    array_hand_over(out.cameras, scene.cameras, scene.camera_count);
    bounds_compute(scene);
}

} // namespace gltf
