// Scenes of the evaluation, and their bakes: made when a step first needs one, gone when the last one is
// done.
#pragma once

#include "apps/evaluation/scene_inputs.h"
#include "precompute/bake/bake.h"

#include <nlohmann/json.hpp>

namespace relume {

struct BakeRecipe {
    std::string name; // for people
    SceneInput model;
    std::string material;                // as readMaterials() takes it
    std::optional<GroundOptions> ground; // of white-diffuse
    BakeOptions options;
    size_t triangles = 0; // that the model is simplified to; 0: all

    // Everything that decides the asset on a device.
    nlohmann::ordered_json key() const;
    // What recipes have in common whose vertices are the same and see the same.
    nlohmann::ordered_json visibilityKey() const;
};

// Returns the options of BakePreset::Paper with so many terms and coefficients.
BakeOptions paperOptions(int terms, int coefficients = 96);

Scene makeScene(const BakeRecipe& recipe);

// What a bake cost.
struct BakeRecord {
    uint64_t vertices = 0, bytes = 0; // of transport, in memory
    // Of wall-clock time, over the vertices of its last run: a tenth or more. None: of a bake that was not
    // timed.
    std::optional<double> msPerVertex;
    std::vector<std::pair<std::string, double>> msByStage; // device time of a vertex; empty unless timed
};

class BakeStore {
  public:
    BakeStore(const vk::Device& device, std::filesystem::path folder)
        : mDevice(device), mFolder(std::move(folder)) {}

    // Bakes unless it is there, from its checkpoint on where there is one, and with the visibility that the
    // first bake of the same visibilityKey() kept. Shows progress. Throws BakeStopped when an interrupt was
    // caught, Error. Files are of this program and device alone.
    BakeRecord make(const BakeRecipe& recipe) const;
    // The same, of a bake that finds the visibility of the vertices that it times, and does not keep it.
    BakeRecord makeTimed(const BakeRecipe& recipe) const;
    Asset read(const BakeRecipe& recipe) const; // after either
    void remove(const BakeRecipe& recipe) const;
    void removeVisibility(const BakeRecipe& recipe) const;
    // A bake that keeps the recipe's visibility; there after the first make() of such that had to bake.
    std::filesystem::path visibilityPath(const BakeRecipe& recipe) const;

  private:
    std::filesystem::path pathOf(const nlohmann::ordered_json& key) const;
    std::filesystem::path bakePath(const BakeRecipe& recipe) const { return pathOf(recipe.key()); }

    const vk::Device& mDevice;
    std::filesystem::path mFolder;
};

} // namespace relume
