#include "precompute/residual/sphere_kernel.h"

#include "engine/math/disk_map.h"

#include <Eigen/Core>
#include <algorithm>
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
// which has azimuth a in that frame. incoming() is the direction of light at (ρ', φ' - φ).
struct Geometry {
    float sine, cosine; // of half of ρ, which is the view's angle to the normal

    explicit Geometry(float mirrorAngle)
        : sine(std::sin(mirrorAngle / 2)), cosine(std::cos(mirrorAngle / 2)) {}
    vec3 outgoing(float azimuth) const {
        return liftAboveHorizon({sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
    }
    // Returns a direction above the horizon if its z > 0.
    vec3 incoming(float angle, float azimuth, float viewAzimuth) const {
        const float s = std::sin(angle), c = std::cos(angle);
        const float x = -cosine * s * std::cos(azimuth) + sine * c, y = -s * std::sin(azimuth);
        const float cosA = std::cos(viewAzimuth), sinA = std::sin(viewAzimuth);
        return {x * cosA - y * sinA, x * sinA + y * cosA, sine * s * std::cos(azimuth) + cosine * c};
    }
};

float ringAngle(float ring) { return ring * kPi / float(kRings); }
float azimuthAngle(float azimuth) { return azimuth * 2 * kPi / float(kAzimuths); }

// Returns the mean of f cos over a cell of the light, by side² samples.
template <typename Function>
vec3 cellMean(const Geometry& geometry, int ring, int azimuth, float viewAzimuth, int side,
              Function&& reflected) {
    vec3 sum(0);
    float weights = 0;
    for (int j = 0; j < side; j++) {
        const float angle = ringAngle(float(ring) + (float(j) + 0.5f) / float(side)),
                    weight = std::sin(angle);
        for (int i = 0; i < side; i++) {
            weights += weight;
            const vec3 incoming = geometry.incoming(
                angle, azimuthAngle(float(azimuth) - 0.5f + (float(i) + 0.5f) / float(side)), viewAzimuth);
            if (incoming.z > kGrazingCosine) sum += weight * incoming.z * reflected(glm::normalize(incoming));
        }
    }
    return sum / weights;
}

// All components that the sampled azimuths resolve, before small ones are dropped.
class WholeKernel {
  public:
    WholeKernel(const Reflectance& exact, bool isIsotropic)
        : mValues(kHarmonics + 1, std::vector<std::vector<vec3>>(2 * kFrequencies + 1)) {
        for (auto& harmonic : mValues)
            for (auto& component : harmonic) component.resize(size_t(kRings) * kRings);
        const int views = isIsotropic ? 1 : kViewAzimuths;
        tbb::parallel_for(0, kRings, [&](int row) { fill(exact, views, row); });
    }

    const std::vector<vec3>& component(int harmonic, int frequency) const {
        return mValues[size_t(harmonic)][size_t(frequency + kFrequencies)];
    }

  private:
    // Samples of a row: [view azimuth · rings · channels][azimuth of the light].
    using Samples = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    // Fills a row. `views` is the number of view azimuths over half a turn; 1 for an isotropic BRDF.
    void fill(const Reflectance& exact, int views, int row) {
        const Geometry geometry(ringAngle(float(row) + 0.5f));
        Samples samples(views * kRings * 3, kAzimuths);
        for (int view = 0; view < views; view++) {
            const float viewAzimuth = float(view) * kPi / float(views);
            const vec3 outgoing = geometry.outgoing(viewAzimuth);
            for (int ring = 0; ring < kRings; ring++)
                for (int azimuth = 0; azimuth < kAzimuths; azimuth++) {
                    const vec3 mean = cellMean(geometry, ring, azimuth, viewAzimuth, kSamplesPerSide,
                                               [&](vec3 incoming) { return exact(incoming, outgoing); });
                    for (int channel = 0; channel < 3; channel++)
                        samples((view * kRings + ring) * 3 + channel, azimuth) = mean[channel];
                }
        }
        transform(samples, views, row);
    }

    // Computes Fourier coefficients Σ_δ f e^(imδ) over the light's azimuth, then e^(-2ica) over the view's.
    // Keeps their real part, which is everything if the BRDF has mirror symmetry.
    void transform(const Samples& samples, int views, int row) {
        Eigen::MatrixXf cosines(kAzimuths, kFrequencies + 1), sines(kAzimuths, kFrequencies + 1);
        for (int m = 0; m <= kFrequencies; m++)
            for (int azimuth = 0; azimuth < kAzimuths; azimuth++) {
                const float phase = azimuthAngle(float(m * azimuth % kAzimuths));
                cosines(azimuth, m) = std::cos(phase);
                sines(azimuth, m) = std::sin(phase);
            }
        const Samples real = samples * cosines, imaginary = samples * sines;
        for (int harmonic = 0; harmonic <= (views == 1 ? 0 : kHarmonics); harmonic++)
            for (int m = -kFrequencies; m <= kFrequencies; m++) {
                std::vector<vec3>& values = mValues[size_t(harmonic)][size_t(m + kFrequencies)];
                for (int view = 0; view < views; view++) {
                    const float phase = 2 * kPi * float(harmonic * view) / float(views);
                    const float c = std::cos(phase) / float(views),
                                s = (m < 0 ? -1 : 1) * std::sin(phase) / float(views);
                    for (int ring = 0; ring < kRings; ring++)
                        for (int channel = 0; channel < 3; channel++) {
                            const int sample = (view * kRings + ring) * 3 + channel;
                            values[size_t(row * kRings + ring)][channel] +=
                                c * real(sample, std::abs(m)) + s * imaginary(sample, std::abs(m));
                        }
                }
            }
    }

    // [harmonic][frequency + kFrequencies][ring of the mirror direction · rings + ring of the light]
    std::vector<std::vector<std::vector<vec3>>> mValues;
};

// Returns the squared sum over both rings, weighted by their solid angles.
double energyOf(const std::vector<vec3>& component) {
    double energy = 0;
    for (int row = 0; row < kRings; row++)
        for (int ring = 0; ring < kRings; ring++) {
            const vec3 value = component[size_t(row * kRings + ring)];
            energy +=
                double(std::sin(ringAngle(float(row) + 0.5f)) * std::sin(ringAngle(float(ring) + 0.5f))) *
                double(glm::dot(value, value));
        }
    return energy;
}

} // namespace

std::shared_ptr<const SphereKernel> makeSphereKernel(const Reflectance& exact, bool isIsotropic) {
    const WholeKernel whole(exact, isIsotropic);
    double all = 0;
    std::vector<double> byHarmonic(kHarmonics + 1, 0), byFrequency(kFrequencies + 1, 0);
    for (int harmonic = 0; harmonic <= kHarmonics; harmonic++)
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
