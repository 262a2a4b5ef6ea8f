#include "precompute/layout/same_sums.h"

#include <Eigen/Core>
#include <mutex>

namespace relume {

void sumAlikeEverywhere() {
    constexpr std::ptrdiff_t kFirstCache = 32 << 10, kSecondCache = 256 << 10, kThirdCache = 2 << 20; // bytes
    static std::once_flag once;
    std::call_once(once, [] { Eigen::setCpuCacheSizes(kFirstCache, kSecondCache, kThirdCache); });
}

} // namespace relume
