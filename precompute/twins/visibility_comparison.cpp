#include "precompute/twins/visibility_comparison.h"

#include "engine/math/cubemap.h"
#include "engine/vk/upload.h"
#include "precompute/visibility/visibility.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace relume {

namespace {

constexpr uint32_t kBatch = 16;

std::vector<shared::BakePoint> spreadPoints(const Asset& asset, uint64_t wanted) {
    const uint64_t vertices = vertexCount(asset);
    wanted = std::min(wanted, vertices);
    std::vector<shared::BakePoint> points;
    for (uint64_t i = 0; i < wanted; i++) {
        uint64_t vertex = i * vertices / wanted;
        auto part = asset.parts.begin();
        for (; vertex >= part->mesh.vertexCount(); part++) vertex -= part->mesh.vertexCount();
        points.push_back(bakePoint(part->mesh, vertex, asset.visibilityOffset));
    }
    return points;
}

using Bits = std::vector<uint32_t>;
bool isSet(const Bits& bits, int texel) { return bits[size_t(texel) / 32] >> texel % 32 & 1; }

// Finds visibility by one method, for up to kBatch points at a time.
class Finder {
  public:
    Finder(const vk::Device& device, const Asset& asset, VisibilityMethod method)
        : mDevice(device), mBytes(visibilityBytes(uint32_t(asset.visibilitySize))),
          mVisibility(makeVisibility(device, method, asset.occluder, uint32_t(asset.visibilitySize), kBatch,
                                     visibilityNearDistance(asset.visibilityOffset))),
          mBits(device, kBatch * mBytes, vk::BufferUse::Device, "visibility bits"),
          mCommands(device, "compare visibility") {}

    std::vector<Bits> find(std::span<const shared::BakePoint> points) {
        const auto buffer = vk::upload<shared::BakePoint>(mDevice, points, "points");
        mCommands.begin();
        mVisibility->record(mCommands, buffer, uint32_t(points.size()), mBits);
        mCommands.submitAndWait();
        mVisibility->check();
        const auto words = vk::download<uint32_t>(mDevice, mBits, points.size() * mBytes / 4);
        std::vector<Bits> cubes;
        for (size_t point = 0; point < points.size(); point++) {
            const auto begin = words.begin() + ptrdiff_t(point * mBytes / 4);
            cubes.emplace_back(begin, begin + ptrdiff_t(mBytes / 4));
        }
        return cubes;
    }

  private:
    const vk::Device& mDevice;
    uint64_t mBytes;
    std::unique_ptr<Visibility> mVisibility;
    vk::Buffer mBits;
    vk::Commands mCommands;
};

bool hasSilhouette(const Bits& bits, int face, int x, int y, int size) {
    const bool own = isSet(bits, cubeTexelIndex(face, x, y, size));
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, size - 1); ny++)
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, size - 1); nx++)
            if (isSet(bits, cubeTexelIndex(face, nx, ny, size)) != own) return true;
    return false;
}

// Draws a square ring around a texel, which alone is hard to find.
void drawRing(Image& image, ivec2 at, vec4 color) {
    constexpr int kRadius = 5;
    for (int dy = -kRadius; dy <= kRadius; dy++)
        for (int dx = -kRadius; dx <= kRadius; dx++) {
            const ivec2 p = at + ivec2(dx, dy);
            const bool isRing = std::max(std::abs(dx), std::abs(dy)) == kRadius;
            if (isRing && p.x >= 0 && p.y >= 0 && p.x < image.width && p.y < image.height)
                image.at(p.x, p.y) = color;
        }
}

Image draw(const Bits& raster, const Bits& traced, vec3 normal, int size) {
    constexpr std::array<ivec2, 6> kPlaces = {ivec2(2, 1), {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
    const vec4 seen(1), blocked(0, 0, 0, 1), below(0.45f, 0.45f, 0.45f, 1), different(1, 0.1f, 0.1f, 1),
        paper(0.8f, 0.8f, 0.8f, 1);
    Image image(4 * size, 3 * size);
    std::ranges::fill(image.pixels, paper);
    std::vector<ivec2> differences;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) {
                const int texel = cubeTexelIndex(face, x, y, size);
                const bool isAbove = glm::dot(cubeTexelDirection(face, x, y, size), normal) > 0;
                const ivec2 at = kPlaces[size_t(face)] * size + ivec2(x, y);
                image.at(at.x, at.y) = !isAbove ? below : isSet(traced, texel) ? seen : blocked;
                if (isSet(raster, texel) != isSet(traced, texel)) differences.push_back(at);
            }
    for (const ivec2 at : differences) {
        image.at(at.x, at.y) = different;
        drawRing(image, at, different);
    }
    return image;
}

} // namespace

std::optional<VisibilityComparison> compareVisibility(const vk::Device& device, const Asset& asset,
                                                      int samples) {
    if (!canUse(device, VisibilityMethod::Traced)) return std::nullopt;
    Finder raster(device, asset, VisibilityMethod::Raster), traced(device, asset, VisibilityMethod::Traced);
    const std::vector<shared::BakePoint> points = spreadPoints(asset, uint64_t(samples));
    const int size = asset.visibilitySize;
    VisibilityComparison found;
    std::optional<uint64_t> most;
    for (size_t first = 0; first < points.size(); first += kBatch) {
        const auto batch = std::span(points).subspan(first, std::min<size_t>(kBatch, points.size() - first));
        const std::vector<Bits> rasterCubes = raster.find(batch), tracedCubes = traced.find(batch);
        for (size_t point = 0; point < batch.size(); point++) {
            const Bits &a = rasterCubes[point], &b = tracedCubes[point];
            uint64_t different = 0;
            for (int face = 0; face < kCubeFaces; face++)
                for (int y = 0; y < size; y++)
                    for (int x = 0; x < size; x++) {
                        const vec3 direction = cubeTexelDirection(face, x, y, size);
                        found.hemisphere += glm::dot(direction, batch[point].normal) > 0;
                        const int texel = cubeTexelIndex(face, x, y, size);
                        if (isSet(a, texel) == isSet(b, texel)) continue;
                        different++;
                        found.inside += !hasSilhouette(b, face, x, y, size);
                    }
            found.different += different;
            if (!most || different > *most) {
                most = different;
                found.picture = draw(a, b, batch[point].normal, size);
            }
        }
    }
    return found;
}

} // namespace relume
