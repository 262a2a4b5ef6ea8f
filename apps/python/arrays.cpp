#include "apps/python/arrays.h"

namespace relume::python {

Image imageOf(const Array<float>& array, const char* name) {
    if (array.ndim() != 3 || (array.shape(2) != 3 && array.shape(2) != 4) || array.size() == 0)
        throw py::value_error(std::string(name) + ": expected an array of shape (height, width, 3 or 4)");
    Image image(int(array.shape(1)), int(array.shape(0)));
    const auto pixels = array.unchecked<3>();
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++)
            image.at(x, y) = {pixels(y, x, 0), pixels(y, x, 1), pixels(y, x, 2),
                              array.shape(2) == 4 ? pixels(y, x, 3) : 1.0f};
    return image;
}

py::array_t<float> arrayOf(Image image) {
    const py::ssize_t width = image.width, height = image.height;
    return arrayOf(std::move(image.pixels), {height, width});
}

py::object parsed(const std::string& json) { return py::module_::import("json").attr("loads")(json); }

} // namespace relume::python
