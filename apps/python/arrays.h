// Conversion between NumPy arrays and meshes, images and tuples.
#pragma once

#include "engine/image/image.h"
#include "engine/math/vector.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <vector>

namespace relume::python {

namespace py = pybind11;

// A C-contiguous array; others are converted.
template <typename T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

// Returns an array of `shape`, plus an axis for components, that takes over `values` without a copy.
template <typename Element>
py::array_t<float> arrayOf(std::vector<Element> values, std::vector<py::ssize_t> shape) {
    constexpr auto kComponents = py::ssize_t(sizeof(Element) / sizeof(float));
    if (kComponents > 1) shape.push_back(kComponents);
    auto* const kept = new std::vector<Element>(std::move(values));
    const py::capsule owner(kept, [](void* held) { delete static_cast<std::vector<Element>*>(held); });
    return py::array_t<float>(shape, reinterpret_cast<const float*>(kept->data()), owner);
}

// Returns the elements of an (n, components) array. Throws ValueError naming the argument, `name`, for any
// other shape.
template <typename Element, typename T = float>
std::vector<Element> elementsOf(const Array<T>& array, const char* name) {
    constexpr auto kComponents = py::ssize_t(sizeof(Element) / sizeof(T));
    if (array.ndim() != 2 || array.shape(1) != kComponents)
        throw py::value_error(std::string(name) + ": expected an array of shape (n, " +
                              std::to_string(kComponents) + ")");
    const auto* const first = reinterpret_cast<const Element*>(array.data());
    return {first, first + array.shape(0)};
}

// Returns the image of an (height, width, 3 or 4) array of linear values, top row first.
Image imageOf(const Array<float>& array, const char* name);

// Returns an (height, width, 4) array.
py::array_t<float> arrayOf(Image image);

// Returns JSON text as Python objects.
py::object parsed(const std::string& json);

} // namespace relume::python
