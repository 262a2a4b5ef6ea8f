// The interface of BRDF models, each of which has a file in this folder.
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

    // Returns f(ωi, ωo) per color channel in sr⁻¹, without the cosine; finite, never negative. Takes unit
    // directions in the local frame, z along the normal, both with z > 0.
    virtual vec3 evaluate(vec3 incoming, vec3 outgoing) const = 0;

    // Returns the part of f that a texture of base color (diffuse albedo) multiplies, per channel: at most f,
    // up to rounding, so that the rest is never negative. Zero for a model without such a part.
    virtual vec3 evaluateBase(vec3 /*incoming*/, vec3 /*outgoing*/) const { return vec3(0); }

    // Returns whether f(ωi, ωo) = f(ωo, ωi) by construction.
    virtual bool isReciprocal() const { return true; }

    // Returns whether rotating both directions about the normal changes nothing.
    virtual bool isIsotropic() const { return true; }

    // Returns JSON from which makeBrdf() makes the same BRDF: {"model": NAME, every parameter that has an
    // effect…} or, for measured data, {"measured": PATH, "scale": s, "hash": h}.
    virtual nlohmann::json describe() const = 0;
};

// Makes a BRDF from a preset's name ("clay"), a model's name ("ashikhmin-shirley"), a JSON object as text
// ({"model": "ashikhmin-shirley", "nu": 10} or {"measured": "steel.binary"}), the path of a .json file with
// such an object, or the path of measured data (.binary, .brdf). A "name" in the object is ignored. Relative
// paths start at `folder`, those in a .json file at its folder. Throws UsageError naming the nearest valid
// name or a parameter's valid range, and Error for an unusable file.
std::unique_ptr<Brdf> makeBrdf(const std::string& material, const std::filesystem::path& folder = {});

// All presets: names, one-line descriptions and models.
struct MaterialPreset {
    std::string name, description, model;
};
std::vector<MaterialPreset> materialPresets();

} // namespace relume
