#include "engine/vk/compute_programs.h"

#include <utility>

namespace relume::vk {

std::optional<ComputeProgram> ComputePrograms::find(const Source& source) const {
    const std::lock_guard lock(mMutex);
    const auto found = mPrograms.find(source);
    return found == mPrograms.end() ? std::nullopt : std::optional(found->second);
}

ComputeProgram ComputePrograms::add(Source source, ComputeProgram program) {
    const std::lock_guard lock(mMutex);
    return mPrograms.try_emplace(std::move(source), std::move(program)).first->second;
}

void ComputePrograms::clear() {
    const std::lock_guard lock(mMutex);
    mPrograms.clear();
}

} // namespace relume::vk
