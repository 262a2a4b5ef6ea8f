// The list of BRDF models with their parameters.
#pragma once

#include "precompute/brdf/material_parameters.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace relume {

class Brdf;

struct MaterialModel {
    std::string name, description;
    std::vector<MaterialParameter> parameters;
};
std::vector<MaterialModel> materialModels();

std::vector<std::string_view> modelNames();

// Makes a model from a JSON object of its parameters. Throws UsageError naming the nearest valid name or a
// parameter's valid range.
std::unique_ptr<Brdf> makeModel(const std::string& name, const nlohmann::json& parameters);

} // namespace relume
