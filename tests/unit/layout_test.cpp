#include "precompute/layout/conversion.h"

#include "engine/transport/asset_check.h"
#include "precompute/layout/bases/basis_encoder.h"
#include "precompute/layout/layout_scale.h"
#include "precompute/transport/layout_work.h"
#include "precompute/transport/light_spectrum.h"
#include "precompute/transport/norm_sum.h"
#include "tests/support/asset_sample.h"
#include "tests/support/singular_values.h"

#include <doctest/doctest.h>
#include <set>

using namespace relume;
using namespace relume::test;

namespace {

constexpr int kFace = 8;
constexpr size_t kCoefficients = 6 * kFace * kFace;

FactoredBrdf factors(int terms, bool isGray) {
    std::mt19937 random(7);
    FactoredBrdf brdf;
    brdf.size = 4;
    brdf.terms = terms;
    const auto number = [&] { return float(random() % 2001) * 1e-3f - 1; };
    for (int term = 0; term < terms; term++)
        for (size_t i = 0; i < brdf.mapTexels(); i++) {
            const float gray = number();
            brdf.lightMaps.push_back(isGray ? vec3(gray)
                                            : vec3(gray, 0.8f * gray, 0.5f * gray + 0.02f * number()));
        }
    return brdf;
}

// Rows of a smooth field: a few patterns of light, in amounts that change slowly from vertex to vertex.
SparseTransport smoothRows(uint32_t vertices, uint32_t terms, uint32_t seed, bool isGray = true,
                           int kept = 60) {
    std::mt19937 random(seed);
    const auto number = [&] { return float(random() % 2001) * 1e-3f - 1; };
    constexpr size_t kPatterns = 12;
    std::vector<std::vector<float>> patterns(kPatterns, std::vector<float>(kCoefficients, 0.0f));
    for (auto& pattern : patterns)
        for (int i = 0; i < 20; i++) pattern[random() % kCoefficients] = number();
    SparseTransport rows;
    rows.vertices = vertices, rows.terms = terms;
    rows.rowStarts.push_back(0);
    for (size_t row = 0; row < rows.rows(); row++) {
        std::vector<std::pair<float, uint16_t>> entries;
        for (size_t c = 0; c < kCoefficients; c++) {
            float sum = 0;
            for (size_t p = 0; p < kPatterns; p++)
                sum += patterns[p][c] * std::cos(float(p + 1) * (0.01f * float(row) + 1)) / float(p + 1);
            if (sum != 0) entries.push_back({sum, uint16_t(c)});
        }
        std::ranges::stable_sort(entries,
                                 [](auto& a, auto& b) { return std::abs(a.first) > std::abs(b.first); });
        entries.resize(std::min<size_t>(entries.size(), size_t(kept)));
        std::ranges::sort(entries, {}, [](auto& entry) { return entry.second; });
        rows.scales.push_back(0.1f);
        for (const auto& [value, index] : entries) {
            const vec3 color = isGray ? vec3(1) : vec3(1, 0.8f, 0.5f + 0.02f * number());
            const uint32_t packed = packCoefficient(quantizeCoefficient(0.2f * value * color, 1));
            if (packed == 0) continue;
            rows.indices.push_back(index);
            rows.values.push_back(packed);
        }
        rows.rowStarts.push_back(rows.values.size());
    }
    return rows;
}

Asset assetOf(SparseTransport rows, bool isGray = true) {
    Asset asset = test::sampleAsset();
    asset.parts.resize(1);
    std::mt19937 random(1);
    asset.coefficients = 60;
    asset.parts[0] = test::samplePart(rows.vertices, int(rows.terms), kFace, asset.coefficients, random);
    asset.parts[0].sets[0].brdf.lightMaps = factors(int(rows.terms), isGray).lightMaps;
    asset.parts[0].sets[0].transport = std::move(rows);
    return asset;
}

const BasisTransport& basesOf(const Asset& asset) {
    return std::get<BasisTransport>(asset.parts[0].sets[0].transport);
}

// Relative, weighted by light: what Conversion::error says.
double errorOf(const Transport& kept, const Transport& rows) {
    const std::vector<float> spectrum = lightSpectrum(kFace);
    double lost = 0;
    for (size_t row = 0; row < rowsOf(rows).rows(); row++) {
        const std::vector<vec3> a = dequantizedRow(kept, row, kCoefficients),
                                b = dequantizedRow(rows, row, kCoefficients);
        for (size_t i = 0; i < a.size(); i++) {
            const vec3 away = (a[i] - b[i]) * spectrum[i];
            lost += double(glm::dot(away, away));
        }
    }
    return std::sqrt(lost / verticesOf(rows)) / double(transportNorm(rowsOf(rows), spectrum));
}

double bytesPerVertex(const Asset& asset) {
    return double(bytesOf(asset.parts[0].sets[0].transport)) / double(vertexCount(asset));
}

LayoutOptions bases(std::optional<double> budget, double error = 0.05) {
    return {TransportLayout::Bases, budget, error};
}

} // namespace

TEST_CASE("layout: light's spectrum has a weight per wavelet level, the same on all faces") {
    const std::vector<float> spectrum = lightSpectrum(64);
    REQUIRE(spectrum.size() == 6 * 4096);
    CHECK(spectrum[0] == 1);
    CHECK(spectrum[1] == spectrum[64]);
    CHECK(spectrum[65] == doctest::Approx(std::pow(0.53, 0.7)));
    CHECK(spectrum[63] == doctest::Approx(std::pow(0.043, 0.7)));
    CHECK(spectrum[31] == doctest::Approx(std::pow(0.085, 0.7)));
    CHECK(std::set(spectrum.begin(), spectrum.end()).size() == 7);
    CHECK(spectrum[5 * 4096 + 65] == spectrum[65]);
    CHECK(lightSpectrum(kFace)[kFace - 1] == spectrum[kFace - 1]);
}

TEST_CASE("layout: a gray material has one kind a term, a colored one its principal directions") {
    const std::vector<BasisKind> gray = basisKinds(factors(3, true));
    REQUIRE(gray.size() == 3);
    for (uint32_t term = 0; term < 3; term++) {
        CHECK(gray[term].term == term);
        CHECK(gray[term].color == vec3(1));
        CHECK(glm::dot(kindDual(gray[term]), vec3(0.5f)) == doctest::Approx(0.5f));
    }
    FactoredBrdf brdf = factors(1, false);
    std::vector<BasisKind> kinds = basisKinds(brdf);
    REQUIRE(kinds.size() == 2); // gray, and the noise in blue: nothing tells red from green
    CHECK(glm::dot(kinds[0].color, glm::normalize(vec3(1, 0.8f, 0.5f))) > 0.999f);
    CHECK(glm::dot(kinds[0].color, kinds[1].color) == doctest::Approx(0).epsilon(1e-5));
    for (vec3& texel : brdf.lightMaps) texel = {0, texel.x, 0};
    kinds = basisKinds(brdf);
    REQUIRE(kinds.size() == 1);
    CHECK(glm::distance(kinds[0].color, vec3(0, 1, 0)) < 1e-6f);
    CHECK(basisKinds({.size = 4, .terms = 1, .lightMaps = std::vector<vec3>(16, vec3(0))}).size() == 1);
}

TEST_CASE("layout: errors are relative to what tells a set's vertices apart") {
    const std::vector<float> spectrum = lightSpectrum(kFace);
    SparseTransport rows{
        .vertices = 2, .terms = 1, .rowStarts = {0, 1, 2}, .scales = {3, 3}, .indices = {0, 0}, .values = {}};
    const auto unitOf = [&](ivec3 first, ivec3 second) {
        rows.values = {packCoefficient(first), packCoefficient(second)};
        return transportNorm(rows, spectrum);
    };
    CHECK(unitOf({1023, 0, 0}, {-1023, 0, 0}) == doctest::Approx(3));  // no mean
    CHECK(unitOf({1023, 0, 0}, {0, 0, 0}) == doctest::Approx(1.5));    // half of it is mean
    CHECK(unitOf({1023, 0, 0}, {1023, 0, 0}) == doctest::Approx(0.3)); // nothing else: a tenth
    CHECK(unitOf({0, 0, 0}, {0, 0, 0}) == 1);
}

TEST_CASE("layout: with bounced light, errors are the same share of the light") {
    const std::vector<float> spectrum = lightSpectrum(kFace);
    SparseTransport rows{
        .vertices = 2, .terms = 1, .rowStarts = {0, 1, 2}, .scales = {3, 3}, .indices = {0, 0}, .values = {}};
    const auto sumOf = [&](int first, int second) {
        rows.values = {packCoefficient({first, 0, 0}), packCoefficient({second, 0, 0})};
        NormSum sum(1, spectrum);
        sum.add(rows);
        return sum;
    };
    const NormSum shadowed = sumOf(1023, 0), dark = sumOf(0, 0), bright = sumOf(1023, -1023);
    // The spread falls from 1.5 to 1.353, while the RMS grows.
    const double growth = std::sqrt(1 + 100.0 * 100 / (1023 * 1023));
    CHECK(sumOf(1023, 100).normBeside(shadowed) == doctest::Approx(1.5 * growth).epsilon(1e-3));
    const NormSum even = sumOf(1023, 511); // what is left of the shadow is not lost
    CHECK(even.normBeside(shadowed) == doctest::Approx(1.25 * double(even.norm())));
    CHECK(bright.normBeside(shadowed) == bright.norm()); // never stricter than without direct light
    CHECK(shadowed.normBeside(dark) == shadowed.norm()); // which there may be none of
}

TEST_CASE("layout: a unit is the same of vertices that come a few at a time") {
    const std::vector<float> spectrum = lightSpectrum(kFace);
    const SparseTransport rows = smoothRows(2, 2, 4);
    NormSum sum(2, spectrum);
    for (uint64_t vertex = 0; vertex < 2; vertex++) {
        const uint64_t row = 2 * vertex, first = rows.rowStarts[row], end = rows.rowStarts[row + 2];
        SparseTransport one{
            .vertices = 1, .terms = 2, .rowStarts = {}, .scales = {}, .indices = {}, .values = {}};
        for (uint64_t i = row; i <= row + 2; i++) one.rowStarts.push_back(rows.rowStarts[i] - first);
        one.scales = {rows.scales[row], rows.scales[row + 1]};
        one.indices.assign(rows.indices.begin() + ptrdiff_t(first), rows.indices.begin() + ptrdiff_t(end));
        one.values.assign(rows.values.begin() + ptrdiff_t(first), rows.values.begin() + ptrdiff_t(end));
        CHECK(sum.norm() != transportNorm(rows, spectrum));
        sum.add(one);
    }
    CHECK(sum.norm() == transportNorm(rows, spectrum));
}

TEST_CASE("layout: bases leave hardly more than the best of their rank do") {
    const SparseTransport rows = smoothRows(256, 2, 3);
    const std::vector<BasisKind> kinds = basisKinds(factors(2, true));
    const std::vector<float> spectrum = lightSpectrum(kFace);
    const ClusterMatrix matrix = clusterMatrix(rows, 0, 256, kinds, spectrum, transportNorm(rows, spectrum));
    CHECK(matrix.energy.sum() >= 256); // what varies, and the mean
    CHECK(matrix.values.squaredNorm() == doctest::Approx(matrix.energy.sum()));
    const BasisAnalysis analysis = analyze(matrix);
    const Eigen::VectorXf sigma = singularValues(matrix.values);
    for (const double lambda : {1e-3, 1e-4, 1e-5}) {
        const BasisCut cut = cutFor(analysis, lambda);
        const EncodedCluster encoded = encodeBases(matrix, analysis, cut, kinds, spectrum);
        const Eigen::Index rank = Eigen::Index(cut.components) - 2;
        REQUIRE(rank > 1);
        const double best = double(sigma.tail(sigma.size() - rank).squaredNorm());
        // Columns and weights that do not pay are left out besides; bytes are not exact.
        CHECK(encoded.error < 2 * (best + lambda * cut.bytes));
        CHECK(encoded.error < 1.5 * cut.error + 1e-4 * 256);
        CHECK(cut.error < 2 * (best + lambda * cut.bytes));
    }
}

TEST_CASE("layout: what a conversion says of bytes and error is so") {
    for (const bool isGray : {true, false}) {
        CAPTURE(isGray);
        const Asset rows = assetOf(smoothRows(700, 3, 5, isGray), isGray);
        Asset asset = rows;
        uint64_t last = 0;
        const Conversion conversion =
            convertLayout(asset, bases({}, 0.04), [&](uint64_t done, uint64_t total) {
                CHECK(done >= last);
                CHECK(total == 700);
                last = done;
            });
        CHECK(last == 700);
        checkAsset(asset, "converted");
        const double error = errorOf(asset.parts[0].sets[0].transport, rows.parts[0].sets[0].transport);
        CHECK(*conversion.error == doctest::Approx(error).epsilon(0.02));
        CHECK(error < 0.05);
        CHECK(error > 0.02);
        CHECK(conversion.bytesAfter == bytesOf(asset.parts[0].sets[0].transport));
        CHECK(conversion.bytesAfter * 3 < conversion.bytesBefore);
        CHECK(basesOf(asset).kinds.size() == (isGray ? 3 : 6));
        Asset again = rows;
        convertLayout(again, bases({}, 0.04));
        CHECK(encodeAsset(again) == encodeAsset(asset));
    }
}

TEST_CASE("layout: a budget is met, and more bytes leave less error") {
    const Asset rows = assetOf(smoothRows(5140, 4, 6)); // the last cluster has 20 vertices
    double before = 1;
    for (const double budget : {30.0, 40.0, 60.0}) {
        Asset asset = rows;
        const Conversion conversion = convertLayout(asset, bases(budget));
        CHECK(bytesPerVertex(asset) <= budget);
        CHECK(bytesPerVertex(asset) > 0.97 * budget);
        CHECK(*conversion.error < before);
        before = *conversion.error;
        CHECK(basesOf(asset).clusters.size() == 21);
    }
}

TEST_CASE("layout: errors of a diffuse set matter more") {
    const std::vector<float> spectrum = lightSpectrum(kFace);
    const SparseTransport rows = smoothRows(256, 1, 8), several = smoothRows(256, 2, 8);
    const ClusterMatrix matrix = clusterMatrix(rows, 0, 256, basisKinds(factors(1, true)), spectrum, 1);
    CHECK(matrix.importance == kDiffuseImportance);
    CHECK(clusterMatrix(several, 0, 256, basisKinds(factors(2, true)), spectrum, 1).importance == 1);
    BasisAnalysis analysis = analyze(matrix);
    const double lambda = analysis.energy.sum() * 1e-5;
    const BasisCut diffuse = cutFor(analysis, lambda);
    analysis.importance = 1;
    CHECK(diffuse.error < cutFor(analysis, lambda).error);
}

// Rows of `each` coefficients that no other row has, as where the edge of a sharp shadow passes every vertex.
SparseTransport disjointRows(uint32_t vertices, uint32_t terms, uint32_t each, float value) {
    SparseTransport rows;
    rows.vertices = vertices, rows.terms = terms;
    rows.rowStarts.push_back(0);
    for (uint32_t i = 0; i < vertices * terms * each; i++) {
        rows.indices.push_back(uint16_t(i + 1));
        rows.values.push_back(packCoefficient(quantizeCoefficient(value * vec3(1, 0.9f, 0.8f), 1)));
        if (i % each != each - 1) continue;
        rows.rowStarts.push_back(rows.values.size());
        rows.scales.push_back(1);
    }
    return rows;
}

TEST_CASE("layout: a cluster has more columns where much would be left out") {
    constexpr uint32_t kVertices = 256, kTerms = 4;
    const std::vector<BasisKind> kinds = basisKinds(factors(kTerms, true));
    const std::vector<float> spectrum(6 * 16 * 16, 1.0f);
    const auto columnsOf = [&](float value) {
        const SparseTransport rows = disjointRows(kVertices, kTerms, 1, value); // 1024 columns
        return clusterMatrix(rows, 0, kVertices, kinds, spectrum, 1).columns.size();
    };
    CHECK(columnsOf(1e-3f) == kAnalyzedSide);
    CHECK(columnsOf(1) == kMostAnalyzedColumns);
}

TEST_CASE("layout: where an error cannot be met, the last bytes are not spent on next to nothing") {
    const SparseTransport rows = smoothRows(256, 2, 8);
    const BasisAnalysis whole =
        analyze(clusterMatrix(rows, 0, 256, basisKinds(factors(2, true)), lightSpectrum(kFace), 1));
    BasisAnalysis lacking = whole;
    lacking.energy.array() += 0.1 * whole.energy.sum(); // of columns that were left out
    const std::span<const BasisAnalysis> clusters(&lacking, 1);
    const CutTotals least = totalsAt(clusters, 0);
    const double wanted = 0.5 * least.error;
    const CutTotals found = totalsAt(clusters, lambdaForError(clusters, wanted));
    CHECK(found.error > least.error);
    CHECK(found.error <= least.error + 0.1 * wanted);
    CHECK(found.bytes < 0.8 * least.bytes);
}

TEST_CASE("layout: a diffuse set keeps sharp shadows where colored light bounces") {
    constexpr int kFine = 16;
    constexpr uint32_t kVertices = 256;
    const SparseTransport rows = disjointRows(kVertices, 1, 5, 1);
    const std::vector<BasisKind> kinds = basisKinds(factors(1, true), true);
    REQUIRE(kinds.size() == kFewKinds);
    const BasisAnalysis analysis = analyze(clusterMatrix(rows, 0, kVertices, kinds, lightSpectrum(kFine), 1));
    CHECK(cutFor(analysis, 0).error < 0.05 * analysis.energy.sum());
}

TEST_CASE("layout: bytes fall and error rises with the lambda") {
    const SparseTransport rows = smoothRows(512, 2, 8);
    const std::vector<BasisKind> kinds = basisKinds(factors(2, true));
    const std::vector<float> spectrum = lightSpectrum(kFace);
    std::vector<BasisAnalysis> analyses;
    for (uint32_t first : {0u, 256u})
        analyses.push_back(analyze(clusterMatrix(rows, first, 256, kinds, spectrum, 1)));
    CutTotals before = totalsAt(analyses, 1e-9);
    for (double lambda = 1e-8; lambda < 1; lambda *= 2) {
        const CutTotals now = totalsAt(analyses, lambda);
        CHECK(now.bytes <= before.bytes);
        CHECK(now.error >= before.error);
        before = now;
    }
    const double lambda = lambdaForBytes(analyses, 8000);
    CHECK(totalsAt(analyses, lambda).bytes <= 8000);
    CHECK(totalsAt(analyses, lambda * 0.99).bytes > 7400);
    const double wanted = 0.5 * (analyses[0].energy.sum() + analyses[1].energy.sum());
    CHECK(totalsAt(analyses, lambdaForError(analyses, wanted)).error <= wanted);
}

TEST_CASE("layout: nothing to keep, little to keep, one term, many") {
    SparseTransport empty = smoothRows(300, 2, 9);
    empty.indices.clear(), empty.values.clear();
    std::ranges::fill(empty.rowStarts, 0);
    Asset asset = assetOf(empty);
    CHECK(*convertLayout(asset, bases({})).error == 0);
    checkAsset(asset, "empty");
    CHECK(basesOf(asset).clusters[1].components == 0);
    CHECK(basesOf(asset).clusters[1].columns() == 0);

    SparseTransport half = smoothRows(300, 2, 9); // the second cluster has nothing
    const uint64_t end = half.rowStarts[256 * 2];
    std::fill(half.rowStarts.begin() + 256 * 2, half.rowStarts.end(), end);
    half.indices.resize(end), half.values.resize(end);
    asset = assetOf(half);
    CHECK(*convertLayout(asset, bases({}, 0.02)).error < 0.03);
    CHECK(basesOf(asset).clusters[0].components > 0);
    CHECK(basesOf(asset).clusters[1].components == 0);

    for (const uint32_t terms : {1u, 32u})
        for (const uint32_t vertices : {1u, 2u, 257u}) {
            CAPTURE(terms);
            CAPTURE(vertices);
            const Asset rows = assetOf(smoothRows(vertices, terms, 10));
            asset = rows;
            const Conversion conversion = convertLayout(asset, bases({}, 0.01));
            checkAsset(asset, "few");
            const double most = vertices < 3 ? 0.1 : 0.03; // so few hardly vary
            CHECK(errorOf(asset.parts[0].sets[0].transport, rows.parts[0].sets[0].transport) < most);
            CHECK(*conversion.error < most);
        }
}

TEST_CASE("layout: rows of any finite scale") {
    for (const float scale : {1e-36f, 1e36f}) {
        SparseTransport rows = smoothRows(300, 1, 11);
        for (float& own : rows.scales) own = scale;
        Asset asset = assetOf(rows);
        CHECK(*convertLayout(asset, bases({}, 0.02)).error < 0.03);
        checkAsset(asset, "scaled");
        CHECK(basesOf(asset).clusters[0].components > 0);
    }
}

TEST_CASE("layout: samples that stand for twice as many find about the lambda of all") {
    const SparseTransport rows = smoothRows(4096, 2, 14);
    const Asset asset = assetOf(rows);
    const MaterialSet& set = asset.parts[0].sets[0];
    const float norm = transportNorm(rows, lightSpectrum(kFace));
    SparseTransport half = smoothRows(2048, 2, 14); // of the same patterns
    for (const LayoutOptions& options : {bases({}), bases(40)}) {
        const auto lambdaOf = [&](const SparseTransport& sample) {
            const SetSample one{&set, {&sample}, 4096, norm};
            const LayoutScale scale = findScale({&one, 1}, kFace, 4096, options);
            CHECK(scale.norms == std::vector(1, norm));
            return scale.lambda;
        };
        const double all = lambdaOf(rows);
        CHECK(all > 0);
        CHECK(std::abs(std::log2(lambdaOf(half) / all)) < 0.5);
    }
}

TEST_CASE("layout: sets without a sample do not change what the others' say") {
    const SparseTransport rows = smoothRows(1024, 2, 15);
    const Asset asset = assetOf(rows);
    const MaterialSet& set = asset.parts[0].sets[0];
    const float norm = transportNorm(rows, lightSpectrum(kFace));
    const SetSample told{&set, {&rows}, 1024, norm}, untold{&set, {}, 3072, 7};
    for (const LayoutOptions& options : {bases({}), bases(40)}) {
        const std::array both = {untold, told};
        const LayoutScale scale = findScale(both, kFace, 4096, options);
        CHECK(scale.norms == std::vector{7.0f, norm});
        CHECK(scale.lambda == findScale({&told, 1}, kFace, 1024, options).lambda);
        CHECK(scale.lambda > 0);
    }
}

TEST_CASE("layout: there and back") {
    const Asset rows = assetOf(smoothRows(300, 2, 13));
    Asset asset = rows;
    uint64_t last = 0;
    const auto progress = [&](uint64_t done, uint64_t total) {
        CHECK(total == 300);
        last = done;
    };
    const Conversion there = convertLayout(asset, bases({}, 1e-3), progress);
    CHECK(last == 300);
    REQUIRE(asset.layout);
    CHECK(asset.layout->error == *there.error);
    CHECK(asset.layout->wantedError == 1e-3);
    CHECK(!asset.layout->wantedBytes);
    last = 0;
    const Conversion back = convertLayout(asset, {TransportLayout::Rows, {}, 0}, progress);
    CHECK(last == 300);
    CHECK(!back.error);
    REQUIRE(asset.layout); // what was lost is lost
    CHECK(asset.layout->error == *there.error);
    checkAsset(asset, "back");
    REQUIRE(layoutOf(asset.parts[0].sets[0].transport) == TransportLayout::Rows);
    // Bytes leave an error of their own.
    CHECK(errorOf(asset.parts[0].sets[0].transport, rows.parts[0].sets[0].transport) < 0.012);

    // Bases into other bases: making rows is a third of the work, and can be stopped too.
    Asset twice = rows;
    convertLayout(twice, bases({}, 1e-3));
    const std::vector<std::byte> before = encodeAsset(twice);
    struct Stop {};
    const auto stop = [](uint64_t done, uint64_t) {
        CHECK(done == 100);
        throw Stop();
    };
    CHECK_THROWS_AS(convertLayout(twice, bases({}), stop), Stop);
    CHECK(encodeAsset(twice) == before);
    std::vector<uint64_t> reports;
    convertLayout(twice, bases({}), [&](uint64_t done, uint64_t total) {
        CHECK(total == 300);
        reports.push_back(done);
    });
    CHECK(reports == std::vector<uint64_t>{100, 200, 300});

    // A chain's errors add.
    Asset chained = rows;
    const double first = *convertLayout(chained, bases({}, 0.06)).error;
    const Conversion second = convertLayout(chained, bases({}, 0.03));
    CHECK(chained.layout->error == doctest::Approx(std::hypot(first, *second.error)));
    CHECK(*second.error < 0.04);
    CHECK(errorOf(chained.parts[0].sets[0].transport, rows.parts[0].sets[0].transport) ==
          doctest::Approx(chained.layout->error).epsilon(0.15));

    Asset same = rows;
    convertLayout(same, {TransportLayout::Rows, {}, 0});
    CHECK(encodeAsset(same) == encodeAsset(rows));
    convertLayout(same, {TransportLayout::Rows, {}, 0}, {}, 20);
    CHECK_EQ(same.coefficients, 20);
    CHECK(entriesOf(same.parts[0].sets[0].transport) <= 20 * 600);
}

TEST_CASE("layout: where all is diffuse, the standard error is less") {
    for (const auto& [terms, wanted] :
         {std::pair(1u, kDiffuseLayoutError), std::pair(2u, kDefaultLayoutError)}) {
        Asset asset = assetOf(smoothRows(2048, terms, 16));
        CHECK_EQ(defaultLayoutError(asset), wanted);
        convertLayout(asset, {});
        CHECK_EQ(asset.layout->wantedError, std::optional(wanted));
        CHECK_LE(asset.layout->error, 1.05 * wanted);
    }
}
