#include "engine/base/printable.h"

#include <cstdint>
#include <fmt/core.h>

namespace relume {

std::string printable(std::string_view text) {
    std::string result;
    for (size_t i = 0; i < text.size(); i++) {
        const auto byte = uint8_t(text[i]), next = uint8_t(i + 1 < text.size() ? text[i + 1] : 0);
        if ((byte < 0x20 && byte != '\n') || byte == 0x7f)
            result += fmt::format("\\x{:02x}", byte);
        else if (byte == 0xc2 && next >= 0x80 && next < 0xa0) // C1 control characters in UTF-8
            result += fmt::format("\\x{:02x}", uint8_t(text[++i]));
        else
            result += text[i];
    }
    return result;
}

} // namespace relume
