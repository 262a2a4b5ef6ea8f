// Bindings of BRDFs: factorization, evaluation and errors.
#include "apps/python/checks.h"
#include "apps/python/module.h"
#include "engine/base/error.h"
#include "precompute/brdf/factorization.h"
#include "precompute/brdf/factorization_error.h"
#include "precompute/brdf/material_json.h"
#include "precompute/brdf/tabulation.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume::python {

namespace {

Factorization factorizationFrom(const std::string& name) {
    if (const auto method = factorizationFromName(name)) return *method;
    throw UsageError(fmt::format("factorization: \"{}\" is unknown", name));
}

DiskMapping mappingFrom(const std::string& name) {
    if (const auto mapping = diskMappingFromName(name)) return *mapping;
    throw UsageError(fmt::format("mapping: \"{}\" is unknown", name));
}

TexelValue texelsFrom(const std::string& name) {
    if (name == "centers") return TexelValue::Center;
    if (name == "means") return TexelValue::Mean;
    throw UsageError(fmt::format("texels: expected centers or means, found \"{}\"", name));
}

// Returns one layer of a factored BRDF as the dictionary that factorsFrom() reads.
py::dict dictOf(const FactoredBrdf& brdf, int layer) {
    const py::ssize_t side = brdf.size, count = brdf.terms;
    const vec3* const views = brdf.viewMap(layer, 0);
    py::dict result;
    result["light_maps"] = arrayOf(brdf.lightMaps, {count, side, side});
    result["view_maps"] =
        arrayOf(std::vector<vec3>(views, views + size_t(count) * brdf.mapTexels()), {count, side, side});
    result["mapping"] = std::string(diskMappingName(brdf.mapping));
    return result;
}

// Returns the factors of materials, found jointly.
py::list factored(const std::vector<std::string>& materials, int terms, const std::string& factorization,
                  int mapSize, const std::optional<std::string>& map,
                  const std::optional<std::string>& texels) {
    const Factorization method = factorizationFrom(factorization);
    const DiskMapping mapping = map                   ? mappingFrom(*map)
                                : isPublished(method) ? DiskMapping::Orthographic
                                                      : DiskMapping::EqualArea;
    const TexelValue value = texels ? texelsFrom(*texels) : texelValueOf(method);
    expectWithin("terms", terms, 1, kMostTerms);
    expectWithin("map_size", mapSize, kMinMapSize, kMaxMapSize);
    if (materials.empty()) throw UsageError("material: expected a material or more, found an empty list");
    FactoredBrdf brdf;
    std::vector<std::vector<float>> frobenius, expected;
    std::vector<RmsErrors> rms;
    {
        const py::gil_scoped_release unlocked;
        std::vector<std::unique_ptr<Brdf>> exact;
        std::vector<BrdfTable> tables;
        for (const std::string& material : materials) {
            exact.push_back(makeBrdf(material));
            tables.push_back(tabulate(*exact.back(), mapSize, mapping, value));
        }
        brdf = factorize(tables, {.terms = terms, .method = method});
        expected = expectedErrors(tables, brdf);
        for (size_t layer = 0; layer < tables.size(); layer++) {
            frobenius.push_back(frobeniusResiduals(tables[layer], brdf, int(layer)));
            rms.push_back(rmsErrors(*exact[layer], brdf, int(layer)));
        }
    }
    py::list layers;
    for (size_t layer = 0; layer < materials.size(); layer++) {
        py::dict own = dictOf(brdf, int(layer));
        own["frobenius"] = frobenius[layer];
        own["rms_absolute"] = rms[layer].absolute;
        own["rms_relative"] = rms[layer].relative;
        own["expected"] = expected[layer];
        layers.append(own);
    }
    return layers;
}

// Reads maps of shape (K, S, S, 3); sets K and S, or checks them if they are known.
std::vector<vec3> mapsOf(const py::dict& factors, const char* name, FactoredBrdf& brdf) {
    const auto maps = factors[name].cast<Array<float>>();
    if (maps.ndim() != 4 || maps.shape(0) < 1 || maps.shape(0) > kMostTerms || maps.shape(1) < kMinMapSize ||
        maps.shape(1) > kMaxMapSize || maps.shape(1) != maps.shape(2) || maps.shape(3) != 3)
        throw py::value_error(std::string(name) + ": expected an array of shape (K, S, S, 3)");
    if (brdf.terms != 0 && (brdf.terms != maps.shape(0) || brdf.size != maps.shape(1)))
        throw py::value_error(std::string(name) + ": expected as many maps as light_maps has, of its size");
    brdf.terms = int(maps.shape(0)), brdf.size = int(maps.shape(1));
    for (py::ssize_t i = 0; i < maps.size(); i++)
        if (!std::isfinite(maps.data()[i]))
            throw UsageError(std::string(name) + ": expected values that are finite");
    const auto* const first = reinterpret_cast<const vec3*>(maps.data());
    return {first, first + maps.size() / 3};
}

FactoredBrdf factorsFrom(const py::dict& factors) {
    for (const char* name : {"light_maps", "view_maps", "mapping"})
        if (!factors.contains(name))
            throw py::value_error(
                fmt::format("factors: expected what brdf() returns; \"{}\" is missing", name));
    FactoredBrdf brdf;
    brdf.lightMaps = mapsOf(factors, "light_maps", brdf);
    brdf.viewMaps = mapsOf(factors, "view_maps", brdf);
    brdf.mapping = mappingFrom(factors["mapping"].cast<std::string>());
    return brdf;
}

// Returns the errors after each term, per light and factors.
std::vector<std::vector<std::vector<float>>> errorsOfRadiance(const std::string& material,
                                                              const std::vector<py::dict>& factors,
                                                              const std::vector<Light>& lights,
                                                              int orientations, bool uniform) {
    constexpr int kLightSize = 64; // per side of the cube, as in `relume brdf`
    expectWithin("orientations", orientations, 1, 1 << 20);
    std::vector<FactoredBrdf> brdfs;
    for (const py::dict& one : factors) brdfs.push_back(factorsFrom(one));
    const py::gil_scoped_release unlocked;
    std::vector<LayerOf> layers;
    for (const FactoredBrdf& brdf : brdfs) layers.push_back({&brdf});
    std::vector<LightCube> cubes;
    for (const Light& light : lights) cubes.push_back(sampleLight(light, kLightSize));
    return radianceErrors(*makeBrdf(material), layers, cubes, {orientations, uniform});
}

// Returns local directions, lifted above the horizon.
std::vector<vec3> directionsFrom(const Array<float>& array, const char* name) {
    std::vector<vec3> directions = elementsOf<vec3>(array, name);
    for (vec3& direction : directions) {
        const float length = glm::length(direction);
        if (!(length > 0 && std::isfinite(length)))
            throw UsageError(fmt::format("{}: expected directions that are finite and not 0", name));
        direction = liftAboveHorizon(direction / length);
    }
    return directions;
}

py::array_t<float> valuesOf(const std::variant<std::string, py::dict>& of, const Array<float>& incoming,
                            const Array<float>& outgoing) {
    const std::vector<vec3> in = directionsFrom(incoming, "incoming"),
                            out = directionsFrom(outgoing, "outgoing");
    if (in.size() != out.size()) throw py::value_error("incoming and outgoing: expected as many of either");
    std::vector<vec3> values(in.size());
    if (const auto* material = std::get_if<std::string>(&of)) {
        const std::unique_ptr<Brdf> brdf = makeBrdf(*material);
        for (size_t i = 0; i < in.size(); i++) values[i] = brdf->evaluate(in[i], out[i]);
    } else {
        const FactoredBrdf brdf = factorsFrom(std::get<py::dict>(of));
        for (size_t i = 0; i < in.size(); i++) values[i] = evaluate(brdf, in[i], out[i]);
    }
    return arrayOf(std::move(values), {py::ssize_t(in.size())});
}

} // namespace

void addBrdfs(py::module_& module) {
    module.def("_brdf", factored);
    module.def("_radiance_errors", errorsOfRadiance);
    module.def(
        "brdf_values", valuesOf, py::arg("of"), py::arg("incoming"), py::arg("outgoing"),
        "f (n, 3) at pairs of local unit directions (n, 3), z along the normal, of a material or of the "
        "factors that brdf() returned.");
    module.def("materials", [] { return parsed(describeMaterials().dump()); });
}

} // namespace relume::python
