#include "apps/factorization_study/report.h"

#include <algorithm>
#include <fmt/format.h>

namespace relume {

namespace {

constexpr int kTermCounts[] = {4, 8, 16, 24, 32};
constexpr int kMainTerms = 16;

using Studies = std::vector<MaterialStudy>;

std::string rowOf(const std::vector<std::string>& cells) {
    std::string row = "|";
    for (const std::string& cell : cells) row += fmt::format(" {} |", cell);
    return row + "\n";
}

std::string headOf(const std::vector<std::string>& cells) {
    return rowOf(cells) + rowOf(std::vector<std::string>(cells.size(), "---"));
}

struct Mean {
    double sum = 0;
    int count = 0;

    void add(double value) {
        sum += value;
        count++;
    }
    std::string text() const { return count > 0 ? fmt::format("{:.3f}", sum / count) : "–"; }
};

// Over all materials and lights.
Mean meanError(const Studies& studies, const StudyOptions& options, size_t approach, int size, int terms,
               Measure measure) {
    Mean mean;
    for (const MaterialStudy& study : studies)
        for (size_t light = 0; light < options.lights.size(); light++)
            if (const auto error = study.error(approach, size, terms, measure, light)) mean.add(*error);
    return mean;
}

// What `kMainTerms` terms of two approaches miss, and the ratio: per material and light.
std::string comparison(const Studies& studies, const StudyOptions& options, size_t before, size_t after) {
    std::vector<std::string> head = {"material"};
    head.insert(head.end(), options.lightNames.begin(), options.lightNames.end());
    head.push_back("mean ratio");
    std::string table = headOf(head);
    std::vector<Mean> perLight(options.lights.size());
    Mean all;
    double largest = 0;
    for (const MaterialStudy& study : studies) {
        std::vector<std::string> cells = {study.name};
        Mean ratios;
        for (size_t light = 0; light < options.lights.size(); light++) {
            const auto errorOf = [&](size_t approach) {
                return *study.error(approach, options.mainSize(), kMainTerms, Measure::Pixels, light);
            };
            const double ratio = errorOf(after) / errorOf(before);
            cells.push_back(fmt::format("{:.3f} → {:.3f} ({:.2f})", errorOf(before), errorOf(after), ratio));
            ratios.add(ratio);
            perLight[light].add(ratio);
        }
        cells.push_back(ratios.text());
        all.add(ratios.sum / ratios.count);
        largest = std::max(largest, ratios.sum / ratios.count);
        table += rowOf(cells);
    }
    std::vector<std::string> cells = {"mean of ratios"};
    for (const Mean& mean : perLight) cells.push_back(mean.text());
    cells.push_back(fmt::format("{}, largest {:.3f}", all.text(), largest));
    return table + rowOf(cells);
}

std::string byTerms(const Studies& studies, const StudyOptions& options, Measure measure) {
    std::vector<std::string> head = {"approach"};
    for (const int terms : kTermCounts) head.push_back(fmt::format("K = {}", terms));
    std::string table = headOf(head);
    for (size_t a = 0; a < approaches().size(); a++) {
        std::vector<std::string> cells = {approaches()[a].name};
        for (const int terms : kTermCounts)
            cells.push_back(meanError(studies, options, a, options.mainSize(), terms, measure).text());
        table += rowOf(cells);
    }
    return table;
}

std::string bySize(const Studies& studies, const StudyOptions& options, Measure measure) {
    std::vector<std::string> head = {"approach"};
    for (const int size : options.sizes) head.push_back(fmt::format("S = {}", size));
    std::string table = headOf(head);
    for (size_t a = 0; a < approaches().size(); a++) {
        std::vector<std::string> cells = {approaches()[a].name};
        for (const int size : options.sizes)
            cells.push_back(meanError(studies, options, a, size, kMainTerms, measure).text());
        table += rowOf(cells);
    }
    return table;
}

// One material, all term counts: the default under each light.
std::string defaultByTerms(const Studies& studies, const StudyOptions& options) {
    std::vector<std::string> head = {"material, environment"};
    for (const int terms : kTermCounts) head.push_back(fmt::format("K = {}", terms));
    std::string table = headOf(head);
    for (const MaterialStudy& study : studies)
        for (size_t light = 0; light < options.lights.size(); light++) {
            std::vector<std::string> cells = {fmt::format("{}, {}", study.name, options.lightNames[light])};
            for (const int terms : kTermCounts)
                cells.push_back(fmt::format(
                    "{:.3f}", *study.error(kDefault, options.mainSize(), terms, Measure::Pixels, light)));
            table += rowOf(cells);
        }
    return table;
}

} // namespace

std::string summaryOf(const Studies& studies, const StudyOptions& options) {
    const std::string main = fmt::format("S = {}", options.mainSize()),
                      both = fmt::format("K = {}, {}", kMainTerms, main);
    const auto section = [](const std::string& title, const std::string& table) {
        return fmt::format("## {}\n\n{}\n", title, table);
    };
    return section("Radiance, paper → default, " + both, comparison(studies, options, kPaper, kDefault)) +
           section("Radiance, mean over materials and environments, " + main,
                   byTerms(studies, options, Measure::Pixels)) +
           section("The same with uniform views", byTerms(studies, options, Measure::Uniform)) +
           section("RMS, mean over materials, " + main, byTerms(studies, options, Measure::Rms)) +
           section(fmt::format("Radiance over S, mean over materials and environments, K = {}", kMainTerms),
                   bySize(studies, options, Measure::Pixels)) +
           section("RMS over S, likewise", bySize(studies, options, Measure::Rms)) +
           section("Radiance of the default, " + main, defaultByTerms(studies, options)) +
           section("Radiance, texel centres → means, " + both,
                   comparison(studies, options, kCentres, kDefault)) +
           section("Radiance, cosine → nonnegative, equal-area, " + both,
                   comparison(studies, options, kCosine, kNonNegative));
}

} // namespace relume
