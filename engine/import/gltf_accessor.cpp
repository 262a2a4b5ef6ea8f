#include "engine/import/gltf_accessor.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cstring>
#include <fmt/core.h>

namespace relume {
namespace {

// An accessor whose elements are known to lie inside their buffer.
struct Elements {
    const unsigned char* data;
    size_t count, stride;
};

const tinygltf::Accessor& accessorAt(const tinygltf::Model& model, int index, const std::string& name) {
    if (index < 0 || size_t(index) >= model.accessors.size())
        throw Error(fmt::format("{}: refers to accessor {}, but there are only {}", name, index,
                                model.accessors.size()));
    return model.accessors[size_t(index)];
}

const char* typeName(int type) {
    switch (type) {
    case TINYGLTF_TYPE_VEC2:
        return "VEC2";
    case TINYGLTF_TYPE_VEC3:
        return "VEC3";
    case TINYGLTF_TYPE_VEC4:
        return "VEC4";
    default:
        return "SCALAR";
    }
}

Elements locate(const tinygltf::Model& model, int index, int type, const std::string& name) {
    const tinygltf::Accessor& accessor = accessorAt(model, index, name);
    if (accessor.type != type)
        throw Error(
            fmt::format("{}: accessor {} has the wrong type: expected {}", name, index, typeName(type)));
    if (accessor.sparse.isSparse)
        throw Error(
            fmt::format("{}: accessor {} is sparse, which is not supported: export without sparse accessors",
                        name, index));
    const std::span<const unsigned char> view = gltfViewBytes(model, accessor.bufferView, name);
    const size_t viewStride = model.bufferViews[size_t(accessor.bufferView)].byteStride;
    const int componentSize = tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType));
    const size_t size =
        size_t(std::max(componentSize, 1)) * size_t(tinygltf::GetNumComponentsInType(uint32_t(type)));
    const size_t stride = viewStride > 0 ? viewStride : size;
    const bool isInside = componentSize > 0 && accessor.byteOffset <= view.size() && stride >= size &&
                          accessor.count > 0 && size <= view.size() - accessor.byteOffset &&
                          accessor.count - 1 <= (view.size() - accessor.byteOffset - size) / stride;
    if (!isInside)
        throw Error(fmt::format(
            "{}: accessor {} ({} elements, stride {}) does not fit in its buffer view of {} bytes: the "
            "file is truncated or corrupt",
            name, index, accessor.count, stride, view.size()));
    return {view.data() + accessor.byteOffset, accessor.count, stride};
}

template <typename T>
T load(const unsigned char* data) {
    T value;
    std::memcpy(&value, data, sizeof value);
    return value;
}

template <typename T>
float loadNormalized(const unsigned char* data, bool isNormalized) {
    const float value = float(load<T>(data));
    return isNormalized ? std::max(value / float(std::numeric_limits<T>::max()), -1.0f) : value;
}

float loadComponent(const unsigned char* data, const tinygltf::Accessor& accessor, const std::string& name) {
    switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return load<float>(data);
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return loadNormalized<int8_t>(data, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return loadNormalized<uint8_t>(data, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return loadNormalized<int16_t>(data, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return loadNormalized<uint16_t>(data, accessor.normalized);
    default:
        throw Error(
            fmt::format("{}: an accessor of vectors has component type {}", name, accessor.componentType));
    }
}

// `components` of each element of this type go into a Vector, whose others are 0.
template <typename Vector>
std::vector<Vector> readVectors(const tinygltf::Model& model, int index, int type, int components,
                                const std::string& name) {
    const Elements elements = locate(model, index, type, name);
    const tinygltf::Accessor& accessor = model.accessors[size_t(index)];
    const size_t step = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType)));
    std::vector<Vector> values(elements.count, Vector(0));
    for (size_t i = 0; i < elements.count; i++)
        for (int axis = 0; axis < components; axis++)
            values[i][axis] =
                loadComponent(elements.data + i * elements.stride + size_t(axis) * step, accessor, name);
    return values;
}

} // namespace

std::span<const unsigned char> gltfViewBytes(const tinygltf::Model& model, int index,
                                             const std::string& name) {
    if (index < 0 || size_t(index) >= model.bufferViews.size())
        throw Error(fmt::format("{}: refers to buffer view {}, but there are only {}", name, index,
                                model.bufferViews.size()));
    const tinygltf::BufferView& view = model.bufferViews[size_t(index)];
    if (view.buffer < 0 || size_t(view.buffer) >= model.buffers.size())
        throw Error(fmt::format("{}: buffer view {} refers to buffer {}, but there are only {}", name, index,
                                view.buffer, model.buffers.size()));
    const std::vector<unsigned char>& buffer = model.buffers[size_t(view.buffer)].data;
    if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset)
        throw Error(fmt::format(
            "{}: buffer view {} does not fit in its buffer of {} bytes: the file is truncated or corrupt",
            name, index, buffer.size()));
    return std::span(buffer).subspan(view.byteOffset, view.byteLength);
}

std::vector<vec3> readGltfVectors(const tinygltf::Model& model, int index, const std::string& name) {
    return readVectors<vec3>(model, index, TINYGLTF_TYPE_VEC3, 3, name);
}

std::vector<vec2> readGltfUvs(const tinygltf::Model& model, int index, const std::string& name) {
    return readVectors<vec2>(model, index, TINYGLTF_TYPE_VEC2, 2, name);
}

std::vector<vec4> readGltfFourVectors(const tinygltf::Model& model, int index, const std::string& name) {
    if (accessorAt(model, index, name).type == TINYGLTF_TYPE_VEC3)
        return readVectors<vec4>(model, index, TINYGLTF_TYPE_VEC3, 3, name);
    return readVectors<vec4>(model, index, TINYGLTF_TYPE_VEC4, 4, name);
}

std::vector<uint32_t> readGltfIndices(const tinygltf::Model& model, int index, const std::string& name) {
    const Elements elements = locate(model, index, TINYGLTF_TYPE_SCALAR, name);
    std::vector<uint32_t> values(elements.count);
    for (size_t i = 0; i < elements.count; i++) {
        const unsigned char* data = elements.data + i * elements.stride;
        switch (model.accessors[size_t(index)].componentType) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            values[i] = *data;
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            values[i] = load<uint16_t>(data);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            values[i] = load<uint32_t>(data);
            break;
        default:
            throw Error(fmt::format("{}: accessor {} of indices is not of an unsigned type", name, index));
        }
    }
    return values;
}

} // namespace relume
