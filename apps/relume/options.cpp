#include "apps/relume/options.h"
#include "engine/import/environment_file.h"

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/image_file.h"
#include "engine/import/light_file.h"
#include "engine/render/tone_map.h"

#include <cmath>
#include <cstdio>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace relume {

// Largest angle or coordinate; beyond it all precision is lost.
static constexpr float kLargestNumber = 1e6f;

float radians(float degrees) { return glm::radians(degrees); }

CLI::Validator between(float low, float high) {
    const auto check = [low, high](const std::string& text) -> std::string {
        float value;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return "";
        return fmt::format("expected a number from {} to {}, found \"{}\"", low, high, text);
    };
    return CLI::Validator(check, "");
}

namespace {

vec3 vectorOf(const std::vector<float>& values) { return {values[0], values[1], values[2]}; }

} // namespace

void DeviceArguments::add(CLI::App& command) {
    command
        .add_option("--device", options.select, "Vulkan device by index, UUID or name (see `relume devices`)")
        ->type_name("DEVICE");
    command.add_option("--validation", options.validation, "Vulkan checks: some of core,sync,gpu,best")
        ->type_name("LIST");
}

std::unique_ptr<vk::Device> DeviceArguments::open() const { return std::make_unique<vk::Device>(options); }

void DeviceArguments::expectNoMessages(const vk::Device& device) {
    if (device.validationMessages() > 0)
        throw Error(
            fmt::format("the Vulkan validation layer reported {} messages", device.validationMessages()));
}

void CameraArguments::add(CLI::App& command) {
    command.add_option("--size", mSize, fmt::format("Image size in pixels (default {}x{})", width, height))
        ->type_name("WxH")
        ->each([this](const std::string& text) {
            char rest;
            if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 1 ||
                height < 1 || width > 16384 || height > 16384)
                throw UsageError(
                    fmt::format("--size: expected WIDTHxHEIGHT, each 1 to 16384, found \"{}\"", text));
        });
    CLI::Option* eye = command.add_option("--eye", mEye, "Eye position")
                           ->type_name("X,Y,Z")
                           ->delimiter(',')
                           ->expected(3)
                           ->check(between(-kLargestNumber, kLargestNumber));
    command.add_option("--target", mTarget, "Point looked at (default: the object's middle)")
        ->type_name("X,Y,Z")
        ->delimiter(',')
        ->expected(3)
        ->check(between(-kLargestNumber, kLargestNumber));
    command
        .add_option("--orbit", mOrbit,
                    "Eye about the object: azimuth and elevation in degrees, distance where 1 just fits it")
        ->type_name("AZ,EL,DIST")
        ->delimiter(',')
        ->expected(3)
        ->check(between(-kLargestNumber, kLargestNumber))
        ->excludes(eye);
    command.add_option("--fov", mFovDegrees, "Vertical field of view in degrees")
        ->type_name("DEG")
        ->capture_default_str()
        ->check(between(1, 170));
}

Camera CameraArguments::camera(const Asset& asset, float turn) const {
    const float aspect = float(width) / float(height), fov = radians(mFovDegrees);
    const Bounds bounds = objectBounds(asset);
    Camera camera;
    if (!mOrbit.empty()) {
        if (!(mOrbit[2] > 0))
            throw UsageError(fmt::format("--orbit: expected a distance above 0, found {}", mOrbit[2]));
        camera = orbitCamera(bounds, radians(mOrbit[0]), radians(mOrbit[1]), mOrbit[2], fov, aspect);
    } else
        camera = defaultCamera(bounds, fov, aspect);
    if (!mEye.empty()) {
        camera.target = bounds.center();
        camera.eye = vectorOf(mEye);
    }
    if (!mTarget.empty()) camera.target = vectorOf(mTarget);
    const vec3 arm = camera.eye - camera.target;
    const float c = std::cos(turn), s = std::sin(turn);
    if (turn != 0) camera.eye = camera.target + vec3(c * arm.x + s * arm.z, arm.y, c * arm.z - s * arm.x);
    if (!(glm::length(arm) > 0))
        throw UsageError(mOrbit.empty()
                             ? "--eye: expected a point other than the target"
                             : "--orbit: expected a distance at which the eye is not on the target");
    return camera;
}

void LightArguments::add(CLI::App& command) {
    CLI::Option* environment =
        command
            .add_option("-e,--environment", mEnvironment,
                        "Latlong or cube .exr, or .hdr; a_####.exr: 24 a second (default: a built-in sky)")
            ->type_name("FILE");
    CLI::Option* distant = command
                               .add_option("--distant-light", mDistant,
                                           "One direction instead: azimuth (0 +Z, 90 +X), elevation, degrees")
                               ->type_name("AZ,EL")
                               ->delimiter(',')
                               ->expected(2)
                               ->check(between(-kLargestNumber, kLargestNumber))
                               ->excludes(environment);
    CLI::Option* blend = command.add_option("--blend", mBlend, "A second environment, mixed into the first")
                             ->type_name("FILE");
    command.add_option("--blend-weight", mBlendWeight, "The second environment's share")
        ->type_name("0..1")
        ->capture_default_str()
        ->check(between(0, 1))
        ->needs(blend);
    distant->excludes(blend);
    CLI::Option* sphere =
        command
            .add_option("--sphere-light", mSphere,
                        "A distant sphere instead: azimuth, elevation and angular radius, degrees")
            ->type_name("AZ,EL,RADIUS")
            ->delimiter(',')
            ->expected(3)
            ->check(between(-kLargestNumber, kLargestNumber))
            ->excludes(environment)
            ->excludes(blend)
            ->excludes(distant);
    command
        .add_option("--light", mFile,
                    "A light file instead (.json), or its content: environments, day sky, strokes, lamps, "
                    "still or moving")
        ->type_name("FILE|JSON")
        ->excludes(environment)
        ->excludes(blend)
        ->excludes(distant)
        ->excludes(sphere);
    command.add_option("--rotate", rotationDegrees, "Turn the light about +Y, from +Z towards +X")
        ->check(between(-kLargestNumber, kLargestNumber))
        ->type_name("DEG")
        ->capture_default_str();
    command.add_option("--time", seconds, "The moment of a light that moves, or the first")
        ->check(between(0, 1e6f))
        ->type_name("SECONDS")
        ->capture_default_str();
    command
        .add_option("--intensity", mIntensity, "Scales the light; 1 lets a lamp light white to radiance 1")
        ->type_name("X")
        ->capture_default_str()
        ->check(between(1e-6f, 1e6f));
}

Environment LightArguments::environment() const {
    Environment environment = mEnvironment.empty() ? makeSky() : readEnvironment(mEnvironment);
    for (vec3& radiance : environment.radiance) radiance *= mIntensity;
    return environment;
}

MovingLight LightArguments::moving(bool withPictures) const {
    MovingLight light = source(withPictures);
    if (withPictures) light.keepPictures();
    light.setGain(mIntensity);
    return light;
}

// Returns whether --light is the content of a light file instead of its name.
static bool isInline(const std::string& light) { return light.starts_with('{'); }

void LightArguments::addInputs(CommandFiles& files) const {
    for (const std::string& file : {mEnvironment, mBlend}) files.addInput(file);
    if (!isInline(mFile)) files.addInput(mFile);
}

// Makes an environment light; `file` is empty for the built-in sky.
static EnvironmentLight environmentLight(const std::string& file, float gain, bool withPicture) {
    Environment map = file.empty() ? makeSky() : readEnvironment(file);
    EnvironmentLight light{std::make_shared<const Environment>(prepareForSampling(map)), 0, gain};
    if (withPicture) light.picture = makePicture(file.empty() ? makeSky(kSkyPictureColumns) : std::move(map));
    return light;
}

Light stillLight(const std::string& file, bool withPictures) {
    if (!file.ends_with(".json")) return {.environments = {environmentLight(file, 1, withPictures)}};
    MovingLight light = readLight(file);
    if (withPictures) light.keepPictures();
    return light.at(0);
}

MovingLight LightArguments::source(bool withPictures) const {
    if (isInline(mFile)) return {mFile, "--light", ""};
    if (!mFile.empty()) return readLight(mFile);
    if (!mDistant.empty())
        return MovingLight({.distant = {{directionAt(mDistant[0], mDistant[1]), vec3(kPi)}}});
    if (!mSphere.empty()) {
        if (!(mSphere[2] >= kSmallestLampRadius && mSphere[2] <= 90))
            throw UsageError(fmt::format("--sphere-light: expected a radius of {} to 90 degrees, found {}",
                                         kSmallestLampRadius, mSphere[2]));
        // A surface that faces a sphere of angular radius r receives irradiance π sin² r times its radiance.
        const float radius = radians(mSphere[2]), sine = std::sin(radius);
        return MovingLight(
            {.lamps = {{directionAt(mSphere[0], mSphere[1]), radius, vec3(1 / (sine * sine))}}});
    }
    if (isSequence(mEnvironment) || isSequence(mBlend)) return sequence();
    const float share = mBlend.empty() ? 1 : 1 - mBlendWeight;
    Light light{.environments = {environmentLight(mEnvironment, share, withPictures)}};
    if (!mBlend.empty()) light.environments.push_back(environmentLight(mBlend, mBlendWeight, withPictures));
    return MovingLight(std::move(light));
}

MovingLight LightArguments::sequence() const {
    if (mEnvironment.empty())
        throw UsageError("--blend: a sequence is mixed into an --environment; give one");
    const auto describe = [](const std::string& file) {
        return nlohmann::json{{isSequence(file) ? "sequence" : "file", file}};
    };
    nlohmann::json light{{"environment", describe(mEnvironment)}};
    if (!mBlend.empty()) {
        light["blend"] = describe(mBlend);
        light["blend"]["weight"] = mBlendWeight;
    }
    return {light.dump(), "--environment", ""};
}

void ImageArguments::add(CLI::App& command) {
    command.add_option("-o,--output", output, "Image to write: .exr (linear) or .png (tone-mapped)")
        ->type_name("IMAGE")
        ->required();
    const auto isExposure = [](std::string& text) -> std::string {
        return text == "auto" ? "" : between(-100, 100)(text);
    };
    command
        .add_option("--exposure", mExposure,
                    "Exposure of a .png in stops; auto: what the object asks for in the first frame")
        ->check(CLI::Validator(isExposure, ""))
        ->type_name("STOPS|auto")
        ->capture_default_str();
    command.add_option("--tone", mTone, "Tone curve of a .png: none, aces or agx")
        ->type_name("CURVE")
        ->capture_default_str()
        ->check(CLI::IsMember({"none", "aces", "agx"}));
    command
        .add_option("--background", mBackground,
                    "Behind the object: the environment as it lights it (without lamps and distant lights; "
                    "default of "
                    ".png), none (alpha tells what is covered; default of .exr), or an even #rrggbb or r,g,b "
                    "of 0 to 1")
        ->type_name("environment|none|COLOR");
    command.add_option("--background-blur", mBlurDegrees, "The environment behind the object out of focus")
        ->check(between(0, 90))
        ->type_name("DEGREES")
        ->capture_default_str();
    std::map<std::string, std::optional<GroundStyle>> styles;
    for (size_t i = 0; i < kGroundStyleNames.size(); i++) styles[kGroundStyleNames[i]] = GroundStyle(i);
    addChoice(
        command, "--ground-style", mGround, styles,
        "A ground as a shadow on the background (shadow, the default where there is one), ending around the "
        "object (fade), or as it is (whole, the default otherwise)")
        ->type_name("STYLE");
}

void ImageArguments::check() const {
    const std::string extension = output.extension();
    if (extension != ".exr" && extension != ".png")
        throw UsageError(
            fmt::format("--output: expected a name ending in .exr or .png, found \"{}\"", output.string()));
    if (color() && !isPng())
        throw UsageError(
            fmt::format("--background {}: a color is of display values, and .exr is radiance; use "
                        "environment or none, or "
                        "write .png",
                        mBackground));
    if (mBlurDegrees > 0 && !showsLight())
        throw UsageError(
            "--background-blur: there is no environment behind the object; add --background environment");
    expectWritable(output);
}

void addSamples(CLI::App& command, int& samples) {
    command
        .add_option("--samples", samples, "Samples a pixel, against jagged edges: 1 (its center), 2, 4 or 8")
        ->check(CLI::IsMember({1, 2, 4, 8}))
        ->capture_default_str();
}

void tellSamples(int drawn, int wanted, const vk::Device& device) {
    if (drawn != wanted)
        spdlog::warn("{} draws {} samples a pixel, not {}: edges are those of --samples {}", device.name(),
                     drawn, wanted, drawn);
}

bool ImageArguments::showsLight() const {
    return mBackground == "environment" || (mBackground.empty() && isPng());
}

std::optional<vec3> ImageArguments::color() const {
    if (mBackground.empty() || mBackground == "environment" || mBackground == "none") return std::nullopt;
    vec3 color(-1);
    unsigned int rgb;
    char rest;
    const bool isHex = mBackground.size() == 7 && mBackground[0] == '#' &&
                       mBackground.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
    if (isHex && std::sscanf(mBackground.c_str(), "#%x", &rgb) == 1)
        color = vec3(float(rgb >> 16), float(rgb >> 8 & 255), float(rgb & 255)) / 255.0f;
    else if (std::sscanf(mBackground.c_str(), "%f,%f,%f%c", &color.x, &color.y, &color.z, &rest) != 3)
        color = vec3(-1);
    if (!(glm::all(glm::greaterThanEqual(color, vec3(0))) && glm::all(glm::lessThanEqual(color, vec3(1)))))
        throw UsageError(
            fmt::format("--background: expected environment, none, #rrggbb, or r,g,b of 0 to 1, found \"{}\"",
                        mBackground));
    return color;
}

std::optional<GroundFade> ImageArguments::groundFade(const Asset& asset) const {
    const bool hasBackground = showsLight() || color();
    const GroundStyle style = mGround.value_or(hasBackground ? GroundStyle::Shadow : GroundStyle::Whole);
    const std::optional<GroundFade> fade = makeGroundFade(asset, style);
    if (!fade && mGround && style != GroundStyle::Whole)
        throw UsageError(groundOf(asset)
                             ? "--ground-style: the ground is not under the object; use whole"
                             : "--ground-style: expected a part called \"ground\", found none; bake "
                               "with --ground");
    return fade;
}

float ImageArguments::exposureFor(const Image& view, bool isLogged) const {
    if (!isPng()) return 0;
    if (mExposure != "auto") return std::stof(mExposure);
    const float stops = autoExposure(view);
    if (!isLogged) return stops;
    spdlog::info("exposure: {} stops, as the object asks for; --exposure={} says the same", stops, stops);
    return stops;
}

void ImageArguments::write(const std::filesystem::path& path, const Image& image, float exposure) const {
    if (!isPng()) return writeExr(path, image);
    Image straight = image; // alpha of .png is not premultiplied
    for (vec4& pixel : straight.pixels)
        if (pixel.w > 0 && pixel.w < 1) pixel = vec4(vec3(pixel) / pixel.w, pixel.w);
    Image display = toneMap(straight, *toneCurveFromName(mTone), exposure);
    if (const std::optional<vec3> behind = color())
        for (vec4& pixel : display.pixels) pixel = vec4(glm::mix(*behind, vec3(pixel), pixel.w), 1);
    writePng(path, display);
}

} // namespace relume
