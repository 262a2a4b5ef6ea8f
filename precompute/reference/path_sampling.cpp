#include "precompute/reference/path_sampling.h"

#include "precompute/reference/lobe_sampling.h"

namespace relume {

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
        sum += throughput * sampleReflection(at, scene.light, scene.occluder, scene.shadowOffset, random);
    }
}

} // namespace relume
