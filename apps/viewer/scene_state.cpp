#include "apps/viewer/scene_state.h"

#include <algorithm>

namespace relume {

void bindNextMaterial(SceneState& state, const std::vector<std::string>& names) {
    const auto bound =
        state.material.empty() ? names.end() : std::ranges::find(names, state.material[0].name);
    const size_t next = bound == names.end() ? 0 : size_t(bound - names.begin()) + 1;
    state.material.clear();
    if (next < names.size()) state.material.push_back({names[next]});
}

void bindBlend(SceneState& state, const std::vector<std::string>& all,
               const std::vector<WeightedMaterial>& blend) {
    std::erase_if(state.material, [&](const WeightedMaterial& material) {
        return std::ranges::find(all, material.name) != all.end();
    });
    state.material.insert(state.material.end(), blend.begin(), blend.end());
}

void addTerms(SceneState& state, int more, int most) {
    const int terms = std::clamp((state.terms > 0 ? state.terms : most) + more, 1, most);
    state.terms = terms < most ? terms : 0;
}

} // namespace relume
