// NumPy arrays in and out: meshes, images, tuples.
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

// C-contiguous; what has another type or order is converted.
template <typename T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

// An array that owns `values`, without a copy: rows of `shape` and the components of an element.
template <typename Element>
py::array_t<float> arrayOf(std::vector<Element> values, std::vector<py::ssize_t> shape) {
    constexpr auto kComponents = py::ssize_t(sizeof(Element) / sizeof(float));
    if (kComponents > 1) shape.push_back(kComponents);
    auto* const kept = new std::vector<Element>(std::move(values));
    const py::capsule owner(kept, [](void* held) { delete static_cast<std::vector<Element>*>(held); });
    return py::array_t<float>(shape, reinterpret_cast<const float*>(kept->data()), owner);
}

// (n, components) values. Throws ValueError, in which `name` is the argument, for another shape.
template <typename Element, typename T = float>
std::vector<Element> elementsOf(const Array<T>& array, const char* name) {
    constexpr auto kComponents = py::ssize_t(sizeof(Element) / sizeof(T));
    if (array.ndim() != 2 || array.shape(1) != kComponents)
        throw py::value_error(std::string(name) + ": expected an array of shape (n, " +
                              std::to_string(kComponents) + ")");
    const auto* const first = reinterpret_cast<const Element*>(array.data());
    return {first, first + array.shape(0)};
}

// (height, width, 3 or 4) linear values, rows from the top.
Image imageOf(const Array<float>& array, const char* name);

// (height, width, 4).
py::array_t<float> arrayOf(Image image);

// A JSON text as Python's objects.
py::object parsed(const std::string& json);

} // namespace relume::python
