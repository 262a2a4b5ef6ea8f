#include "precompute/brdf/model_list.h"

#include "engine/base/error.h"
#include "engine/base/nearest_name.h"
#include "precompute/brdf/models.h"

#include <fmt/ranges.h>

namespace relume {

using nlohmann::json;

namespace {

struct Model {
    const char* name;
    const char* description;
    std::unique_ptr<Brdf> (*make)(MaterialParameters& parameters);
    const char* least = "{}"; // the parameters that are mandatory
};

constexpr Model kModels[] = {
    {"diffuse", "Lambert's", makeDiffuse},
    {"oren-nayar", "rough and diffuse; sigma in degrees (Oren and Nayar 1994, Fujii 2012)", makeOrenNayar},
    {"phong", "normalized Phong, kd + ks at most 1 (Lafortune and Willems 1994)", makePhong},
    {"ashikhmin-shirley", "anisotropic Phong over a diffuse base (Ashikhmin and Shirley 2000)",
     makeAshikhminShirley},
    {"lafortune", "cosine lobes {cx, cy, cz, n} fitted to measurements (Lafortune et al. 1997)",
     makeLafortune, R"({"lobes": []})"},
    {"cook-torrance", "Beckmann microfacets over a diffuse base (Cook and Torrance 1982)", makeCookTorrance},
    {"ggx", "bare conductor, anisotropic GGX microfacets (Walter et al. 2007, Heitz 2014)", makeGgx},
    {"gltf",
     "glTF 2.0 metallic-roughness with sheen, clear coat and anisotropy; alpha = max(roughness^2, 0.02)",
     makeGltf},
    {"plastic", "GGX coat over a diffuse base; give f0 or the index of refraction", makePlastic},
};

} // namespace

std::vector<std::string_view> modelNames() {
    std::vector<std::string_view> names;
    for (const Model& model : kModels) names.push_back(model.name);
    return names;
}

std::unique_ptr<Brdf> makeModel(const std::string& name, const json& parameters) {
    for (const Model& model : kModels) {
        if (name != model.name) continue;
        MaterialParameters reader(name, parameters);
        auto brdf = model.make(reader);
        reader.noteUnknownKeys();
        reader.rejectFaults();
        return brdf;
    }
    const std::vector<std::string_view> names = modelNames();
    throw UsageError(fmt::format("unknown model \"{}\"; did you mean \"{}\"? Models: {}", name.substr(0, 60),
                                 nearestName(name, names), fmt::join(names, ", ")));
}

std::vector<MaterialModel> materialModels() {
    std::vector<MaterialModel> models;
    for (const Model& model : kModels) {
        MaterialParameters reader(model.name, json::parse(model.least));
        model.make(reader);
        models.push_back({model.name, model.description, reader.asked()});
    }
    return models;
}

} // namespace relume
