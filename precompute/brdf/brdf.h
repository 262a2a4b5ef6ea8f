// The interface of every BRDF model. One file per model beside this one.
#pragma once

#include "engine/math/vector.h"

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace relume {

class Brdf {
  public:
    virtual ~Brdf() = default;

    // f(ωi, ωo) in sr⁻¹ per color channel, without the cosine. Unit directions in the local frame,
    // z along the normal, both with z > 0. Never negative, always finite.
    virtual vec3 evaluate(vec3 incoming, vec3 outgoing) const = 0;

    // The part of f that a texture of the base color (the diffuse albedo) multiplies, per channel: at most
    // f, without rounding, so that the rest is never negative. Zero for a model that has no such part.
    virtual vec3 evaluateBase(vec3 /*incoming*/, vec3 /*outgoing*/) const { return vec3(0); }

    // Whether f(ωi, ωo) = f(ωo, ωi) by construction.
    virtual bool isReciprocal() const { return true; }

    // Returns whether a turn of both directions about the normal changes nothing.
    virtual bool isIsotropic() const { return true; }

    // {"model": NAME, every parameter…}, or of measured data {"measured": PATH, "scale": s, "hash": h}:
    // makeBrdf of it gives the same BRDF.
    virtual nlohmann::json describe() const = 0;
};

// An object may also have a "name", which says nothing about the BRDF. From a preset's name ("clay"), a
// model's name ("ashikhmin-shirley"), a JSON object as text ({"model": "ashikhmin-shirley", "nu": 10} or
// {"measured": "steel.binary"}), the path of a file of such JSON (.json), or that of measured data (.binary,
// .brdf). A relative path starts at `folder`, one in a .json file at that file's folder. Throws UsageError
// naming the nearest valid name, or the valid range of a parameter; Error for a file that cannot be used.
std::unique_ptr<Brdf> makeBrdf(const std::string& material, const std::filesystem::path& folder = {});

// Names of all presets, with a line of description each, and their model.
struct MaterialPreset {
    std::string name, description, model;
};
std::vector<MaterialPreset> materialPresets();

} // namespace relume
