#include "precompute/error/advice.h"

#include "engine/base/check.h"
#include "engine/base/stopwatch.h"
#include "precompute/error/error_grid.h"
#include "precompute/error/layout_costs.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace relume {

namespace {

// Returns points seen from four sides, slightly from above.
std::vector<SeenPoints> seenPoints(const Asset& asset, size_t count) {
    constexpr int kViews = 4, kWidth = 320, kHeight = 240;
    const RayTracer tracer(partMeshes(asset));
    std::vector<SeenPoints> views;
    for (int view = 0; view < kViews; view++) {
        const Camera camera =
            orbitCamera(objectBounds(asset), glm::radians(30.0f + 90.0f * float(view)), glm::radians(15.0f),
                        1, glm::radians(35.0f), float(kWidth) / float(kHeight));
        const std::vector<RayHit> hits = viewPoints(tracer, camera, kWidth, kHeight).hits;
        const size_t own = std::min(hits.size(), std::max<size_t>(1, count / kViews));
        SeenPoints& seen = views.emplace_back(SeenPoints{camera.eye, {}});
        for (size_t i = 0; i < own; i++) seen.hits.push_back(hits[(2 * i + 1) * hits.size() / (2 * own)]);
    }
    if (std::ranges::all_of(views, [](const SeenPoints& seen) { return seen.hits.empty(); }))
        throw UsageError(
            fmt::format("advise: none of {} views shows the scene: it is a surface seen from its edge, or "
                        "too small for its distance from the origin",
                        kViews));
    return views;
}

// Returns where a descending curve reaches `wanted`, as an index with a fraction; none if it does not.
std::optional<double> placeOf(std::span<const double> values, double wanted) {
    for (size_t i = 0; i < values.size(); i++) {
        if (values[i] > wanted) continue;
        if (i == 0) return 0;
        if (values[i] <= 0 || values[i - 1] == values[i]) return double(i);
        return double(i) - std::log(wanted / values[i]) / std::log(values[i - 1] / values[i]);
    }
    return std::nullopt;
}

// Interpolates a curve at such a place, logarithmically.
template <typename Values>
double valueAt(const Values& values, double place) {
    const size_t next = std::min(size_t(std::ceil(place)), std::size(values) - 1);
    const size_t before = next > 0 ? next - 1 : 0;
    const double share = next > 0 ? place - double(before) : 0;
    return std::exp((1 - share) * std::log(std::max(double(values[before]), 1e-12)) +
                    share * std::log(std::max(double(values[next]), 1e-12)));
}

double rowBytes(const Asset& asset, const ErrorGrid& grid, size_t terms, double place) {
    constexpr double kEntryBytes = sizeof(uint16_t) + sizeof(uint32_t),
                     kRowBytes = sizeof(float) + sizeof(uint64_t);
    double bytes = 0;
    for (size_t part = 0; part < asset.parts.size(); part++) {
        const auto& entries = grid.entries[part]; // of the bound set; other sets are taken to have as many
        for (const MaterialSet& set : asset.parts[part].sets)
            for (size_t term = 0; term < std::min(terms, size_t(set.brdf.terms)); term++)
                bytes +=
                    double(asset.parts[part].mesh.vertexCount()) *
                    (kRowBytes + kEntryBytes * valueAt(entries[std::min(term, entries.size() - 1)], place));
    }
    return bytes;
}

// Returns the K and N of fewest bytes.
std::optional<AdvisedBake> adviseRows(const AdviceRequest& request, const Asset& asset,
                                      const ErrorGrid& grid) {
    std::optional<AdvisedBake> best;
    for (size_t terms = 1; terms <= grid.errors.size(); terms++) {
        const std::optional<double> place = placeOf(grid.errors[terms - 1], request.error);
        if (!place) continue;
        AdvisedBake bake{request.options, valueAt(grid.errors[terms - 1], *place),
                         rowBytes(asset, grid, terms, *place)};
        bake.options.layout = {TransportLayout::Rows};
        bake.options.factorization.terms = int(terms);
        bake.options.coefficients = int(std::lround(valueAt(kTriedCoefficients, *place)));
        if (!best || bake.bytes < best->bytes) best = bake;
    }
    return best;
}

// Returns the smallest K that leaves part of the error to the layout.
std::optional<int> termsForBases(const ErrorGrid& grid, size_t rung, double wanted) {
    constexpr double kMostWithoutStorage = 0.85;
    size_t least = 0;
    for (size_t term = 0; term < grid.errors.size(); term++) {
        if (grid.errors[term][rung] <= kMostWithoutStorage * wanted) return int(term) + 1;
        if (grid.errors[term][rung] < grid.errors[least][rung]) least = term;
    }
    if (grid.errors[least][rung] < wanted) return int(least) + 1;
    return std::nullopt;
}

using Report = std::function<void(double)>;

Report shareOf(const Report& report, double first, double last) {
    return [=](double done) {
        if (report) report(first + (last - first) * done);
    };
}

// Advises a bake in bases, from a plan for the most terms and its grid.
std::optional<AdvisedBake> adviseBases(const vk::Device& device, const AdviceRequest& request,
                                       const Scene& scene, const ErrorGrid& grid, const LightVector& light,
                                       std::span<const SeenPoints> points, BakeObserver& observer,
                                       const Report& report) {
    BakeOptions options = request.options;
    const auto rung =
        size_t(std::ranges::find(kTriedCoefficients, options.coefficients) - kTriedCoefficients.begin());
    RELUME_CHECK_LT(rung, kTriedCoefficients.size());
    const std::optional<int> terms = termsForBases(grid, rung, request.error);
    if (!terms) return std::nullopt;
    options.factorization.terms = *terms;
    BakePlan plan = planBake(device, scene, options, observer);
    std::vector<vec3> eyes;
    for (const SeenPoints& seen : points) eyes.push_back(seen.eye);
    const LayoutCosts costs =
        layoutCosts(device, plan, defaultAppearance(plan.asset), light, eyes, grid, observer, report);
    // Errors of the layout are nearly independent of the others, so squares add.
    const double before = grid.errors[size_t(*terms) - 1][rung];
    const double left = std::sqrt(request.error * request.error - before * before);
    const std::optional<double> place = placeOf(costs.errors, left);
    if (!place) return std::nullopt;
    options.layout.error = valueAt(kTriedLayoutErrors, *place);
    return AdvisedBake{options, std::hypot(before, valueAt(costs.errors, *place)),
                       valueAt(costs.bytes, *place), costs.bakeSeconds};
}

MeshAdvice adviseMesh(const vk::Device& device, const AdviceRequest& request, const Scene& scene,
                      const StudiedLight& light, double secondsBefore, BakeObserver& observer,
                      const Report& report) {
    BakeOptions options = request.options;
    options.factorization.terms = kMostTerms;
    options.bounces = 0; // errors are those of direct light
    const BakePlan plan = planBake(device, scene, options, observer);
    const Appearance appearance = defaultAppearance(plan.asset);
    const DrawnLight drawn = drawnLight(sampleLight(light.light, plan.asset.faceSize), light.selection);
    const std::vector<SeenPoints> points = seenPoints(plan.asset, request.points);
    const std::vector<vec3> exact =
        exactRadiance(plan.asset, appearance, points, light.fine, shareOf(report, 0, 0.2));
    const ErrorGrid grid = errorGrid(plan.asset, appearance, points, exact, drawn, shareOf(report, 0.2, 0.8));

    MeshAdvice advice;
    advice.vertices = plan.vertices();
    for (const auto& errors : grid.errors)
        advice.leastErrors.push_back(errors[kTriedCoefficients.size() - 1]);
    advice.rows = adviseRows(request, plan.asset, grid);
    advice.bases = adviseBases(device, request, scene, grid, drawn[size_t(LightPart::Whole)].entries, points,
                               observer, shareOf(report, 0.8, 1));
    if (advice.bases) *advice.bases->seconds += secondsBefore;
    if (advice.rows && advice.bases) // they take equally long per term
        advice.rows->seconds = *advice.bases->seconds * advice.rows->options.factorization.terms.value() /
                               advice.bases->options.factorization.terms.value();
    if (report) report(1);
    return advice;
}

// Returns the scene as a refining bake has it. A few terms vary between vertices as all of them do.
Scene refinedScene(const vk::Device& device, const AdviceRequest& request, double wanted,
                   BakeObserver& observer) {
    constexpr int kTerms = 4;
    BakeOptions options = request.options;
    options.factorization.terms = kTerms;
    options.refinement = RefinementRecord{.wanted = wanted};
    const BakePlan plan = planBake(device, *request.refinable, options, observer);
    Scene scene = *request.refinable;
    for (size_t part = 0; part < scene.parts.size(); part++)
        scene.parts[part].mesh = plan.asset.parts[part].mesh;
    return scene;
}

const AdvisedBake* bestOf(const MeshAdvice& advice) {
    if (!advice.bases) return advice.rows ? &*advice.rows : nullptr;
    return advice.rows && advice.rows->bytes < advice.bases->bytes ? &*advice.rows : &*advice.bases;
}

uint64_t verticesOf(const Scene& scene) {
    uint64_t vertices = 0;
    for (const Part& part : scene.parts) vertices += part.mesh.vertexCount();
    return vertices;
}

} // namespace

const MeshAdvice& Advice::bestMesh() const {
    if (!refined || !bestOf(*refined)) return plain;
    const AdvisedBake* own = bestOf(plain);
    return !own || bestOf(*refined)->bytes < own->bytes ? *refined : plain;
}

const AdvisedBake* Advice::best() const { return bestOf(bestMesh()); }

Advice advise(const vk::Device& device, AdviceRequest request, const StudiedLight& light,
              BakeObserver& observer, const Report& report) {
    if (request.options.factorization.method == Factorization::NonNegative)
        request.options.factorization.method = Factorization::Environment;
    request.options.layout = {};
    request.options.coefficients = defaultCoefficients(TransportLayout::Bases);
    request.options.factorization.wantedError.reset();
    request.options.refinement.reset();
    if (request.refinable && verticesOf(*request.refinable) > kMostRefinedVertices) request.refinable.reset();
    const double half = request.refinable ? 0.5 : 1;
    Advice advice{adviseMesh(device, request, request.scene, light, 0, observer, shareOf(report, 0, half)),
                  {}};
    if (!request.refinable) return advice;
    // Interpolation gets half of the error, which is a quarter of its square.
    const double wanted = std::clamp(request.error / 2, kLeastRefinementError, kMostRefinementError);
    const Stopwatch watch;
    const Scene refined = refinedScene(device, request, wanted, observer);
    const double seconds = watch.seconds();
    advice.refined = adviseMesh(device, request, refined, light, seconds, observer, shareOf(report, half, 1));
    for (auto* bake : {&advice.refined->bases, &advice.refined->rows})
        if (*bake) (*bake)->options.refinement = RefinementRecord{.wanted = wanted};
    return advice;
}

} // namespace relume
