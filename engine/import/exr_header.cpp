// Checks sizes in an OpenEXR header. OpenEXR allocates what a header says before it reads. For attributes of
// known types it reads the number of bytes it expects, whatever the stated size, and would then take
// arbitrary bytes for sizes.
#include "engine/base/error.h"
#include "engine/import/exr_check.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/core.h>

namespace relume {

namespace {

using Bytes = std::span<const std::byte>;

// Attribute types of fixed size in bytes. All others have checks of their own, or are read by their stated
// size.
struct FixedType {
    std::string_view name;
    size_t bytes;
};
constexpr std::array kFixedTypes = {
    FixedType{"box2f", 16},      FixedType{"box2i", 16},    FixedType{"chromaticities", 32},
    FixedType{"compression", 1}, FixedType{"double", 8},    FixedType{"deepImageState", 1},
    FixedType{"envmap", 1},      FixedType{"float", 4},     FixedType{"int", 4},
    FixedType{"keycode", 28},    FixedType{"lineOrder", 1}, FixedType{"m33d", 72},
    FixedType{"m33f", 36},       FixedType{"m44d", 128},    FixedType{"m44f", 64},
    FixedType{"rational", 8},    FixedType{"tiledesc", 9},  FixedType{"timecode", 8},
    FixedType{"v2d", 16},        FixedType{"v2f", 8},       FixedType{"v2i", 8},
    FixedType{"v3d", 24},        FixedType{"v3f", 12},      FixedType{"v3i", 12}};

class HeaderWalk {
  public:
    HeaderWalk(Bytes bytes, const std::string& name) : mRest(bytes), mName(name) {}

    // Returns the number of bytes of the header.
    size_t run() {
        const size_t all = mRest.size();
        take(8); // magic number, version and flags
        while (!takeText().empty()) {
            const std::string_view type = takeText();
            const int32_t size = takeInt();
            if (size < 0) fail();
            HeaderWalk value(take(size_t(size)), mName);
            value.checkValue(type);
        }
        return all - mRest.size();
    }

  private:
    [[noreturn]] void fail() const {
        throw Error(fmt::format("{}: damaged OpenEXR header; get the file again", mName));
    }

    Bytes take(size_t count) {
        if (count > mRest.size()) fail();
        const Bytes taken = mRest.first(count);
        mRest = mRest.subspan(count);
        return taken;
    }

    int32_t takeInt() {
        int32_t value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }

    // Takes a null-terminated string.
    std::string_view takeText() {
        const auto end = std::ranges::find(mRest, std::byte(0));
        const Bytes text = take(size_t(end - mRest.begin()));
        take(1);
        return {reinterpret_cast<const char*>(text.data()), text.size()};
    }

    void checkValue(std::string_view type) {
        const auto fixed = std::ranges::find(kFixedTypes, type, &FixedType::name);
        if (fixed != kFixedTypes.end() && mRest.size() != fixed->bytes) fail();
        if (type == "chlist") {
            constexpr size_t kChannelBytes = 16; // after the name
            while (!takeText().empty()) take(kChannelBytes);
            if (!mRest.empty()) fail();
        } else if (type == "preview") {
            const int64_t width = takeInt(), height = takeInt();
            if (width < 0 || height < 0 || uint64_t(width) * uint64_t(height) * 4 != mRest.size()) fail();
        } else if (type == "stringvector") {
            while (!mRest.empty()) {
                const int32_t size = takeInt();
                if (size < 0) fail();
                take(size_t(size));
            }
        } else if (type == "floatvector") {
            if (mRest.size() % 4 != 0) fail();
        } else if (type == "idmanifest") {
            throw Error(
                fmt::format("{}: holds an idmanifest attribute, which is not read; save it without", mName));
        }
    }

    Bytes mRest;
    const std::string& mName;
};

} // namespace

size_t checkExrHeader(Bytes bytes, const std::string& name) { return HeaderWalk(bytes, name).run(); }

} // namespace relume
