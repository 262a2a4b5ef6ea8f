// Bindings of meshes and scenes.
#include "apps/python/checks.h"
#include "apps/python/module.h"
#include "engine/import/mesh_cleanup.h"
#include "engine/import/mesh_file.h"
#include "precompute/brdf/material_list.h"
#include "precompute/visibility/occluder.h"

#include <algorithm>
#include <span>

namespace relume::python {

namespace {

const char* const kDefaultMaterial = "gold";

template <typename Number>
void expectIndices(const py::object& object, size_t positions) {
    const auto numbers = py::cast<Array<Number>>(object);
    for (py::ssize_t i = 0; i < numbers.size(); i++)
        if (const Number number = numbers.data()[i];
            !(number >= 0 && number < Number(positions) && number == Number(uint32_t(number))))
            throw UsageError(
                fmt::format("triangles: expected indices of {} positions, found {}", positions, number));
}

// Returns triangles from an array, or lists, of integers; floats that are integers are taken for them.
std::vector<uvec3> trianglesFrom(const py::object& object, size_t positions) {
    const py::array array = py::array::ensure(object);
    const char kind = array ? array.dtype().kind() : 'O';
    if (kind == 'i')
        expectIndices<int64_t>(object, positions);
    else if (kind == 'u')
        expectIndices<uint64_t>(object, positions);
    else if (kind == 'f')
        expectIndices<double>(object, positions);
    else
        throw UsageError("triangles: expected an array of integers");
    return elementsOf<uvec3, uint32_t>(py::cast<Array<uint32_t>>(object), "triangles");
}

// Makes a mesh from arrays, checked and welded as one from a file.
Mesh makeMesh(const Array<float>& positions, const py::object& triangles,
              const std::optional<Array<float>>& normals, const std::optional<Array<float>>& uvs,
              const std::optional<Array<float>>& colors) {
    Mesh mesh;
    mesh.positions = elementsOf<vec3>(positions, "positions");
    mesh.triangles = trianglesFrom(triangles, mesh.positions.size());
    const auto expectCount = [&](size_t count, const char* name) {
        if (count != mesh.positions.size())
            throw UsageError(fmt::format("{}: expected one for each of {} positions, found {}", name,
                                         mesh.positions.size(), count));
    };
    if (normals) expectCount((mesh.normals = elementsOf<vec3>(*normals, "normals")).size(), "normals");
    if (uvs) expectCount((mesh.uvs = elementsOf<vec2>(*uvs, "uvs")).size(), "uvs");
    if (colors) expectCount((mesh.colors = elementsOf<vec4>(*colors, "colors")).size(), "colors");
    const py::gil_scoped_release unlocked;
    return cleanUp(std::move(mesh), "mesh");
}

// Simplifies as bakes simplify occluders, with new normals; drops other attributes.
Mesh simplified(const Mesh& mesh, size_t triangles) {
    if (triangles == 0) throw UsageError("triangles: expected 1 or more");
    Scene scene;
    scene.parts.emplace_back().mesh = mesh;
    Mesh few = makeOccluder(scene, triangles).mesh;
    makeNormals(few);
    return few;
}

py::array_t<uint32_t> trianglesOf(const Mesh& mesh) {
    py::array_t<uint32_t> array({py::ssize_t(mesh.triangles.size()), py::ssize_t(3)});
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), reinterpret_cast<uvec3*>(array.mutable_data()));
    return array;
}

void addFile(SceneBuilder& builder, const std::string& file, const std::optional<std::string>& material,
             const std::optional<std::string>& name, bool isZUp, float brushRotation) {
    expectWithin("brush_rotation", brushRotation, -kLargestBrushRotation, kLargestBrushRotation);
    if (material) readMaterials(*material);
    const bool takesOwn = !material && hasOwnMaterials(file);
    std::vector<Part> parts =
        loadParts(file, isZUp ? UpAxis::Z : UpAxis::Y,
                  takesOwn ? std::nullopt : std::optional(material.value_or(kDefaultMaterial)));
    if (name && parts.size() > 1)
        throw UsageError(fmt::format("name: expected none for {} parts, which have names", parts.size()));
    for (Part& part : parts) {
        if (name) part.name = *name;
        part.brushRotation = brushRotation;
        builder.scene.parts.push_back(std::move(part));
    }
}

void addMesh(SceneBuilder& builder, const Mesh& mesh, const std::optional<std::string>& material,
             const std::optional<std::string>& name, float brushRotation) {
    expectWithin("brush_rotation", brushRotation, -kLargestBrushRotation, kLargestBrushRotation);
    Part part;
    part.name = name.value_or("mesh");
    part.mesh = mesh;
    part.material = material.value_or(kDefaultMaterial);
    part.source = "an array";
    part.brushRotation = brushRotation;
    readMaterials(part.material);
    checkPlace(std::span(&part, 1), "mesh");
    builder.scene.parts.push_back(std::move(part));
}

void addGroundTo(SceneBuilder& builder, std::string material, std::optional<int> tessellation, float extent) {
    readMaterials(material);
    if (tessellation) expectWithin("tessellation", *tessellation, 1, 4096);
    expectWithin("extent", extent, 0.01f, 1000.0f);
    if (std::ranges::count(builder.scene.parts, "ground", &Part::name) > 0)
        throw UsageError("add_ground: the scene has a part called ground");
    builder.ground = SceneBuilder::Ground{std::move(material), tessellation, extent};
}

} // namespace

Scene SceneBuilder::build(bool isRefined) const {
    Scene whole = scene;
    if (whole.parts.empty()) throw UsageError("the scene has no parts; add a mesh");
    if (!ground) return whole;
    GroundOptions options;
    options.extent = ground->extent;
    if (ground->tessellation)
        options.tessellation = *ground->tessellation;
    else if (isRefined) {
        options.tessellation = kRefinedGroundQuads;
        options.isRefinable = true;
    }
    addGround(whole, options, ground->material);
    return whole;
}

void addScene(py::module_& module) {
    py::class_<Mesh>(module, "Mesh")
        .def(py::init(&makeMesh), py::arg("positions"), py::arg("triangles"), py::arg("normals") = py::none(),
             py::arg("uvs") = py::none(), py::arg("colors") = py::none())
        .def_static(
            "load", [](const std::filesystem::path& path) { return readMesh(path); }, py::arg("path"),
            py::call_guard<py::gil_scoped_release>())
        .def("simplified", simplified, py::arg("triangles"), py::call_guard<py::gil_scoped_release>())
        .def_property_readonly(
            "positions",
            [](const Mesh& mesh) { return arrayOf(mesh.positions, {py::ssize_t(mesh.positions.size())}); })
        .def_property_readonly(
            "normals",
            [](const Mesh& mesh) { return arrayOf(mesh.normals, {py::ssize_t(mesh.normals.size())}); })
        .def_property_readonly("triangles", trianglesOf);

    py::class_<SceneBuilder>(module, "Scene")
        .def(py::init<>())
        .def_static(
            "load",
            [](const std::filesystem::path& path) {
                return SceneBuilder{readScene(path), {}};
            },
            py::arg("path"), py::call_guard<py::gil_scoped_release>())
        .def("_add_file", addFile)
        .def("_add_mesh", addMesh)
        .def("add_ground", addGroundTo, py::arg("material") = "white-diffuse",
             py::arg("tessellation") = py::none(), py::arg("extent") = GroundOptions().extent)
        .def_property_readonly("parts", [](const SceneBuilder& builder) {
            std::vector<std::string> names;
            for (const Part& part : builder.scene.parts) names.push_back(part.name);
            if (builder.ground) names.emplace_back("ground");
            return names;
        });
}

} // namespace relume::python
