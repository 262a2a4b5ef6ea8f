#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/scene/gltf_accessor.h"
#include "engine/scene/mesh_cleanup.h"
#include "engine/scene/mesh_formats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <string_view>

namespace relume {
namespace {

using glm::dmat4;
using glm::dvec3;

// The name under which the binary chunk of a .glb is handed to the library.
constexpr std::string_view kBinaryChunk = "binary-chunk-of-this-file";

// A file's two parts; `binary` is empty but for .glb.
struct Container {
    std::string json;
    std::vector<unsigned char> binary;
};

uint32_t wordAt(std::span<const std::byte> bytes, size_t offset) {
    uint32_t value;
    std::memcpy(&value, &bytes[offset], sizeof value);
    return value;
}

// Takes a binary container apart (glTF 2.0, 4.4); text is taken as it is.
Container openContainer(std::span<const std::byte> bytes, const std::string& name) {
    constexpr uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
    if (bytes.size() < 12 || wordAt(bytes, 0) != kMagic)
        return {std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), {}};
    if (wordAt(bytes, 4) != 2)
        throw Error("{}: is binary glTF {}: expected version 2", name, wordAt(bytes, 4));
    if (wordAt(bytes, 8) > bytes.size())
        throw Error("{}: is truncated: expected {} bytes, found {}", name, wordAt(bytes, 8), bytes.size());
    Container container;
    for (size_t start = 12; start + 8 <= bytes.size();) {
        const size_t size = wordAt(bytes, start), kind = wordAt(bytes, start + 4);
        start += 8;
        if (size > bytes.size() - start)
            throw Error("{}: is truncated within a chunk of {} bytes", name, size);
        const auto* data = reinterpret_cast<const unsigned char*>(bytes.data()) + start;
        if (kind == kJson && container.json.empty()) container.json.assign(data, data + size);
        if (kind == kBinary && container.binary.empty()) container.binary.assign(data, data + size);
        start += size;
    }
    return container;
}

// Keeps of the document what geometry needs. The library indexes buffers by numbers from materials and
// images unchecked, and recurses into extras as deep as a file likes.
nlohmann::json readGeometry(const std::string& text, const std::string& name) {
    using Json = nlohmann::json;
    static constexpr std::array<std::string_view, 9> kKept = {"asset",       "scene",   "scenes",
                                                              "nodes",       "meshes",  "accessors",
                                                              "bufferViews", "buffers", "extensionsRequired"};
    const auto keep = [&](int depth, Json::parse_event_t event, Json& parsed) {
        if (depth > 64) throw Error("{}: is nested deeper than any glTF file", name);
        if (event != Json::parse_event_t::key) return true;
        const std::string& key = parsed.get_ref<const std::string&>();
        if (depth == 1) return std::find(kKept.begin(), kKept.end(), key) != kKept.end();
        return key != "extras" && key != "extensions" && key != "targets";
    };
    try {
        return Json::parse(text, keep);
    } catch (const Json::exception& failure) {
        throw Error("{}: is not valid glTF: {}", name, failure.what());
    }
}

// Throws if the file cannot be understood without an extension that changes geometry.
void checkExtensions(const nlohmann::json& document, const std::string& name) {
    const auto required = document.find("extensionsRequired");
    if (required == document.end() || !required->is_array()) return;
    for (const auto& extension : *required) {
        const std::string text = extension.is_string() ? extension.get<std::string>() : extension.dump();
        if (!text.starts_with("KHR_materials_") && !text.starts_with("KHR_texture_") &&
            !text.starts_with("EXT_texture_") && text != "KHR_mesh_quantization" &&
            text != "KHR_lights_punctual")
            throw Error("{}: requires the glTF extension {}, which is not supported: export without it "
                        "(uncompressed)",
                        name, text);
    }
}

// What the library may read: the binary chunk, and files in the folder of the glTF file and below.
struct FileAccess {
    std::string folder;
    const std::vector<unsigned char>* binary;

    bool isBinary(const std::string& path) const { return path == folder + "/" + std::string(kBinaryChunk); }
    bool isInside(const std::string& path) const {
        const auto relative = std::filesystem::path(path).lexically_normal().lexically_relative(
            std::filesystem::path(folder).lexically_normal());
        return !relative.empty() && *relative.begin() != ".." && std::filesystem::is_regular_file(path);
    }
};

tinygltf::FsCallbacks callbacksOf(FileAccess& access) {
    const auto exists = [](const std::string& path, void* data) {
        const auto& files = *static_cast<FileAccess*>(data);
        return files.isBinary(path) || files.isInside(path);
    };
    const auto read = [](std::vector<unsigned char>* out, std::string* failure, const std::string& path,
                         void* data) {
        const auto& files = *static_cast<FileAccess*>(data);
        if (files.isBinary(path)) {
            *out = *files.binary;
            return true;
        }
        try {
            const std::vector<std::byte> bytes = readFile(path);
            const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
            out->assign(first, first + bytes.size());
            return true;
        } catch (const Error& error) {
            *failure = error.what();
            return false;
        }
    };
    return {exists, [](const std::string& path, void*) { return path; }, read,
            [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; },
            &access};
}

tinygltf::Model readModel(Container container, const std::filesystem::path& folder, const std::string& name) {
    nlohmann::json document = readGeometry(container.json, name);
    checkExtensions(document, name);
    // The first buffer of a .glb has no address: it is the binary chunk, without its padding.
    const auto buffers = document.find("buffers");
    if (!container.binary.empty() && buffers != document.end() && buffers->is_array() && !buffers->empty() &&
        buffers->front().is_object() && !buffers->front().contains("uri")) {
        buffers->front()["uri"] = kBinaryChunk;
        const auto length = buffers->front().find("byteLength");
        if (length != buffers->front().end() && length->is_number_unsigned())
            container.binary.resize(std::min(container.binary.size(), length->get<size_t>()));
    }
    FileAccess access{folder.empty() ? "." : folder.string(), &container.binary};
    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks(callbacksOf(access));
    reader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int,
                             const unsigned char*, int, void*) { return true; },
                          nullptr);
    tinygltf::Model model;
    std::string failure, warning;
    const std::string text = document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    if (text.size() > std::numeric_limits<unsigned>::max()) throw Error("{}: is too large", name);
    const bool isRead = reader.LoadASCIIFromString(&model, &failure, &warning, text.data(),
                                                   unsigned(text.size()), access.folder);
    if (!isRead || !failure.empty())
        throw Error("{}: is not valid glTF: {}", name,
                    failure.substr(0, std::min(failure.find_last_not_of('\n') + 1, size_t(400))));
    return model;
}

dmat4 transformOf(const tinygltf::Node& node, const std::string& name) {
    const auto check = [&](const std::vector<double>& values, size_t count) {
        if (!values.empty() && values.size() != count)
            throw Error("{}: node \"{}\": a transform has {} numbers, expected {}", name, node.name,
                        values.size(), count);
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
    SceneReader(const tinygltf::Model& model, const std::string& name)
        : mModel(model), mName(name), mVisited(model.nodes.size(), false) {}

    Mesh read() {
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
                throw Error("{}: its default scene {} does not exist", mName, scene);
            for (const int node : mModel.scenes[size_t(scene)].nodes) mStack.push_back({node, dmat4(1)});
        }
        // Roots and children are pushed last to first, so that meshes come out in the file's order.
        std::reverse(mStack.begin(), mStack.end());
        while (!mStack.empty()) visitNext();
        return std::move(mMesh);
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
            throw Error("{}: refers to node {}, but there are only {}", mName, visit.node,
                        mModel.nodes.size());
        if (mVisited[size_t(visit.node)])
            throw Error("{}: node {} has more than one parent: expected a tree", mName, visit.node);
        mVisited[size_t(visit.node)] = true;
        const tinygltf::Node& node = mModel.nodes[size_t(visit.node)];
        const dmat4 transform = visit.transform * transformOf(node, mName);
        if (node.mesh >= 0) {
            if (size_t(node.mesh) >= mModel.meshes.size())
                throw Error("{}: refers to mesh {}, but there are only {}", mName, node.mesh,
                            mModel.meshes.size());
            for (const tinygltf::Primitive& primitive : mModel.meshes[size_t(node.mesh)].primitives)
                addPrimitive(primitive, transform);
        }
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            mStack.push_back({*child, transform});
    }

    void addPrimitive(const tinygltf::Primitive& primitive, const dmat4& transform) {
        if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
            spdlog::warn("{}: skipped points or lines", mName);
            return;
        }
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) return;
        const std::vector<vec3> positions = readGltfVectors(mModel, position->second, mName);
        const auto normal = primitive.attributes.find("NORMAL");
        std::vector<vec3> normals;
        if (normal != primitive.attributes.end()) normals = readGltfVectors(mModel, normal->second, mName);
        // No normal has length zero: zeros here make cleanUp() discard all of them.
        normals.resize(positions.size(), vec3(0));

        std::vector<uint32_t> order;
        if (primitive.indices >= 0) {
            order = readGltfIndices(mModel, primitive.indices, mName);
        } else {
            for (size_t i = 0; i < positions.size(); i++) order.push_back(uint32_t(i));
        }
        const std::vector<uint32_t> corners = triangleCorners(order, primitive.mode);
        if (mMesh.vertexCount() + positions.size() > kMostMeshVertices ||
            mMesh.triangleCount() + corners.size() / 3 > kMostMeshTriangles)
            throw Error("{}: unfolds to more than {} vertices or triangles: simplify it", mName,
                        kMostMeshVertices);

        const glm::dmat3 linear(transform);
        const double orientation = glm::determinant(linear) < 0 ? -1 : 1;
        // The cofactor matrix turns normals even where the transform cannot be inverted.
        const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                   glm::cross(linear[0], linear[1]));
        const uint32_t first = uint32_t(mMesh.vertexCount());
        for (const vec3& p : positions) mMesh.positions.push_back(vec3(transform * glm::dvec4(p, 1)));
        for (const vec3& n : normals) {
            const dvec3 turned = orientation * (cofactors * dvec3(n));
            const double length = glm::length(turned);
            mMesh.normals.push_back(length > 0 ? vec3(turned / length) : vec3(0));
        }
        for (size_t i = 0; i + 2 < corners.size(); i += 3) {
            for (size_t corner = i; corner < i + 3; corner++)
                if (corners[corner] >= positions.size())
                    throw Error(
                        "{}: a triangle refers to vertex {}, but its primitive has only {}: the file is "
                        "corrupt",
                        mName, corners[corner], positions.size());
            uvec3 triangle = uvec3(corners[i], corners[i + 1], corners[i + 2]) + first;
            if (orientation < 0) std::swap(triangle.y, triangle.z);
            mMesh.triangles.push_back(triangle);
        }
    }

    const tinygltf::Model& mModel;
    const std::string& mName;
    std::vector<bool> mVisited;
    std::vector<Visit> mStack;
    Mesh mMesh;
};

} // namespace

Mesh decodeGltf(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                const std::string& name) {
    const tinygltf::Model model = readModel(openContainer(bytes, name), folder, name);
    return SceneReader(model, name).read();
}

} // namespace relume
