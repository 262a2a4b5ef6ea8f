// The options of `relume bake` that say what to bake and how, shared with `relume bench`.
#pragma once

#include "apps/relume/factorization_arguments.h"
#include "apps/relume/layout_arguments.h"
#include "engine/import/builtin_mesh.h"
#include "engine/import/scene.h"
#include "precompute/bake/bake.h"
#include "precompute/bake/bake_options.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>

namespace relume {

// Returns one or several materials, as options name them, as text for readMaterials().
std::string joinMaterials(const std::vector<std::string>& materials, bool separate);

// MESH|SCENE.json, --material, --separate, --up, --ground…
struct SceneArguments {
    std::string input = "knot";
    bool ground = false;

    void add(CLI::App& command);
    // Throws UsageError for options that do not apply to the input, and Error for bad files. `isRefined`: a
    // ground without given tessellation starts coarse.
    Scene load(bool isRefined) const;

  private:
    void checkMaterials(const Scene& scene) const;
    // Returns none for the mesh's own materials.
    std::optional<std::string> chosenMaterial() const;

    std::vector<std::string> mMaterials; // empty: the mesh's own, or kDefaultMaterial
    bool mSeparate = false;
    CLI::Option* mMaterialOption = nullptr;
    CLI::Option* mUpOption = nullptr;
    CLI::Option* mBrushOption = nullptr;
    float mBrushRotation = 0;
    std::vector<CLI::Option*> mGroundDetails; // need --ground
    CLI::Option* mTessellationOption = nullptr;
    std::string mUp = "y";
    std::string mGroundMaterial = "white-diffuse";
    GroundOptions mGroundOptions;
};

// --preset, and everything in BakeOptions that is given beside it: --terms, --factorization, …
struct BakeArguments {
    BakeOptions options; // after resolve()

    // Without `takesLayout`, transport is in rows, of direct light only.
    void add(CLI::App& command, bool takesLayout = true);
    // Parses and validates all options. Throws UsageError.
    void resolve();

  private:
    // None: as in the preset.
    FactorizationArguments mFactorization;
    LayoutArguments mLayout;
    std::optional<int> mCoefficients, mMapSize, mFaceSize, mVisibilitySize, mTransportSamples, mBounces;
    std::optional<std::string> mOccluder, mVisibility, mRefine;
    BakePreset mPreset = BakePreset::Default;
    bool mTakesLayout = true;
};

// --bounces; `standard` is the default that help shows.
void addBounces(CLI::App& command, std::optional<int>& bounces, const std::string& standard);

// --preset
void addPreset(CLI::App& command, BakePreset& preset, const std::string& help);

// Bakes in memory, with progress on stderr.
Asset bakeWithProgress(const vk::Device& device, Scene scene, const BakeOptions& options, bool quiet,
                       BakeTimes& times);

// {"ms_per_vertex", "seconds", "vertices", "stages": {name: {"ms_per_vertex", "share"}}}
nlohmann::json describeTimes(const BakeTimes& times, uint64_t vertices);

} // namespace relume
