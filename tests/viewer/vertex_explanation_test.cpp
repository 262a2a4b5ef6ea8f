// The explanation of a vertex is that of what is drawn.
#include "apps/viewer/vertex_explanation.h"

#include "apps/viewer/cube_images.h"
#include "engine/math/cubemap.h"
#include "tests/support/test_device.h"
#include "tests/support/viewer_session.h"

using namespace relume;
using namespace relume::test;

TEST_CASE("why: tuple and radiance are those of the relit vertex, and the lamp is what it is lit by") {
    const TestDevice device;
    const auto model = std::make_shared<Model>(device, sharedSession().path("ring.relume"));
    constexpr float kAzimuth = 40, kElevation = 50;
    Light light;
    light.lamps.push_back({directionAt(kAzimuth, kElevation), glm::radians(8.0f), vec3(30)});
    model->light.setLight(light);
    const LightSelection all{.threshold = 0};
    vk::Commands commands(device, "relight");
    commands.begin();
    model->light.record(commands, 0, all);
    model->relighter.record(commands, model->light, model->appearance);
    commands.submitAndWait();

    // A vertex of the ring that faces the lamp, seen from where it faces.
    const Mesh& mesh = model->asset.parts[0].mesh;
    uint32_t vertex = 0;
    for (uint32_t i = 0; i < mesh.vertexCount(); i++)
        if (glm::dot(mesh.normals[i], light.lamps[0].direction) >
            glm::dot(mesh.normals[vertex], light.lamps[0].direction))
            vertex = i;
    const vec3 position = mesh.positions[vertex], normal = mesh.normals[vertex];
    const Camera camera{position + 4.0f * glm::normalize(normal + vec3(0.2f, 0.1f, -0.1f)), position, 0.5f};
    const VertexExplanation explanation = explainVertex({model, model->appearance[0], 0, vertex, camera.eye,
                                                         model->light.readCube(), model->light.readVector()});
    CHECK_EQ(explanation.part, model->asset.parts[0].name);
    CHECK_EQ(explanation.vertex, vertex);
    CHECK_EQ(explanation.position, position);

    const std::vector<vec3> tuples = model->relighter.readTuples(0);
    const auto terms = size_t(termsOf(*model));
    REQUIRE_EQ(explanation.tuple.size(), terms);
    for (size_t term = 0; term < terms; term++) {
        const vec3 relit = tuples[vertex * terms + term];
        CHECK(glm::distance(explanation.tuple[term], relit) <= 1e-4f * glm::length(relit) + 1e-6f);
    }
    // The vertex is in the middle of the image; its terms are what is explained.
    model->view.resize(401, 401);
    model->view.setResidual(false);
    const vec3 drawn = vec3(model->view.render(camera, model->relighter).at(200, 200));
    CHECK_GT(drawn.x, 0.05f);
    CHECK(glm::distance(explanation.radiance, drawn) < 0.05f * glm::length(drawn));

    const Mesh* const occluderMesh = &model->asset.occluder;
    const RayTracer occluder({&occluderMesh, 1});
    float open = 0, above = 0;
    for (int i = 0; i < 6 * 64 * 64; i++) {
        const int face = i / (64 * 64), y = i / 64 % 64, x = i % 64;
        const vec3 direction = cubeTexelDirection(face, x, y, 64);
        if (glm::dot(direction, normal) <= 0) continue;
        above += cubeTexelSolidAngle(x, y, 64);
        if (!occluder.occluded(position + model->asset.visibilityOffset * normal, direction))
            open += cubeTexelSolidAngle(x, y, 64);
    }
    CHECK(explanation.openShare == doctest::Approx(open / above).epsilon(0.02));
    CHECK_EQ(explanation.visibility.width, 4 * kCrossSide);
    CHECK_EQ(explanation.visibility.height, 3 * kCrossSide);
    // Where its normal points to it is open; the other way is below its horizon.
    const auto onCross = [&](vec3 direction) {
        LightCube cube{64, std::vector<vec3>(6 * 64 * 64, vec3(0))};
        const CubeTexel texel = cubeTexel(direction, cube.size);
        cube.radiance[size_t(cubeTexelIndex(texel.face, texel.x, texel.y, cube.size))] = vec3(1);
        const Image cross = crossOf(cube, kCrossSide / cube.size);
        const auto pixel = std::ranges::find_if(cross.pixels, [](vec4 p) { return p.x > 0; });
        return explanation.visibility.pixels[size_t(pixel - cross.pixels.begin())];
    };
    CHECK_EQ(onCross(normal), vec4(1));
    CHECK_EQ(onCross(-normal).w, 0);

    // What reaches the eye comes from the lamp.
    const Image& map = explanation.contributions;
    CHECK_EQ(map.width, kMapWidth);
    const auto hottest =
        std::ranges::max_element(map.pixels, {}, [](const vec4& p) { return p.x + p.y + p.z; });
    const auto place = int(hottest - map.pixels.begin());
    const MapAngles angles = anglesAt({(float(place % map.width) + 0.5f) / float(map.width),
                                       (float(place / map.width) + 0.5f) / float(map.height)});
    CHECK_GT(glm::dot(directionAt(angles.azimuth, angles.elevation), light.lamps[0].direction),
             std::cos(glm::radians(10.0f)));
    CHECK_GT(hottest->x, 0.7f);
    CHECK_LT(map.at(2, map.height - 2).x, 0.1f); // darkness below
}
