#include "precompute/bounce/bounce_gather.h"

#include "engine/math/hashed_numbers.h"
#include "engine/math/tangent_frame.h"
#include "engine/render/appearance.h"
#include "precompute/thread_limit.h"
#include "precompute/transport/row_sum.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

// Values of up to kTerms terms in three channels, side by side, so that an instruction serves all terms.
struct TermGroup {
    static constexpr size_t kTerms = 8;
    using Values = Eigen::Array<float, kTerms, 1>;

    Values red = Values::Zero(), green = Values::Zero(), blue = Values::Zero();

    void set(size_t term, vec3 value) {
        red[Eigen::Index(term)] = value.x;
        green[Eigen::Index(term)] = value.y;
        blue[Eigen::Index(term)] = value.z;
    }
    vec3 get(size_t term) const {
        return {red[Eigen::Index(term)], green[Eigen::Index(term)], blue[Eigen::Index(term)]};
    }
    void add(const TermGroup& light, vec3 value) {
        red += light.red * value.x;
        green += light.green * value.y;
        blue += light.blue * value.z;
    }
};

// Returns the number of groups that hold so many terms.
size_t groupsFor(int terms) { return (size_t(terms) + TermGroup::kTerms - 1) / TermGroup::kTerms; }

// The rays along which a vertex gathers bounced light: cosine-distributed directions in its frame, kSide²
// strata of a square, mapped to the hemisphere and shifted differently for every vertex.
class BounceRays {
  public:
    static constexpr int kSide = 32;
    static constexpr float kWeight = kPi / (kSide * kSide); // cosine · solid angle that a ray stands for

    BounceRays(size_t part, uint32_t vertex) {
        HashedNumbers random(vertex, uint32_t(part));
        for (int axis = 0; axis < 3; axis++) mShift[axis] = random.next();
    }

    // Advances to the next ray; must be called before the first. Returns false after the last.
    bool next() { return ++mRay < kSide * kSide; }

    // Returns a unit vector in the frame.
    vec3 direction() const {
        const float u = (float(mRay / kSide) + mShift.x) / kSide,
                    v = (float(mRay % kSide) + mShift.y) / kSide;
        const float radius = std::sqrt(u), angle = 2 * kPi * v;
        return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0f, 1 - u))};
    }

    // Returns a number in [0, 1), independent of the direction, for a random choice per ray.
    float choice() const {
        constexpr double kGoldenRatio = 0.6180339887498949; // its multiples are evenly distributed
        const double place = double(mShift.z) + mRay * kGoldenRatio;
        return float(place - std::floor(place));
    }

  private:
    int mRay = -1;
    vec3 mShift; // of the square's axes, and of choice()
};

std::vector<const Mesh*> meshesOf(const Asset& asset) {
    std::vector<const Mesh*> meshes;
    for (const AssetPart& part : asset.parts) meshes.push_back(&part.mesh);
    return meshes;
}

} // namespace

std::optional<uint16_t> bounceCoefficient(uint16_t coefficient, int size) {
    const int face = coefficient / (size * size), y = coefficient / size % size, x = coefficient % size;
    if (x >= kBounceFaceSize || y >= kBounceFaceSize) return std::nullopt;
    return uint16_t((face * kBounceFaceSize + y) * kBounceFaceSize + x);
}

uint16_t coefficientOfBounce(uint16_t coefficient, int size) {
    const int face = coefficient / (kBounceFaceSize * kBounceFaceSize),
              y = coefficient / kBounceFaceSize % kBounceFaceSize, x = coefficient % kBounceFaceSize;
    return uint16_t((face * size + y) * size + x);
}

vec3 reflectedShare(const FactoredBrdf& brdf, int layer) {
    // (1 / π) ∫∫ f cosθi cosθo dωi dωo, where the integrals of each term separate.
    std::vector<vec3> in(size_t(brdf.terms), vec3(0)), out = in;
    for (BounceRays rays(0, 0); rays.next();) {
        const MapPlace place = placeInMap(brdf.size, brdf.mapping, rays.direction());
        for (int term = 0; term < brdf.terms; term++) {
            in[size_t(term)] += BounceRays::kWeight * lookupMap(brdf.lightMap(term), place);
            out[size_t(term)] += BounceRays::kWeight * lookupMap(brdf.viewMap(layer, term), place);
        }
    }
    vec3 share(0);
    for (size_t term = 0; term < in.size(); term++) share += in[term] * out[term] / kPi;
    return share;
}

vec3 sourceGain(vec3 reflectedShare) {
    constexpr float kTolerance = 1e-3f; // of sums over directions
    vec3 gain(1);
    for (int channel = 0; channel < 3; channel++)
        if (reflectedShare[channel] > 1 + kTolerance) gain[channel] = 1 / reflectedShare[channel];
    return gain;
}

std::vector<std::vector<vec3>> sourceGains(const Asset& asset, const Appearance& bound) {
    std::vector<std::vector<vec3>> gains;
    for (size_t part = 0; part < asset.parts.size(); part++) {
        gains.emplace_back();
        for (const BoundLayer& shown : boundLayers(asset.parts[part], bound[part]))
            gains.back().push_back(
                sourceGain(reflectedShare(asset.parts[part].sets[bound[part].set].brdf, shown.layer)));
    }
    return gains;
}

// A surface that a ray hits: the vertex whose rows represent it, and the view maps' values per term.
struct BounceGather::Hit {
    size_t part;
    uint32_t vertex;
    std::array<vec3, kMostTerms> views;
};

// A thread's buffers, reused from vertex to vertex.
struct BounceGather::Room {
    explicit Room(int mostTerms)
        : light(groupsFor(mostTerms)), total(light.size() * kBounceCoefficients), sum(kBounceCoefficients) {}

    std::vector<TermGroup> light; // of a ray: g of each term, times the ray's weight
    std::vector<TermGroup> total; // per group and coefficient: bounced light
    RowSum sum;                   // of what leaves a hit; then of a row
};

BounceGather::BounceGather(const Asset& asset, const Appearance& bound)
    : mAsset(asset), mBound(bound), mGains(sourceGains(asset, bound)), mTracer(meshesOf(asset)) {
    for (size_t part = 0; part < asset.parts.size(); part++) {
        mLayers.push_back(boundLayers(asset.parts[part], bound[part]));
        for (size_t i = 0; i < mLayers[part].size(); i++) {
            const vec3 gain = mGains[part][i];
            if (gain != vec3(1))
                mHeld.push_back({part, mLayers[part][i].layer, 1 / std::min({gain.x, gain.y, gain.z})});
        }
    }
}

// Attributes are interpolated as in the view pass. Rows are those of one corner, chosen with its weight as
// probability.
bool BounceGather::find(vec3 origin, vec3 direction, float choice, Hit& hit) const {
    const std::optional<RayHit> met = mTracer.intersect(origin, direction);
    if (!met || !meetsFront(mAsset.parts[met->mesh].mesh, *met, direction)) return false;
    const AssetPart& part = mAsset.parts[met->mesh];
    const Mesh& mesh = part.mesh;
    const uvec3 corners = mesh.triangles[met->triangle];
    const vec3 weights = met->weights;
    const auto interpolate = [&](const auto& values) {
        return weights.x * values[corners.x] + weights.y * values[corners.y] + weights.z * values[corners.z];
    };
    const vec3 normal = interpolate(mesh.normals);
    if (glm::dot(normal, normal) < 1e-12f) return false; // normals cancel on a fold
    const vec3 tangent = mesh.tangents.empty() ? vec3(0) : interpolate(mesh.tangents);
    const TangentFrame frame = tangentFrame(glm::normalize(normal), tangent);
    const vec3 outgoing = liftAboveHorizon(frame.toLocal(-direction));
    const vec2 uv = mesh.uvs.empty() ? vec2(0) : interpolate(mesh.uvs);
    const vec4 color = mesh.colors.empty() ? vec4(0) : interpolate(mesh.colors);

    hit.part = met->mesh;
    hit.vertex = choice < weights.x ? corners.x : choice < weights.x + weights.y ? corners.y : corners.z;
    const size_t set = mBound[hit.part].set;
    const FactoredBrdf& brdf = part.sets[set].brdf;
    const std::vector<BoundLayer>& layers = mLayers[hit.part];
    const std::vector<vec3> shares = layerWeights(part, set, layers, uv, color);
    const MapPlace place = placeInMap(brdf.size, brdf.mapping, outgoing);
    for (int term = 0; term < brdf.terms; term++) {
        vec3 view(0);
        for (size_t i = 0; i < layers.size(); i++)
            view += shares[i] * mGains[hit.part][i] * lookupMap(brdf.viewMap(layers[i].layer, term), place);
        hit.views[size_t(term)] = view;
    }
    return true;
}

void BounceGather::gatherVertex(size_t number, uint32_t vertex, std::span<const SparseTransport> from,
                                Room& room, std::span<SparseTransport> rows) const {
    const AssetPart& part = mAsset.parts[number];
    const Mesh& mesh = part.mesh;
    const TangentFrame frame = frameOf(mesh, vertex);
    const vec3 origin = mesh.positions[vertex] + mAsset.visibilityOffset * mesh.normals[vertex];
    const size_t groups = groupsFor(termCount(part));
    std::fill_n(room.light.begin(), groups, TermGroup{});
    std::fill_n(room.total.begin(), groups * kBounceCoefficients, TermGroup{});
    bool isAny = false;
    Hit hit;
    for (BounceRays rays(number, vertex); rays.next();) {
        const vec3 local = rays.direction();
        if (!find(origin, frame.toWorld(local), rays.choice(), hit)) continue;
        isAny = true;
        size_t row = 0;
        for (const MaterialSet& set : part.sets) {
            const MapPlace place = placeInMap(set.brdf.size, set.brdf.mapping, local);
            for (int term = 0; term < set.brdf.terms; term++, row++) {
                const vec3 g = lookupMap(set.brdf.lightMap(term), place) * BounceRays::kWeight;
                room.light[row / TermGroup::kTerms].set(row % TermGroup::kTerms, g);
            }
        }
        const SparseTransport& sources = from[hit.part];
        for (uint32_t term = 0; term < sources.terms; term++) {
            const size_t source = size_t(hit.vertex) * sources.terms + term;
            const vec3 step = hit.views[term] * sources.scales[source] * kCoefficientUnit;
            for (uint64_t i = sources.rowStarts[source]; i < sources.rowStarts[source + 1]; i++)
                room.sum.add(sources.indices[i], step * vec3(unpackCoefficient(sources.values[i])));
        }
        room.sum.drain([&](size_t coefficient, vec3 radiance) {
            for (size_t group = 0; group < groups; group++)
                room.total[group * kBounceCoefficients + coefficient].add(room.light[group], radiance);
        });
    }

    size_t row = 0;
    for (SparseTransport& own : rows) {
        for (uint32_t term = 0; term < own.terms; term++, row++) {
            const TermGroup* total = &room.total[row / TermGroup::kTerms * kBounceCoefficients];
            if (isAny)
                for (size_t i = 0; i < kBounceCoefficients; i++)
                    room.sum.add(i, total[i].get(row % TermGroup::kTerms));
            appendRow(own, room.sum.pack(kBounceKept));
        }
        own.vertices++;
    }
}

std::vector<std::vector<SparseTransport>> BounceGather::gather(std::span<const SparseTransport> from,
                                                               const Report& report) const {
    constexpr uint32_t kTogether = 8, kPerThread = 256; // vertices: of a task, and between reports
    const auto batch = uint32_t(kPerThread * allowedThreads());
    int mostTerms = 0;
    for (const AssetPart& part : mAsset.parts) mostTerms = std::max(mostTerms, termCount(part));
    tbb::enumerable_thread_specific<Room> rooms(mostTerms);
    const auto rowsOfSets = [](const AssetPart& part) {
        std::vector<SparseTransport> rows;
        for (const MaterialSet& set : part.sets) rows.push_back(emptyRows(uint32_t(set.brdf.terms)));
        return rows;
    };
    std::vector<std::vector<SparseTransport>> gathered;
    uint64_t done = 0;
    for (size_t number = 0; number < mAsset.parts.size(); number++) {
        const AssetPart& part = mAsset.parts[number];
        std::vector<SparseTransport>& all = gathered.emplace_back(rowsOfSets(part));
        const auto vertices = uint32_t(part.mesh.vertexCount());
        for (uint32_t first = 0; first < vertices; first += batch) {
            const uint32_t end = std::min(first + batch, vertices);
            std::vector<std::vector<SparseTransport>> portions((end - first + kTogether - 1) / kTogether,
                                                               rowsOfSets(part));
            tbb::parallel_for(size_t(0), portions.size(), [&](size_t portion) {
                const auto begin = uint32_t(first + portion * kTogether);
                for (uint32_t vertex = begin; vertex < std::min(begin + kTogether, end); vertex++)
                    gatherVertex(number, vertex, from, rooms.local(), portions[portion]);
            });
            for (const std::vector<SparseTransport>& portion : portions)
                for (size_t set = 0; set < all.size(); set++) appendRows(all[set], portion[set]);
            done += end - first;
            if (!report(done)) return {};
        }
    }
    return gathered;
}

} // namespace relume
