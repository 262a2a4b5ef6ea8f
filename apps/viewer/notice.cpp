#include "apps/viewer/notice.h"

#include <spdlog/spdlog.h>
#include <utility>

namespace relume {

namespace {

constexpr std::chrono::seconds kShown(8); // how long good news stay

} // namespace

void Notice::tell(const std::string& words, bool isFailure) {
    if (isFailure)
        spdlog::error("{}", words);
    else
        spdlog::info("{}", words);
    mWords = words;
    mTime = std::chrono::steady_clock::now();
    mIsFailure = isFailure;
    mHasNews = true;
}

void Notice::clear() {
    mWords.clear();
    mHasNews = true;
}

bool Notice::update() {
    const bool isOld = std::chrono::steady_clock::now() - mTime > kShown;
    if (!mWords.empty() && !mIsFailure && isOld) clear();
    return std::exchange(mHasNews, false);
}

} // namespace relume
