// Bindings of lights and cameras.
#include "apps/python/checks.h"
#include "apps/python/module.h"
#include "engine/import/environment_file.h"
#include "engine/import/light_file.h"

namespace relume::python {

namespace {

vec3 vectorOf(const std::array<float, 3>& values) { return {values[0], values[1], values[2]}; }

Environment environmentOf(const Array<float>& array) {
    const Image image = imageOf(array, "environment");
    if (image.width != 2 * image.height)
        throw UsageError("environment: expected a latlong, twice as wide as high");
    Environment environment{image.width, image.height, {}};
    environment.radiance.reserve(image.pixels.size());
    for (const vec4& pixel : image.pixels) {
        for (const float value : {pixel.x, pixel.y, pixel.z})
            expectWithin("environment", value, 0.0f, kLargestRadiance);
        environment.radiance.emplace_back(pixel);
    }
    return environment;
}

Light lightOf(Environment environment) {
    EnvironmentLight light{std::make_shared<const Environment>(prepareForSampling(environment))};
    light.picture = makePicture(std::move(environment));
    return {.environments = {light}};
}

Light sumOf(Light a, const Light& b) {
    if (a.sky && b.sky) throw UsageError("two day skies cannot be added");
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(a.environments, b.environments);
    append(a.strokes, b.strokes);
    append(a.lamps, b.lamps);
    append(a.distant, b.distant);
    if (b.sky) a.sky = b.sky;
    return checked(std::move(a));
}

Light productOf(const Light& light, float factor) {
    if (!(factor >= 0)) throw UsageError("a light is scaled by 0 or more");
    return checked(scaled(light, factor));
}

// Returns the direction at an azimuth and an elevation in degrees.
vec3 directionFrom(float azimuth, float elevation) {
    expectWithin("azimuth", azimuth, -kLargestNumber, kLargestNumber);
    expectWithin("elevation", elevation, -kLargestNumber, kLargestNumber);
    return directionAt(azimuth, elevation);
}

} // namespace

void addLight(py::module_& module) {
    py::class_<Light>(module, "Light")
        .def_static("sky",
                    [] {
                        Light light = lightOf(makeSky());
                        light.environments[0].picture = makePicture(makeSky(kSkyPictureColumns));
                        return light;
                    })
        .def_static("_environment_array",
                    [](const Array<float>& array) { return lightOf(environmentOf(array)); })
        .def_static(
            "_environment_file",
            [](const std::filesystem::path& path) { return lightOf(readEnvironment(path)); },
            py::call_guard<py::gil_scoped_release>())
        .def_static(
            "load",
            [](const std::filesystem::path& path, double seconds) {
                expectWithin("seconds", seconds, 0.0, 1e6);
                MovingLight light = readLight(path);
                light.keepPictures();
                return light.at(seconds);
            },
            py::arg("path"), py::arg("seconds") = 0.0, py::call_guard<py::gil_scoped_release>())
        .def_static(
            "lamp",
            [](float azimuth, float elevation, float radius, std::array<float, 3> radiance) {
                expectWithin("radius", radius, kSmallestLampRadius, 180.0f);
                const float angle = std::min(glm::radians(radius), kPi);
                return checked(
                    Light{.lamps = {{directionFrom(azimuth, elevation), angle, vectorOf(radiance)}}});
            },
            py::arg("azimuth"), py::arg("elevation"), py::arg("radius"), py::arg("radiance"))
        .def_static(
            "distant",
            [](float azimuth, float elevation, std::array<float, 3> irradiance) {
                return checked(Light{.distant = {{directionFrom(azimuth, elevation), vectorOf(irradiance)}}});
            },
            py::arg("azimuth"), py::arg("elevation"), py::arg("irradiance"))
        .def(
            "turned",
            [](const Light& light, float degrees) {
                expectWithin("degrees", degrees, -kLargestNumber, kLargestNumber);
                return checked(turned(light, glm::radians(degrees)));
            },
            py::arg("degrees"))
        .def("__mul__", productOf)
        .def("__rmul__", productOf)
        .def("__add__", [](const Light& a, const Light& b) { return sumOf(a, b); });

    py::class_<Camera>(module, "Camera")
        .def(py::init([](std::array<float, 3> eye, std::array<float, 3> target, float fov) {
                 expectWithin("fov", fov, 1.0f, 170.0f);
                 return checked(Camera{vectorOf(eye), vectorOf(target), glm::radians(fov)});
             }),
             py::arg("eye"), py::arg("target"), py::arg("fov") = 35.0f)
        .def_property_readonly("eye",
                               [](const Camera& camera) {
                                   return std::array{camera.eye.x, camera.eye.y, camera.eye.z};
                               })
        .def_property_readonly("target",
                               [](const Camera& camera) {
                                   return std::array{camera.target.x, camera.target.y, camera.target.z};
                               })
        .def_property_readonly("fov", [](const Camera& camera) { return glm::degrees(camera.verticalFov); });
}

} // namespace relume::python
