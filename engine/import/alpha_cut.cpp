#include "engine/import/alpha_cut.h"

#include "engine/base/log.h"
#include "engine/import/mesh_cleanup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <optional>

namespace relume {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr size_t kMostAddedTriangles = 200'000;
constexpr int kMostRounds = 24;         // rounds of edge halving
constexpr double kLeastTolerance = 0.5; // texels
constexpr double kSnap = 0.1;           // texels: a cut this near to a vertex goes through it
constexpr double kMostTiles = 64;       // most repetitions of the texture on a triangle that are examined
constexpr int kMostCells = 1 << 16;     // most cells examined per triangle; beyond that it is split

// Pyramid of the lowest and highest alpha in squares of 1, 2, 4, … texels a side.
class AlphaPyramid {
  public:
    struct Range {
        uint8_t low = 255, high = 0;
    };

    explicit AlphaPyramid(const Texture& texture) {
        Level level{texture.width, texture.height, {}};
        for (const uint32_t texel : texture.texels)
            level.ranges.push_back({uint8_t(texel >> 24), uint8_t(texel >> 24)});
        mLevels.push_back(std::move(level));
        while (mLevels.back().width > 1 || mLevels.back().height > 1)
            mLevels.push_back(halved(mLevels.back()));
    }

    int top() const { return int(mLevels.size()) - 1; }
    dvec2 size() const { return {mLevels[0].width, mLevels[0].height}; }
    bool isInside(int level, int x, int y) const {
        return x < mLevels[size_t(level)].width && y < mLevels[size_t(level)].height;
    }
    Range at(int level, int x, int y) const {
        const Level& found = mLevels[size_t(level)];
        return found.ranges[size_t(y) * size_t(found.width) + size_t(x)];
    }

  private:
    struct Level {
        int width, height;
        std::vector<Range> ranges;
    };

    static Level halved(const Level& fine) {
        Level level{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
        level.ranges.resize(size_t(level.width) * size_t(level.height));
        for (int y = 0; y < fine.height; y++)
            for (int x = 0; x < fine.width; x++) {
                const Range& one = fine.ranges[size_t(y) * size_t(fine.width) + size_t(x)];
                Range& range = level.ranges[size_t(y / 2) * size_t(level.width) + size_t(x / 2)];
                range = {std::min(range.low, one.low), std::max(range.high, one.high)};
            }
        return level;
    }

    std::vector<Level> mLevels;
};

// Linear function of the plane: at(p) = slope · p + offset.
struct Linear {
    dvec2 slope = dvec2(0);
    double offset = 0;

    double at(dvec2 p) const { return glm::dot(slope, p) + offset; }
    double greatest(dvec2 low, dvec2 high) const {
        return offset + std::max(slope.x * low.x, slope.x * high.x) +
               std::max(slope.y * low.y, slope.y * high.y);
    }
    double least(dvec2 low, dvec2 high) const { return -Linear{-slope, -offset}.greatest(low, high); }
};

// Returns the signed distance from the line through a and b, positive on the side of `inside`.
Linear distanceFrom(dvec2 a, dvec2 b, dvec2 inside) {
    const dvec2 along = b - a;
    const double length = glm::length(along);
    if (length == 0) return {};
    Linear line{dvec2(-along.y, along.x) / length, 0};
    line.offset = -glm::dot(line.slope, a);
    return line.at(inside) < 0 ? Linear{-line.slope, -line.offset} : line;
}

// Set of undirected edges, each given by its vertex indices in ascending order.
class EdgeSet {
  public:
    using Edge = std::array<uint32_t, 2>;

    void add(uint32_t a, uint32_t b) { mEdges.push_back({std::min(a, b), std::max(a, b)}); }
    void sort() {
        std::ranges::sort(mEdges);
        // Clang 14, which builds the fuzz targets, cannot compile std::ranges::unique().
        mEdges.erase(std::unique(mEdges.begin(), mEdges.end()), mEdges.end());
    }
    std::optional<uint32_t> find(uint32_t a, uint32_t b) const {
        const auto found = std::ranges::lower_bound(mEdges, Edge{std::min(a, b), std::max(a, b)});
        if (found == mEdges.end() || *found != Edge{std::min(a, b), std::max(a, b)}) return std::nullopt;
        return uint32_t(found - mEdges.begin());
    }
    const std::vector<Edge>& edges() const { return mEdges; }

  private:
    std::vector<Edge> mEdges;
};

// Adds a vertex on the straight line from `a` to `b`, at `share` of its length.
uint32_t addBetween(Mesh& mesh, uint32_t a, uint32_t b, double share) {
    const auto add = [&](auto& values) {
        if (!values.empty()) values.push_back(glm::mix(values[a], values[b], float(share)));
    };
    add(mesh.positions), add(mesh.normals), add(mesh.uvs), add(mesh.colors), add(mesh.tangents);
    return uint32_t(mesh.vertexCount() - 1);
}

// Appends a triangle, or a quad cut along its shorter diagonal; polygons of fewer corners are dropped.
void addPolygon(const Mesh& mesh, std::vector<uvec3>& triangles, const std::vector<uint32_t>& p) {
    const auto length = [&](uint32_t a, uint32_t b) {
        return glm::distance(dvec3(mesh.positions[a]), dvec3(mesh.positions[b]));
    };
    if (p.size() == 3) triangles.push_back({p[0], p[1], p[2]});
    if (p.size() != 4) return;
    if (length(p[0], p[2]) <= length(p[1], p[3]))
        triangles.insert(triangles.end(), {uvec3(p[0], p[1], p[2]), uvec3(p[0], p[2], p[3])});
    else
        triangles.insert(triangles.end(), {uvec3(p[0], p[1], p[3]), uvec3(p[1], p[2], p[3])});
}

class Cutter {
  public:
    Cutter(Mesh mesh, const AlphaMask& mask, float tolerance)
        : mMesh(std::move(mesh)), mMask(mask), mTolerance(tolerance) {
        if (mask.texture) mPyramid.emplace(*mask.texture);
        for (uint32_t i = 0; i < mMesh.vertexCount(); i++) mIsKept.push_back(isKept(i, i, 0));
    }

    // Splits triangles until straight cuts are accurate enough. Returns false if that would take too many.
    bool refine() {
        const size_t most = mMesh.triangleCount() + kMostAddedTriangles;
        std::vector<bool> isSettled(mMesh.triangleCount(), !mPyramid);
        for (int round = 0; round < kMostRounds; round++) {
            EdgeSet marked;
            for (size_t i = 0; i < mMesh.triangleCount(); i++) {
                if (!isSettled[i] && isWrong(mMesh.triangles[i])) mark(mMesh.triangles[i], marked);
                isSettled[i] = true;
            }
            marked.sort();
            if (marked.edges().empty()) return true;
            if (mMesh.triangleCount() + 2 * marked.edges().size() > most) return false;
            split(marked, isSettled);
        }
        return true;
    }

    // Returns the mesh without its holes.
    Mesh cut() {
        EdgeSet crossed;
        for (const uvec3& t : mMesh.triangles)
            for (int corner = 0; corner < 3; corner++) {
                const uint32_t a = t[corner], b = t[(corner + 1) % 3];
                if (mIsKept[a] != mIsKept[b]) crossed.add(a, b);
            }
        crossed.sort();
        std::vector<uint32_t> ends; // vertex at each crossed edge's cut, by edge index
        for (const auto& [a, b] : crossed.edges()) {
            const double share = crossing(a, b), length = glm::distance(texelPlace(a), texelPlace(b));
            const bool isAtA = share == 0 || (mPyramid && share * length < kSnap);
            const bool isAtB = share == 1 || (mPyramid && (1 - share) * length < kSnap);
            ends.push_back(isAtA ? a : isAtB ? b : addBetween(mMesh, a, b, share));
        }
        std::vector<uvec3> kept;
        for (const uvec3& t : mMesh.triangles) {
            std::vector<uint32_t> polygon;
            const auto add = [&](uint32_t v) {
                if (std::ranges::find(polygon, v) == polygon.end()) polygon.push_back(v);
            };
            for (int corner = 0; corner < 3; corner++) {
                const uint32_t a = t[corner], b = t[(corner + 1) % 3];
                if (mIsKept[a]) add(a);
                if (mIsKept[a] != mIsKept[b]) add(ends[*crossed.find(a, b)]);
            }
            addPolygon(mMesh, kept, polygon);
        }
        mMesh.triangles = std::move(kept);
        return std::move(mMesh);
    }

    bool hasHoles() const { return std::ranges::find(mIsKept, false) != mIsKept.end(); }

  private:
    dvec2 texelPlace(uint32_t vertex) const {
        return mPyramid ? dvec2(mMesh.uvs[vertex]) * mPyramid->size() : dvec2(0);
    }

    double vertexAlpha(uint32_t vertex) const {
        return double(mMask.factor) * (mMesh.colors.empty() ? 1 : double(mMesh.colors[vertex].w));
    }

    bool isKept(uint32_t a, uint32_t b, double share) const {
        double alpha = glm::mix(vertexAlpha(a), vertexAlpha(b), share);
        if (mMask.texture)
            alpha *= double(sample(*mMask.texture, glm::mix(mMesh.uvs[a], mMesh.uvs[b], float(share))).w);
        return alpha >= double(mMask.cutoff);
    }

    // Returns where an edge between a kept and a dropped vertex is cut, to 1 / 65,536 of its length.
    double crossing(uint32_t a, uint32_t b) const {
        double low = 0, high = 1;
        for (int i = 0; i < 16; i++) {
            const double middle = 0.5 * (low + high);
            (isKept(a, b, middle) == mIsKept[a] ? low : high) = middle;
        }
        return high == 1 ? 1 : low == 0 ? 0 : 0.5 * (low + high);
    }

    // A triangle in texel space, and the cut that it would get without splitting.
    struct Look {
        std::array<Linear, 3> sides; // signed distances from the sides, positive inside
        Linear kept;                 // signed distance from the cut in texels, positive if kept
        Linear alpha;                // alpha of the vertices, interpolated
        double tolerance;            // texels
        dvec2 low, high;             // bounds
        int cells = 0;               // examined so far
    };

    // Returns whether cutting the triangle without splitting it would be off by more than the tolerance.
    bool isWrong(const uvec3& t) const {
        std::array<dvec2, 3> p = {texelPlace(t.x), texelPlace(t.y), texelPlace(t.z)};
        const dvec2 size = mPyramid->size();
        const dvec2 first = glm::floor(glm::min(glm::min(p[0], p[1]), p[2]) / size) * size;
        for (dvec2& place : p) place -= first;
        const double area =
            0.5 * std::abs((p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x));
        if (!(area > 0)) return false;
        Look look;
        look.low = glm::min(glm::min(p[0], p[1]), p[2]), look.high = glm::max(glm::max(p[0], p[1]), p[2]);
        for (size_t i = 0; i < 3; i++) look.sides[i] = distanceFrom(p[i], p[(i + 1) % 3], p[(i + 2) % 3]);
        const dvec3 a(mMesh.positions[t.x]), b(mMesh.positions[t.y]), c(mMesh.positions[t.z]);
        const double worldArea = 0.5 * glm::length(glm::cross(b - a, c - a));
        look.tolerance = std::max(kLeastTolerance, double(mTolerance) * std::sqrt(area / worldArea));
        look.alpha = alphaOver(t, p);
        look.kept = keptSide(t, p);
        const dvec2 tiles = glm::ceil(look.high / size);
        if (tiles.x * tiles.y > kMostTiles) {
            const AlphaPyramid::Range all = mPyramid->at(mPyramid->top(), 0, 0);
            return all.low != all.high;
        }
        for (int y = 0; y < int(tiles.y); y++)
            for (int x = 0; x < int(tiles.x); x++)
                if (isWrong(look, dvec2(x, y) * size, mPyramid->top(), 0, 0)) return true;
        return false;
    }

    // Returns the same for the texels of a pyramid cell, in the texture repetition that starts at `tile`.
    bool isWrong(Look& look, dvec2 tile, int level, int x, int y) const {
        const double side = double(1 << level);
        const dvec2 low = tile + dvec2(x, y) * side + 0.5, high = low + side - 1.0; // of the texels' centers
        if (!mPyramid->isInside(level, x, y) || glm::any(glm::greaterThan(low, look.high)) ||
            glm::any(glm::lessThan(high, look.low)))
            return false;
        for (const Linear& one : look.sides)
            if (one.greatest(low, high) < 0) return false;
        const AlphaPyramid::Range range = mPyramid->at(level, x, y);
        const double least = range.low / 255.0 * look.alpha.least(low, high),
                     most = range.high / 255.0 * look.alpha.greatest(low, high);
        const bool isAllKept = least >= double(mMask.cutoff), isAllHole = most < double(mMask.cutoff);
        if (isAllKept && look.kept.least(low, high) >= -look.tolerance) return false;
        if (isAllHole && look.kept.greatest(low, high) <= look.tolerance) return false;
        if (level == 0) return isAllKept || isAllHole;
        if (++look.cells > kMostCells) return true;
        for (int child = 0; child < 4; child++)
            if (isWrong(look, tile, level - 1, 2 * x + child % 2, 2 * y + child / 2)) return true;
        return false;
    }

    // Returns the vertices' alpha, which is linear over a triangle.
    Linear alphaOver(const uvec3& t, const std::array<dvec2, 3>& p) const {
        const double a = vertexAlpha(t.x), b = vertexAlpha(t.y) - a, c = vertexAlpha(t.z) - a;
        const dvec2 u = p[1] - p[0], v = p[2] - p[0];
        const double determinant = u.x * v.y - u.y * v.x;
        Linear linear{dvec2(b * v.y - c * u.y, c * u.x - b * v.x) / determinant, 0};
        linear.offset = a - glm::dot(linear.slope, p[0]);
        return linear;
    }

    Linear keptSide(const uvec3& t, const std::array<dvec2, 3>& p) const {
        std::array<dvec2, 2> ends{};
        size_t count = 0;
        dvec2 inside(0);
        for (int corner = 0; corner < 3; corner++) {
            const int next = (corner + 1) % 3;
            if (mIsKept[t[corner]]) inside = p[size_t(corner)];
            if (mIsKept[t[corner]] == mIsKept[t[next]]) continue;
            // Start at the vertex with the lower index, as cut() does.
            const bool isTurned = t[corner] > t[next];
            const double share = crossing(t[isTurned ? next : corner], t[isTurned ? corner : next]);
            ends[count++ % 2] = glm::mix(p[size_t(corner)], p[size_t(next)], isTurned ? 1 - share : share);
        }
        if (count == 0) return {dvec2(0), mIsKept[t.x] ? 1e30 : -1e30};
        return distanceFrom(ends[0], ends[1], inside);
    }

    // Marks the edges to split: those longer than a texel and than half the longest.
    void mark(const uvec3& t, EdgeSet& marked) const {
        std::array<double, 3> lengths{};
        for (int corner = 0; corner < 3; corner++)
            lengths[size_t(corner)] = glm::distance(texelPlace(t[corner]), texelPlace(t[(corner + 1) % 3]));
        const double longest = std::ranges::max(lengths);
        for (int corner = 0; corner < 3; corner++)
            if (lengths[size_t(corner)] >= std::max(1.0, 0.5 * longest))
                marked.add(t[corner], t[(corner + 1) % 3]);
    }

    void split(const EdgeSet& marked, std::vector<bool>& isSettled) {
        const uint32_t first = uint32_t(mMesh.vertexCount());
        for (const auto& [a, b] : marked.edges()) {
            mIsKept.push_back(isKept(a, b, 0.5));
            addBetween(mMesh, a, b, 0.5);
        }
        std::vector<uvec3> triangles;
        std::vector<bool> settled;
        for (size_t i = 0; i < mMesh.triangleCount(); i++) {
            const uvec3 t = mMesh.triangles[i];
            std::array<std::optional<uint32_t>, 3> middle;
            for (int corner = 0; corner < 3; corner++) {
                middle[size_t(corner)] = marked.find(t[corner], t[(corner + 1) % 3]);
                if (middle[size_t(corner)]) *middle[size_t(corner)] += first;
            }
            const bool isWhole = !middle[0] && !middle[1] && !middle[2];
            addSplit(t, middle, triangles);
            settled.resize(triangles.size(), isWhole && isSettled[i]);
        }
        mMesh.triangles = std::move(triangles);
        isSettled = std::move(settled);
    }

    // Appends the pieces of a triangle whose edges are split at `middle`; edge i goes from corner i to i + 1.
    void addSplit(const uvec3& t, const std::array<std::optional<uint32_t>, 3>& middle,
                  std::vector<uvec3>& triangles) const {
        if (middle[0] && middle[1] && middle[2]) {
            triangles.insert(triangles.end(),
                             {uvec3(t.x, *middle[0], *middle[2]), uvec3(*middle[0], t.y, *middle[1]),
                              uvec3(*middle[2], *middle[1], t.z), uvec3(*middle[0], *middle[1], *middle[2])});
            return;
        }
        for (size_t corner = 0; corner < 3; corner++) {
            const uint32_t a = t[int(corner)], b = t[int(corner + 1) % 3], c = t[int(corner + 2) % 3];
            const auto &before = middle[(corner + 2) % 3], &after = middle[corner];
            if (before && after) { // the third edge is whole
                triangles.push_back({*before, a, *after});
                addPolygon(mMesh, triangles, {*after, b, c, *before});
                return;
            }
            if (after && !middle[(corner + 1) % 3]) { // only this edge is split
                triangles.insert(triangles.end(), {uvec3(a, *after, c), uvec3(*after, b, c)});
                return;
            }
        }
        triangles.push_back(t);
    }

    Mesh mMesh;
    const AlphaMask& mMask;
    float mTolerance;
    std::optional<AlphaPyramid> mPyramid;
    std::vector<bool> mIsKept; // per vertex
};

} // namespace

Mesh cutByAlpha(Mesh mesh, const AlphaMask& mask, float tolerance, const std::string& name) {
    const size_t triangles = mesh.triangleCount();
    Cutter cutter(mesh, mask, tolerance);
    if (!cutter.refine())
        log(LogLevel::Warning,
            fmt::format("{}: its alpha has more detail than {} more triangles can follow: holes are coarser",
                        name, kMostAddedTriangles));
    if (!cutter.hasHoles()) return mesh;
    mesh = cutter.cut();
    if (mesh.triangles.empty()) return mesh;
    log(LogLevel::Info, fmt::format("{}: {} triangles became {} where alpha makes holes", name, triangles,
                                    mesh.triangleCount()));
    return cleanUp(std::move(mesh), name);
}

} // namespace relume
