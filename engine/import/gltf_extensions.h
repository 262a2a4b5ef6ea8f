// The material extensions of glTF that change how a surface reflects.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace relume {

// Returns the parameters of the model `gltf` (docs/materials.md) that a material's extensions set, clamped to
// their ranges. `ignore` is told the name of each extension, and of each texture in one, that is left out.
// Throws Error, in which `place` names the material.
nlohmann::ordered_json readGltfExtensions(const nlohmann::json& material, const std::string& place,
                                          const std::function<void(const std::string&)>& ignore);

} // namespace relume
