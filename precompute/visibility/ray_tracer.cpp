#include "precompute/visibility/ray_tracer.h"

#include "engine/base/check.h"
#include "engine/base/error.h"

#include <algorithm>
#include <array>
#include <embree3/rtcore.h>
#include <fmt/core.h>
#include <limits>

namespace relume {

namespace {

// Throws if Embree has failed. Embree reports the first error since the last call, once, through the device.
void throwOnError(RTCDevice device, const char* what) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw Error(fmt::format(
            "out of memory while Embree was {}; close other programs, or bake with a smaller occluder",
            what));
    throw Error(fmt::format("Embree failed while {}: error {}; check the installation of Embree 3.13", what,
                            int(error)));
}

template <typename Element>
void copyToBuffer(RTCDevice device, RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                  const std::vector<Element>& elements) {
    void* target = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Element), elements.size());
    if (!target) throwOnError(device, "copying a mesh");
    std::copy(elements.begin(), elements.end(), static_cast<Element*>(target));
}

void attach(RTCDevice device, RTCScene scene, const Mesh& mesh, unsigned id) {
    for (const uvec3& triangle : mesh.triangles)
        RELUME_CHECK_LT(std::max({triangle.x, triangle.y, triangle.z}), mesh.vertexCount());
    const std::unique_ptr<RTCGeometryTy, decltype(&rtcReleaseGeometry)> geometry(
        rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE), rtcReleaseGeometry);
    copyToBuffer(device, geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions);
    copyToBuffer(device, geometry.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene, geometry.get(), id);
}

// Fills a ray in place: rays returned by value take 1.5 times as long to trace.
void setRay(RTCRay& ray, vec3 origin, vec3 direction) {
    ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tnear = 0, ray.tfar = std::numeric_limits<float>::infinity();
    ray.time = 0, ray.mask = ~0u, ray.id = 0, ray.flags = 0;
}

} // namespace

bool meetsFront(const Mesh& mesh, const RayHit& hit, vec3 direction) {
    const uvec3 corners = mesh.triangles[hit.triangle];
    const vec3 normal = hit.weights.x * mesh.normals[corners.x] + hit.weights.y * mesh.normals[corners.y] +
                        hit.weights.z * mesh.normals[corners.z];
    const vec3 across = glm::cross(mesh.positions[corners.y] - mesh.positions[corners.x],
                                   mesh.positions[corners.z] - mesh.positions[corners.x]);
    const float side = glm::dot(across, normal) < 0 ? -1.0f : 1.0f;
    return side * glm::dot(across, direction) < 0;
}

struct RayTracer::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
};

RayTracer::RayTracer(std::span<const Mesh* const> meshes) : mImpl(std::make_unique<Impl>()) {
    mImpl->device = rtcNewDevice(nullptr);
    if (!mImpl->device) throwOnError(nullptr, "starting");
    mImpl->scene = rtcNewScene(mImpl->device);
    // Robust mode: no ray slips between two triangles that share an edge.
    rtcSetSceneFlags(mImpl->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(mImpl->scene, RTC_BUILD_QUALITY_HIGH);
    for (size_t i = 0; i < meshes.size(); i++)
        if (!meshes[i]->triangles.empty()) attach(mImpl->device, mImpl->scene, *meshes[i], unsigned(i));
    rtcCommitScene(mImpl->scene);
    throwOnError(mImpl->device, "building its acceleration structure");
}

RayTracer::~RayTracer() = default;
RayTracer::RayTracer(RayTracer&&) noexcept = default;

std::optional<RayHit> RayTracer::intersect(vec3 origin, vec3 direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    setRay(query.ray, origin, direction);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(mImpl->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const float u = query.hit.u, v = query.hit.v;
    return RayHit{query.hit.geomID, query.hit.primID, vec3(1.0f - u - v, u, v), query.ray.tfar};
}

bool RayTracer::occluded(vec3 origin, vec3 direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray;
    setRay(ray, origin, direction);
    rtcOccluded1(mImpl->scene, &context, &ray);
    return ray.tfar < 0;
}

void RayTracer::occluded(vec3 origin, std::span<const vec3> directions, std::span<uint8_t> blocked) const {
    RELUME_CHECK_EQ(directions.size(), blocked.size());
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    std::array<RTCRay, 256> rays; // a batch that stays in the first-level cache
    for (size_t start = 0; start < directions.size(); start += rays.size()) {
        const size_t count = std::min(rays.size(), directions.size() - start);
        for (size_t i = 0; i < count; i++) setRay(rays[i], origin, directions[start + i]);
        rtcOccluded1M(mImpl->scene, &context, rays.data(), unsigned(count), sizeof(RTCRay));
        // Embree sets tfar to minus infinity on a hit.
        for (size_t i = 0; i < count; i++) blocked[start + i] = rays[i].tfar < 0;
    }
}

void RayTracer::occluded(vec3 origin, const float* x, const float* y, const float* z,
                         std::span<float> reach) const {
    RELUME_CHECK_LE(reach.size(), kStream);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    // Fields that no ray changes. An occlusion query writes only tfar, although Embree's signature takes all
    // as writable.
    static const std::array<float, kStream> zeros{};
    static const std::array<unsigned, kStream> noFlags{};
    static const std::array<unsigned, kStream> allMasks = [] {
        std::array<unsigned, kStream> masks;
        masks.fill(~0u);
        return masks;
    }();
    std::array<float, kStream> originX, originY, originZ;
    originX.fill(origin.x), originY.fill(origin.y), originZ.fill(origin.z);
    const auto readOnly = []<typename T>(const T* values) { return const_cast<T*>(values); };
    RTCRayNp rays;
    rays.org_x = originX.data(), rays.org_y = originY.data(), rays.org_z = originZ.data();
    rays.dir_x = readOnly(x), rays.dir_y = readOnly(y), rays.dir_z = readOnly(z);
    rays.tnear = rays.time = readOnly(zeros.data());
    rays.tfar = reach.data();
    rays.mask = readOnly(allMasks.data());
    rays.id = rays.flags = readOnly(noFlags.data());
    rtcOccludedNp(mImpl->scene, &context, &rays, unsigned(reach.size()));
}

} // namespace relume
