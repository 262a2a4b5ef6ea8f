// Bindings of lights and cameras.
#include "apps/python/module.h"
#include "engine/import/environment_file.h"
#include "engine/import/light_file.h"

namespace relume::python {

namespace {

vec3 vectorOf(const std::array<float, 3>& values) { return {values[0], values[1], values[2]}; }

Environment environmentOf(const Array<float>& array) {
    const Image image = imageOf(array, "environment");
    if (image.width != 2 * image.height)
        throw py::value_error("environment: expected a latlong, twice as wide as high");
    Environment environment{image.width, image.height, {}};
    environment.radiance.reserve(image.pixels.size());
    for (const vec4& pixel : image.pixels) {
        if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.z >= 0 && pixel.x + pixel.y + pixel.z < 1e30f))
            throw py::value_error("environment: expected finite radiance of at least 0");
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
    if (a.sky && b.sky) throw py::value_error("two day skies cannot be added");
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(a.environments, b.environments);
    append(a.strokes, b.strokes);
    append(a.lamps, b.lamps);
    append(a.distant, b.distant);
    if (b.sky) a.sky = b.sky;
    return a;
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
                MovingLight light = readLight(path);
                light.keepPictures();
                return light.at(seconds);
            },
            py::arg("path"), py::arg("seconds") = 0.0, py::call_guard<py::gil_scoped_release>())
        .def_static(
            "lamp",
            [](float azimuth, float elevation, float radius, std::array<float, 3> radiance) {
                if (!(radius > 0 && radius <= 180))
                    throw py::value_error("radius: expected 0 to 180 degrees");
                return Light{
                    .lamps = {{directionAt(azimuth, elevation), glm::radians(radius), vectorOf(radiance)}}};
            },
            py::arg("azimuth"), py::arg("elevation"), py::arg("radius"), py::arg("radiance"))
        .def_static(
            "distant",
            [](float azimuth, float elevation, std::array<float, 3> irradiance) {
                return Light{.distant = {{directionAt(azimuth, elevation), vectorOf(irradiance)}}};
            },
            py::arg("azimuth"), py::arg("elevation"), py::arg("irradiance"))
        .def(
            "turned", [](const Light& light, float degrees) { return turned(light, glm::radians(degrees)); },
            py::arg("degrees"))
        .def("__mul__",
             [](const Light& light, float factor) {
                 if (!(factor >= 0)) throw py::value_error("a light is scaled by 0 or more");
                 return scaled(light, factor);
             })
        .def("__rmul__",
             [](const Light& light, float factor) {
                 if (!(factor >= 0)) throw py::value_error("a light is scaled by 0 or more");
                 return scaled(light, factor);
             })
        .def("__add__", [](const Light& a, const Light& b) { return sumOf(a, b); });

    py::class_<Camera>(module, "Camera")
        .def(py::init([](std::array<float, 3> eye, std::array<float, 3> target, float fov) {
                 return Camera{vectorOf(eye), vectorOf(target), glm::radians(fov)};
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
