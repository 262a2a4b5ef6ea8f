#include "precompute/residual/sphere_kernel.h"

#include "engine/math/disk_map.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <tbb/parallel_for.h>

namespace relume {

using namespace shared;

namespace {

constexpr int kRings = kSphereRings, kAzimuths = kSphereAzimuths;
constexpr int kHarmonics = kMostHarmonics, kFrequencies = kMostFrequencies;
constexpr int kViewAzimuths = 2 * (kHarmonics + 1); // over half a turn, after which BRDFs repeat
constexpr int kSamplesPerSide = 2;                  // per side of a cell of the light

// Directions in the tangent frame of a normal whose mirror direction is at angle ρ from the view direction,
// which has azimuth 0 in that frame. incoming() is the direction of light at (ρ', φ' - φ).
struct Geometry {
    float sine, cosine; // of half of ρ, which is the view's angle to the normal

    explicit Geometry(float mirrorAngle)
        : sine(std::sin(mirrorAngle / 2)), cosine(std::cos(mirrorAngle / 2)) {}
    vec3 outgoing() const { return liftAboveHorizon({sine, 0, cosine}); }
    // Returns a direction above the horizon if its z > 0.
    vec3 incoming(float angle, float azimuth) const {
        const float s = std::sin(angle), c = std::cos(angle);
        return glm::normalize(vec3(-cosine * s * std::cos(azimuth) + sine * c, -s * std::sin(azimuth),
                                   sine * s * std::cos(azimuth) + cosine * c));
    }
};

// A rotation about the normal.
struct Turn {
    float sine, cosine;

    explicit Turn(float angle) : sine(std::sin(angle)), cosine(std::cos(angle)) {}
    vec3 operator()(vec3 v) const { return {v.x * cosine - v.y * sine, v.x * sine + v.y * cosine, v.z}; }
};

float ringAngle(float ring) { return ring * kPi / float(kRings); }
float azimuthAngle(float azimuth) { return azimuth * 2 * kPi / float(kAzimuths); }

// A direction of light, with the factor of f in the mean of f cos over a cell.
struct CellSample {
    vec3 incoming;
    float weight; // 0 at and below the horizon
};

// Returns directions in a cell of the light, in the frame where the view's azimuth is 0.
std::array<CellSample, kSamplesPerSide * kSamplesPerSide> cellSamples(const Geometry& geometry, int ring,
                                                                      int azimuth) {
    std::array<CellSample, kSamplesPerSide * kSamplesPerSide> samples;
    const auto place = [](int i) { return (float(i) + 0.5f) / float(kSamplesPerSide); };
    float sum = 0;
    for (int j = 0; j < kSamplesPerSide; j++) {
        const float angle = ringAngle(float(ring) + place(j)), solidAngle = std::sin(angle);
        for (int i = 0; i < kSamplesPerSide; i++) {
            const vec3 incoming = geometry.incoming(angle, azimuthAngle(float(azimuth) - 0.5f + place(i)));
            sum += solidAngle;
            samples[size_t(j * kSamplesPerSide + i)] = {
                incoming, incoming.z > kGrazingCosine ? solidAngle * incoming.z : 0};
        }
    }
    for (CellSample& sample : samples) sample.weight /= sum;
    return samples;
}

// All components that the sampled azimuths resolve, before small ones are dropped.
class WholeKernel {
  public:
    WholeKernel(const Reflectance& exact, bool isIsotropic)
        : mValues(isIsotropic ? 1 : kHarmonics + 1, std::vector<std::vector<vec3>>(2 * kFrequencies + 1)),
          mCosines(kAzimuths, kFrequencies + 1), mSines(kAzimuths, kFrequencies + 1) {
        for (auto& harmonic : mValues)
            for (auto& component : harmonic) component.resize(size_t(kRings) * kRings);
        for (int m = 0; m <= kFrequencies; m++)
            for (int azimuth = 0; azimuth < kAzimuths; azimuth++) {
                const float phase = azimuthAngle(float(m * azimuth % kAzimuths));
                mCosines(azimuth, m) = std::cos(phase);
                mSines(azimuth, m) = std::sin(phase);
            }
        const int views = isIsotropic ? 1 : kViewAzimuths;
        tbb::parallel_for(0, kRings, [&](int row) { fill(exact, views, row); });
    }

    // An isotropic BRDF has none but the first, 0.
    int harmonics() const { return int(mValues.size()); }
    const std::vector<vec3>& component(int harmonic, int frequency) const {
        return mValues[size_t(harmonic)][size_t(frequency + kFrequencies)];
    }

  private:
    // Samples of a row: [view azimuth · rings · channels][azimuth of the light].
    using Samples = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    // Fills a row. `views` is the number of view azimuths over half a turn; 1 for an isotropic BRDF.
    void fill(const Reflectance& exact, int views, int row) {
        const Geometry geometry(ringAngle(float(row) + 0.5f));
        const vec3 outgoing = geometry.outgoing();
        Samples samples(views * kRings * 3, kAzimuths);
        std::vector<Turn> turns;
        for (int view = 0; view < views; view++) turns.emplace_back(float(view) * kPi / float(views));
        for (int ring = 0; ring < kRings; ring++)
            for (int azimuth = 0; azimuth < kAzimuths; azimuth++) {
                const auto cell = cellSamples(geometry, ring, azimuth);
                for (int view = 0; view < views; view++) {
                    const Turn& turn = turns[size_t(view)];
                    const vec3 turned = turn(outgoing);
                    vec3 mean(0);
                    for (const CellSample& sample : cell)
                        if (sample.weight > 0) mean += sample.weight * exact(turn(sample.incoming), turned);
                    for (int channel = 0; channel < 3; channel++)
                        samples((view * kRings + ring) * 3 + channel, azimuth) = mean[channel];
                }
            }
        transform(samples, views, row);
    }

    // Computes Fourier coefficients Σ_δ f e^(imδ) over the light's azimuth, then e^(-2ica) over the view's.
    // Keeps their real part, which is everything if the BRDF has mirror symmetry.
    void transform(const Samples& samples, int views, int row) {
        const Samples real = samples * mCosines, imaginary = samples * mSines;
        Eigen::MatrixXf viewCosines(harmonics(), views), viewSines(harmonics(), views);
        for (int harmonic = 0; harmonic < harmonics(); harmonic++)
            for (int view = 0; view < views; view++) {
                const float phase = 2 * kPi * float(harmonic * view) / float(views);
                viewCosines(harmonic, view) = std::cos(phase) / float(views);
                viewSines(harmonic, view) = std::sin(phase) / float(views);
            }
        // By view azimuth: [view azimuth][rings · channels · frequencies].
        const int components = kRings * 3 * (kFrequencies + 1);
        const Eigen::Map<const Samples> realByView(real.data(), views, components),
            imaginaryByView(imaginary.data(), views, components);
        const Samples even = viewCosines * realByView, odd = viewSines * imaginaryByView;
        for (int harmonic = 0; harmonic < harmonics(); harmonic++)
            for (int m = -kFrequencies; m <= kFrequencies; m++)
                for (int ring = 0; ring < kRings; ring++)
                    for (int channel = 0; channel < 3; channel++) {
                        const int i = (ring * 3 + channel) * (kFrequencies + 1) + std::abs(m);
                        mValues[size_t(harmonic)][size_t(m + kFrequencies)][size_t(row * kRings + ring)]
                               [channel] = even(harmonic, i) + (m < 0 ? -odd(harmonic, i) : odd(harmonic, i));
                    }
    }

    // [harmonic][frequency + kFrequencies][ring of the mirror direction · rings + ring of the light]
    std::vector<std::vector<std::vector<vec3>>> mValues;
    Eigen::MatrixXf mCosines, mSines; // [azimuth][frequency]
};

// Returns the squared sum over both rings, weighted by their solid angles.
double energyOf(const std::vector<vec3>& component) {
    std::array<float, kRings> solidAngles;
    for (int ring = 0; ring < kRings; ring++)
        solidAngles[size_t(ring)] = std::sin(ringAngle(float(ring) + 0.5f));
    double energy = 0;
    for (size_t row = 0; row < kRings; row++)
        for (size_t ring = 0; ring < kRings; ring++) {
            const vec3 value = component[row * kRings + ring];
            energy += double(solidAngles[row] * solidAngles[ring]) * double(glm::dot(value, value));
        }
    return energy;
}

} // namespace

std::shared_ptr<const SphereKernel> makeSphereKernel(const Reflectance& exact, bool isIsotropic) {
    const WholeKernel whole(exact, isIsotropic);
    double all = 0;
    std::vector<double> byHarmonic(size_t(whole.harmonics()), 0), byFrequency(kFrequencies + 1, 0);
    for (int harmonic = 0; harmonic < whole.harmonics(); harmonic++)
        for (int m = -kFrequencies; m <= kFrequencies; m++) {
            // Harmonic -c is the conjugate of harmonic c.
            const double energy = (harmonic == 0 ? 1 : 2) * energyOf(whole.component(harmonic, m));
            all += energy;
            byHarmonic[size_t(harmonic)] += energy;
            byFrequency[size_t(std::abs(m))] += energy;
        }
    // Returns the smallest order that loses at most half of the allowed loss; the other dimension may lose
    // the other half.
    const auto needed = [&](const std::vector<double>& energies) {
        double lost = 0;
        int last = int(energies.size()) - 1;
        for (; last > 0 && lost + energies[size_t(last)] <= 0.5 * kLostEnergy * all; last--)
            lost += energies[size_t(last)];
        return last;
    };
    auto kernel = std::make_shared<SphereKernel>();
    kernel->harmonics = needed(byHarmonic);
    kernel->frequencies = needed(byFrequency);
    const auto add = [&](int harmonic, int m, float weight) {
        for (const vec3& value : whole.component(harmonic, m)) kernel->values.push_back(weight * value);
    };
    // Weights are doubled for components that also stand for their conjugates.
    for (int m = 0; m <= kernel->frequencies; m++) add(0, m, (m == 0 ? 1.0f : 2.0f) / float(kAzimuths));
    for (int harmonic = 1; harmonic <= kernel->harmonics; harmonic++)
        for (int m = -kernel->frequencies; m <= kernel->frequencies; m++)
            add(harmonic, m, 2.0f / float(kAzimuths));
    return kernel;
}

} // namespace relume
