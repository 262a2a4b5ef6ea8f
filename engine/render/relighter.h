// Light change, second half: the K-tuple of every vertex, on the device.
#pragma once

#include "engine/render/appearance.h"
#include "engine/render/light_pass.h"
#include "engine/render/lit_spheres.h"
#include "engine/transport/asset.h"
#include "engine/transport/bases/bases_relighter.h"
#include "engine/transport/rows/rows_relighter.h"

#include <limits>
#include <memory>
#include <tuple>

namespace relume {

struct RelighterOptions {
    // Bytes of the largest buffer of transport; the device's own limit holds as well.
    uint64_t largestShard = std::numeric_limits<uint64_t>::max();
    bool residual = true; // whether sets that have one are drawn with it; else by their K terms alone
};

// Holds the transport of every part and set of materials on the device, each in its layout.
class Relighter {
  public:
    // Throws OutOfMemory, or Error when a part has more rows than the device can bind tuples for, or the
    // device cannot relight a layout.
    Relighter(const vk::Device& device, const Asset& asset, const RelighterOptions& options = {});

    // Pass "relight": tuples of every part's bound set (none given: the first) under the light recorded
    // before. Draws may use them at once. Those of other sets stay as they are. Recordings are to be
    // submitted in their order, and once: tuples may be made from those of the light before.
    void record(vk::Commands& commands, const LightPass& light, const Appearance& appearance = {});

    // Of the record() calls that follow.
    void setMode(RelightMode mode) { mMode = mode; }

    size_t parts() const { return mParts.size(); }
    size_t shards(size_t part, size_t set = 0) const { return mParts[part][set]->shards(); }
    // vec3 per row, row = vertex · terms + term: what the light gives of a term, the γ of the method.
    const vk::Buffer& tuples(size_t part, size_t set = 0) const { return mParts[part][set]->tuples(); }

    // The unshadowed reflection of the light. A view pass makes the spheres that it needs.
    LitSpheres& spheres() const { return *mSpheres; }

    // Those of the last submission. Waits for the device.
    std::vector<vec3> readTuples(size_t part, size_t set = 0) const;

  private:
    std::unique_ptr<SetRelighter> makeSet(const Transport& transport, const std::string& name,
                                          uint64_t largestShard);

    const vk::Device& mDevice;
    int mFaceSize;
    RelightMode mMode = RelightMode::Auto;
    // Of the layouts that are there; where they are they stay, as the sets refer to them.
    std::tuple<std::unique_ptr<RowsRelighter::Programs>, std::unique_ptr<BasesRelighter::Programs>> mPrograms;
    std::vector<std::vector<std::unique_ptr<SetRelighter>>> mParts; // sets by part
    std::unique_ptr<LitSpheres> mSpheres;
};

} // namespace relume
