#include "apps/relume/options.h"

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/image/image_file.h"
#include "engine/light/light_file.h"

#include <cmath>
#include <cstdio>

namespace relume {

// Angles and positions beyond this have lost all precision.
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
        throw Error("the Vulkan validation layer reported {} messages", device.validationMessages());
}

void CameraArguments::add(CLI::App& command) {
    command.add_option("--size", mSize, fmt::format("Image size in pixels (default {}x{})", width, height))
        ->type_name("WxH")
        ->each([this](const std::string& text) {
            char rest;
            if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 1 ||
                height < 1 || width > 16384 || height > 16384)
                throw UsageError("--size: expected WIDTHxHEIGHT, each 1 to 16384, found \"{}\"", text);
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
        if (!(mOrbit[2] > 0)) throw UsageError("--orbit: expected a distance above 0, found {}", mOrbit[2]);
        camera = orbitCamera(bounds, radians(mOrbit[0]), radians(mOrbit[1]), mOrbit[2], fov, aspect);
    } else
        camera = defaultCamera(bounds, fov, aspect);
    if (!mEye.empty()) {
        camera.target = bounds.centre();
        camera.eye = vectorOf(mEye);
    }
    if (!mTarget.empty()) camera.target = vectorOf(mTarget);
    const vec3 arm = camera.eye - camera.target;
    const float c = std::cos(turn), s = std::sin(turn);
    if (turn != 0) camera.eye = camera.target + vec3(c * arm.x + s * arm.z, arm.y, c * arm.z - s * arm.x);
    if (!(glm::length(arm) > 0)) throw UsageError("--eye: expected a point other than the target");
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
                    "A light file instead: environments, day sky, strokes, lamps, still or moving (.json)")
        ->type_name("FILE")
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

MovingLight LightArguments::moving() const {
    MovingLight light = source();
    light.setGain(mIntensity);
    return light;
}

void LightArguments::addInputs(CommandFiles& files) const {
    for (const std::string& file : {mEnvironment, mBlend, mFile}) files.addInput(file);
}

MovingLight LightArguments::source() const {
    if (!mFile.empty()) return readLight(mFile);
    if (!mDistant.empty())
        return MovingLight({.distant = {{directionAt(mDistant[0], mDistant[1]), vec3(kPi)}}});
    if (!mSphere.empty()) {
        if (!(mSphere[2] > 0 && mSphere[2] <= 90))
            throw UsageError("--sphere-light: expected a radius above 0 and up to 90 degrees, found {}",
                             mSphere[2]);
        // Irradiance of a surface that faces a sphere of angular radius r: π sin² r times its radiance.
        const float radius = radians(mSphere[2]), sine = std::sin(radius);
        return MovingLight(
            {.lamps = {{directionAt(mSphere[0], mSphere[1]), radius, vec3(1 / (sine * sine))}}});
    }
    if (isSequence(mEnvironment) || isSequence(mBlend)) return sequence();
    const auto prepared = [](const Environment& map) {
        return std::make_shared<const Environment>(prepareForSampling(map));
    };
    Light light{
        .environments = {{prepared(mEnvironment.empty() ? makeSky() : readEnvironment(mEnvironment))}}};
    if (!mBlend.empty()) {
        light.environments.front().gain = 1 - mBlendWeight;
        light.environments.push_back({prepared(readEnvironment(mBlend)), 0, mBlendWeight});
    }
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
    return {std::move(light), "--environment", ""};
}

void ImageArguments::add(CLI::App& command) {
    command.add_option("-o,--output", output, "Image to write: .exr (linear) or .png (tone-mapped)")
        ->type_name("IMAGE")
        ->required();
    command.add_option("--exposure", exposure, "Exposure of a .png in stops")
        ->check(between(-100, 100))
        ->type_name("STOPS")
        ->capture_default_str();
    command.add_option("--tone", mTone, "Tone curve of a .png: none, aces or agx")
        ->type_name("CURVE")
        ->capture_default_str()
        ->check(CLI::IsMember({"none", "aces", "agx"}));
}

void ImageArguments::check() const {
    const std::string extension = output.extension();
    if (extension != ".exr" && extension != ".png")
        throw UsageError("--output: expected a name ending in .exr or .png, found \"{}\"", output.string());
    expectWritable(output);
}

void ImageArguments::write(const std::filesystem::path& path, const Image& image) const {
    if (path.extension() == ".exr")
        writeExr(path, image);
    else
        writePng(path, toneMap(image, *toneCurveFromName(mTone), exposure));
}

} // namespace relume
