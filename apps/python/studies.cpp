// References, errors, advice, materials and factored BRDFs.
#include "apps/python/module.h"
#include "engine/math/disk_map.h"
#include "precompute/brdf/brdf.h"
#include "precompute/brdf/factorization.h"
#include "precompute/brdf/factorization_error.h"
#include "precompute/brdf/material_json.h"
#include "precompute/error/advice.h"
#include "precompute/error/study_json.h"
#include "precompute/reference/reference_image.h"

#include <nlohmann/json.hpp>

namespace relume::python {

namespace {

Camera cameraOr(const std::optional<Camera>& camera, const Asset& asset, std::pair<int, int> size) {
    return camera.value_or(
        defaultCamera(objectBounds(asset), glm::radians(35.0f), float(size.first) / float(size.second)));
}

py::array_t<float> reference(const std::shared_ptr<const Asset>& asset, const Light& light,
                             const std::optional<Camera>& camera, std::pair<int, int> size, int samples,
                             const std::string& brdf, const py::object& progress) {
    ReferenceOptions options;
    options.width = size.first;
    options.height = size.second;
    options.samples = samples;
    if (brdf == "factored")
        options.brdf = ReferenceBrdf::Factored;
    else if (brdf == "residual")
        options.brdf = ReferenceBrdf::Residual;
    else if (brdf != "exact")
        throw UsageError("brdf: expected exact, factored or residual");
    Image image;
    runLong(progress, [&](const std::function<void(double)>& tell) {
        image = renderReference(*asset, cameraOr(camera, *asset, size), sampleLight(light, asset->faceSize),
                                options, [&](int rows) { tell(double(rows) / double(size.second)); });
    });
    return arrayOf(std::move(image));
}

// The light is taken as finely as its maps are known.
StudiedLight studied(const Light& light) {
    return {light, sampleLight(light, kTruthFaceSize), LightSelection()};
}

py::object errors(const std::shared_ptr<const Asset>& asset, const Light& light,
                  const std::optional<Camera>& camera, std::pair<int, int> size, bool residual,
                  const py::object& progress) {
    const std::shared_ptr<const vk::Device> on = device();
    std::string text;
    runLong(progress, [&](const std::function<void(double)>& tell) {
        const StudiedLight one = studied(light);
        const ErrorStudies studies =
            studyErrors(*on, *asset, defaultAppearance(*asset), std::span(&one, 1),
                        {.view = {cameraOr(camera, *asset, size), size.first, size.second},
                         .lowOrder = 5, // as `relume errors`: 25 harmonics
                         .residual = residual},
                        tell);
        text = describe(studies.lights.front()).dump();
    });
    return parsed(text);
}

py::object advice(const SceneBuilder& scene, const Light& light, double error, size_t points, bool asIs,
                  const py::object& progress) {
    const std::shared_ptr<const vk::Device> on = device();
    AdviceRequest request{scene.build(false), {}, error};
    request.points = points;
    if (!asIs) request.refinable = scene.build(true);
    std::string text;
    runLong(progress, [&](const std::function<void(double)>& tell) {
        BakeObserver observer;
        text = describe(advise(*on, request, studied(light), observer, tell), error).dump();
    });
    return parsed(text);
}

py::dict factored(const std::string& material, int terms, const std::string& factorization, int mapSize) {
    const std::optional<Factorization> method = factorizationFromName(factorization);
    if (!method) throw UsageError("factorization: \"" + factorization + "\" is unknown");
    FactoredBrdf brdf;
    std::vector<float> frobenius, expected;
    {
        const py::gil_scoped_release unlocked;
        const DiskMapping mapping = isPublished(*method) ? DiskMapping::Orthographic : DiskMapping::EqualArea;
        const BrdfTable table = tabulate(*makeBrdf(material), mapSize, mapping, texelValueOf(*method));
        brdf = factorize(table, {.terms = terms, .method = *method});
        frobenius = frobeniusResiduals(table, brdf);
        expected = expectedErrors(table, brdf);
    }
    const py::ssize_t side = brdf.size, count = brdf.terms;
    py::dict result;
    result["light_maps"] = arrayOf(std::move(brdf.lightMaps), {count, side, side});
    result["view_maps"] = arrayOf(std::move(brdf.viewMaps), {count, side, side});
    result["mapping"] = std::string(diskMappingName(brdf.mapping));
    result["frobenius"] = frobenius;
    result["expected"] = expected;
    return result;
}

} // namespace

void addStudies(py::module_& module) {
    module.def("_reference", reference);
    module.def("_errors", errors);
    module.def("_advise", advice);
    module.def("_brdf", factored);
    module.def("materials", [] { return parsed(describeMaterials().dump()); });
}

} // namespace relume::python
