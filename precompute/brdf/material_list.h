// Reads the materials that can be bound to a part.
#pragma once

#include "precompute/brdf/brdf.h"

namespace relume {

struct NamedMaterial {
    std::string name; // unique within the part
    std::shared_ptr<Brdf> brdf;
};

// Materials of a set are factored jointly, each set separately.
using MaterialSets = std::vector<std::vector<NamedMaterial>>;

constexpr size_t kMostMaterials = 16;   // per part
constexpr size_t kMostSetMaterials = 8; // per set, whose tables (some hundred MB each) are held together

// Reads a single material, as makeBrdf() takes it; {"set": [M, …]}, several that share light maps and
// transport; or {"separate": [M or {"set": …}, …]}, several baked independently. A .json file may hold any of
// these, or be an element of a list. A material without "name" is named after its preset, model or file, with
// a number if that is taken. Throws UsageError and Error as makeBrdf() does.
MaterialSets readMaterials(const std::string& text, const std::filesystem::path& folder = {});

} // namespace relume
