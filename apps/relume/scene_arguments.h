// What to bake and how: the options of `relume bake`, shared with `relume bench`.
#pragma once

#include "apps/relume/factorization_arguments.h"
#include "apps/relume/layout_arguments.h"
#include "engine/import/ground.h"
#include "engine/import/scene.h"
#include "precompute/bake/bake.h"
#include "precompute/bake/bake_preset.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>

namespace relume {

// Of one material or several, as options name them: the text that readMaterials() takes.
std::string joinMaterials(const std::vector<std::string>& materials, bool separate);

// MESH|SCENE.json, --material, --separate, --up, --ground…
struct SceneArguments {
    std::string input = "knot";
    bool ground = false;

    void add(CLI::App& command);
    // Throws UsageError for options that the input cannot obey, Error for bad files. `isRefined`: a ground
    // whose tessellation is not given starts coarse.
    Scene load(bool isRefined) const;

  private:
    void checkMaterials(const Scene& scene) const;
    // None: the mesh's own.
    std::optional<std::string> chosenMaterial() const;

    std::vector<std::string> mMaterials; // none: the mesh's own, else kDefaultMaterial
    bool mSeparate = false;
    CLI::Option* mMaterialOption = nullptr;
    CLI::Option* mUpOption = nullptr;
    CLI::Option* mBrushOption = nullptr;
    float mBrushRotation = 0;
    std::vector<CLI::Option*> mGroundDetails; // mean nothing without --ground
    CLI::Option* mTessellationOption = nullptr;
    std::string mUp = "y";
    std::string mGroundMaterial = "white-diffuse";
    GroundOptions mGroundOptions;
};

// --preset, and everything in BakeOptions that is given beside it: --terms, --factorization, …
struct BakeArguments {
    BakeOptions options; // after resolve()

    // `takesLayout`: without, all is kept in rows, of direct light alone.
    void add(CLI::App& command, bool takesLayout = true);
    // Fills what needs parsing and validates. Throws UsageError.
    void resolve();

  private:
    // None: the preset's.
    FactorizationArguments mFactorization;
    LayoutArguments mLayout;
    std::optional<int> mCoefficients, mMapSize, mFaceSize, mVisibilitySize, mTransportSamples, mBounces;
    std::optional<std::string> mOccluder, mVisibility, mRefine;
    BakePreset mPreset = BakePreset::Default;
    bool mTakesLayout = true;
};

// --bounces; `standard` is what the help says for none.
void addBounces(CLI::App& command, std::optional<int>& bounces, const std::string& standard);

// --preset
void addPreset(CLI::App& command, BakePreset& preset, const std::string& help);

// Bakes in memory with progress on stderr.
Asset bakeWithProgress(const vk::Device& device, Scene scene, const BakeOptions& options, bool quiet,
                       BakeTimes& times);

// {"ms_per_vertex", "seconds", "vertices", "stages": {name: {"ms_per_vertex", "share"}}}
nlohmann::json describeTimes(const BakeTimes& times, uint64_t vertices);

uint64_t vertexCount(const Asset& asset);

} // namespace relume
