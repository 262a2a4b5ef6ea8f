// A bake relit and drawn by what draws it for users, and the reference that its image is held against.
#pragma once

#include "apps/evaluation/measured_error.h"
#include "apps/evaluation/scene_inputs.h"
#include "engine/light/light.h"
#include "engine/light/light_selection.h"
#include "engine/render/view_pass.h"
#include "precompute/error/stage_radiance.h"

#include <functional>

namespace relume {

struct ImageSize {
    int width = 640, height = 480;
    float aspect() const { return float(width) / float(height); }
};

// A light as relighting takes it, and as the truth has it.
struct SceneLight {
    std::string name;
    Light light;
    LightCube truth;
};

// A map at all of its resolution, up to 1024 columns. Throws Error.
SceneLight environmentLight(const SceneInput& input, float rotationDegrees = 0);
// A sphere, of an angular radius, and single directions; of white, that light a surface facing them to
// radiance 1 of a white diffuse BRDF. In degrees. A single direction is, in the truth too, one of a cube of
// `face` texels a side.
SceneLight areaLight(float azimuth, float elevation, float radius);
SceneLight distantLight(float azimuth, float elevation, int face);

// Degrees; distance 1 just fits the object.
Camera orbitOf(const Asset& asset, ImageSize size, float azimuth, float elevation, float distance = 1);

struct RelitOptions {
    int terms = 0; // of the bake's K; 0: all
    LightSelection selection;
    bool residual = true; // what these terms leave of the BRDF is added
};

// Refers to device and asset.
class RelitScene {
  public:
    // Throws OutOfMemory, Error.
    RelitScene(const vk::Device& device, const Asset& asset, ImageSize size);
    Image render(const Camera& camera, const Light& light, const RelitOptions& options = {});

  private:
    const vk::Device& mDevice;
    LightPass mLight;
    Relighter mRelighter;
    ViewPass mView;
};

// When a reference is good enough.
struct ReferenceEffort {
    double noise = 0.15; // at most this share of the least error of the images
    int fewest = 16, most = 256;
};

// Refers to the asset.
class SceneReference {
  public:
    SceneReference(const Asset& asset, const Camera& camera, const LightCube& truth, ImageSize size,
                   ReferenceBrdf brdf = ReferenceBrdf::Exact);

    // Adds passes until the reference is good enough for these images. Shows progress. Throws BakeStopped
    // when an interrupt was caught.
    void refine(const std::vector<Image>& images, const ReferenceEffort& effort = {});

    Image mean() const { return mReference.mean(); }
    int passes() const { return mReference.passes(); }
    MeasuredError errorOf(const Image& image) const; // after refine()
    double noise() const { return mNoise; }          // of mean(), relative to the truth

  private:
    ProgressiveReference mReference;
    double mNoise = 0;
};

} // namespace relume
