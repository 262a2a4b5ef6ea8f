#include "tests/fuzz/fuzz_target.h"

#include <algorithm>
#include <string_view>

namespace relume::test {

namespace {

std::vector<FuzzTarget>& targets() {
    static std::vector<FuzzTarget> all;
    return all;
}

} // namespace

const std::vector<FuzzTarget>& fuzzTargets() { return targets(); }

AddFuzzTarget::AddFuzzTarget(const FuzzTarget& target) {
    const auto next = std::ranges::find_if(
        targets(), [&](const FuzzTarget& other) { return std::string_view(other.name) > target.name; });
    targets().insert(next, target);
}

} // namespace relume::test
