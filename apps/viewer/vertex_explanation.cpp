#include "apps/viewer/vertex_explanation.h"

#include "apps/viewer/cube_images.h"
#include "engine/math/cubemap.h"
#include "engine/render/compare.h"
#include "precompute/error/vertex_probe.h"

#include <algorithm>

namespace relume {

namespace {

constexpr float kGray = 0.35f; // brightness of the environment behind colors

float mean(vec3 v) { return (v.x + v.y + v.z) / 3; }

// Returns the 99th percentile of the texels' mean over channels.
float brightestOf(const LightCube& cube) {
    std::vector<float> values;
    for (const vec3& texel : cube.radiance) values.push_back(mean(texel));
    const auto place = values.end() - std::ptrdiff_t(values.size() / 100) - 1;
    std::nth_element(values.begin(), place, values.end());
    return std::max(*place, 1e-20f);
}

LightCube scaled(const LightCube& cube, float factor) {
    LightCube result = cube;
    for (vec3& texel : result.radiance) texel = glm::max(factor * texel, vec3(0));
    return result;
}

// Draws visibility: black where it is blocked, transparent below the horizon.
Image visibilityPicture(const std::vector<float>& visibility, int size, vec3 normal) {
    LightCube open{size, {}}, above{size, {}};
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) {
                open.radiance.emplace_back(visibility[open.radiance.size()]);
                above.radiance.emplace_back(glm::dot(cubeTexelDirection(face, x, y, size), normal) > 0 ? 1
                                                                                                       : 0);
            }
    Image picture = crossOf(open, kCrossSide / size);
    const Image mask = crossOf(above, kCrossSide / size);
    for (size_t i = 0; i < picture.pixels.size(); i++) picture.pixels[i].w = mask.pixels[i].x;
    return picture;
}

// Draws what each direction contributes to the radiance, over the light itself.
Image contributionsPicture(const LightCube& light, const LightCube& transport) {
    LightCube contributions = transport;
    for (size_t i = 0; i < light.radiance.size(); i++)
        contributions.radiance[i] = glm::max(contributions.radiance[i] * light.radiance[i], vec3(0));
    const float hottest = brightestOf(contributions);
    const Image behind = toneMap(latlongOf(light, kMapWidth), ToneCurve::Agx, 0);
    Image picture = latlongOf(contributions, kMapWidth);
    for (vec4& pixel : picture.pixels) pixel = vec4(heatColor(mean(vec3(pixel)) / hottest), 1);
    picture = toneMap(picture, ToneCurve::None, 0);
    for (size_t i = 0; i < picture.pixels.size(); i++) {
        const vec3 gray(kGray * mean(vec3(behind.pixels[i])));
        picture.pixels[i] = vec4(glm::max(gray, vec3(picture.pixels[i])), 1);
    }
    return picture;
}

} // namespace

VertexExplanation explainVertex(const VertexQuestion& question) {
    const Model& model = *question.model;
    const AssetPart& part = model.asset.parts[question.part];
    const VertexProbe probe = probeVertex(model.asset, model.occluder, question.part, question.vertex,
                                          question.eye, question.bound, question.light, question.selected);
    VertexExplanation explanation;
    explanation.part = part.name;
    explanation.vertex = question.vertex;
    explanation.position = part.mesh.positions[question.vertex];
    explanation.tuple = probe.tuple;
    explanation.radiance = probe.radiance;
    const vec3 normal = part.mesh.normals[question.vertex];
    const int size = model.asset.faceSize;
    float open = 0, above = 0;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) {
                const float angle = cubeTexelSolidAngle(x, y, size);
                open += angle * probe.visibility[size_t(cubeTexelIndex(face, x, y, size))];
                if (glm::dot(cubeTexelDirection(face, x, y, size), normal) > 0) above += angle;
            }
    explanation.openShare = std::min(1.0f, open / above);
    explanation.visibility = visibilityPicture(probe.visibility, size, normal);
    explanation.transport =
        toneMap(crossOf(scaled(probe.transport, 1 / brightestOf(probe.transport)), kCrossSide / size),
                ToneCurve::None, 0);
    explanation.contributions = contributionsPicture(question.light, probe.transport);
    return explanation;
}

} // namespace relume
