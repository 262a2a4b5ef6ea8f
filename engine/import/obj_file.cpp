#include "engine/base/error.h"
#include "engine/import/mesh_cleanup.h"
#include "engine/import/mesh_formats.h"
#include "engine/import/polygon.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/core.h>
#include <sstream>
#include <string_view>
#include <tiny_obj_loader.h>

namespace relume {
namespace {

constexpr size_t kMostObjCorners = 255;

bool isBlank(char c) { return c == ' ' || c == '\t'; }

std::string_view takeWord(std::string_view& line) {
    size_t start = 0;
    while (start < line.size() && isBlank(line[start])) start++;
    size_t end = start;
    while (end < line.size() && !isBlank(line[end])) end++;
    const std::string_view word = line.substr(start, end - start);
    line.remove_prefix(end);
    return word;
}

bool isNumber(std::string_view word) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    double value;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    return !word.empty() && failure == std::errc() && end == word.data() + word.size() &&
           std::isfinite(value);
}

// Takes the next line, ended by "\n", "\r\n" or "\r", as the library does.
std::string_view takeLine(std::string_view& text) {
    const size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + (text.substr(end, 2) == "\r\n" ? 2 : 1), text.size()));
    return line;
}

// Numbers of vertices, texture coordinates and normals so far, from which negative indices count back.
using Counts = std::array<int64_t, 3>;

// Returns whether a word is a corner: "v", "v/t", "v//n" or "v/t/n", with indices from 1 up or negative.
bool isCorner(std::string_view word, const Counts& counts) {
    for (size_t kind = 0; kind < counts.size(); kind++) {
        const std::string_view digits = word.substr(0, word.find('/'));
        int number = 0;
        const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
        const bool isNumber = failure == std::errc() && end == digits.data() + digits.size() && number != 0 &&
                              number >= -counts[kind];
        const bool isLeftOut = kind == 1 && digits.empty() && digits.size() < word.size();
        if (!isNumber && !isLeftOut) return false;
        if (digits.size() == word.size()) return true;
        word.remove_prefix(digits.size() + 1);
    }
    return false;
}

// Throws for lines that the library would misread: it reads words that are not numbers as zeros, wraps
// numbers that are too large, and counts corners in eight bits.
void checkLine(std::string_view keyword, std::string_view rest, const Counts& counts, const std::string& name,
               size_t number) {
    if (keyword == "f") {
        size_t corners = 0;
        for (std::string_view word; !(word = takeWord(rest)).empty(); corners++)
            if (!isCorner(word, counts))
                throw Error(
                    fmt::format("{}: line {}: expected a corner v, v/t, v//n or v/t/n of numbers from 1 on, "
                                "or from -1 back to the first; found \"{}\": export the mesh again",
                                name, number, word.substr(0, 40)));
        if (corners > kMostObjCorners)
            throw Error(
                fmt::format("{}: line {}: a face has {} corners, expected at most {}: triangulate the mesh "
                            "before export",
                            name, number, corners, kMostObjCorners));
    } else if (keyword == "vt") {
        // The second coordinate is optional and defaults to 0.
        const std::string_view u = takeWord(rest), v = takeWord(rest);
        if (!isNumber(u) || !(v.empty() || isNumber(v)))
            throw Error(fmt::format("{}: line {}: expected two finite numbers after \"vt\", found \"{} {}\"",
                                    name, number, u.substr(0, 40), v.substr(0, 40)));
    } else {
        for (int i = 0; i < 3; i++)
            if (const std::string_view word = takeWord(rest); !isNumber(word))
                throw Error(
                    fmt::format("{}: line {}: expected three finite numbers after \"{}\", found \"{}\"", name,
                                number, keyword, word.substr(0, 40)));
    }
}

// Keeps the lines that describe the surface, joined where they continue, and empties all others, so that line
// numbers remain. The library would read other files on "mtllib", trust the sizes in "t" lines, and knows
// neither byte order marks nor lines continued by a backslash.
std::string surfaceLines(std::string_view text, const std::string& name, bool areUvsWanted) {
    std::string kept;
    kept.reserve(text.size() + 1);
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    constexpr std::string_view kCounted[] = {"v", "vt", "vn"};
    Counts counts{};
    std::string line;
    for (size_t number = 1, lines = 1; !text.empty(); number += lines) {
        line = takeLine(text);
        // A name or comment may also end in a backslash; it does not continue.
        const size_t start = line.find_first_not_of(" \t");
        const bool mayGoOn = start < line.size() && (line[start] == 'v' || line[start] == 'f');
        for (lines = 1; mayGoOn && line.ends_with('\\') && !text.empty(); lines++) {
            line.back() = ' ';
            line += takeLine(text);
        }
        std::string_view rest = std::string_view(line).substr(0, line.find('#'));
        const std::string_view surface = rest, keyword = takeWord(rest);
        const auto kind = std::ranges::find(kCounted, keyword);
        const bool isCounted = kind != std::end(kCounted);
        if (keyword == "f" || (isCounted && (keyword != "vt" || areUvsWanted)))
            checkLine(keyword, rest, counts, name, number);
        if (isCounted) counts[size_t(kind - kCounted)]++;
        if (keyword == "f" || isCounted) kept += surface;
        kept.append(lines, '\n');
    }
    return kept;
}

// Throws unless a face's index, here from 0, is less than `count`.
void checkIndex(int index, size_t count, const char* what, const std::string& name) {
    if (index < 0 || size_t(index) >= count)
        throw Error(fmt::format("{}: a face refers to {} {}, but there are only {}: the file is corrupt",
                                name, what, int64_t(index) + 1, count));
}

// Returns whether every corner of every face has an index of this kind. Throws if an index is out of range.
bool haveAll(const std::vector<tinyobj::shape_t>& shapes, int tinyobj::index_t::*number, size_t count,
             const char* what, const std::string& name) {
    bool isComplete = count > 0;
    for (const tinyobj::shape_t& shape : shapes)
        for (const tinyobj::index_t& corner : shape.mesh.indices)
            if (corner.*number < 0)
                isComplete = false;
            else
                checkIndex(corner.*number, count, what, name);
    return isComplete;
}

// Makes a vertex of every face corner if there are normals or uvs, since corners index each attribute
// separately.
class Corners {
  public:
    Corners(const tinyobj::attrib_t& attributes, bool hasNormals, bool hasUvs, const std::string& name)
        : mAttributes(attributes), mHasNormals(hasNormals), mHasUvs(hasUvs), mName(name) {
        if (!isSplit())
            for (size_t i = 0; i < attributes.vertices.size() / 3; i++)
                mMesh.positions.push_back(position(int(i)));
    }

    void addFace(std::span<const tinyobj::index_t> face) {
        mFace.clear();
        mTriangles.clear();
        for (const tinyobj::index_t& corner : face) mFace.push_back(position(corner.vertex_index));
        triangulate(mFace, mTriangles, mName);
        const uint32_t first = uint32_t(mMesh.positions.size());
        if (isSplit())
            for (const tinyobj::index_t& corner : face) {
                mMesh.positions.push_back(position(corner.vertex_index));
                if (mHasNormals) mMesh.normals.push_back(normal(corner.normal_index));
                if (mHasUvs) mMesh.uvs.push_back(uv(corner.texcoord_index));
            }
        const auto vertex = [&](uint32_t i) {
            return isSplit() ? first + i : uint32_t(face[i].vertex_index);
        };
        for (const uvec3& t : mTriangles) mMesh.triangles.push_back({vertex(t.x), vertex(t.y), vertex(t.z)});
        if (mMesh.positions.size() > kMostMeshVertices)
            throw Error(fmt::format("{}: has more than {} corners: simplify it", mName, kMostMeshVertices));
    }

    Mesh take() { return std::move(mMesh); }

  private:
    template <typename Vector>
    Vector element(const std::vector<tinyobj::real_t>& values, int index, const char* what) const {
        constexpr size_t kWidth = size_t(Vector::length());
        checkIndex(index, values.size() / kWidth, what, mName);
        Vector vector;
        for (size_t i = 0; i < kWidth; i++) vector[int(i)] = values[kWidth * size_t(index) + i];
        return vector;
    }
    vec3 position(int index) const { return element<vec3>(mAttributes.vertices, index, "vertex"); }
    vec3 normal(int index) const { return element<vec3>(mAttributes.normals, index, "normal"); }
    // OBJ measures v upward from an image's lower edge.
    vec2 uv(int index) const {
        const vec2 up = element<vec2>(mAttributes.texcoords, index, "texture coordinates");
        return {up.x, 1 - up.y};
    }

    bool isSplit() const { return mHasNormals || mHasUvs; }

    const tinyobj::attrib_t& mAttributes;
    bool mHasNormals, mHasUvs;
    const std::string& mName;
    Mesh mMesh;
    std::vector<vec3> mFace;
    std::vector<uvec3> mTriangles;
};

} // namespace

Mesh decodeObj(std::span<const std::byte> bytes, const std::string& name, MeshAttributes wanted) {
    std::istringstream text(
        surfaceLines({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name, wanted.uvs));
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::string warning, failure;
    if (!tinyobj::LoadObj(&attributes, &shapes, nullptr, &warning, &failure, &text, nullptr, false, false))
        throw Error(fmt::format("{}: is not a valid OBJ file: {}", name,
                                failure.substr(0, failure.find_last_not_of('\n') + 1)));

    const bool hasNormals =
        haveAll(shapes, &tinyobj::index_t::normal_index, attributes.normals.size() / 3, "normal", name);
    const bool hasUvs = wanted.uvs && haveAll(shapes, &tinyobj::index_t::texcoord_index,
                                              attributes.texcoords.size() / 2, "texture coordinates", name);
    Corners corners(attributes, hasNormals, hasUvs, name);
    for (const tinyobj::shape_t& shape : shapes) {
        size_t start = 0;
        for (const size_t count : shape.mesh.num_face_vertices) {
            if (count >= 3) corners.addFace(std::span(shape.mesh.indices).subspan(start, count));
            start += count;
        }
    }
    return corners.take();
}

} // namespace relume
