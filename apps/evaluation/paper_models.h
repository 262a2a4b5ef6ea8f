// The four models of the paper's tables, with its numbers.
#pragma once

#include "apps/evaluation/scene_setup.h"

#include <array>

namespace relume {

inline constexpr std::array<int, 2> kPaperTerms = {1, 4};

struct PaperModel {
    const char* name;
    double vertices, ground;         // counts
    std::array<double, 2> minutes;   // of a bake, by kPaperTerms
    std::array<double, 2> megabytes; // 10^6 bytes
    std::array<double, 2> viewFps, lightFps;

    double allVertices() const { return vertices + ground; }
};

struct PaperScene {
    const PaperModel* model;
    SceneInput input;
};

// Those whose meshes are there; nothing stands in for the others.
std::vector<PaperScene> paperScenes(const SectionInputs& inputs);

// Ashikhmin-Shirley on its ground, in the paper's way.
BakeRecipe paperRecipe(const SectionInputs& inputs, const PaperScene& scene, int terms);

} // namespace relume
