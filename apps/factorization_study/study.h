// What is compared, under which conditions, and what came out.
#pragma once

#include "engine/light/light_cube.h"
#include "precompute/brdf/factorization.h"

#include <optional>
#include <string>
#include <vector>

namespace relume {

// A way to factor a BRDF.
struct Approach {
    std::string name;
    Factorization method;
    DiskMapping mapping;
    TexelValue value;
    size_t colour; // of its curves
};
const std::vector<Approach>& approaches();

// The paper's way; what `relume` does where nothing is asked for; that but for one choice.
constexpr size_t kPaper = 0, kDefault = 6, kCentres = 4, kCosine = 5, kNonNegative = 7;

struct StudyOptions {
    std::vector<int> sizes;              // S
    std::vector<std::string> lightNames; // per light
    std::vector<LightCube> lights;       // of one size
    int orientations = 240;              // a quarter of them for uniform views

    // The size at which all approaches are compared: 48, or the largest.
    int mainSize() const;
};

enum class Measure {
    Rms,     // of f cos cos over pairs of directions
    Pixels,  // radiance as the pixels of a convex object show it
    Uniform, // radiance, views uniform over the hemisphere
};

// One factorization's errors after each of its terms.
struct Curve {
    size_t approach;
    int size, factored; // S, and the terms that were asked for
    std::vector<float> rms;
    std::vector<std::vector<float>> pixels, uniform; // per light

    const std::vector<float>& values(Measure measure, size_t light) const;
};

struct MaterialStudy {
    std::string name;
    std::vector<Curve> curves;

    // Relative error of `terms` terms; all there are where a BRDF has fewer. Nothing where it was not
    // measured.
    std::optional<double> error(size_t approach, int size, int terms, Measure measure, size_t light) const;
};

MaterialStudy studyMaterial(const std::string& name, const Brdf& brdf, const StudyOptions& options);

} // namespace relume
