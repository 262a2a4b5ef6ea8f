// The classes that several files of the module share.
#pragma once

#include "apps/python/arrays.h"
#include "engine/import/moving_light.h"
#include "engine/import/scene.h"
#include "engine/scene/camera.h"
#include "engine/transport/asset.h"
#include "engine/vk/device.h"

#include <atomic>
#include <functional>
#include <memory>

namespace relume::python {

// A scene that grows part by part. Its ground is sized when all parts are there.
struct SceneBuilder {
    Scene scene;
    struct Ground {
        std::string material;
        std::optional<int> tessellation;
        float extent;
    };
    std::optional<Ground> ground;

    // As `relume bake` takes it; refined: the ground's own tessellation is coarse where none was asked for.
    Scene build(bool isRefined) const;
};

// Returns the device that all calls share, which is opened when first needed, as use_device() selected it.
// Callers keep the pointer while they work: another device may be selected meanwhile, or Python may end.
std::shared_ptr<const vk::Device> device();

// Runs `work` without Python's lock. `work` is given a function that tells how far it is: that calls
// `progress`, where it is not None, now and then, and looks for Ctrl-C. An exception of either ends the work
// and reaches the caller.
void runLong(const py::object& progress, const std::function<void(const std::function<void(double)>&)>& work);

void addScene(py::module_& module);
void addLight(py::module_& module);
void addRenderer(py::module_& module);
void addBake(py::module_& module);
void addStudies(py::module_& module);
void addBrdfs(py::module_& module);

} // namespace relume::python
