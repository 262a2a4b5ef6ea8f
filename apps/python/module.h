// The classes and functions that several files of the module share.
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

// A scene to which parts are added. Its ground is sized once all parts are known.
struct SceneBuilder {
    Scene scene;
    struct Ground {
        std::string material;
        std::optional<int> tessellation;
        float extent;
    };
    std::optional<Ground> ground;

    // Returns the scene as `relume bake` takes it. `isRefined`: a ground without given tessellation is
    // coarse.
    Scene build(bool isRefined) const;
};

// Returns the device that all calls share, opened on first use as use_device() selected it. Callers keep the
// pointer while they work, since another device may be selected meanwhile, or Python may end.
std::shared_ptr<const vk::Device> device();

// Runs `work` without Python's lock. Passes it a function to report progress, which now and then calls
// `progress`, unless that is None, and checks for Ctrl-C. An exception from either ends the work and reaches
// the caller.
void runLong(const py::object& progress, const std::function<void(const std::function<void(double)>&)>& work);

// Each adds one part of the Python interface to the module.
void addScene(py::module_& module);
void addLight(py::module_& module);
void addRenderer(py::module_& module);
void addBake(py::module_& module);
void addStudies(py::module_& module);
void addBrdfs(py::module_& module);

} // namespace relume::python
