#include "apps/factorization_study/study.h"

#include "precompute/brdf/factorization_error.h"

#include <algorithm>

namespace relume {

namespace {

// Non-negative terms are only good together: each number of them is a factorization of its own.
std::vector<int> termCounts(Factorization method) {
    if (method == Factorization::NonNegative) return {4, 8, 16, 24, 32};
    return {kMaxTerms};
}

void factorAt(int size, const Brdf& brdf, const StudyOptions& options, std::vector<Curve>& curves,
              std::vector<FactoredBrdf>& factored) {
    BrdfTable table;
    const Approach* tabulated = nullptr;
    for (size_t a = 0; a < approaches().size(); a++) {
        const Approach& approach = approaches()[a];
        if (approach.method == Factorization::NonNegative && size != options.mainSize()) continue; // slow
        if (!tabulated || tabulated->mapping != approach.mapping || tabulated->value != approach.value)
            table = tabulate(brdf, size, approach.mapping, approach.value);
        tabulated = &approach;
        for (const int terms : termCounts(approach.method)) {
            factored.push_back(factorize(table, {terms, approach.method}));
            curves.push_back({a, size, terms, rmsErrors(brdf, factored.back()).relative});
        }
    }
}

} // namespace

const std::vector<Approach>& approaches() {
    using enum Factorization;
    using enum DiskMapping;
    using enum TexelValue;
    // Those of one table side by side; later curves are drawn over earlier ones.
    static const std::vector<Approach> kApproaches = {
        {"paper, orthographic", Paper, Orthographic, Centre, 1},
        {"paper, polar-sine", Paper, Polar, Centre, 4},
        {"cosine, orthographic", Cosine, Orthographic, Mean, 5},
        {"environment, orthographic", Environment, Orthographic, Mean, 3},
        {"environment, equal-area, texel centres", Environment, EqualArea, Centre, 7},
        {"cosine, equal-area", Cosine, EqualArea, Mean, 2},
        {"environment, equal-area", Environment, EqualArea, Mean, 0},
        {"nonnegative, equal-area", NonNegative, EqualArea, Mean, 6},
    };
    return kApproaches;
}

int StudyOptions::mainSize() const {
    const bool hasUsual = std::find(sizes.begin(), sizes.end(), 48) != sizes.end();
    return hasUsual ? 48 : *std::max_element(sizes.begin(), sizes.end());
}

const std::vector<float>& Curve::values(Measure measure, size_t light) const {
    switch (measure) {
    case Measure::Rms:
        return rms;
    case Measure::Pixels:
        return pixels[light];
    case Measure::Uniform:
        break;
    }
    return uniform[light];
}

std::optional<double> MaterialStudy::error(size_t approach, int size, int terms, Measure measure,
                                           size_t light) const {
    const bool isWhole = approaches()[approach].method == Factorization::NonNegative;
    for (const Curve& curve : curves) {
        if (curve.approach != approach || curve.size != size || (isWhole && curve.factored != terms))
            continue;
        const std::vector<float>& values = curve.values(measure, light);
        return values[std::min(size_t(terms), values.size()) - 1];
    }
    return std::nullopt;
}

MaterialStudy studyMaterial(const std::string& name, const Brdf& brdf, const StudyOptions& options) {
    MaterialStudy study{name, {}};
    std::vector<FactoredBrdf> factored;
    for (const int size : options.sizes) factorAt(size, brdf, options, study.curves, factored);

    std::vector<LayerOf> layers;
    for (const FactoredBrdf& one : factored) layers.push_back({&one});
    const auto pixels = radianceErrors(brdf, layers, options.lights, {options.orientations, false});
    const auto uniform =
        radianceErrors(brdf, layers, options.lights, {std::max(options.orientations / 4, 1), true});
    for (size_t c = 0; c < study.curves.size(); c++)
        for (size_t light = 0; light < options.lights.size(); light++) {
            study.curves[c].pixels.push_back(pixels[light][c]);
            study.curves[c].uniform.push_back(uniform[light][c]);
        }
    return study;
}

} // namespace relume
