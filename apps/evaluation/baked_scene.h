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

    // Everything that decides the bake's bytes on a device.
    nlohmann::ordered_json key() const;
};

// The paper's: its factorisation, orthographic maps of 48, rows of `coefficients`.
BakeOptions paperOptions(int terms, int coefficients = 96);

Scene makeScene(const BakeRecipe& recipe);

// What a bake cost.
struct BakeRecord {
    uint64_t vertices = 0, bytes = 0; // of transport, in memory
    double msPerVertex = 0; // of wall-clock time, over the vertices of its last run: a tenth or more
};

class BakeStore {
  public:
    BakeStore(const vk::Device& device, std::filesystem::path folder)
        : mDevice(device), mFolder(std::move(folder)) {}

    // Bakes unless it is there, from its checkpoint on where there is one. Shows progress. Throws BakeStopped
    // when an interrupt was caught, Error. Files are of this program and device alone.
    BakeRecord make(const BakeRecipe& recipe) const;
    Asset read(const BakeRecipe& recipe) const; // after make()
    void remove(const BakeRecipe& recipe) const;

  private:
    std::filesystem::path pathOf(const BakeRecipe& recipe) const;

    const vk::Device& mDevice;
    std::filesystem::path mFolder;
};

} // namespace relume
