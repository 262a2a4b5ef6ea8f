#include "apps/python/module.h"

#include "engine/base/error.h"
#include "engine/base/log.h"

#include <chrono>
#include <tbb/task_arena.h>

namespace relume::python {

namespace {

std::string selectedDevice;
std::shared_ptr<const vk::Device> openDevice;

void useDevice(const std::string& select) {
    openDevice.reset();
    selectedDevice = select;
}

py::dict dictOf(const vk::DeviceInfo& info) {
    py::dict entry;
    entry["index"] = info.index;
    entry["name"] = info.name;
    entry["type"] = info.type;
    entry["driver"] = info.driver;
    entry["uuid"] = info.uuid;
    entry["unsuitable"] = info.unsuitable;
    return entry;
}

py::list listedDevices() {
    py::list list;
    for (const vk::DeviceInfo& info : vk::listDevices()) list.append(dictOf(info));
    return list;
}

// Sends messages to Python's logger "relume".
void logToPython(LogLevel level, const std::string& text) {
    const py::gil_scoped_acquire lock;
    static constexpr const char* kMethods[] = {"debug", "info", "warning", "error"};
    try {
        py::module_::import("logging").attr("getLogger")("relume").attr(kMethods[size_t(level)])("%s", text);
    } catch (py::error_already_set& failure) {
        failure.discard_as_unraisable("relume's log");
    }
}

} // namespace

std::shared_ptr<const vk::Device> device() {
    if (!openDevice)
        openDevice = std::make_shared<const vk::Device>(vk::DeviceOptions{.select = selectedDevice});
    return openDevice;
}

void runLong(const py::object& progress,
             const std::function<void(const std::function<void(double)>&)>& work) {
    using Clock = std::chrono::steady_clock;
    Clock::time_point last = Clock::now() - std::chrono::hours(1);
    const py::gil_scoped_release unlocked;
    work([&](double share) {
        const Clock::time_point now = Clock::now();
        if (share < 1 && now - last < std::chrono::milliseconds(50)) return;
        last = now;
        const py::gil_scoped_acquire lock;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        // In isolation: a callback that calls this module must not take up other tasks of the work that
        // waits.
        if (!progress.is_none()) tbb::this_task_arena::isolate([&] { progress(share); });
    });
}

} // namespace relume::python

PYBIND11_MODULE(_relume, module) {
    using namespace relume;
    using namespace relume::python;
    module.doc() = "The compiled part of relume; see relume.";
    static py::exception<Error> error(module, "Error", PyExc_RuntimeError);
    static py::exception<UsageError> usage(module, "UsageError", error.ptr());
    static py::exception<NoDeviceError> noDevice(module, "NoDeviceError", error.ptr());
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const UsageError& wrong) {
            usage(wrong.what());
        } catch (const NoDeviceError& none) {
            noDevice(none.what());
        } catch (const Error& failure) {
            error(failure.what());
        }
    });
    setLog(logToPython);
    module.def("devices", listedDevices);
    module.def("device", [] { return dictOf(device()->info()); });
    module.def("use_device", useDevice, py::arg("select"));
    addScene(module);
    addLight(module);
    addBake(module);
    addRenderer(module);
    addStudies(module);
    addBrdfs(module);
    // Before the interpreter exits, so that the driver's threads and Python's log end in order.
    py::module_::import("atexit").attr("register")(py::cpp_function([] {
        openDevice.reset();
        setLog(nullptr);
    }));
}
