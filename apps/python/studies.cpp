// Bindings of references, errors and advice.
#include "apps/python/checks.h"
#include "apps/python/module.h"
#include "precompute/bake/bake_options.h"
#include "precompute/error/advice.h"
#include "precompute/error/heat_maps.h"
#include "precompute/error/study_json.h"
#include "precompute/reference/reference_image.h"

#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

namespace relume::python {

namespace {

Camera cameraOr(const std::optional<Camera>& camera, const Asset& asset, std::pair<int, int> size) {
    return camera.value_or(
        defaultCamera(objectBounds(asset), glm::radians(35.0f), float(size.first) / float(size.second)));
}

// Returns the asset with the first terms of its BRDFs, for references. Its transport keeps all terms.
Asset withTerms(Asset asset, int terms) {
    for (AssetPart& part : asset.parts)
        for (MaterialSet& set : part.sets) {
            FactoredBrdf& brdf = set.brdf;
            FactoredBrdf few = brdf;
            few.terms = std::min(terms, brdf.terms);
            const size_t texels = size_t(few.terms) * brdf.mapTexels();
            few.lightMaps.resize(texels);
            few.eigenvalues.resize(size_t(few.terms));
            few.viewMaps.clear();
            for (int layer = 0; layer < brdf.layers; layer++)
                few.viewMaps.insert(few.viewMaps.end(), brdf.viewMap(layer, 0),
                                    brdf.viewMap(layer, 0) + texels);
            brdf = std::move(few);
        }
    return asset;
}

py::array_t<float> reference(const std::shared_ptr<Asset>& asset, const Light& light,
                             const std::optional<Camera>& camera, std::pair<int, int> size, int samples,
                             const std::string& brdf, int rays, std::optional<int> terms,
                             const py::object& progress) {
    expectAsset(asset);
    expectSize(size);
    expectSamples(samples);
    ReferenceOptions options;
    options.width = size.first;
    options.height = size.second;
    options.samples = samples;
    options.raysPerTexelSide = int(std::lround(std::sqrt(rays)));
    if (rays < 1 || rays > 64 || options.raysPerTexelSide * options.raysPerTexelSide != rays)
        throw UsageError("rays: expected 1, 4, 16 or 64 through each texel of the light");
    if (brdf == "factored")
        options.brdf = ReferenceBrdf::Factored;
    else if (brdf == "residual")
        options.brdf = ReferenceBrdf::Residual;
    else if (brdf != "exact")
        throw UsageError("brdf: expected exact, factored or residual");
    if (terms) expectWithin("terms", *terms, 1, kMostTerms);
    if (terms && options.brdf != ReferenceBrdf::Factored)
        throw UsageError("terms: expected only with brdf=\"factored\"");
    Image image;
    runLong(progress, [&](const std::function<void(double)>& tell) {
        const Asset few = terms ? withTerms(*asset, *terms) : Asset();
        image = renderReference(terms ? few : *asset, cameraOr(camera, *asset, size),
                                sampleLight(light, asset->faceSize), options,
                                [&](int rows) { tell(double(rows) / double(size.second)); });
    });
    return arrayOf(std::move(image));
}

// Returns the light as a cube of `faceSize` texels a side, with maps as fine as the cube can represent.
LightCube fineLight(Light light, int faceSize) {
    for (EnvironmentLight& environment : light.environments)
        if (environment.picture)
            environment.map =
                std::make_shared<const Environment>(prepareForSampling(*environment.picture, 8 * faceSize));
    return sampleLight(light, faceSize);
}

// A progressive reference; keeps alive the asset that it refers to. Several threads may call it.
class SampledReference {
  public:
    SampledReference(const std::shared_ptr<Asset>& asset, const Light& light,
                     const std::optional<Camera>& camera, std::pair<int, int> size, int samples, int faceSize)
        : mAsset(expectAsset(asset)), mReference(*mAsset) {
        expectSize(size);
        expectSamples(samples);
        expectWithin("face_size", faceSize, 2, 1024);
        mReference.restart(cameraOr(camera, *mAsset, size), fineLight(light, faceSize),
                           defaultAppearance(*mAsset), size.first, size.second, samples);
    }

    void addPasses(int count, const py::object& progress) {
        expectWithin("count", count, 1, std::numeric_limits<int>::max());
        runLong(progress, [&](const std::function<void(double)>& tell) {
            for (int i = 1; i <= count; i++) {
                while (mWaiting > 0)
                    std::this_thread::yield(); // readers go first, or they might wait for the last pass
                {
                    const std::lock_guard lock(mMutex);
                    mReference.addPass();
                }
                tell(double(i) / double(count));
            }
        });
    }
    int passes() const {
        const auto lock = lockNext();
        return mReference.passes();
    }
    Image mean() const {
        const auto lock = lockNext();
        if (mReference.passes() < 1) throw UsageError("mean: add a pass first");
        return mReference.mean();
    }
    std::array<Image, 2> halves() const {
        const auto lock = lockNext();
        if (mReference.passes() < 2) throw UsageError("halves: add two passes first");
        return mReference.halves();
    }

  private:
    // Locks the reference before the next pass can.
    std::unique_lock<std::mutex> lockNext() const {
        ++mWaiting;
        std::unique_lock lock(mMutex);
        --mWaiting;
        return lock;
    }

    mutable std::mutex mMutex;
    mutable std::atomic<int> mWaiting = 0;
    std::shared_ptr<const Asset> mAsset;
    ProgressiveReference mReference;
};

StudiedLight studied(const Light& light) { return {light, fineLight(light, kTruthFaceSize), {}}; }

py::dict imagesOf(const ErrorStudy& study, const ViewPoints& points) {
    py::dict images;
    images["drawn"] = arrayOf(study.drawn);
    images["reference"] = arrayOf(study.reference);
    images["harmonics"] = arrayOf(study.lowOrder->image);
    for (HeatMap& heat : heatMaps(study, points, 1)) images[heat.name.c_str()] = arrayOf(std::move(heat.map));
    return images;
}

py::list errors(const std::shared_ptr<Asset>& asset, const std::vector<Light>& lights,
                const std::optional<Camera>& camera, std::pair<int, int> size, bool residual, int passes,
                std::optional<int> bounces, bool withImages, const py::object& progress) {
    expectBaked(asset);
    expectSize(size);
    expectStudiedSize(size.first, size.second);
    if (lights.empty()) throw UsageError("light: expected a Light or more, found an empty list");
    expectWithin("passes", passes, 0, 1 << 20);
    if (asset->provenance.bakedShare)
        throw Error(
            "the asset is a preview, whose rows are interpolated for the most part: load the finished bake");
    const std::shared_ptr<const vk::Device> on = device();
    ErrorStudies studies;
    runLong(progress, [&](const std::function<void(double)>& tell) {
        std::vector<StudiedLight> all;
        for (const Light& light : lights) all.push_back(studied(light));
        studies = studyErrors(*on, *asset, defaultAppearance(*asset), all,
                              {.view = {cameraOr(camera, *asset, size), size.first, size.second},
                               .mostPasses = passes,
                               .lowOrder = 5, // as in `relume errors`: 25 harmonics
                               .residual = residual,
                               .bounces = bounces},
                              tell);
    });
    py::list results;
    for (const ErrorStudy& study : studies.lights) {
        const py::object result = parsed(describe(study, studies.points, *asset).dump());
        if (withImages) result["images"] = imagesOf(study, studies.points);
        results.append(result);
    }
    return results;
}

py::object advice(const SceneBuilder& scene, const Light& light, double error, int points, bool asIs,
                  const py::object& progress) {
    expectWithin("error", error, 0.001, 1.0);
    expectWithin("points", points, 40, 40'000);
    const std::shared_ptr<const vk::Device> on = device();
    AdviceRequest request{scene.build(false), {}, error};
    request.options.bounces = presetOptions(BakePreset::Default).bounces;
    request.options.areBouncesAuto = true;
    request.points = size_t(points);
    if (!asIs) request.refinable = scene.build(true);
    std::string text;
    runLong(progress, [&](const std::function<void(double)>& tell) {
        BakeObserver observer;
        text = describe(advise(*on, request, studied(light), observer, tell), error).dump();
    });
    return parsed(text);
}

} // namespace

void addStudies(py::module_& module) {
    py::class_<SampledReference>(module, "SampledReference")
        .def(py::init<std::shared_ptr<Asset>, const Light&, const std::optional<Camera>&, std::pair<int, int>,
                      int, int>(),
             py::call_guard<py::gil_scoped_release>())
        .def("add_passes", &SampledReference::addPasses)
        .def_property_readonly(
            "passes", py::cpp_function(&SampledReference::passes, py::call_guard<py::gil_scoped_release>()))
        .def("mean",
             [](const SampledReference& reference) {
                 Image mean;
                 {
                     const py::gil_scoped_release unlocked;
                     mean = reference.mean();
                 }
                 return arrayOf(std::move(mean));
             })
        .def("halves", [](const SampledReference& reference) {
            std::array<Image, 2> halves;
            {
                const py::gil_scoped_release unlocked;
                halves = reference.halves();
            }
            return std::pair(arrayOf(std::move(halves[0])), arrayOf(std::move(halves[1])));
        });
    module.def("_reference", reference);
    module.def("_errors", errors);
    module.def("_advise", advice);
}

} // namespace relume::python
