// Options that several subcommands share, and the values they stand for.
#pragma once

#include "apps/relume/command_files.h"
#include "engine/import/moving_light.h"
#include "engine/render/ground_fade.h"
#include "engine/render/tone_map.h"
#include "engine/scene/camera.h"
#include "engine/transport/asset.h"
#include "engine/vk/device.h"

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <optional>

namespace relume {

float radians(float degrees);

// --device, --validation
struct DeviceArguments {
    vk::DeviceOptions options;

    void add(CLI::App& command);
    std::unique_ptr<vk::Device> open() const;
    // Throws Error if the validation layer reported anything.
    static void expectNoMessages(const vk::Device& device);
};

// --size, --eye, --target, --fov, --orbit
struct CameraArguments {
    int width = 960, height = 720;

    void add(CLI::App& command);
    // Returns the camera, with `turn` radians added to the azimuth (with --eye, about the target's vertical
    // axis).
    Camera camera(const Asset& asset, float turn = 0) const;

  private:
    std::vector<float> mEye, mTarget, mOrbit;
    float mFovDegrees = 35;
    std::string mSize;
};

// --light, --environment, --blend, --blend-weight, --rotate, --time, --distant-light, --sphere-light,
// --intensity
struct LightArguments {
    float rotationDegrees = 0;
    double seconds = 0;

    void add(CLI::App& command);
    // Returns whether the light is a single environment.
    bool isEnvironment() const {
        return mDistant.empty() && mSphere.empty() && mBlend.empty() && mFile.empty() &&
               !isSequence(mEnvironment);
    }
    // Returns the environment file or the built-in sky at full resolution. Only if isEnvironment().
    Environment environment() const;
    // Returns the whole light, not rotated; with what backgrounds are drawn from if `withPictures`.
    MovingLight moving(bool withPictures = false) const;
    Light light() const { return moving().at(seconds); }
    // Adds the files that the options name. Those that a light file or a sequence names are in
    // moving().files().
    void addInputs(CommandFiles& files) const;

  private:
    MovingLight source(bool withPictures) const;
    MovingLight sequence() const;

    std::string mEnvironment, mBlend, mFile;
    float mBlendWeight = 0.5f;
    std::vector<float> mDistant, mSphere;
    float mIntensity = 1;
};

// Returns the light of an environment (.exr, .hdr; empty: the built-in sky), or of a light file (.json) at
// its beginning; with what backgrounds are drawn from if `withPictures`.
Light stillLight(const std::string& file, bool withPictures);

// -o, --exposure, --tone, --background, --background-blur, --ground-style
struct ImageArguments {
    std::filesystem::path output;

    void add(CLI::App& command);
    // Throws UsageError, before any work is done, for a name that ends in neither .exr nor .png, and for
    // options that do not go together.
    void check() const;

    // Returns whether the caller must draw the light behind the object, out of focus by backgroundBlur()
    // radians.
    bool showsLight() const;
    float backgroundBlur() const { return radians(mBlurDegrees); }

    // Returns the fade of the ground, or nothing to draw all of it. Throws UsageError if one is asked for but
    // the bake has no ground.
    std::optional<GroundFade> groundFade(const Asset& asset) const;

    // Returns the stops given by --exposure or, with "auto", those chosen for the object in `view`, which are
    // logged unless told otherwise; 0 for .exr.
    float exposureFor(const Image& view, bool isLogged = true) const;

    // Writes linear .exr or tone-mapped .png, by the extension of `path`. Radiance is premultiplied by alpha,
    // which is 1 where a background was drawn.
    void write(const std::filesystem::path& path, const Image& image, float exposure) const;

  private:
    bool isPng() const { return output.extension() == ".png"; }
    std::optional<vec3> color() const; // display values

    std::string mExposure = "auto", mTone = "agx", mBackground;
    float mBlurDegrees = 0;
    std::optional<GroundStyle> mGround;
};

// --samples
void addSamples(CLI::App& command, int& samples);
// Warns if the device draws fewer samples than were asked for.
void tellSamples(int drawn, int wanted, const vk::Device& device);

// Adds an option whose value is chosen by name; help and errors list the names.
template <typename Value>
CLI::Option* addChoice(CLI::App& command, const std::string& option, Value& value,
                       const std::map<std::string, Value>& choices, const std::string& help) {
    std::vector<std::string> names;
    for (const auto& [name, choice] : choices) names.push_back(name);
    return command
        .add_option_function<std::string>(
            option, [&value, choices](const std::string& name) { value = choices.at(name); }, help)
        ->check(CLI::IsMember(names));
}

// Accepts finite numbers from `low` to `high` (CLI::Range lets NaN pass).
CLI::Validator between(float low, float high);

} // namespace relume
