// Bindings of bakes.
#include "precompute/bake/bake.h"
#include "apps/python/checks.h"
#include "apps/python/module.h"
#include "engine/import/asset_info.h"
#include "engine/render/appearance.h"
#include "precompute/bake/bake_options.h"
#include "precompute/bake/bake_plan.h"

#include <fmt/core.h>

namespace relume::python {

namespace {

// Takes options from `given` by name, so that those left over are unknown.
class GivenOptions {
  public:
    explicit GivenOptions(const py::kwargs& given) : mGiven(given) {}

    template <typename T>
    void take(const char* name, T& option) {
        if (const py::object value = pop(name); !value.is_none()) option = as<T>(name, value);
    }
    template <typename T>
    static T as(const char* name, const py::object& value) {
        try {
            return value.cast<T>();
        } catch (const py::cast_error&) {
            throw py::type_error(
                fmt::format("bake(): {}: cannot take {}", name, std::string(py::repr(value)).substr(0, 100)));
        }
    }
    py::object pop(const char* name) { return mGiven.attr("pop")(name, py::none()); }

    void expectNoMore() const {
        if (!mGiven.empty())
            throw py::type_error(fmt::format("bake() and plan() have no option \"{}\"",
                                             mGiven.begin()->first.cast<std::string>()));
    }

  private:
    py::dict mGiven;
};

BakePreset presetFrom(const std::string& name) {
    for (const BakePreset preset : kBakePresets)
        if (name == presetName(preset)) return preset;
    throw UsageError(fmt::format("preset: expected default or paper, found \"{}\"", name));
}

template <typename Value>
Value known(const std::optional<Value>& value, const char* option, const std::string& text) {
    if (!value) throw UsageError(fmt::format("{}: \"{}\" is unknown", option, text));
    return *value;
}

// By the rules of `relume bake`: what is sought for bases makes a bake of bases, unless rows are asked for.
void takeLayout(GivenOptions& given, BakeOptions& options) {
    std::optional<std::string> name;
    std::optional<double> budget, error;
    given.take("layout", name);
    given.take("budget", budget);
    given.take("error", error);
    if (budget && error) throw UsageError("error: expected none beside a budget");
    TransportLayout layout = options.layout.layout;
    if (name)
        layout = known(layoutFromName(*name), "layout", *name);
    else if (budget || error)
        layout = TransportLayout::Bases;
    if (layout == TransportLayout::Rows && (budget || error))
        throw UsageError("layout: error and budget are for bases; rows are shortened by coefficients");
    if (layout != options.layout.layout) options.layout = {.layout = layout};
    if (budget) options.layout.bytesPerVertex = budget;
    if (error) options.layout.error = error, options.layout.bytesPerVertex.reset();
    options.coefficients = defaultCoefficients(layout);
    given.take("coefficients", options.coefficients);
}

void takeVisibility(GivenOptions& given, BakeOptions& options) {
    const py::object name = given.pop("visibility");
    if (name.is_none()) return;
    for (const VisibilityMethod method : {VisibilityMethod::Raster, VisibilityMethod::Traced})
        if (GivenOptions::as<std::string>("visibility", name) == visibilityMethodName(method)) {
            options.visibilityMethod = method;
            return;
        }
    throw UsageError("visibility: expected traced or raster");
}

void takeRefinement(GivenOptions& given, BakeOptions& options) {
    const py::object refine = given.pop("refine");
    if (refine.is_none() || (py::isinstance<py::str>(refine) && refine.cast<std::string>() == "auto")) return;
    options.refinement.reset();
    if (py::isinstance<py::str>(refine)) {
        if (refine.cast<std::string>() != "off") throw UsageError("refine: expected auto, off or an error");
        return;
    }
    RefinementRecord record;
    record.wanted = GivenOptions::as<decltype(record.wanted)>("refine", refine);
    options.refinement = record;
}

BakeOptions optionsFrom(const py::kwargs& kwargs) {
    GivenOptions given(kwargs);
    std::string preset = "default";
    given.take("preset", preset);
    BakeOptions options = presetOptions(presetFrom(preset));
    given.take("terms", options.factorization.terms);
    if (const py::object name = given.pop("factorization"); !name.is_none()) {
        const auto text = GivenOptions::as<std::string>("factorization", name);
        options.factorization.method = known(factorizationFromName(text), "factorization", text);
        options.mapping = defaultMapping(options.factorization.method);
    }
    takeLayout(given, options);
    if (const py::object bounces = given.pop("bounces"); !bounces.is_none())
        options.bounces = GivenOptions::as<int>("bounces", bounces), options.areBouncesAuto = false;
    given.take("map_size", options.mapSize);
    given.take("face_size", options.faceSize);
    given.take("visibility_size", options.visibilitySize);
    options.transportSamples = std::min(options.transportSamples, options.mostTransportSamples());
    given.take("transport_samples", options.transportSamples);
    given.take("occluder_triangles", options.occluderTriangles);
    given.take("keep_visibility", options.keepVisibility);
    takeVisibility(given, options);
    takeRefinement(given, options);
    given.expectNoMore();
    options.validate();
    return options;
}

// Reports a bake's progress to Python.
class Reporter : public BakeObserver {
  public:
    explicit Reporter(const std::function<void(double)>& tell) : mTell(tell) {}
    void stage(BakeStage, const std::string&) override { mTell(mShare); }
    void progress(const BakeStatus& status) override { mTell(mShare = std::max(mShare, status.fraction)); }

  private:
    const std::function<void(double)>& mTell;
    double mShare = 0;
};

std::shared_ptr<Asset> bakeScene(const SceneBuilder& builder,
                                 const std::optional<std::filesystem::path>& output,
                                 const py::object& progress, const py::kwargs& kwargs) {
    const BakeOptions options = optionsFrom(kwargs);
    if (options.keepVisibility && !output)
        throw UsageError("keep_visibility: visibility is kept in a file; give output");
    const Scene scene = builder.build(options.refinement.has_value());
    const std::shared_ptr<const vk::Device> on = device();
    std::shared_ptr<Asset> asset;
    runLong(progress, [&](const std::function<void(double)>& tell) {
        Reporter reporter(tell);
        if (output) {
            bakeToFile(*on, scene, options, *output, {}, reporter);
            asset = std::make_shared<Asset>(readAsset(*output));
        } else {
            asset = std::make_shared<Asset>(bake(*on, scene, options, reporter));
        }
        tell(1);
    });
    return asset;
}

std::shared_ptr<Asset> planScene(const SceneBuilder& builder, const py::kwargs& kwargs) {
    const BakeOptions options = optionsFrom(kwargs);
    const Scene scene = builder.build(options.refinement.has_value());
    const std::shared_ptr<const vk::Device> on = device();
    const py::gil_scoped_release unlocked;
    BakeObserver silent;
    return std::make_shared<Asset>(planBake(*on, scene, options, silent).asset);
}

const AssetPart& partOf(const Asset& asset, size_t part) {
    if (part >= asset.parts.size())
        throw py::index_error(fmt::format("part {}: the asset has {} parts", part, asset.parts.size()));
    return asset.parts[part];
}

// Returns rows of a part's first set as an array (rows, 6 F²) of RGB coefficients.
py::array_t<float> coefficientsOfRows(const std::shared_ptr<Asset>& asset, size_t part,
                                      const std::vector<size_t>& rows) {
    const Transport& transport = partOf(*expectBaked(asset), part).sets.front().transport;
    const size_t count = size_t(6 * asset->faceSize * asset->faceSize),
                 all = size_t(verticesOf(transport)) * termsOf(transport);
    std::vector<vec3> values;
    values.reserve(rows.size() * count);
    for (const size_t row : rows) {
        if (row >= all) throw py::index_error(fmt::format("row {}: the part has {} rows", row, all));
        const std::vector<vec3> own = dequantizedRow(transport, row, count);
        values.insert(values.end(), own.begin(), own.end());
    }
    return arrayOf(std::move(values), {py::ssize_t(rows.size()), py::ssize_t(count)});
}

} // namespace

void addBake(py::module_& module) {
    py::class_<Asset, std::shared_ptr<Asset>>(module, "Asset")
        .def_static(
            "load",
            [](const std::filesystem::path& path) { return std::make_shared<Asset>(readAsset(path)); },
            py::arg("path"), py::call_guard<py::gil_scoped_release>())
        .def(
            "save", [](const Asset& asset, const std::filesystem::path& path) { writeAsset(path, asset); },
            py::arg("path"), py::call_guard<py::gil_scoped_release>())
        .def_property_readonly("parts",
                               [](const Asset& asset) {
                                   std::vector<std::string> names;
                                   for (const AssetPart& part : asset.parts) names.push_back(part.name);
                                   return names;
                               })
        .def_property_readonly("materials", materialNames)
        .def_property_readonly("vertices", vertexCount)
        .def("info",
             [](const Asset& asset) {
                 std::string text;
                 {
                     const py::gil_scoped_release unlocked;
                     text = describeAssetJson(asset, encodeAsset(asset).size());
                 }
                 return parsed(text);
             })
        .def(
            "mesh", [](const Asset& asset, size_t part) { return partOf(asset, part).mesh; },
            py::arg("part") = 0)
        .def("coefficients", coefficientsOfRows, py::arg("part"), py::arg("rows"));
    module.def("_bake", bakeScene);
    module.def("_plan", planScene);
}

} // namespace relume::python
