// Lit spheres: a material's unshadowed reflection of the light for every mirror direction, from a grid of
// view directions (Sloan, Martin, Gooch, Gooch: The Lit Sphere, 2001). A sphere is made when first needed,
// and anew after the light changed. engine/scene/residual.h has the mathematics.
#pragma once

#include "engine/render/fill_light.h"
#include "engine/render/light_pass.h"
#include "engine/render/map_texture.h"
#include "engine/scene/residual.h"
#include "engine/transport/asset.h"

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <span>

namespace relume {

// Makes and keeps the lit spheres of an asset. Keeps a reference to the device, which must outlive it.
class LitSpheres {
  public:
    // Makes buffers for all parts and sets of `asset` that have a residual, or for none unless
    // `takesResiduals`; and for the unshadowed tuples of a ground (ground_fade.h), which its shadow needs.
    // Throws OutOfMemory.
    LitSpheres(const vk::Device& device, const Asset& asset, bool takesResiduals);

    // Records pass "unshadowed", which sets the light of all spheres made from now on, and sums the
    // unshadowed tuples. `fill` is the light's; it may be null where no set has a residual.
    void recordLight(vk::Commands& commands, const LightPass& light, const FillLight* fill);

    // Records pass "spheres", which makes the missing spheres of these kernels and grid nodes, for draws that
    // follow: of the whole light, and of its fill if `makesFill`. Throws Error if the device's images have
    // too few layers.
    void record(vk::Commands& commands, std::span<const uint32_t> kernels, const std::set<uint32_t>& nodes,
                bool makesFill = true);

    // Returns the residual of a set, or null if its K terms are drawn alone.
    const ResidualSet* set(size_t part, size_t set) const { return mResiduals[part][set].get(); }
    // Returns the number of a layer's kernel.
    uint32_t kernel(const SphereKernel* layer) const { return mKernelNumbers.at(layer); }

    // Returns the spheres, RGBA32F, one layer of the image per kernel and node, found by slots(). A layer has
    // kSphereAzimuths × kSphereRings texels for harmonic 0 of the view's azimuth a, and below them two such
    // images for each further harmonic c, which are added times cos 2ca and -sin 2ca.
    const vk::Image& image() const { return mImage; }
    // Returns the layer, a uint, of kernel · kGridNodes + node; those of the fill follow.
    const vk::Buffer& slots() const { return mSlots; }
    // Returns the number of slots before those of the fill.
    uint32_t fillSlots() const { return uint32_t(mSlotTable.size() / kLightParts); }
    // Returns two vec4 per node: its direction, and the side towards azimuth 0.
    const vk::Buffer& grid() const { return mGrid; }
    // Returns the unshadowed tuples, RGBA32F: polar maps about +Y of kTupleAzimuths × kTupleRings normals
    // (kTurnedRows for sets of parts with tangents), three images for each four terms of a set, laid out as
    // tuples are. The second half of the images is of the fill.
    const vk::Image& tuples() const { return mTuples; }
    // Returns ResidualSet::irradianceWeights, laid out as tuples are, in whole quads of terms.
    const vk::Buffer& weights() const { return mWeights; }
    // Returns the first image of a set's unshadowed tuples, which is also the first texel of its weights;
    // none if the set has neither a residual nor a ground.
    std::optional<uint32_t> firstTuples(size_t part, size_t set) const {
        const Set* const known = mSetOf[part][set];
        return known ? std::optional(known->firstImage) : std::nullopt;
    }

    // Return what was last made, for tests and `relume verify`. Wait for the device.
    // Spheres × rings × azimuths, and rows × azimuths × terms.
    std::vector<vec3> readSphere(uint32_t kernel, uint32_t node, LightPart lit = LightPart::Whole) const;
    std::vector<vec3> readTuples(size_t part, size_t set, LightPart lit = LightPart::Whole) const;

  private:
    struct Kernel {
        shared::SpherePush push;
        uint32_t components;
        vk::Buffer values;

        uint32_t parts() const { return 2 * push.harmonics + 1; }
    };
    struct Set {
        uint32_t firstImage, terms, mapping;
        ViewMapTexture lightMaps;
        uint32_t isTurned; // 1 if a part has tangents, 0 if the frames of all its parts follow from normals

        uint32_t rows() const { return isTurned ? shared::kTurnedRows : shared::kTupleRings; }
    };

    void makePrograms();
    Set& addSet(const FactoredBrdf& factors, const ResidualSet* residual, std::vector<float>& weights);
    void makeRoom(size_t spheres);
    void makeSpheres(vk::Commands& commands, uint32_t kernel, LightPart lit, std::span<const uint32_t> nodes);
    size_t slotOf(uint32_t kernel, LightPart lit, uint32_t node) const {
        return (size_t(lit) * mKernels.size() + kernel) * shared::kGridNodes + node;
    }
    void freeSlots();

    const vk::Device& mDevice;
    std::vector<std::vector<std::shared_ptr<const ResidualSet>>> mResiduals; // by part, then by set
    std::map<const SphereKernel*, uint32_t> mKernelNumbers;
    std::deque<Set> mSets;
    std::vector<std::vector<const Set*>>
        mSetOf; // by part, then by set; null if the set has no unshadowed tuples
    std::vector<Kernel> mKernels;
    vk::ComputeProgram mCube, mUnshadowed, mLight, mSpectrumProgram, mReflect, mSynthesize;
    vk::Sampler mSampler, mPolarSampler; // mPolarSampler repeats in x
    // A light's cube, downsampled: the whole light's or its fill's.
    struct ReducedLight {
        vk::Buffer texels;
        vk::Image cube;
    };
    std::vector<ReducedLight> mReduced; // by LightPart
    vk::Buffer mCells;                  // lights of cells, kCellTexels each
    vk::Buffer mTupleTexels, mGrid, mSlots, mWeights;
    vk::Buffer mBatchNodes, mPolar, mSpectrum, mReflected, mParts;
    vk::Image mImage, mTuples;
    std::vector<vk::Image> mRetired;  // earlier, smaller images, which pending commands may still use
    std::vector<uint32_t> mSlotTable; // slots(); kNoSlot
    std::vector<uint32_t> mFreeSlots;
    uint32_t mSlotCount = 0, mTupleImages = 1; // mTupleImages: of one light
    uint32_t mMostParts = 1;                   // over all kernels
    uint32_t mTupleRows = shared::kTupleRings; // of an image of unshadowed tuples: the most of any set
};

} // namespace relume
