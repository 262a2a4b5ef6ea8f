#include "engine/base/error.h"
#include "engine/scene/mesh_cleanup.h"
#include "engine/scene/mesh_formats.h"
#include "engine/scene/polygon.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>
#include <tiny_obj_loader.h>

namespace relume {
namespace {

constexpr size_t kMostCorners = 255;

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

// The next line, ended by "\n", "\r\n" or "\r", as the library has it.
std::string_view takeLine(std::string_view& text) {
    const size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + (text.substr(end, 2) == "\r\n" ? 2 : 1), text.size()));
    return line;
}

// Throws for what the library would misread: it takes words that are no numbers for zeros, and counts
// corners in eight bits.
void checkLine(std::string_view keyword, std::string_view rest, const std::string& name, size_t number) {
    if (keyword == "f") {
        size_t corners = 0;
        while (!takeWord(rest).empty()) corners++;
        if (corners > kMostCorners)
            throw Error("{}: line {}: a face has {} corners, expected at most {}: triangulate the mesh "
                        "before export",
                        name, number, corners, kMostCorners);
    } else {
        for (int i = 0; i < 3; i++)
            if (const std::string_view word = takeWord(rest); !isNumber(word))
                throw Error("{}: line {}: expected three finite numbers after \"{}\", found \"{}\"", name,
                            number, keyword, word.substr(0, 40));
    }
}

// Keeps the lines that describe the surface and empties all others, so that line numbers stay: the library
// reads other files on "mtllib" and believes the sizes that "t" lines claim.
std::string surfaceLines(std::string_view text, const std::string& name) {
    std::string kept;
    kept.reserve(text.size() + 1);
    for (size_t number = 1; !text.empty(); number++) {
        const std::string_view line = takeLine(text);
        std::string_view rest = line;
        const std::string_view keyword = takeWord(rest);
        if (keyword == "v" || keyword == "vn" || keyword == "f") checkLine(keyword, rest, name, number);
        if (keyword == "v" || keyword == "vn" || keyword == "vt" || keyword == "f") kept += line;
        kept += '\n';
    }
    return kept;
}

// The faces' corners, whose position and normal have numbers of their own, as vertices of their own.
class Corners {
  public:
    Corners(const tinyobj::attrib_t& attributes, bool hasNormals, const std::string& name)
        : mAttributes(attributes), mHasNormals(hasNormals), mName(name) {
        if (!hasNormals)
            for (size_t i = 0; i < attributes.vertices.size() / 3; i++)
                mMesh.positions.push_back(position(int(i)));
    }

    void addFace(std::span<const tinyobj::index_t> face) {
        mFace.clear();
        mTriangles.clear();
        for (const tinyobj::index_t& corner : face) mFace.push_back(position(corner.vertex_index));
        triangulate(mFace, mTriangles, mName);
        const uint32_t first = uint32_t(mMesh.positions.size());
        if (mHasNormals)
            for (const tinyobj::index_t& corner : face) {
                mMesh.positions.push_back(position(corner.vertex_index));
                mMesh.normals.push_back(normal(corner.normal_index));
            }
        const auto vertex = [&](uint32_t i) {
            return mHasNormals ? first + i : uint32_t(face[i].vertex_index);
        };
        for (const uvec3& t : mTriangles) mMesh.triangles.push_back({vertex(t.x), vertex(t.y), vertex(t.z)});
        if (mMesh.positions.size() > kMostMeshVertices)
            throw Error("{}: has more than {} corners: simplify it", mName, kMostMeshVertices);
    }

    Mesh take() { return std::move(mMesh); }

  private:
    vec3 element(const std::vector<tinyobj::real_t>& values, int index, const char* what) const {
        if (index < 0 || size_t(index) >= values.size() / 3)
            throw Error("{}: a face refers to {} {}, but there are only {}: the file is corrupt", mName, what,
                        int64_t(index) + 1, values.size() / 3);
        return {values[3 * size_t(index)], values[3 * size_t(index) + 1], values[3 * size_t(index) + 2]};
    }
    vec3 position(int index) const { return element(mAttributes.vertices, index, "vertex"); }
    vec3 normal(int index) const { return element(mAttributes.normals, index, "normal"); }

    const tinyobj::attrib_t& mAttributes;
    bool mHasNormals;
    const std::string& mName;
    Mesh mMesh;
    std::vector<vec3> mFace;
    std::vector<uvec3> mTriangles;
};

} // namespace

Mesh decodeObj(std::span<const std::byte> bytes, const std::string& name) {
    std::istringstream text(surfaceLines({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name));
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::string warning, failure;
    if (!tinyobj::LoadObj(&attributes, &shapes, nullptr, &warning, &failure, &text, nullptr, false, false))
        throw Error("{}: is not a valid OBJ file: {}", name,
                    failure.substr(0, failure.find_last_not_of('\n') + 1));

    bool hasNormals = !attributes.normals.empty();
    for (const tinyobj::shape_t& shape : shapes)
        for (const tinyobj::index_t& corner : shape.mesh.indices) hasNormals &= corner.normal_index >= 0;
    Corners corners(attributes, hasNormals, name);
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
