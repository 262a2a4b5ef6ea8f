// How large scenes and images are, in full and with --quick.
#pragma once

#include "apps/evaluation/evaluation.h"
#include "apps/evaluation/relit_scene.h"

#include <span>

namespace relume {

// The model as it is on the ground that the paper tessellates for it; with --quick a small one on a coarse
// ground, seen at half the resolution.
BakeRecipe sceneRecipe(const SectionInputs& inputs, const std::string& model, const SceneInput& found,
                       const std::string& material, const BakeOptions& options);

// Those of these names that are there.
std::vector<SceneInput> environmentsOf(const SectionInputs& inputs, std::span<const char* const> names);

ImageSize wideImage(bool quick), tallImage(bool quick);

ReferenceEffort referenceEffort(bool quick);

// What --quick makes smaller, as a sentence for sections; empty in full.
std::string quickNote(bool quick);

// N at which nothing is dropped, at the default size of the light's cube.
constexpr int kMostCoefficients = 6 * 64 * 64;

// The section without steps, saying why.
Section skippedSection(Section section, const std::string& why);

// The preset of the paper's Figures 2 and 5.
constexpr const char* kAshikhminShirley = "ashikhmin-shirley";

} // namespace relume
