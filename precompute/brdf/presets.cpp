#include "precompute/brdf/presets.h"

namespace relume {

namespace {

// F0 of metals: Adobe's, in linear Rec. 709 ("Metal material references" of the Standard Material: Ag, Al,
// Au, Cr, Cu); iron's is from Google's Filament ("Material properties"). Highlights are as wide as maps of 48
// × 48 texels and a few terms can represent; the narrowest, chrome's, needs 16 terms or more. Colors of
// paints, woods and stones are chosen by eye.
//
// Clay and skin: fits of Lafortune's model (Lafortune et al. 1997) to measurements at Cornell, attributed to
// Westin; values as in pbrt, version 1.
constexpr PresetDefinition kPresets[] = {
    {"gray-diffuse", "Lambertian, albedo 0.5", R"({"model": "diffuse", "albedo": 0.5})"},
    {"white-diffuse", "Lambertian, albedo 0.8, for grounds", R"({"model": "diffuse", "albedo": 0.8})"},
    {"ashikhmin-shirley", "brushed metal, anisotropic: kd 0.5, ks 0.75, nu 10, nv 100",
     R"({"model": "ashikhmin-shirley", "kd": 0.5, "ks": 0.75, "nu": 10, "nv": 100})"},
    {"clay", "blue-gray pottery clay, Lafortune's three lobes fitted to measurements", R"({
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
    {"black-plastic", "black under a glossy coat of index 1.5",
     R"({"model": "plastic", "diffuse": 0.01, "f0": 0.04, "roughness": 0.25})"},
    {"white-plastic", "white under a glossy coat of index 1.5",
     R"({"model": "plastic", "diffuse": 0.8, "f0": 0.04, "roughness": 0.25})"},
    {"rubber", "dark rubber, a wide dull highlight",
     R"({"model": "cook-torrance", "diffuse": 0.03, "f0": 0.035, "roughness": 0.5})"},
    {"porcelain", "white glazed ceramic",
     R"({"model": "plastic", "diffuse": [0.82, 0.81, 0.78], "index": 1.55, "roughness": 0.2})"},
    {"jade", "green polished stone, without its translucency",
     R"({"model": "plastic", "diffuse": [0.12, 0.36, 0.17], "index": 1.65, "roughness": 0.22})"},
    {"varnished-wood", "brown wood under a clear varnish",
     R"({"model": "plastic", "diffuse": [0.32, 0.15, 0.06], "index": 1.52, "roughness": 0.22})"},
    {"lacquer", "deep red lacquer",
     R"({"model": "plastic", "diffuse": [0.3, 0.012, 0.008], "index": 1.55, "roughness": 0.22})"},
    {"pearl", "off-white with a bright soft sheen",
     R"({"model": "ashikhmin-shirley", "kd": [0.75, 0.7, 0.66], "ks": [0.3, 0.29, 0.28], "nu": 30, "nv": 30})"},
    {"gold", "gold, softly polished",
     R"({"model": "ggx", "f0": [1.0, 0.7099, 0.3148], "roughness_u": 0.3, "roughness_v": 0.3})"},
    {"silver", "silver, softly polished",
     R"({"model": "ggx", "f0": [0.9868, 0.983, 0.9667], "roughness_u": 0.25, "roughness_v": 0.25})"},
    {"copper", "copper, softly polished",
     R"({"model": "ggx", "f0": [1.0, 0.6504, 0.5274], "roughness_u": 0.3, "roughness_v": 0.3})"},
    {"aluminium", "aluminium, satin finish",
     R"({"model": "ggx", "f0": [0.9157, 0.9226, 0.9236], "roughness_u": 0.35, "roughness_v": 0.35})"},
    {"chrome", "chromium, less polished than in life; wants 16 terms or more",
     R"({"model": "ggx", "f0": [0.5496, 0.5561, 0.5531], "roughness_u": 0.2, "roughness_v": 0.2})"},
    {"brushed-steel", "steel brushed along t, its highlight drawn out along s",
     R"({"model": "ggx", "f0": [0.527, 0.509, 0.491], "roughness_u": 0.5, "roughness_v": 0.2})"},
    {"brushed-copper", "copper brushed along t, its highlight drawn out along s",
     R"({"model": "ggx", "f0": [1.0, 0.6504, 0.5274], "roughness_u": 0.55, "roughness_v": 0.22})"},
    {"satin", "silk-like cloth, a highlight across its threads",
     R"({"model": "ashikhmin-shirley", "kd": [0.35, 0.08, 0.16], "ks": [0.35, 0.25, 0.28], "nu": 6, "nv": 60})"},
    {"car-paint-red", "red car paint with a metallic sheen",
     R"({"model": "ashikhmin-shirley", "kd": [0.42, 0.02, 0.02], "ks": [0.22, 0.06, 0.05], "nu": 30, "nv": 30})"},
    {"car-paint-blue", "blue car paint with a metallic sheen",
     R"({"model": "ashikhmin-shirley", "kd": [0.02, 0.06, 0.38], "ks": [0.06, 0.09, 0.22], "nu": 30, "nv": 30})"},
    {"paint-gloss", "white gloss paint",
     R"({"model": "gltf", "base_color": [0.8, 0.79, 0.76], "metallic": 0, "roughness": 0.4})"},
    {"paint-matte", "white matte paint",
     R"({"model": "oren-nayar", "albedo": [0.8, 0.79, 0.76], "sigma": 20})"},
    {"concrete", "gray concrete, rough",
     R"({"model": "oren-nayar", "albedo": [0.38, 0.37, 0.35], "sigma": 30})"},
    {"plaster", "white plaster, rough",
     R"({"model": "oren-nayar", "albedo": [0.75, 0.73, 0.7], "sigma": 25})"},
    {"terracotta", "unglazed red earthenware",
     R"({"model": "oren-nayar", "albedo": [0.45, 0.17, 0.09], "sigma": 25})"},
};

} // namespace

std::span<const PresetDefinition> presetDefinitions() { return kPresets; }

} // namespace relume
