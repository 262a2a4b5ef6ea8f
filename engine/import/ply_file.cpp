// Reads PLY files without a library: libraries trust a file's counts, and checking those would mean walking
// the whole file, which is all there is to reading it. Format: Turk, "The PLY Polygon File Format", 1994.
#include "engine/base/error.h"
#include "engine/import/mesh_formats.h"
#include "engine/import/ply_header.h"
#include "engine/import/polygon.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/core.h>
#include <optional>
#include <string_view>

namespace relume {
namespace {

constexpr size_t kMostPlyCorners = 1 << 16;

// Takes values from the data one by one.
class Values {
  public:
    Values(std::span<const std::byte> data, PlyEncoding encoding, const std::string& name)
        : mData(data), mEncoding(encoding), mName(name) {}

    double take(const PlyScalarType& type) {
        return mEncoding == PlyEncoding::Ascii ? takeWord() : takeBinary(type);
    }

    // Returns whether the remaining bytes can hold this many values of a type.
    bool canHold(uint64_t values, const PlyScalarType& type) const {
        const size_t smallest = mEncoding == PlyEncoding::Ascii ? 1 : type.size;
        return values <= mData.size() / smallest;
    }

    [[noreturn]] void failShort() const {
        throw Error(fmt::format(
            "{}: ends before its data do: the file is truncated, or its header's counts are wrong", mName));
    }

  private:
    double takeWord() {
        const auto isSpace = [](std::byte b) {
            return b == std::byte(' ') || (b >= std::byte(9) && b <= std::byte(13));
        };
        const auto start = std::find_if_not(mData.begin(), mData.end(), isSpace);
        const auto end = std::find_if(start, mData.end(), isSpace);
        if (start == end) failShort();
        std::string_view word(reinterpret_cast<const char*>(&*start), size_t(end - start));
        mData = mData.subspan(size_t(end - mData.begin()));
        const std::string_view digits = word.substr(word.front() == '+' ? 1 : 0);
        double value;
        const auto [last, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (failure != std::errc() || last != digits.data() + digits.size())
            throw Error(
                fmt::format("{}: expected a number among the data, found \"{}\"", mName, word.substr(0, 40)));
        return value;
    }

    double takeBinary(const PlyScalarType& type) {
        if (mData.size() < type.size) failShort();
        std::array<std::byte, 8> bytes{};
        std::copy_n(mData.begin(), type.size, bytes.begin());
        mData = mData.subspan(type.size);
        const bool isForeign =
            (mEncoding == PlyEncoding::BigEndian) != (std::endian::native == std::endian::big);
        if (isForeign) std::reverse(bytes.begin(), bytes.begin() + ptrdiff_t(type.size));
        switch (type.size) {
        case 1:
            return type.kind == 'i' ? as<int8_t>(bytes) : as<uint8_t>(bytes);
        case 2:
            return type.kind == 'i' ? as<int16_t>(bytes) : as<uint16_t>(bytes);
        case 4:
            return type.kind == 'f'   ? as<float>(bytes)
                   : type.kind == 'i' ? as<int32_t>(bytes)
                                      : as<uint32_t>(bytes);
        default:
            return as<double>(bytes);
        }
    }

    template <typename T>
    static double as(const std::array<std::byte, 8>& bytes) {
        T value;
        std::memcpy(&value, bytes.data(), sizeof(T));
        return double(value);
    }

    std::span<const std::byte> mData;
    PlyEncoding mEncoding;
    const std::string& mName;
};

// Finds the columns of properties of the element "vertex".
class VertexColumns {
  public:
    explicit VertexColumns(const PlyElement& element) : mElement(element) {}

    // Returns the columns of these properties, or none if one is missing.
    std::optional<std::vector<size_t>> find(std::initializer_list<std::string_view> names) const {
        std::vector<size_t> columns;
        for (const std::string_view name : names) {
            const std::optional<size_t> column = find(name);
            if (!column) return std::nullopt;
            columns.push_back(*column);
        }
        return columns;
    }

    // Programs disagree on the names of texture coordinates.
    std::optional<std::vector<size_t>> findUvs() const {
        auto columns = find({"s", "t"});
        if (!columns) columns = find({"u", "v"});
        if (!columns) columns = find({"texture_u", "texture_v"});
        return columns;
    }

    // Colors are integers of the type's full range, or floating point.
    std::optional<std::vector<size_t>> findColors() const {
        auto columns = find({"red", "green", "blue", "alpha"});
        if (!columns) columns = find({"red", "green", "blue"});
        return columns;
    }

  private:
    std::optional<size_t> find(std::string_view name) const {
        for (size_t i = 0; i < mElement.properties.size(); i++)
            if (mElement.properties[i].name == name && !mElement.properties[i].countType) return i;
        return std::nullopt;
    }

    const PlyElement& mElement;
};

// Returns the divisor that maps a color of this type to [0, 1].
float fullColor(const PlyScalarType& type) {
    return type.kind == 'f' ? 1 : float(std::exp2(8.0 * double(type.size) - (type.kind == 'i')) - 1);
}

class BodyReader {
  public:
    BodyReader(Values values, const std::string& name, MeshAttributes wanted)
        : mValues(values), mName(name), mWanted(wanted) {}

    void read(const PlyElement& element) {
        if (element.properties.empty() && element.count > 0)
            throw Error(fmt::format("{}: element \"{}\" has no properties", mName, element.name));
        // Every row takes at least this many bytes, so an absurd count fails here.
        for (const PlyProperty& property : element.properties)
            if (!mValues.canHold(element.count, property.countType ? *property.countType : *property.type))
                mValues.failShort();
        if (element.name == "vertex")
            readVertices(element);
        else if (element.name == "face")
            readFaces(element);
        else
            for (uint64_t row = 0; row < element.count; row++)
                for (const PlyProperty& property : element.properties) takeProperty(property);
    }

    Mesh take() {
        Mesh mesh = std::move(mMesh);
        std::vector<uvec3> cut;
        std::vector<vec3> corners;
        for (size_t start = 0, face = 0; face < mFaceSizes.size(); start += mFaceSizes[face++]) {
            const std::span<const uint32_t> indices = std::span(mCorners).subspan(start, mFaceSizes[face]);
            corners.clear();
            cut.clear();
            for (const uint32_t index : indices) {
                if (index >= mesh.vertexCount())
                    throw Error(fmt::format(
                        "{}: face {} (counted from 0) refers to vertex {}, but there are only {}: the "
                        "file is corrupt",
                        mName, face, index, mesh.vertexCount()));
                corners.push_back(mesh.positions[index]);
            }
            if (indices.size() < 3) continue;
            triangulate(corners, cut, mName);
            for (const uvec3& t : cut) mesh.triangles.push_back({indices[t.x], indices[t.y], indices[t.z]});
        }
        return mesh;
    }

  private:
    // Takes a property's value. Items of a list go to mItems instead.
    double takeProperty(const PlyProperty& property) {
        if (!property.countType) return mValues.take(*property.type);
        const double count = mValues.take(*property.countType);
        if (!(count >= 0 && count <= kMostPlyCorners))
            throw Error(
                fmt::format("{}: a list \"{}\" claims {} items, expected 0 to {}: the file is corrupt", mName,
                            property.name, count, kMostPlyCorners));
        mItems.clear();
        for (size_t i = 0; i < size_t(count); i++) mItems.push_back(mValues.take(*property.type));
        return 0;
    }

    void readVertices(const PlyElement& element) {
        const VertexColumns columns(element);
        const auto position = columns.find({"x", "y", "z"}), normal = columns.find({"nx", "ny", "nz"});
        const auto uv = mWanted.uvs ? columns.findUvs() : std::nullopt;
        const auto color = mWanted.colors ? columns.findColors() : std::nullopt;
        if (!position)
            throw Error(fmt::format("{}: element \"vertex\" needs the properties x, y and z", mName));

        std::vector<float> row(element.properties.size());
        const auto vectorAt = [&](const std::vector<size_t>& at) {
            return vec3(row[at[0]], row[at[1]], row[at[2]]);
        };
        for (uint64_t i = 0; i < element.count; i++) {
            for (size_t j = 0; j < row.size(); j++) row[j] = float(takeProperty(element.properties[j]));
            mMesh.positions.push_back(vectorAt(*position));
            if (normal) mMesh.normals.push_back(vectorAt(*normal));
            // PLY measures v upward from an image's lower edge.
            if (uv) mMesh.uvs.push_back({row[(*uv)[0]], 1 - row[(*uv)[1]]});
            if (!color) continue;
            mMesh.colors.push_back(vec4(0));
            for (size_t c = 0; c < color->size(); c++)
                mMesh.colors.back()[int(c)] =
                    row[(*color)[c]] / fullColor(*element.properties[(*color)[c]].type);
        }
    }

    void readFaces(const PlyElement& element) {
        for (uint64_t i = 0; i < element.count; i++)
            for (const PlyProperty& property : element.properties) {
                takeProperty(property);
                if (!property.countType ||
                    (property.name != "vertex_indices" && property.name != "vertex_index"))
                    continue;
                mFaceSizes.push_back(uint32_t(mItems.size()));
                for (const double item : mItems) {
                    if (!(item >= 0 && item < 4294967295.0))
                        throw Error(fmt::format(
                            "{}: face {} (counted from 0) refers to vertex {}: the file is corrupt", mName, i,
                            item));
                    mCorners.push_back(uint32_t(item));
                }
            }
    }

    Values mValues;
    const std::string& mName;
    MeshAttributes mWanted;
    Mesh mMesh;
    std::vector<uint32_t> mFaceSizes, mCorners; // faces may precede the vertices that they refer to
    std::vector<double> mItems;
};

} // namespace

Mesh decodePly(std::span<const std::byte> bytes, const std::string& name, MeshAttributes wanted) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const PlyHeader header = readPlyHeader(text, name);
    BodyReader body(Values(bytes.subspan(header.size), header.encoding, name), name, wanted);
    for (const PlyElement& element : header.elements) body.read(element);
    return body.take();
}

} // namespace relume
