#include "engine/import/builtin_mesh.h"
#include "engine/math/tangent_frame.h"
#include "engine/render/view_pass.h"
#include "precompute/twins/transport_twin.h"
#include "tests/support/host_view.h"
#include "tests/support/test_device.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace relume;
using namespace relume::test;

namespace {

// Random view maps of both signs and a few random entries a row.
MaterialSet makeSet(uint32_t vertices, int terms, DiskMapping mapping, uint32_t seed, int layers = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-1, 1);
    MaterialSet set;
    set.materials = {{"test", "{}"}};
    set.brdf.size = 8;
    set.brdf.terms = terms;
    set.brdf.layers = layers;
    set.brdf.mapping = mapping;
    for (size_t i = 0; i < size_t(layers * terms) * set.brdf.mapTexels(); i++)
        set.brdf.viewMaps.emplace_back(value(random), value(random), value(random));
    SparseTransport& transport = rowsOf(set.transport);
    transport.vertices = vertices;
    transport.terms = uint32_t(terms);
    transport.rowStarts.push_back(0);
    for (size_t row = 0; row < transport.rows(); row++) {
        transport.scales.push_back(1 + value(random) / 2);
        for (int e = 0; e < 3; e++) {
            transport.indices.push_back(uint16_t(random() % (6 * 64 * 64)));
            transport.values.push_back(random());
        }
        transport.rowStarts.push_back(transport.values.size());
    }
    return set;
}

AssetPart makePart(Mesh mesh, int terms, DiskMapping mapping, uint32_t seed) {
    AssetPart part;
    part.name = "test";
    part.sets.push_back(makeSet(uint32_t(mesh.vertexCount()), terms, mapping, seed));
    part.mesh = std::move(mesh);
    return part;
}

Texture randomTexture(int width, int height, bool srgb, uint32_t seed) {
    std::mt19937 random(seed);
    Texture texture{width, height, {}, srgb};
    for (int i = 0; i < width * height; i++) texture.texels.push_back(uint32_t(random()));
    return texture;
}

// A sphere with two sets of materials, some with a base, a base color texture, and paint of either kind;
// over a plane in one plain material.
Asset makePaintedAsset(bool byColors) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> value(0, 1);
    Asset asset;
    AssetPart& part = asset.parts.emplace_back();
    part.name = "painted";
    part.mesh = makeSphere(2, true);
    const auto vertices = uint32_t(part.mesh.vertexCount());
    part.sets.push_back(makeSet(vertices, 5, DiskMapping::EqualArea, 11, 4));
    part.sets[0].materials = {{"matt", "{}", 0, false}, {"coated", "{}", 1, true}, {"gloss", "{}", 3, false}};
    part.sets.push_back(makeSet(vertices, 2, DiskMapping::Orthographic, 12, 2));
    part.sets[1].materials = {{"other", "{}", 0, true}};
    part.baseColor = randomTexture(7, 5, true, 13);
    part.paintedByColors = byColors;
    if (!byColors) part.materialMap = randomTexture(6, 4, false, 14);
    for (uint32_t v = 0; byColors && v < vertices; v++)
        part.mesh.colors.emplace_back(value(random), value(random), value(random), value(random));
    Mesh plane = makePlane(4, 3);
    for (vec3& position : plane.positions) position.y -= 0.5f;
    asset.parts.push_back(makePart(plane, 3, DiskMapping::EqualArea, 2));
    return asset;
}

Asset makeAsset(int firstTerms, int secondTerms) {
    Asset asset;
    Mesh plane = makePlane(4, 3);
    for (vec3& position : plane.positions) position.y -= 0.5f; // cuts the sphere
    asset.parts.push_back(makePart(makeSphere(2), firstTerms, DiskMapping::Orthographic, 1));
    asset.parts.push_back(makePart(plane, secondTerms, DiskMapping::Polar, 2));
    return asset;
}

LightCube makeLight() {
    std::mt19937 random(3);
    LightCube cube{64, {}};
    for (int i = 0; i < 6 * 64 * 64; i++)
        cube.radiance.emplace_back(float(random() % 997), float(random() % 1009), float(random() % 1013));
    return cube;
}

struct TestScene {
    TestScene(const vk::Device& device, const Asset& asset, const Appearance& appearance)
        : light(device, asset.faceSize), relighter(device, asset) {
        light.setCube(makeLight());
        vk::Commands commands(device, "view test");
        commands.begin();
        light.record(commands, 0, {0});
        relighter.record(commands, light, appearance);
        commands.submitAndWait();
    }
    LightPass light;
    Relighter relighter;
};

// Errors may be up to `tolerance` of the largest value, or what the sampler's rounding makes of view maps.
void checkAgainstHost(const vk::Device& device, const Asset& asset, const Appearance& appearance,
                      float tolerance = 0) {
    const TestScene scene(device, asset, appearance);
    const LightVector light = scene.light.readVector();
    constexpr int kWidth = 120, kHeight = 80;
    ViewPass view(device, asset, {.width = kWidth, .height = kHeight, .samples = 1});
    view.setAppearance(appearance);
    const Camera camera = orbitCamera(boundsOf(asset), 0.5f, 0.6f, 0.7f, 0.8f, float(kWidth) / kHeight);
    const Image image = view.render(camera, scene.relighter);
    REQUIRE_EQ(image.width, kWidth);
    REQUIRE_EQ(image.height, kHeight);

    const HostView host(device, asset, light, appearance);
    std::vector<HostPixel> expected;
    for (int y = 0; y < kHeight; y++)
        for (int x = 0; x < kWidth; x++)
            expected.push_back(host.at(camera, vec2(x, y) + 0.5f, {kWidth, kHeight}));

    float largest = 0, worst = 0;
    int covered = 0, clamped = 0;
    for (int y = 1; y + 1 < kHeight; y++)
        for (int x = 1; x + 1 < kWidth; x++) {
            const HostPixel* here = &expected[size_t(y * kWidth + x)];
            const bool beside =
                here[-1].covered || here[1].covered || here[-kWidth].covered || here[kWidth].covered;
            if (!here->covered && beside) continue;
            if (here->covered && !here->steady) continue;
            const vec4 pixel = image.at(x, y);
            CHECK_EQ(pixel.w, here->covered ? 1.0f : 0.0f);
            covered += here->covered;
            for (int c = 0; c < 3; c++) {
                CHECK_LE(0.0f, pixel[c]);
                largest = std::max(largest, here->radiance[c]);
                worst = std::max(worst, std::abs(pixel[c] - here->radiance[c]));
                clamped += here->covered && here->radiance[c] == 0;
            }
        }
    CHECK_LT(worst, std::max(tolerance, filterError(device)) * largest);
    CHECK_LT(kWidth * kHeight / (roundsFinely(device) ? 4 : 12), covered);
    CHECK_LT(roundsFinely(device) ? 100 : 30, clamped);
}

void checkPlain(const vk::Device& device, const Asset& asset) {
    checkAgainstHost(device, asset, defaultAppearance(asset));
}

// Tolerance where textures are looked up: their texels of 8 bits are filtered with weights of 8 bits on many
// devices, lavapipe among them.
constexpr float kFiltered = 0.01f;

} // namespace

TEST_CASE("view pass: materials of a set are bound alone, blended, and swapped for another set's") {
    const TestDevice device;
    const Asset asset = makePaintedAsset(true);
    const auto bound = [&](std::vector<WeightedMaterial> blend) {
        Appearance appearance = defaultAppearance(asset);
        bindMaterials(appearance, asset, blend);
        return appearance;
    };
    checkAgainstHost(device, asset, bound({{"matt"}}));
    checkAgainstHost(device, asset, bound({{"gloss", 0.25f}, {"matt", 0.75f}}));
    checkAgainstHost(device, asset, bound({{"coated"}}), kFiltered); // rest and textured base
    checkAgainstHost(device, asset, bound({{"other"}}), kFiltered);
}

TEST_CASE("view pass: materials are painted by vertex colors and by a map") {
    const TestDevice device;
    for (bool byColors : {true, false}) {
        const Asset asset = makePaintedAsset(byColors);
        checkAgainstHost(device, asset, defaultAppearance(asset), kFiltered);
    }
}

TEST_CASE("view pass: far away, a texture is its mean over each pixel") {
    // A plane that glows through a texture of 64 x 64 random squares, and reflects nothing.
    Asset asset;
    for (int i = 0; i < 2; i++) {
        AssetPart& part = asset.parts.emplace_back(makePart(makePlane(4, 3, true), 1, DiskMapping::Polar, 1));
        std::ranges::fill(part.sets[0].brdf.viewMaps, vec3(0));
        for (vec3& position : part.mesh.positions) position.y -= float(i); // the second is hidden
    }
    const Texture squares = randomTexture(64, 64, true, 5);
    Texture texture{256, 256, {}, true};
    for (int t = 0; t < 256 * 256; t++)
        texture.texels.push_back(squares.texels[size_t(t / 1024 * 64 + t % 256 / 4)]);
    asset.parts[0].detail = {.emission = vec3(1), .emissionMap = texture};
    const Mesh& plane = asset.parts[0].mesh;

    const TestDevice device;
    const Appearance appearance = defaultAppearance(asset);
    const TestScene scene(device, asset, appearance);
    constexpr int kWidth = 120, kHeight = 80;
    ViewPass view(device, asset, {.width = kWidth, .height = kHeight, .samples = 1});
    const Camera camera = orbitCamera(boundsOf(asset), 0.5f, 0.2f, 0.7f, 0.8f, float(kWidth) / kHeight);
    const Image image = view.render(camera, scene.relighter);

    // The texture coordinates where the ray through a place in the image meets the plane.
    const uvec3 corners = plane.triangles[0];
    const vec3 origin = plane.positions[corners.x];
    const auto uvAt = [&](vec2 place) {
        const vec3 ray = camera.directionAt(place, kWidth, kHeight);
        const vec3 solved = glm::inverse(mat3(plane.positions[corners.y] - origin,
                                              plane.positions[corners.z] - origin, -ray)) *
                            (camera.eye - origin);
        return plane.uvs[corners.x] + solved.x * (plane.uvs[corners.y] - plane.uvs[corners.x]) +
               solved.y * (plane.uvs[corners.z] - plane.uvs[corners.x]);
    };
    const std::vector<Texture> levels = makeMipLevels(texture);
    double sum = 0, ofPoints = 0;
    int covered = 0;
    for (int y = 0; y < kHeight; y++)
        for (int x = 0; x < kWidth; x++) {
            const vec2 middle(float(x) + 0.5f, float(y) + 0.5f);
            const vec2 uv = uvAt(middle);
            const vec2 margin = glm::min(uv, 1.0f - uv);
            if (image.at(x, y).w == 0 || std::min(margin.x, margin.y) < 0.02f) continue;
            const vec2 right = uvAt(middle + vec2(0.5f, 0)) - uvAt(middle - vec2(0.5f, 0)),
                       down = uvAt(middle + vec2(0, 0.5f)) - uvAt(middle - vec2(0, 0.5f));
            const vec3 expected(sampleFootprint(levels, uv, right, down)), found(image.at(x, y));
            sum += double(glm::dot(found - expected, found - expected));
            const vec3 off = vec3(sample(texture, uv)) - expected;
            ofPoints += double(glm::dot(off, off));
            covered++;
        }
    CHECK_LT(500, covered);
    // Devices round weights to 8 bits, and lavapipe takes the mip level of the first pixel of four.
    CHECK_LT(std::sqrt(sum / covered), 0.01);
    CHECK_LT(0.2, std::sqrt(ofPoints / covered));
}

TEST_CASE("view pass: a swap takes the next draw, in one submission, and costs no relighting within a set") {
    const TestDevice device;
    const Asset asset = makePaintedAsset(true);
    const TestScene scene(device, asset, defaultAppearance(asset));
    ViewPass view(device, asset, {.width = 64, .height = 48});
    const Camera camera = orbitCamera(boundsOf(asset), 0.5f, 0.6f, 0.7f, 0.8f, 64.0f / 48);
    Appearance matt = defaultAppearance(asset), gloss = matt;
    bindMaterials(matt, asset, std::vector<WeightedMaterial>{{"matt"}});
    bindMaterials(gloss, asset, std::vector<WeightedMaterial>{{"gloss"}});
    view.setAppearance(matt);
    const Image first = view.render(camera, scene.relighter);
    view.setAppearance(gloss);
    const Image second = view.render(camera, scene.relighter);
    vk::Commands commands(device, "swap test");
    commands.begin();
    view.record(commands, camera, scene.relighter);
    view.setAppearance(matt);
    view.record(commands, camera, scene.relighter);
    commands.submitAndWait();
    CHECK(view.read().pixels == first.pixels);
    CHECK(first.pixels != second.pixels);
}

TEST_CASE("view pass: agrees with the CPU at every number of terms") {
    const TestDevice device;
    checkPlain(device, makeAsset(4, 1));
    checkPlain(device, makeAsset(32, 7));
    checkPlain(device, makeAsset(5, 2));
    checkPlain(device, makeAsset(3, 8));
    checkPlain(device, makeAsset(31, 12));
}

TEST_CASE("view pass: gray view maps, four terms a lookup, agree with the CPU") {
    const TestDevice device;
    for (const auto& [first, second] : {std::pair(6, 4), std::pair(16, 1)}) {
        Asset asset = makeAsset(first, second);
        for (AssetPart& part : asset.parts)
            for (vec3& value : part.sets[0].brdf.viewMaps) value = vec3(value.x);
        checkPlain(device, asset);
    }
}

TEST_CASE("view pass: frames follow tangents") {
    const TestDevice device;
    Asset asset = makeAsset(4, 3);
    Mesh& sphere = asset.parts[0].mesh;
    for (const vec3& normal : sphere.normals) sphere.tangents.push_back(tangentFrame(normal, {1, 3, 2}).s);
    checkPlain(device, asset);
}

TEST_CASE("view pass: many parts are told apart") {
    const TestDevice device;
    // As many as there are stencil values and one, so that the first and the last share one; they overlap.
    Asset asset = makeAsset(4, 1);
    const AssetPart plane = asset.parts.back();
    asset.parts.pop_back();
    for (int i = 0; i < 254; i++) {
        AssetPart& part = asset.parts.emplace_back(plane);
        for (vec3& position : part.mesh.positions) position = 1e-3f * position + vec3(0, 5 + float(i), 0);
    }
    asset.parts.push_back(plane);
    const Asset two = makeAsset(4, 1);
    const TestScene manyScene(device, asset, defaultAppearance(asset));
    const TestScene twoScene(device, two, defaultAppearance(two));
    const Camera camera = orbitCamera(boundsOf(two), 0.5f, 0.6f, 0.7f, 0.8f, 1.5f);
    for (const int samples : {1, 4}) {
        const ViewOptions options{.width = 60, .height = 40, .samples = samples};
        ViewPass many(device, asset, options), few(device, two, options);
        const Image found = many.render(camera, manyScene.relighter),
                    expected = few.render(camera, twoScene.relighter);
        float largest = 0, worst = 0;
        for (size_t i = 0; i < found.pixels.size(); i++)
            for (int c = 0; c < 4; c++) {
                largest = std::max(largest, expected.pixels[i][c]);
                worst = std::max(worst, std::abs(found.pixels[i][c] - expected.pixels[i][c]));
            }
        CHECK_LT(0.0f, largest);
        CHECK_LT(worst, 1e-5f * largest);
    }
}

TEST_CASE("view pass: a pixel of several samples shows each surface by its share") {
    const TestDevice device;
    const Asset asset = makeAsset(4, 1);
    const Appearance appearance = defaultAppearance(asset);
    const TestScene scene(device, asset, appearance);
    const LightVector light = scene.light.readVector();
    const HostView host(device, asset, light, appearance);
    constexpr ivec2 kSize(120, 80);
    ViewPass view(device, asset, {.width = kSize.x, .height = kSize.y, .samples = 1});
    const Camera camera = orbitCamera(boundsOf(asset), 0.5f, 0.6f, 0.7f, 0.8f, float(kSize.x) / kSize.y);
    const Image centers = view.render(camera, scene.relighter);
    float largest = 0;
    for (const vec4& pixel : centers.pixels) largest = std::max(largest, glm::length(vec3(pixel)));
    const float tolerance = filterError(device) * largest;
    for (const int asked : {2, 4, 8}) {
        view.setSamples(asked);
        const int samples = view.samples();
        REQUIRE_LE(samples, asked);
        if (samples == 1) continue; // the device has no more
        const Image image = view.render(camera, scene.relighter);
        float worst = 0;
        int edges = 0, differ = 0, partly = 0;
        for (int y = 0; y < kSize.y; y++)
            for (int x = 0; x < kSize.x; x++) {
                const auto [expected, isSteady] = host.at(camera, {x, y}, kSize, samples);
                const vec4 pixel = image.at(x, y);
                const float apart = glm::length(vec3(pixel) - vec3(expected));
                if (isSteady) {
                    CHECK_EQ(pixel.w, 1.0f);
                    worst = std::max(worst, apart);
                } else if (expected.w > 0) { // rounding may decide what a sample sees
                    edges++;
                    partly += expected.w < 1;
                    const float allowed = std::max(0.01f * glm::length(vec3(expected)), tolerance);
                    differ += pixel.w != expected.w || apart > allowed;
                }
            }
        CHECK_LT(worst, tolerance);
        CHECK_LT(300, edges);
        CHECK_LT(isSoftware(device) ? 100 : 50, partly);
        CHECK_LT(differ, edges / 20);
        MESSAGE(samples, " samples: ", differ, " of ", edges, " edge pixels differ, ", partly,
                " half covered");
    }
    view.setSamples(1);
    CHECK(view.render(camera, scene.relighter).pixels == centers.pixels);
}

TEST_CASE("view pass: backs are seen from inside, and through holes") {
    const TestDevice device;
    Asset asset;
    asset.parts.push_back(makePart(makeSphere(3), 1, DiskMapping::EqualArea, 5));
    const auto covered = [&](const Camera& camera) {
        const TestScene scene(device, asset, defaultAppearance(asset));
        ViewPass view(device, asset, {.width = 32, .height = 32});
        const Image image = view.render(camera, scene.relighter);
        return std::ranges::count(image.pixels, 1.0f, [](const vec4& pixel) { return pixel.w; });
    };
    CHECK_EQ(covered({{0, 0, 0}, {0, 0, -1}, 0.9f}), 32 * 32);
    const Camera outside{{0, 0, 4}, {0, 0, 0}, 0.9f};
    const auto whole = covered(outside);
    CHECK_LT(32 * 6, whole);
    CHECK_LT(whole, 32 * 32);
    // Without what faces the eye the far side shows: as many pixels, or some fewer at the rim.
    Mesh& mesh = asset.parts[0].mesh;
    std::erase_if(mesh.triangles, [&](const uvec3& t) {
        return mesh.positions[t.x].z + mesh.positions[t.y].z + mesh.positions[t.z].z > 0;
    });
    CHECK_LT(whole * 3 / 4, covered(outside));
}

TEST_CASE("view pass: leaving clusters of triangles out changes no pixel") {
    const TestDevice device;
    for (const bool isClosed : {true, false}) {
        Asset ordered;
        Mesh mesh = makeKnot(6000);
        if (!isClosed) mesh.triangles.pop_back();
        ordered.parts.push_back(makePart(mesh, 1, DiskMapping::EqualArea, 5));
        // Clusters from everywhere, of which none can be left out.
        Asset shuffled = ordered;
        std::mt19937 random(4);
        std::ranges::shuffle(shuffled.parts[0].mesh.triangles, random);
        const TestScene scene(device, ordered, defaultAppearance(ordered));
        ViewPass less(device, ordered, {.width = 90, .height = 60});
        ViewPass all(device, shuffled, {.width = 90, .height = 60});
        const Bounds bounds = boundsOf(mesh);
        const vec3 surface = mesh.positions[0], normal = mesh.normals[0];
        std::vector<Camera> cameras = {
            {surface + 0.02f * normal, surface, 0.8f}, // nearer than the near plane of some of it
            {surface - 0.05f * normal, surface, 2.0f}, // inside
            {bounds.center(), bounds.center() + vec3(1, 0.3f, 0.2f), 1.2f},
            {bounds.center() + vec3(0, 0, 30), bounds.center(), 0.1f},
            {bounds.center() + vec3(3, 0, 0), bounds.center() + vec3(9, 0, 0), 0.8f}}; // all behind
        for (int i = 0; i < 8; i++)
            cameras.push_back(orbitCamera(bounds, 0.8f * float(i), 0.3f * float(i) - 1,
                                          0.3f + 0.1f * float(i), 0.8f, 1.5f));
        for (size_t i = 0; i < cameras.size(); i++) {
            CAPTURE(i);
            const Image seen = less.render(cameras[i], scene.relighter),
                        expected = all.render(cameras[i], scene.relighter);
            int differ = 0;
            for (size_t pixel = 0; pixel < seen.pixels.size(); pixel++)
                differ += seen.pixels[pixel] != expected.pixels[pixel];
            // A front and a back face may tie in depth at a silhouette, where the order of triangles decides.
            CHECK_LE(differ, isClosed || roundsFinely(device) ? 0 : 1);
        }
    }
}

TEST_CASE("view pass: another size is another image") {
    const TestDevice device;
    const Asset asset = makeAsset(4, 1);
    const TestScene scene(device, asset, defaultAppearance(asset));
    const Camera camera = orbitCamera(boundsOf(asset), 0.5f, 0.6f, 0.7f, 0.8f, 1.5f);
    ViewPass resized(device, asset, {.width = 20, .height = 90});
    ViewPass made(device, asset, {.width = 60, .height = 40});
    resized.render(camera, scene.relighter);
    resized.resize(60, 40);
    CHECK(resized.render(camera, scene.relighter).pixels == made.render(camera, scene.relighter).pixels);
}

TEST_CASE("view pass: what is seen is kept while the camera stays, and drawn again when it does not") {
    const TestDevice device;
    const Asset asset = makeAsset(4, 1);
    const TestScene scene(device, asset, defaultAppearance(asset));
    const Camera camera = orbitCamera(boundsOf(asset), 0.5f, 0.6f, 0.7f, 0.8f, 1.5f),
                 other = orbitCamera(boundsOf(asset), 0.9f, 0.6f, 0.7f, 0.8f, 1.5f);
    for (const int samples : {1, 4}) {
        CAPTURE(samples);
        const auto anew = [&](const Camera& from, int terms) {
            ViewPass view(device, asset, {.width = 60, .height = 40, .samples = samples});
            view.setTerms(terms);
            return view.render(from, scene.relighter).pixels;
        };
        ViewPass view(device, asset, {.width = 60, .height = 40, .samples = samples});
        view.setInspect(Inspect::Normals); // marks no edges
        view.render(camera, scene.relighter);
        view.setInspect(Inspect::Off);
        for (const int terms : {4, 2, 4}) {
            view.setTerms(terms);
            CHECK(view.render(camera, scene.relighter).pixels == anew(camera, terms));
        }
        CHECK(view.render(other, scene.relighter).pixels == anew(other, 4));
        view.resize(20, 90);
        view.render(other, scene.relighter);
        view.resize(60, 40);
        CHECK(view.render(other, scene.relighter).pixels == anew(other, 4));
    }
}

TEST_CASE("view pass: a diffuse plane seen from above is its tuple") {
    const TestDevice device;
    Asset asset;
    asset.parts.push_back(makePart(makePlane(2, 1), 1, DiskMapping::Orthographic, 4));
    AssetPart& part = asset.parts[0];
    std::fill(part.sets[0].brdf.viewMaps.begin(), part.sets[0].brdf.viewMaps.end(), vec3(0.5f));
    // One entry a row: the average of face 2 (+Y), 64 times its constant radiance of 3.
    rowsOf(part.sets[0].transport).indices.assign(4, 2 * 4096);
    rowsOf(part.sets[0].transport).values.assign(4, packCoefficient({1023, 512, 0}));
    rowsOf(part.sets[0].transport).scales.assign(4, 2.0f);
    rowsOf(part.sets[0].transport).rowStarts = {0, 1, 2, 3, 4};
    LightPass light(device, 64);
    LightCube cube{64, std::vector<vec3>(6 * 4096, vec3(0))};
    std::fill_n(cube.radiance.begin() + 2 * 4096, 4096, vec3(3));
    light.setCube(cube);
    Relighter relighter(device, asset);
    ViewPass view(device, asset, {.width = 16, .height = 8});
    vk::Commands commands(device, "view test");
    commands.begin();
    light.record(commands);
    relighter.record(commands, light);
    view.record(commands, {{0, 3, 0}, {0, 0, 0}, 1.2f}, relighter);
    commands.submitAndWait();
    const Image image = view.read();
    CHECK_EQ(image.at(8, 4).x, doctest::Approx(0.5 * 2 * 3 * 64));
    CHECK_EQ(image.at(8, 4).y, doctest::Approx(0.5 * 2 * 3 * 64 * 512 / 1023));
    CHECK_EQ(image.at(8, 4).z, 0);
    CHECK_EQ(image.at(8, 4).w, 1);
    CHECK(image.at(0, 0) == vec4(0)); // the plane ends before the border

    view.resize(30, 20);
    CHECK_EQ(view.render({{0, 3, 0}, {0, 0, 0}, 1.2f}, relighter).at(15, 10).x,
             doctest::Approx(0.5 * 2 * 3 * 64));
}

TEST_CASE("view pass: the first terms of K are what is left when the maps of the others are zero") {
    const TestDevice device;
    const Camera camera = orbitCamera(boundsOf(makeAsset(1, 1)), 0.5f, 0.6f, 0.7f, 1, 1.5f);
    for (const int terms : {4, 6}) {
        const Asset asset = makeAsset(terms, 3);
        const TestScene scene(device, asset, defaultAppearance(asset));
        ViewPass cut(device, asset, {.width = 40, .height = 40});
        const Image whole = cut.render(camera, scene.relighter);
        Image last;
        for (const int kept : {1, 2, 5}) {
            CAPTURE(terms);
            CAPTURE(kept);
            Asset zeroed = asset;
            for (AssetPart& part : zeroed.parts) {
                FactoredBrdf& brdf = part.sets[0].brdf;
                for (int term = kept; term < brdf.terms; term++)
                    std::ranges::fill(
                        std::span(brdf.viewMaps).subspan(size_t(term) * brdf.mapTexels(), brdf.mapTexels()),
                        vec3(0));
            }
            ViewPass expected(device, zeroed, {.width = 40, .height = 40});
            cut.setTerms(kept);
            last = cut.render(camera, scene.relighter);
            const Image without = expected.render(camera, scene.relighter);
            for (size_t i = 0; i < last.pixels.size(); i++) // compilers may fuse products with sums
                CHECK_LE(glm::distance(last.pixels[i], without.pixels[i]),
                         1e-5f * (1 + glm::length(without.pixels[i])));
        }
        CHECK((last.pixels == whole.pixels) == (terms == 4));
        cut.setTerms(0);
        CHECK(cut.render(camera, scene.relighter).pixels == whole.pixels);
    }
}

TEST_CASE("view pass: inspected, a plane shows its edges, its normal, and that its triangles are alike") {
    const TestDevice device;
    Asset asset;
    asset.parts.push_back(makePart(makePlane(2, 2), 1, DiskMapping::Orthographic, 4));
    const TestScene scene(device, asset, defaultAppearance(asset));
    ViewPass view(device, asset, {.width = 64, .height = 64});
    for (const int samples : {1, 4}) {
        view.setSamples(samples);
        const auto shown = [&](Inspect inspect) {
            view.setInspect(inspect);
            return view.render({{0, 3, 0}, {0, 0, 0}, 0.5f}, scene.relighter); // within the plane
        };
        const Image normals = shown(Inspect::Normals), density = shown(Inspect::Density),
                    wires = shown(Inspect::Wireframe);
        const float half = std::pow(0.5f, 2.2f);
        size_t edges = 0;
        for (size_t i = 0; i < normals.pixels.size(); i++) {
            CHECK_LT(glm::distance(normals.pixels[i], vec4(half, 1, half, 1)), 1e-3f);
            const vec4 d = density.pixels[i];
            CHECK(d.x == d.z);
            CHECK_GT(d.x, 0.8f);
            edges += wires.pixels[i].x > 0.4f;
        }
        // A cross of two pixels' width, and two diagonals.
        CHECK_GT(edges, 64u * 2);
        CHECK_LT(edges, 64u * 64 / 4);
        CHECK(shown(Inspect::Off).pixels != normals.pixels);
    }
}
