#include "apps/factorization_study/set_price.h"

#include "precompute/brdf/factorization_error.h"

#include <algorithm>
#include <fmt/format.h>
#include <span>

namespace relume {

namespace {

constexpr int kTerms[] = {4, 8, 16, 24, 32};

// Every material's own layer, in sets of `members` neighbours; the last set may be smaller.
std::vector<LayerOf> factorInSets(std::span<const BrdfTable> tables, size_t members,
                                  std::vector<FactoredBrdf>& sets) {
    sets.reserve((tables.size() + members - 1) / members); // pointers stay
    std::vector<LayerOf> layers;
    for (size_t first = 0; first < tables.size(); first += members) {
        const size_t count = std::min(members, tables.size() - first);
        sets.push_back(factorize(tables.subspan(first, count), {.terms = kMaxTerms}));
        for (size_t member = 0; member < count; member++) layers.push_back({&sets.back(), int(member)});
    }
    return layers;
}

double meanError(const std::vector<std::vector<std::vector<float>>>& errors, size_t approximation,
                 int terms) {
    double sum = 0;
    for (const auto& light : errors) {
        const std::vector<float>& curve = light[approximation];
        sum += double(curve[std::min(size_t(terms), curve.size()) - 1]);
    }
    return sum / double(errors.size());
}

} // namespace

std::string setPriceOf(const std::vector<std::pair<std::string, std::string>>& materials,
                       const StudyOptions& options) {
    const Approach& approach = approaches()[kDefault];
    std::vector<BrdfTable> tables;
    for (const auto& [name, text] : materials)
        tables.push_back(tabulate(*makeBrdf(text), options.mainSize(), approach.mapping, approach.value));

    std::vector<std::vector<FactoredBrdf>> sets;
    std::vector<std::vector<LayerOf>> layers; // by number of members, then material
    std::string text = "| material |", rule = "|---|";
    for (const int terms : kTerms) text += fmt::format(" K = {} |", terms), rule += "---|";
    text += "\n" + rule + "\n";
    for (size_t members = 1; members <= materials.size(); members *= 2)
        layers.push_back(factorInSets(tables, members, sets.emplace_back()));
    std::vector<std::vector<double>> ratios(std::size(kTerms), std::vector<double>(layers.size(), 0));
    for (size_t m = 0; m < materials.size(); m++) {
        std::vector<LayerOf> own;
        for (const auto& list : layers) own.push_back(list[m]);
        const auto errors = radianceErrors(*makeBrdf(materials[m].second), own, options.lights,
                                           {options.orientations, false});
        text += fmt::format("| {} |", materials[m].first);
        for (size_t k = 0; k < std::size(kTerms); k++) {
            const double alone = meanError(errors, 0, kTerms[k]);
            for (size_t s = 0; s < layers.size(); s++) {
                const double error = meanError(errors, s, kTerms[k]);
                text += fmt::format(" {:.3f}", error);
                ratios[k][s] += (alone > 0 ? error / alone : 1) / double(materials.size());
            }
            text += " |";
        }
        text += "\n";
    }
    text += "| mean of ratios to alone |";
    for (const std::vector<double>& list : ratios) {
        for (const double ratio : list) text += fmt::format(" {:.2f}", ratio);
        text += " |";
    }
    return text + "\n";
}

} // namespace relume
