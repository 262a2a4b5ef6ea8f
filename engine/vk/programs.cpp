#include "engine/vk/programs.h"

#include <utility>

namespace relume::vk {

Program Programs::find(const Source& source) const {
    const std::lock_guard lock(mMutex);
    const auto found = mPrograms.find(source);
    return found == mPrograms.end() ? Program() : found->second;
}

Program Programs::add(Source source, Program program) {
    const std::lock_guard lock(mMutex);
    return mPrograms.try_emplace(std::move(source), std::move(program)).first->second;
}

void Programs::clear() {
    const std::lock_guard lock(mMutex);
    mPrograms.clear();
}

} // namespace relume::vk
