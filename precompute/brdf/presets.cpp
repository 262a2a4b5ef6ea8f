#include "precompute/brdf/presets.h"

namespace relume {

namespace {

// Clay and skin: fits of Lafortune's model (Lafortune et al. 1997) to measurements at Cornell, attributed to
// Westin; the values as in pbrt, version 1.
constexpr PresetDefinition kPresets[] = {
    {"grey-diffuse", "Lambertian, albedo 0.5", R"({"model": "diffuse", "albedo": 0.5})"},
    {"white-diffuse", "Lambertian, albedo 0.8, for grounds", R"({"model": "diffuse", "albedo": 0.8})"},
    {"ashikhmin-shirley", "brushed metal, anisotropic: kd 0.5, ks 0.75, nu 10, nv 100",
     R"({"model": "ashikhmin-shirley", "kd": 0.5, "ks": 0.75, "nu": 10, "nv": 100})"},
    {"clay", "blue-grey pottery clay, Lafortune's three lobes fitted to measurements", R"({
        "model": "lafortune",
        "diffuse": [0.383626, 0.260749, 0.274207],
        "lobes": [
            {"cx": [-1.089701, -1.102701, -1.107603], "cy": [-1.089701, -1.102701, -1.107603],
             "cz": [-1.354682, -2.714801, -1.569866], "n": [17.968505, 11.024489, 21.270282]},
            {"cx": [-0.733381, -0.793320, -0.848206], "cy": [-0.733381, -0.793320, -0.848206],
             "cz": [0.676108, 0.679314, 0.726031], "n": [8.219745, 9.055139, 11.261951]},
            {"cx": [-1.010548, -1.012378, -1.011263], "cy": [-1.010548, -1.012378, -1.011263],
             "cz": [0.910783, 0.885239, 0.892451], "n": [152.912795, 141.937171, 201.046802]}
        ]})"},
    {"skin", "human skin, Lafortune's three lobes fitted to measurements", R"({
        "model": "lafortune",
        "diffuse": [0.428425, 0.301341, 0.331054],
        "lobes": [
            {"cx": [-1.131747, -1.016939, -0.966018], "cy": [-1.131747, -1.016939, -0.966018],
             "cz": [-1.209182, -1.462488, -1.222419], "n": [6.421658, 3.699932, 3.524889]},
            {"cx": [-0.546570, -0.643533, -0.638934], "cy": [-0.546570, -0.643533, -0.638934],
             "cz": [0.380123, 0.410559, 0.437367], "n": [3.685044, 4.266495, 4.539742]},
            {"cx": [-0.998888, -1.020153, -1.027479], "cy": [-0.998888, -1.020153, -1.027479],
             "cz": [0.857998, 0.703913, 0.573625], "n": [64.208486, 63.919687, 43.809866]}
        ]})"},
    {"red-plastic", "red under a glossy coat of index 1.5",
     R"({"model": "plastic", "diffuse": [0.55, 0.04, 0.03], "f0": 0.04, "roughness": 0.3})"},
    {"brown-plastic", "light brown under a satin coat of index 1.5",
     R"({"model": "plastic", "diffuse": [0.45, 0.29, 0.16], "f0": 0.04, "roughness": 0.4})"},
};

} // namespace

std::span<const PresetDefinition> presetDefinitions() { return kPresets; }

} // namespace relume
