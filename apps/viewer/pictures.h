// Images that panels show.
#pragma once

#include "engine/image/image.h"
#include "engine/vk/commands.h"

#include <optional>

namespace relume {

// A place for one, in pixels; of no size: none.
struct Picture {
    ivec2 place{0}, size{0};
    explicit operator bool() const { return size.x > 0; }
};

// They lie in the texture that Dear ImGui has its letters in: its Vulkan backend draws from no other before
// 1.88.
class Pictures {
  public:
    // Takes room in the texture; before the backend makes it. `device` must outlive this.
    explicit Pictures(const vk::Device& device);

    // Room for good; of no size where there is none left.
    Picture add(int width, int height);

    // What a place holds from the next record() on: as large, and display values as toneMap() gives them.
    void set(const Picture& picture, const Image& image);
    // Copies what was set since.
    void record(vk::Commands& commands);

    // Between Ui::begin() and end(): a panel's next item, so wide; as high as that makes it.
    void draw(const Picture& picture, float width) const;
    // The same as a button that is marked if `isChosen`; true: it was pressed. `name` tells it apart.
    bool drawButton(const char* name, const Picture& picture, float width, bool isChosen) const;

  private:
    struct Change {
        Picture picture;
        std::vector<uint32_t> texels;
    };
    // Corners in texture coordinates.
    std::array<vec2, 2> cornersOf(const Picture& picture) const;

    const vk::Device& mDevice;
    int mRoom; // Dear ImGui's number of it
    // Rows of pictures of one height, from the top.
    struct Row {
        int top, height, used;
    };
    std::vector<Row> mRows;
    std::vector<Change> mChanges;
    vk::Buffer mStaging; // of the last record()
};

} // namespace relume
