// What it costs a material to share its light maps.
#pragma once

#include "apps/factorization_study/study.h"

#include <string>
#include <utility>

namespace relume {

// A Markdown table: radiance error, mean over the lights, of every material factored alone and in sets of 2,
// 4, 8 … of its neighbours in the list, at K = 4 to 32. As the default, at mainSize().
std::string setPriceOf(const std::vector<std::pair<std::string, std::string>>& materials,
                       const StudyOptions& options);

} // namespace relume
