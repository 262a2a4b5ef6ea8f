#include "precompute/reference/path_sampling.h"

#include "precompute/reference/lobe_sampling.h"

#include <algorithm>
#include <array>

namespace relume {

namespace {

// Many choices of these counts give equal noise in equal time; these give an early first image.
constexpr int kFromLight = 8, kFromCosine = 4, kRays = 8;
constexpr size_t kCandidates = kFromLight + kFromCosine + kLobeWidths.size();

struct Candidate {
    vec3 direction;
    vec3 share;   // radiance · BRDF · cosine, divided by the sum of its channels' magnitudes
    float weight; // that sum over the sum of all sampling densities
};

class Resampling {
  public:
    Resampling(const SurfacePoint& point, const LightDistribution& light)
        : mPoint(point), mLight(light), mMirror(-point.outgoing.x, -point.outgoing.y, point.outgoing.z) {}

    void drawCandidates(HashedNumbers& random) {
        for (int i = 0; i < kFromLight; i++) {
            const double choice = (double(i) + double(random.next())) / kFromLight;
            const float across = random.next(), down = random.next();
            const auto [direction, texel] = mLight.draw(choice, across, down);
            add(direction, mPoint.frame.toLocal(direction), texel);
        }
        for (int i = 0; i < kFromCosine; i++) {
            const float turn = (float(i) + random.next()) / kFromCosine;
            addLocal(onCone(std::sqrt(1 - random.next()), turn));
        }
        const TangentFrame frame = tangentFrame(mMirror);
        for (float width : kLobeWidths) {
            const float choice = random.next(), turn = random.next();
            addLocal(frame.toWorld(drawLobe(width, choice, turn)));
        }
    }

    // Calls `take` with kRays candidates, in order and some repeatedly, by systematic resampling: equidistant
    // points on the cumulative weights, the first at `offset` of the distance.
    void choose(float offset, const auto& take) const {
        if (!(mSum > 0)) return;
        float end = 0;
        int taken = 0;
        for (size_t i = 0; i < mCount; i++) {
            end += mCandidates[i].weight;
            for (; taken < kRays && (float(taken) + offset) * mSum < end * kRays; taken++)
                take(mCandidates[i]);
        }
    }

    float sum() const { return mSum; }

  private:
    void addLocal(vec3 local) {
        if (!(local.z > 0)) return;
        const vec3 direction = mPoint.frame.toWorld(local);
        add(direction, local, mLight.texelOf(direction));
    }

    void add(vec3 direction, vec3 local, size_t texel) {
        if (!(local.z > 0)) return;
        const vec3 radiance = mLight.radiance(texel);
        if (radiance == vec3(0)) return;
        const vec3 value = radiance * mPoint.reflected(local) * local.z;
        const float size = std::abs(value.x) + std::abs(value.y) + std::abs(value.z);
        if (!(size > 0)) return;
        float density = kFromLight * mLight.density(direction, texel) + kFromCosine * local.z / kPi;
        const float t = 0.5f - 0.5f * glm::dot(local, mMirror);
        for (float width : kLobeWidths) density += lobeDensity(width, t);
        mCandidates[mCount++] = {direction, value / size, size / density};
        mSum += size / density;
    }

    const SurfacePoint& mPoint;
    const LightDistribution& mLight;
    vec3 mMirror; // mirror direction of the view, in the frame
    std::array<Candidate, kCandidates> mCandidates;
    size_t mCount = 0;
    float mSum = 0;
};

} // namespace

void sampleBounces(const PathScene& scene, const SurfacePoint& point, std::span<vec3> byBounces,
                   HashedNumbers& random) {
    vec3 throughput(1);
    SurfacePoint at = point;
    for (vec3& sum : byBounces) {
        const vec3 mirror(-at.outgoing.x, -at.outgoing.y, at.outgoing.z);
        const vec3 incoming = drawReflected(mirror, random);
        if (!(incoming.z > 0)) break;
        throughput *= at.reflected(incoming) * (incoming.z / reflectedDensity(mirror, incoming));
        if (throughput == vec3(0)) break;
        const vec3 direction = at.frame.toWorld(incoming);
        const std::optional<RayHit> hit =
            scene.surfaces.intersect(at.position + scene.shadowOffset * at.normal, direction);
        if (!hit || !meetsFront(*scene.meshes[hit->mesh], *hit, direction)) break;
        at = scene.asset.pointAt(*hit, at.position);
        sum += throughput *
               sampleReflection(at, scene.light, scene.occluder, scene.shadowOffset, random).shadowed;
    }
}

ReflectedRadiance sampleReflection(const SurfacePoint& point, const LightDistribution& light,
                                   const RayTracer& occluder, float shadowOffset, HashedNumbers& random) {
    ReflectedRadiance sum{vec3(0), vec3(0)};
    if (light.isBlack()) return sum;
    Resampling resampling(point, light);
    resampling.drawCandidates(random);
    const vec3 origin = point.position + shadowOffset * point.normal;
    const Candidate* last = nullptr;
    bool isBlocked = false;
    resampling.choose(random.next(), [&](const Candidate& chosen) {
        if (&chosen != last) isBlocked = occluder.occluded(origin, chosen.direction);
        last = &chosen;
        sum.unshadowed += chosen.share;
        if (!isBlocked) sum.shadowed += chosen.share;
    });
    const float scale = resampling.sum() / kRays;
    return {scale * sum.shadowed, scale * sum.unshadowed};
}

} // namespace relume
