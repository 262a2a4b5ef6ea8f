#include "engine/import/gltf_geometry.h"

#include "engine/base/error.h"
#include "engine/base/log.h"
#include "engine/import/gltf_accessor.h"
#include "engine/import/mesh_cleanup.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <numeric>

namespace relume {
namespace {

using glm::dmat4;
using glm::dvec3;

dmat4 transformOf(const tinygltf::Node& node, const std::string& name) {
    const auto check = [&](const std::vector<double>& values, size_t count) {
        if (!values.empty() && values.size() != count)
            throw Error(fmt::format("{}: node \"{}\": a transform has {} numbers, expected {}", name,
                                    node.name, values.size(), count));
        return !values.empty();
    };
    if (check(node.matrix, 16)) return glm::make_mat4(node.matrix.data());
    dmat4 transform(1);
    if (check(node.translation, 3))
        transform[3] = glm::dvec4(node.translation[0], node.translation[1], node.translation[2], 1);
    if (check(node.rotation, 4)) {
        const glm::dquat turn(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
        transform *= glm::mat4_cast(glm::normalize(turn));
    }
    if (check(node.scale, 3))
        for (int axis = 0; axis < 3; axis++) transform[axis] *= node.scale[size_t(axis)];
    return transform;
}

// Corners of a primitive's triangles, three a triangle, whichever way they are strung together.
std::vector<uint32_t> triangleCorners(const std::vector<uint32_t>& order, int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES) return {order.begin(), order.end() - ptrdiff_t(order.size() % 3)};
    std::vector<uint32_t> corners;
    for (size_t i = 2; i < order.size(); i++) {
        const bool isFan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
        const bool isOdd = !isFan && i % 2 == 1;
        const uint32_t a = isFan ? order[0] : order[i - 2], b = order[i - 1], c = order[i];
        corners.insert(corners.end(), {isOdd ? b : a, isOdd ? a : b, c});
    }
    return corners;
}

class SceneReader {
  public:
    SceneReader(const tinygltf::Model& model, const GltfWishes& requests, const std::string& name)
        : mModel(model), mWishes(requests), mName(name), mVisited(model.nodes.size(), false) {}

    std::map<int, Mesh> read() {
        if (mModel.scenes.empty()) {
            // Without a scene, every node that is no child is a root.
            std::vector<bool> isChild(mModel.nodes.size(), false);
            for (const tinygltf::Node& node : mModel.nodes)
                for (const int child : node.children)
                    if (child >= 0 && size_t(child) < isChild.size()) isChild[size_t(child)] = true;
            for (size_t i = 0; i < isChild.size(); i++)
                if (!isChild[i]) mStack.push_back({int(i), dmat4(1)});
        } else {
            const int scene = std::max(mModel.defaultScene, 0);
            if (size_t(scene) >= mModel.scenes.size())
                throw Error(fmt::format("{}: its default scene {} does not exist", mName, scene));
            for (const int node : mModel.scenes[size_t(scene)].nodes) mStack.push_back({node, dmat4(1)});
        }
        // Roots and children are pushed last to first, so that meshes come out in the file's order.
        std::reverse(mStack.begin(), mStack.end());
        while (!mStack.empty()) visitNext();
        return std::move(mMeshes);
    }

  private:
    struct Visit {
        int node;
        dmat4 transform;
    };

    void visitNext() {
        const Visit visit = mStack.back();
        mStack.pop_back();
        if (visit.node < 0 || size_t(visit.node) >= mModel.nodes.size())
            throw Error(fmt::format("{}: refers to node {}, but there are only {}", mName, visit.node,
                                    mModel.nodes.size()));
        if (mVisited[size_t(visit.node)])
            throw Error(
                fmt::format("{}: node {} has more than one parent: expected a tree", mName, visit.node));
        mVisited[size_t(visit.node)] = true;
        const tinygltf::Node& node = mModel.nodes[size_t(visit.node)];
        const dmat4 transform = visit.transform * transformOf(node, mName);
        if (node.mesh >= 0) {
            if (size_t(node.mesh) >= mModel.meshes.size())
                throw Error(fmt::format("{}: refers to mesh {}, but there are only {}", mName, node.mesh,
                                        mModel.meshes.size()));
            for (const tinygltf::Primitive& primitive : mModel.meshes[size_t(node.mesh)].primitives)
                addPrimitive(primitive, transform);
        }
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            mStack.push_back({*child, transform});
    }

    void addPrimitive(const tinygltf::Primitive& primitive, const dmat4& transform) {
        if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
            log(LogLevel::Warning, fmt::format("{}: skipped points or lines", mName));
            return;
        }
        if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
            throw Error(fmt::format("{}: a primitive has mode {}: expected 0 to {}: export the file again",
                                    mName, primitive.mode, TINYGLTF_MODE_TRIANGLE_FAN));
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) return;
        const std::vector<vec3> positions = readGltfVectors(mModel, position->second, mName);
        std::vector<uint32_t> order(positions.size());
        std::iota(order.begin(), order.end(), 0u);
        if (primitive.indices >= 0) order = readGltfIndices(mModel, primitive.indices, mName);
        const std::vector<uint32_t> corners = triangleCorners(order, primitive.mode);
        mVertices += positions.size();
        mTriangles += corners.size() / 3;
        if (mVertices > kMostMeshVertices || mTriangles > kMostMeshTriangles)
            throw Error(fmt::format("{}: unfolds to more than {} vertices or triangles: simplify it", mName,
                                    kMostMeshVertices));

        Mesh& mesh = mMeshes[std::max(primitive.material, -1)];
        addTriangles(mesh, corners, positions.size(), glm::determinant(glm::dmat3(transform)) < 0);
        addNormals(mesh, primitive, positions.size(), glm::dmat3(transform));
        addTangents(mesh, primitive, positions.size(), glm::dmat3(transform));
        addAttributes(mesh, primitive, positions.size());
        for (const vec3& p : positions) mesh.positions.push_back(vec3(transform * glm::dvec4(p, 1)));
    }

    // Before the `count` vertices that they refer to are in the mesh. Mirrored ones are turned over.
    void addTriangles(Mesh& mesh, const std::vector<uint32_t>& corners, size_t count, bool isMirrored) const {
        const uint32_t first = uint32_t(mesh.vertexCount());
        for (size_t i = 0; i + 2 < corners.size(); i += 3) {
            for (size_t corner = i; corner < i + 3; corner++)
                if (corners[corner] >= count)
                    throw Error(fmt::format(
                        "{}: a triangle refers to vertex {}, but its primitive has only {}: the file is "
                        "corrupt",
                        mName, corners[corner], count));
            uvec3 triangle = uvec3(corners[i], corners[i + 1], corners[i + 2]) + first;
            if (isMirrored) std::swap(triangle.y, triangle.z);
            mesh.triangles.push_back(triangle);
        }
    }

    void checkCount(const std::string& attribute, size_t found, size_t expected) const {
        if (found != expected)
            throw Error(fmt::format(
                "{}: a primitive has {} of {} vertices, but POSITION of {}: export the file again", mName,
                attribute, found, expected));
    }

    void addNormals(Mesh& mesh, const tinygltf::Primitive& primitive, size_t count,
                    const glm::dmat3& linear) const {
        const auto normal = primitive.attributes.find("NORMAL");
        std::vector<vec3> normals;
        if (normal != primitive.attributes.end()) {
            normals = readGltfVectors(mModel, normal->second, mName);
            checkCount("NORMAL", normals.size(), count);
        }
        // No normal has length zero: zeros here make cleanUp() discard all of them.
        normals.resize(count, vec3(0));
        const double orientation = glm::determinant(linear) < 0 ? -1 : 1;
        // The cofactor matrix turns normals even where the transform cannot be inverted.
        const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                   glm::cross(linear[0], linear[1]));
        for (const vec3& n : normals) {
            const dvec3 turned = orientation * (cofactors * dvec3(n));
            const double length = glm::length(turned);
            mesh.normals.push_back(length > 0 ? vec3(turned / length) : vec3(0));
        }
    }

    // Adds zeros where the file has no tangents, or none that can be read: few materials need them. Materials
    // turn them counter-clockwise; where the bitangent lies on the other side, they are turned back twice.
    void addTangents(Mesh& mesh, const tinygltf::Primitive& primitive, size_t count,
                     const glm::dmat3& linear) const {
        const auto found = primitive.attributes.find("TANGENT");
        std::vector<vec4> tangents;
        try {
            if (found != primitive.attributes.end()) {
                tangents = readGltfFourVectors(mModel, found->second, mName);
                checkCount("TANGENT", tangents.size(), count);
            }
        } catch (const Error& unreadable) {
            log(LogLevel::Warning,
                fmt::format("{}; brushed materials do without its tangents", unreadable.what()));
            tangents.clear();
        }
        tangents.resize(count, vec4(0));
        const double back = -2 * double(mWishes(std::max(primitive.material, -1)).brushRotation);
        const bool isMirrored = glm::determinant(linear) < 0;
        for (const vec4& tangent : tangents) {
            const dvec3 normal = mesh.normals[mesh.tangents.size()];
            dvec3 turned = linear * dvec3(tangent);
            if ((tangent.w < 0) != isMirrored)
                turned = std::cos(back) * turned + std::sin(back) * glm::cross(normal, turned);
            const double length = glm::length(turned);
            mesh.tangents.push_back(length > 0 ? vec3(turned / length) : vec3(0));
        }
    }

    void addAttributes(Mesh& mesh, const tinygltf::Primitive& primitive, size_t count) const {
        const GltfWish wish = mWishes(std::max(primitive.material, -1));
        const auto uv = primitive.attributes.find(fmt::format("TEXCOORD_{}", wish.uvSet));
        if (wish.attributes.uvs && uv != primitive.attributes.end()) {
            const std::vector<vec2> uvs = readGltfUvs(mModel, uv->second, mName);
            checkCount(uv->first, uvs.size(), count);
            for (const vec2& place : uvs) mesh.uvs.push_back(vec2(wish.uvTransform * vec3(place, 1)));
        }
        const auto color = primitive.attributes.find("COLOR_0");
        const bool hasColors = color != primitive.attributes.end();
        if (!wish.attributes.colors || (!hasColors && !wish.isTint)) return;
        std::vector<vec4> colors(count, vec4(1));
        try {
            if (hasColors) {
                colors = readGltfFourVectors(mModel, color->second, mName);
                checkCount("COLOR_0", colors.size(), count);
                // Without alpha, a tint is opaque.
                if (wish.isTint && mModel.accessors[size_t(color->second)].type == TINYGLTF_TYPE_VEC3)
                    for (vec4& one : colors) one.w = 1;
            }
        } catch (const Error& unreadable) {
            if (!wish.isTint) throw;
            log(LogLevel::Warning,
                fmt::format("{}; its vertex colors are taken for white", unreadable.what()));
            colors.assign(count, vec4(1));
        }
        mesh.colors.insert(mesh.colors.end(), colors.begin(), colors.end());
    }

    const tinygltf::Model& mModel;
    const GltfWishes& mWishes;
    const std::string& mName;
    std::vector<bool> mVisited;
    std::vector<Visit> mStack;
    std::map<int, Mesh> mMeshes;
    size_t mVertices = 0, mTriangles = 0;
};

} // namespace

std::map<int, Mesh> readGltfGeometry(const tinygltf::Model& model, const GltfWishes& requests,
                                     const std::string& name) {
    return SceneReader(model, requests, name).read();
}

} // namespace relume
