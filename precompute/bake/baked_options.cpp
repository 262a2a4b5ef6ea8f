#include "precompute/bake/baked_options.h"

#include "engine/base/error.h"
#include "precompute/brdf/material_json.h"
#include "precompute/layout/conversion.h"

#include <cmath>
#include <fmt/core.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace relume {

using nlohmann::json;

namespace {

constexpr const char* kVertexOrder = "bisected";

constexpr const char* kRemedy = "bake it again from its inputs";

// Reads the members of the options' object, all of which must be present.
class OptionReader {
  public:
    explicit OptionReader(const std::string& text) {
        constexpr size_t kLongest = 4096; // the options are short and shallow
        if (text.size() <= kLongest) mOptions = json::parse(text, nullptr, false);
        if (!mOptions.is_object()) fail("expected a JSON object");
    }

    uint64_t whole(const char* key, uint64_t most) {
        const json& value = take(key);
        if (!value.is_number_unsigned() || value.get<uint64_t>() > most)
            fail(fmt::format("\"{}\": expected a whole number up to {}", key, most));
        return value.get<uint64_t>();
    }
    int integer(const char* key) { return int(whole(key, 1u << 20)); }
    std::optional<int> integerOrNull(const char* key) {
        if (!mOptions.contains(key) || !mOptions[key].is_null()) return integer(key);
        mTaken++;
        return std::nullopt;
    }

    std::optional<double> amount(const char* key, double most) {
        const json& value = take(key);
        if (value.is_null()) return std::nullopt;
        if (!value.is_number() || !(value.get<double>() > 0 && value.get<double>() <= most))
            fail(fmt::format("\"{}\": expected null, or a number above 0 and up to {}", key, most));
        return value.get<double>();
    }

    // Only bakes that refined their meshes record this.
    std::optional<RefinementRecord> refinement() {
        if (!mOptions.contains("refinement")) return std::nullopt;
        const json& value = take("refinement");
        const auto number = [&](const char* key) {
            const auto found = value.is_object() ? value.find(key) : value.end();
            if (found == value.end() || !found->is_number() || !(found->get<double>() >= 0))
                fail(fmt::format("\"refinement\": expected an object with numbers, \"{}\" among them", key));
            return found->get<double>();
        };
        const auto count = [&](const char* key) {
            const double vertices = number(key);
            constexpr uint32_t kMost = std::numeric_limits<uint32_t>::max();
            if (vertices > double(kMost) || vertices != std::floor(vertices))
                fail(fmt::format("\"refinement\": \"{}\": expected a whole number up to {}", key, kMost));
            return uint64_t(vertices);
        };
        return RefinementRecord{number("wanted_error"), number("start_error"),
                                number("error"),        count("start_vertices"),
                                count("vertices"),      value.contains("auto") && value["auto"] == true};
    }

    // Bakes without bounces do not record the option.
    int bounces() { return mOptions.contains("bounces") ? integer("bounces") : 0; }

    // `parse` returns an std::optional, empty for an unknown name.
    template <typename Parse>
    auto name(const char* key, const Parse& parse) {
        const json& value = take(key);
        const auto known = parse(value.is_string() ? value.get<std::string>() : std::string());
        if (!known) fail(fmt::format("\"{}\": is unknown", key));
        return *known;
    }

    void expectEnd() const {
        if (mTaken != mOptions.size()) fail("there are options that this program does not know");
    }

    [[noreturn]] static void fail(const std::string& what) {
        throw Error(fmt::format("the bake's own options: {}; {}", what, kRemedy));
    }

  private:
    const json& take(const char* key) {
        const auto found = mOptions.find(key);
        if (found == mOptions.end()) fail(fmt::format("\"{}\" is missing", key));
        mTaken++;
        return *found;
    }

    json mOptions;
    size_t mTaken = 0;
};

std::optional<VisibilityMethod> methodFromName(const std::string& name) {
    for (const VisibilityMethod method : {VisibilityMethod::Raster, VisibilityMethod::Traced})
        if (name == visibilityMethodName(method)) return method;
    return std::nullopt;
}

bool isByError(const LayoutOptions& layout) { return isCompressed(layout.layout) && !layout.bytesPerVertex; }

} // namespace

std::string describeOptions(const BakeOptions& options) {
    const FactorizationOptions& factorization = options.factorization;
    json description = {
        {"terms", factorization.terms ? json(*factorization.terms) : nullptr},
        {"error", factorization.wantedError ? json(*factorization.wantedError) : nullptr},
        {"factorization", factorizationName(factorization.method)},
        {"coefficients", options.coefficients},
        {"layout", layoutName(options.layout.layout)},
        {"layout_bytes", options.layout.bytesPerVertex ? json(*options.layout.bytesPerVertex) : nullptr},
        {"layout_error",
         isByError(options.layout) && options.layout.error ? json(*options.layout.error) : nullptr},
        {"map_size", options.mapSize},
        {"map", diskMappingName(options.mapping)},
        {"face_size", options.faceSize},
        {"visibility_size", options.visibilitySize},
        {"transport_samples", options.transportSamples},
        {"occluder_triangles", options.occluderTriangles},
        {"visibility", visibilityMethodName(options.visibilityMethod)},
        {"vertex_order", kVertexOrder}};
    if (const auto& refinement = options.refinement) {
        description["refinement"] = {{"wanted_error", refinement->wanted},
                                     {"start_error", refinement->startError},
                                     {"error", refinement->error},
                                     {"start_vertices", refinement->startVertices},
                                     {"vertices", refinement->vertices}};
        if (refinement->isAuto) description["refinement"]["auto"] = true;
    }
    if (options.bounces > 0) description["bounces"] = options.bounces;
    return description.dump();
}

BakeOptions optionsOf(const Asset& asset) {
    OptionReader in(asset.provenance.options);
    BakeOptions options;
    options.factorization.terms = in.integerOrNull("terms");
    if (const auto error = in.amount("error", 1)) options.factorization.wantedError = float(*error);
    options.factorization.method =
        in.name("factorization", [](const std::string& name) { return factorizationFromName(name); });
    options.coefficients = in.integer("coefficients");
    options.layout.layout = in.name("layout", [](const std::string& name) { return layoutFromName(name); });
    options.layout.bytesPerVertex = in.amount("layout_bytes", kMostLayoutBytes);
    options.layout.error = in.amount("layout_error", 1);
    // A default error depends on the materials, which may change.
    if (options.layout.error == kDefaultLayoutError || options.layout.error == kDiffuseLayoutError)
        options.layout.error.reset();
    options.mapSize = in.integer("map_size");
    options.mapping = in.name("map", [](const std::string& name) { return diskMappingFromName(name); });
    options.faceSize = in.integer("face_size");
    options.visibilitySize = in.integer("visibility_size");
    options.transportSamples = in.integer("transport_samples");
    options.occluderTriangles = in.whole("occluder_triangles", uint64_t(1) << 40);
    options.visibilityMethod = in.name("visibility", methodFromName);
    in.name("vertex_order", [](const std::string& name) {
        return name == kVertexOrder ? std::optional(true) : std::nullopt;
    });
    options.refinement = in.refinement();
    options.bounces = in.bounces();
    in.expectEnd();
    try {
        options.validate();
    } catch (const UsageError& wrong) {
        OptionReader::fail(wrong.what());
    }
    if (options.coefficients != asset.coefficients || options.faceSize != asset.faceSize ||
        options.visibilitySize != asset.visibilitySize ||
        options.transportSamples != asset.transportSamples || options.bounces != asset.bounces ||
        (options.refinement && options.refinement->vertices != vertexCount(asset)))
        OptionReader::fail("they are not those of what it holds");
    return options;
}

std::string materialsOf(const AssetPart& part) {
    json sets = json::array();
    for (const MaterialSet& set : part.sets) {
        json materials = json::array();
        for (const AssetMaterial& material : set.materials) {
            json description;
            try {
                description = parseMaterial(material.description);
            } catch (const UsageError&) {
            }
            if (!description.is_object())
                throw Error(
                    fmt::format("part \"{}\": the description of \"{}\" is no JSON object; name its material",
                                part.name, material.name));
            description["name"] = material.name;
            materials.push_back(std::move(description));
        }
        sets.push_back({{"set", std::move(materials)}});
    }
    return json{{"separate", std::move(sets)}}.dump(-1, ' ', false, json::error_handler_t::replace);
}

} // namespace relume
