// Light change, second half: computes the K-tuple of every vertex on the device.
#pragma once

#include "engine/render/appearance.h"
#include "engine/render/fill_light.h"
#include "engine/render/light_pass.h"
#include "engine/render/lit_spheres.h"
#include "engine/transport/asset.h"
#include "engine/transport/bases/bases_relighter.h"
#include "engine/transport/rows/rows_relighter.h"

#include <limits>
#include <memory>

namespace relume {

struct RelighterOptions {
    // Most bytes of a buffer of transport; the device's own limit applies as well.
    uint64_t largestShard = std::numeric_limits<uint64_t>::max();
    bool residual = true; // whether sets with a residual are drawn with it; otherwise by their K terms alone
};

// Holds the transport of every part and set of materials on the device, each in its layout. Keeps a reference
// to the device, which must outlive it.
class Relighter {
  public:
    // Throws OutOfMemory, or Error if a part has more rows than the device can bind tuples for, or the device
    // cannot relight a layout.
    Relighter(const vk::Device& device, const Asset& asset, const RelighterOptions& options = {});

    // Records pass "relight", after those of FillLight where a set has a residual: computes the tuples of
    // every part's bound set (without `appearance`: of its first set) from the light recorded before, and of
    // sets with a residual those of its fill. Draws may use them at once. The tuples of other sets stay as
    // they are. Submit recordings once, in order: tuples may be made from those of the light before.
    void record(vk::Commands& commands, const LightPass& light, const Appearance& appearance = {});

    // Sets the mode of the record() calls that follow.
    void setMode(RelightMode mode) { mMode = mode; }

    size_t parts() const { return mParts.size(); }
    size_t shards(size_t part, size_t set = 0) const { return mParts[part][set]->shards(); }
    // Returns the tuples γ: a vec3 per row, row = vertex · terms + term.
    const vk::Buffer& tuples(size_t part, size_t set = 0) const { return mParts[part][set]->tuples(); }
    // Returns those of the light's fill, for sets with a residual; else those of the whole light.
    const vk::Buffer& fillTuples(size_t part, size_t set) const;

    // Returns the lit spheres: the unshadowed reflection of the light. A view pass makes those that it needs.
    LitSpheres& spheres() const { return *mSpheres; }

    // Returns the tuples of the last submission. Waits for the device.
    std::vector<vec3> readTuples(size_t part, size_t set = 0) const;
    std::vector<vec3> readFillTuples(size_t part, size_t set = 0) const;

  private:
    std::unique_ptr<SetRelighter> makeSet(const Transport& transport, const std::string& name,
                                          uint64_t largestShard, size_t lights);

    const vk::Device& mDevice;
    int mFaceSize;
    RelightMode mMode = RelightMode::Auto;
    std::vector<std::vector<std::unique_ptr<SetRelighter>>> mParts; // sets by part
    std::unique_ptr<LitSpheres> mSpheres;
    std::unique_ptr<FillLight> mFill; // null if no set has a residual
};

} // namespace relume
