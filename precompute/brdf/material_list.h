// The materials that a part can binding, as a text names them.
#pragma once

#include "precompute/brdf/brdf.h"

namespace relume {

struct NamedMaterial {
    std::string name; // unique among those of the part
    std::shared_ptr<Brdf> brdf;
};

// Factored jointly within a set, each set on its own.
using MaterialSets = std::vector<std::vector<NamedMaterial>>;

constexpr size_t kMostMaterials = 16;   // of a part
constexpr size_t kMostSetMaterials = 8; // of a set: its tables are held at once, some hundred MB each at most

// From a material as makeBrdf() takes it; {"set": [M, …]}: several that share light maps and one bake; or
// {"separate": [M or {"set": …}, …]}: several baked independently. A .json file may hold any of these, or be
// an element of a list. An object may have a "name"; without one a material is called by its preset, its
// model or its file, and a number where that is taken. Throws UsageError and Error as makeBrdf() does.
MaterialSets readMaterials(const std::string& text, const std::filesystem::path& folder = {});

} // namespace relume
