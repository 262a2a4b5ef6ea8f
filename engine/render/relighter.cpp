#include "engine/render/relighter.h"

#include "engine/base/check.h"
#include "engine/vk/upload.h"

#include <algorithm>

namespace relume {

using vk::Stage;

Relighter::Relighter(const vk::Device& device, const Asset& asset, const RelighterOptions& options)
    : mDevice(device), mFaceSize(asset.faceSize) {
    const uint64_t largestShard = std::min(options.largestShard, device.largestStorageBuffer());
    mSpheres = std::make_unique<LitSpheres>(device, asset, options.residual);
    for (size_t p = 0; p < asset.parts.size(); p++) {
        const AssetPart& part = asset.parts[p];
        auto& sets = mParts.emplace_back();
        for (size_t s = 0; s < part.sets.size(); s++) {
            const bool hasFill = mSpheres->set(p, s) != nullptr;
            sets.push_back(
                makeSet(part.sets[s].transport, part.name, largestShard, hasFill ? kLightParts : 1));
            if (hasFill && !mFill) mFill = std::make_unique<FillLight>(device, asset.faceSize);
        }
    }
}

// Declares the relighter of each layout; the functions are not defined.
RowsRelighter relighterOf(const SparseTransport&);
BasesRelighter relighterOf(const BasisTransport&);

std::unique_ptr<SetRelighter> Relighter::makeSet(const Transport& transport, const std::string& name,
                                                 uint64_t largestShard, size_t lights) {
    const uint32_t coefficients = 6 * uint32_t(mFaceSize) * uint32_t(mFaceSize);
    return std::visit(
        [&](const auto& kept) -> std::unique_ptr<SetRelighter> {
            using Set = decltype(relighterOf(kept));
            return std::make_unique<Set>(mDevice, kept, coefficients, lights, largestShard, name);
        },
        transport);
}

void Relighter::record(vk::Commands& commands, const LightPass& light, const Appearance& appearance) {
    RELUME_CHECK(appearance.empty() || appearance.size() == mParts.size());
    RELUME_CHECK_EQ(light.faceSize(), mFaceSize);
    // An earlier frame of the same submission may still be reading the tuples.
    commands.barrier(Stage::Draw, Stage::Compute);
    if (mFill) mFill->record(commands, light);
    commands.pass("relight", [&] {
        for (size_t part = 0; part < mParts.size(); part++) {
            SetRelighter& set = *mParts[part].at(appearance.empty() ? 0 : appearance[part].set);
            set.record(commands, light.table().onDevice(), mMode);
            if (set.lights() > 1) set.record(commands, mFill->table().onDevice(), mMode, LightPart::Fill);
        }
        commands.barrier(Stage::Compute, Stage::Draw);
    });
    mSpheres->recordLight(commands, light, mFill.get());
}

const vk::Buffer& Relighter::fillTuples(size_t part, size_t set) const {
    const SetRelighter& own = *mParts[part][set];
    return own.tuples(own.lights() > 1 ? LightPart::Fill : LightPart::Whole);
}

std::vector<vec3> Relighter::readTuples(size_t part, size_t set) const {
    return vk::download<vec3>(mDevice, tuples(part, set), mParts[part][set]->rows());
}

std::vector<vec3> Relighter::readFillTuples(size_t part, size_t set) const {
    return vk::download<vec3>(mDevice, fillTuples(part, set), mParts[part][set]->rows());
}

} // namespace relume
