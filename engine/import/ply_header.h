// The header of a PLY file, which describes its data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace relume {

enum class PlyEncoding { Ascii, LittleEndian, BigEndian };

struct PlyScalarType {
    std::string_view name, otherName;
    size_t size;
    char kind; // 'i' signed, 'u' unsigned, 'f' floating
};

struct PlyProperty {
    std::string name;
    const PlyScalarType* type;
    const PlyScalarType* countType = nullptr; // of a list's length; null unless it is a list
};

struct PlyElement {
    std::string name;
    uint64_t count;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::Ascii;
    std::vector<PlyElement> elements;
    size_t size = 0; // bytes of the header, behind which the data begin
};

// Reads the header at the start of `file`. Throws Error, in which `name` names the file. Counts are as the
// file claims: the data may not be there.
PlyHeader readPlyHeader(std::string_view file, const std::string& name);

} // namespace relume
