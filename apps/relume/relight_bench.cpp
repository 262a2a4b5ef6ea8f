#include "apps/relume/relight_bench.h"

#include "apps/bench/timing.h"
#include "apps/relume/csr_relighter.h"
#include "apps/relume/options.h"
#include "engine/base/progress.h"
#include "engine/render/relighter.h"
#include "precompute/cpu/cpu_relighter.h"

#include <cmath>
#include <set>

namespace relume {

namespace {

std::vector<bool> metBy(const LightVector& light) {
    std::vector<bool> met(kMaximumLightEntries, false);
    for (const uint16_t index : light.indices) met[index] = true;
    return met;
}

double bytesRead(const SparseTransport& transport, const std::vector<bool>&) {
    return double(6 * transport.entries() + 4 * transport.rows());
}

double bytesRead(const BasisTransport& transport, const std::vector<bool>& met) {
    double bytes = 0;
    for (const BasisCluster& cluster : transport.clusters) {
        bytes += double(2 * cluster.columns() + 4 * cluster.scales.size() + cluster.weights.size());
        for (const uint16_t index : cluster.indices) bytes += met[index] ? cluster.components : 0;
    }
    return bytes;
}

// Returns the least bytes of transport that relighting reads under a light, plus those of the tuples written.
// Returns the bytes that relighting reads and writes. A column without light is read up to its index.
double relightBytes(const Transport& transport, const LightVector& light) {
    const std::vector<bool> met = metBy(light);
    const double tuples = double(verticesOf(transport)) * termsOf(transport) * sizeof(vec3);
    return tuples + std::visit([&](const auto& kept) { return bytesRead(kept, met); }, transport);
}

// A part's CPU relighter, and the tuples that it writes.
struct CpuPart {
    const Transport& transport;
    std::unique_ptr<CpuRelighter> relighter;
    std::vector<vec3> tuples;
};

std::vector<CpuPart> cpuParts(const Asset& asset) {
    std::vector<CpuPart> parts;
    for (const AssetPart& part : asset.parts) {
        const Transport& transport = part.sets[0].transport;
        parts.push_back({transport, makeCpuRelighter(transport),
                         std::vector<vec3>(size_t(verticesOf(transport)) * termsOf(transport))});
    }
    return parts;
}

void relight(std::vector<CpuPart>& parts, const LightVector& light) {
    for (CpuPart& part : parts) part.relighter->relight(light, part.tuples);
}

double relativeError(const std::vector<CpuPart>& parts, const std::vector<CpuPart>& exact) {
    double difference = 0, all = 0;
    for (size_t part = 0; part < parts.size(); part++)
        for (size_t row = 0; row < parts[part].tuples.size(); row++) {
            const glm::dvec3 a(parts[part].tuples[row]), b(exact[part].tuples[row]);
            difference += glm::dot(a - b, a - b);
            all += glm::dot(b, b);
        }
    return all > 0 ? std::sqrt(difference / all) : 0;
}

struct Variant {
    std::string name;
    Relighter relighter;
    std::vector<CpuPart> cpu;
};

Light withLamp(Light light, float azimuth) {
    constexpr float kRadius = 3; // degrees
    const float radius = radians(kRadius), sine = std::sin(radius);
    light.lamps.push_back({directionAt(azimuth, 40), radius, vec3(1 / (sine * sine))});
    return light;
}

// Relights under the light recorded last; returns the milliseconds.
double relightMs(vk::Commands& commands, const LightPass& light, Relighter& relighter, RelightMode mode) {
    return milliseconds([&] {
        relighter.setMode(mode);
        commands.begin();
        relighter.record(commands, light);
        commands.submitAndWait();
    });
}

// Measures the light with an additional lamp that moves by a degree.
void benchLamp(vk::Commands& commands, LightPass& pass, const Light& light, float azimuth,
               const LightSelection& selection, std::vector<Variant>& variants, RelightSeries& series) {
    const auto setLight = [&](float place) {
        pass.setLight(withLamp(light, place));
        commands.begin();
        pass.record(commands, 0, selection);
        commands.submitAndWait();
    };
    const auto relight = [&](Relighter& relighter, RelightMode mode) {
        return relightMs(commands, pass, relighter, mode);
    };
    setLight(azimuth);
    for (Variant& variant : variants) relight(variant.relighter, RelightMode::Full);
    setLight(azimuth + 1);
    for (Variant& variant : variants) {
        LayoutSeries& own = series.layouts[variant.name];
        own.incrementalMs.push_back(relight(variant.relighter, RelightMode::Incremental));
        own.lampMs.push_back(relight(variant.relighter, RelightMode::Full));
    }
    const LightStats stats = pass.readStats();
    series.lampCoefficients.push_back(stats.kept);
    series.lampChanges.push_back(stats.changed.value_or(stats.kept));
}

} // namespace

RelightSeries benchRelight(const vk::Device& device, const RelightBenchInput& input, const Light& light,
                           const RelightRounds& rounds, bool quiet) {
    std::vector<Variant> variants;
    std::vector<CsrRelighter> csr;
    for (const auto& [name, asset] : input.variants) {
        variants.push_back({name, Relighter(device, asset), cpuParts(asset)});
        if (name != layoutName(TransportLayout::Rows)) continue;
        for (const AssetPart& part : asset.parts)
            csr.emplace_back(rowsOf(part.sets[0].transport), asset.faceSize);
    }
    std::vector<CpuPart> exact = cpuParts(*input.source);
    std::array<Eigen::VectorXf, 3> csrTuples;
    LightPass pass(device, input.source->faceSize);
    vk::Commands commands(device, "bench relight");
    RelightSeries series;
    Progress progress("relighting", uint64_t(rounds.count) + 1, "rounds", quiet);
    for (int round = 0; round <= rounds.count; round++) {
        const float rotation = radians(rounds.rotationDegrees + float(round));
        pass.setLight(light);
        const auto setLight = [&](const LightSelection& selection) {
            commands.begin();
            pass.record(commands, rotation, selection);
            commands.submitAndWait();
        };
        setLight({.threshold = 0});
        relight(exact, pass.readVector());
        for (Variant& variant : variants) relight(variant.cpu, pass.readVector());
        for (Variant& variant : variants)
            series.layouts[variant.name].errors.push_back(relativeError(variant.cpu, exact));

        const double lightMs = milliseconds([&] { setLight(rounds.selection); });
        const LightVector vector = pass.readVector();
        for (Variant& variant : variants) {
            LayoutSeries& own = series.layouts[variant.name];
            double bytes = 0;
            for (const CpuPart& part : variant.cpu) bytes += relightBytes(part.transport, vector);
            own.bytesTouched.push_back(bytes);
            own.deviceMs.push_back(relightMs(commands, pass, variant.relighter, RelightMode::Full));
            own.cpuMs.push_back(milliseconds([&] { relight(variant.cpu, vector); }));
        }
        series.lightMs.push_back(lightMs);
        series.lightCoefficients.push_back(double(vector.indices.size()));
        series.csrMs.push_back(milliseconds([&] {
            for (const CsrRelighter& part : csr) part.relight(vector, csrTuples);
        }));
        for (const int count : std::set(rounds.counts.begin(), rounds.counts.end())) {
            setLight({.count = count});
            for (Variant& variant : variants)
                series.layouts[variant.name].msByCount[count].push_back(
                    relightMs(commands, pass, variant.relighter, RelightMode::Full));
        }
        benchLamp(commands, pass, turned(light, rotation), 10 * float(round), rounds.selection, variants,
                  series);
        progress.update(uint64_t(round) + 1);
    }
    // Drop the first round, which warmed up.
    const auto dropFirst = [](std::vector<double>& values) { values.erase(values.begin()); };
    for (auto& [name, own] : series.layouts) {
        for (auto& [count, values] : own.msByCount) dropFirst(values);
        for (auto* values :
             {&own.deviceMs, &own.cpuMs, &own.bytesTouched, &own.errors, &own.lampMs, &own.incrementalMs})
            dropFirst(*values);
    }
    for (auto* values : {&series.csrMs, &series.lightMs, &series.lightCoefficients, &series.lampCoefficients,
                         &series.lampChanges})
        dropFirst(*values);
    return series;
}

} // namespace relume
