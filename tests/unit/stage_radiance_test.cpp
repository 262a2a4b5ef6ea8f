// Tests the stages of radiance against the twins that they represent, and the error grid.
#include "precompute/error/stage_radiance.h"

#include "engine/light/light.h"
#include "precompute/bake/baked_options.h"
#include "precompute/brdf/material_factory.h"
#include "precompute/error/error_budget.h"
#include "precompute/error/error_grid.h"
#include "precompute/error/view_points.h"
#include "precompute/reference/reference_image.h"
#include "precompute/residual/residuals.h"
#include "precompute/twins/transport_twin.h"
#include "precompute/twins/vertex_check.h"
#include "tests/support/diffuse_asset.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

constexpr int kTerms = 6;

// A glossy quad beside a wall, in rows of N coefficients.
Asset bakeCourt(int coefficients, const char* material = "clay") {
    AssetPart part = makeDiffusePart(makeQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), 0.5f);
    BakeOptions options;
    options.layout = {.layout = TransportLayout::Rows};
    options.factorization = {.terms = kTerms};
    options.mapSize = 16;
    options.faceSize = 32, options.visibilitySize = 64, options.coefficients = coefficients;
    part.sets =
        MaterialFactory(options.factorization, options.mapSize, options.mapping).make(material, {}, false);
    Asset asset = makeTestAsset({std::move(part)});
    append(asset.parts[0].mesh, makeQuad({-1.5f, 0, -3}, {0, 2, 0}, {0, 0, 6}));
    asset.occluder = asset.parts[0].mesh;
    asset.faceSize = options.faceSize, asset.visibilitySize = options.visibilitySize;
    asset.coefficients = coefficients;
    asset.visibilityOffset = kFullMeshShadowOffset * boundsOf(asset).radius();
    asset.provenance.options = describeOptions(options);
    const Mesh* mesh = &asset.occluder;
    const RayTracer tracer({&mesh, 1});
    MaterialSet& set = asset.parts[0].sets[0];
    set.transport = SparseTransport();
    SparseTransport& rows = rowsOf(set.transport);
    rows.vertices = uint32_t(asset.parts[0].mesh.vertexCount());
    rows.terms = uint32_t(set.brdf.terms), rows.rowStarts = {0};
    for (size_t vertex = 0; vertex < rows.vertices; vertex++)
        for (const auto& term : recomputeVertex(asset, 0, 0, vertex, tracer).terms) {
            rows.indices.insert(rows.indices.end(), term.row.indices.begin(), term.row.indices.end());
            rows.values.insert(rows.values.end(), term.row.values.begin(), term.row.values.end());
            rows.scales.push_back(term.row.scale);
            rows.rowStarts.push_back(rows.values.size());
        }
    return asset;
}

Camera cameraOf(const Asset& asset) { return orbitCamera(boundsOf(asset), 0.6f, 0.5f, 0.5f, 0.6f, 4.0f / 3); }

StageLight skyOf(int faceSize, const LightSelection& selection) {
    const auto sky = std::make_shared<const Environment>(prepareForSampling(makeSky()));
    const Light light{.environments = {{sky}}};
    return {drawnLight(sampleLight(light, faceSize), selection), sampleLight(light, kTruthFaceSize)};
}

double changeBy(std::span<const StageRadiance> stages, ErrorSource source) {
    return errorBudget(stages).sources[size_t(source)].rms;
}

} // namespace

TEST_CASE("stages: they start with what is drawn and end with the reference") {
    const Asset asset = bakeCourt(40);
    const Appearance appearance = defaultAppearance(asset);
    const Camera camera = cameraOf(asset);
    const ViewPoints points = viewPoints(RayTracer(partMeshes(asset)), camera, 16, 12);
    REQUIRE(points.hits.size() > 60);
    const StageLight light = skyOf(asset.faceSize, {});
    const auto stages =
        StageTracer(asset, appearance).trace(points.hits, camera.eye, std::span(&light, 1)).front();

    const ReferenceOptions options{.width = 16, .height = 12, .samples = 1, .raysPerTexelSide = 2};
    const Image reference = renderReference(asset, camera, light.fine, options);
    double squares = 0, level = 0;
    for (size_t i = 0; i < points.pixels.size(); i++) {
        const vec3 truth(reference.pixels[points.pixels[i]]);
        squares += double(glm::dot(stages[i][kErrorSources] - truth, stages[i][kErrorSources] - truth));
        level += double(glm::dot(truth, truth));
    }
    CHECK(std::sqrt(squares / level) < 2e-3); // BRDFs at the cell's center, or at each of its four rays
    const ErrorBudget budget = errorBudget(stages);
    CHECK(budget.total > 0.01);
    CHECK(budget.sources[size_t(ErrorSource::Occluder)].rms < 1e-6);   // the same mesh and offset
    CHECK(budget.sources[size_t(ErrorSource::Visibility)].rms > 1e-3); // 64² rays a face
}

TEST_CASE("stages: a source that is not there changes nothing") {
    const Asset few = bakeCourt(24), all = bakeCourt(6 * 32 * 32);
    const Appearance appearance = defaultAppearance(few);
    const Camera camera = cameraOf(few);
    const ViewPoints points = viewPoints(RayTracer(partMeshes(few)), camera, 12, 9);
    const std::array<StageLight, 2> lights = {skyOf(32, {.threshold = 4000}), skyOf(32, {.threshold = 0})};
    const auto stagesFew = StageTracer(few, appearance).trace(points.hits, camera.eye, lights);
    const auto stagesAll = StageTracer(all, appearance).trace(points.hits, camera.eye, lights);

    CHECK(changeBy(stagesFew[0], ErrorSource::LightSelection) > 0.005);
    CHECK(changeBy(stagesFew[1], ErrorSource::LightSelection) < 1e-3);
    CHECK(changeBy(stagesFew[1], ErrorSource::Truncation) > 0.005);
    CHECK(changeBy(stagesAll[1], ErrorSource::Truncation) < 1e-6);
    CHECK(changeBy(stagesAll[1], ErrorSource::Interpolation) ==
          doctest::Approx(changeBy(stagesFew[1], ErrorSource::Interpolation)));
}

TEST_CASE("stages: the table is what all terms are, and the light map's lookup is theirs") {
    MaterialBrdfs brdfs;
    const BakeOptions options{.factorization = {.terms = 32, .method = Factorization::Paper}, .mapSize = 8};
    const MaterialSet set = MaterialFactory(options.factorization, 8, DiskMapping::Orthographic)
                                .make("red-plastic", {}, false)
                                .front();
    const BoundLayer layer{};
    const TabulatedBrdf table(set, std::span(&layer, 1), Factorization::Paper, brdfs);
    const vec3 weight(1), outgoing = glm::normalize(vec3(0.3f, -0.2f, 0.8f));
    const std::vector<vec3> map = table.lightMap(std::span(&layer, 1), std::span(&weight, 1), outgoing);
    double squares = 0, level = 0;
    for (int i = 0; i < 200; i++) {
        const float angle = 0.7f * float(i), radius = 0.9f * std::sqrt(float(i) / 200);
        const vec3 incoming(radius * std::cos(angle), radius * std::sin(angle),
                            std::sqrt(1 - radius * radius));
        const vec3 own = lookupMap(map.data(), 8, DiskMapping::Orthographic, incoming);
        const vec3 terms = evaluate(set.brdf, incoming, outgoing);
        squares += double(glm::dot(own - terms, own - terms));
        level += double(glm::dot(own, own));
    }
    CHECK(std::sqrt(squares / level) < 0.02); // 32 of 52 terms
}

TEST_CASE("error grid: it predicts the drawn image's error, whatever K and N") {
    Asset most = bakeCourt(1);
    makeResiduals(most);
    const Appearance appearance = defaultAppearance(most);
    const Camera camera = cameraOf(most);
    const ViewPoints points = viewPoints(RayTracer(partMeshes(most)), camera, 12, 9);
    const StageLight light = skyOf(32, {});
    const SeenPoints seen{camera.eye, points.hits};
    const std::vector<vec3> exact = exactRadiance(most, appearance, std::span(&seen, 1), light.fine);
    REQUIRE(most.parts[0].sets[0].residual);
    const ErrorGrid grid = errorGrid(most, appearance, std::span(&seen, 1), exact, light.drawn);
    CHECK(grid.terms == kTerms);
    CHECK(grid.shares[0] == doctest::Approx(1));
    for (const size_t rung : {size_t(2), size_t(6), size_t(9)}) {
        Asset asset = bakeCourt(kTriedCoefficients[rung]);
        makeResiduals(asset);
        const auto stages =
            StageTracer(asset, appearance).trace(points.hits, camera.eye, std::span(&light, 1)).front();
        // But for quantization, and single rays towards the truth.
        CHECK(grid.errors[kTerms - 1][rung] == doctest::Approx(errorBudget(stages).total).epsilon(0.03));
        const SparseTransport& rows = rowsOf(asset.parts[0].sets[0].transport);
        double entries = 0;
        for (const auto& term : grid.entries[0]) entries += term[rung];
        CHECK(entries == doctest::Approx(double(rows.entries()) / rows.vertices).epsilon(0.15));
    }
    for (size_t rung = 1; rung < kTriedCoefficients.size(); rung++)
        CHECK(grid.entries[0][0][rung] >= grid.entries[0][0][rung - 1]);
}
