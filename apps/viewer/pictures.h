// Images that panels show.
#pragma once

#include "engine/image/image.h"
#include "engine/vk/commands.h"

#include <optional>

namespace relume {

// A place for an image, in pixels of the texture; empty if its size is 0.
struct Picture {
    ivec2 place{0}, size{0};
    explicit operator bool() const { return size.x > 0; }
};

// Images are stored in Dear ImGui's font texture, the only one from which its Vulkan backend draws before
// version 1.88.
class Pictures {
  public:
    // Reserves room in the texture; must precede the creation of the backend. Keeps a reference to `device`.
    explicit Pictures(const vk::Device& device);

    // Reserves a place for good; returns an empty one if there is no room left.
    Picture add(int width, int height);

    // Sets a place's content from the next record() on. `image` has the same size and display values, as from
    // toneMap().
    void set(const Picture& picture, const Image& image);
    // Copies what was set since the last call.
    void record(vk::Commands& commands);

    // Draws a picture as a panel's next item, with this width and proportional height. Between Ui::begin()
    // and end().
    void draw(const Picture& picture, float width) const;
    // Draws it as a button, highlighted if `isChosen`. Returns true if it was pressed. `name` identifies the
    // button.
    bool drawButton(const char* name, const Picture& picture, float width, bool isChosen) const;

  private:
    struct Change {
        Picture picture;
        std::vector<uint32_t> texels;
    };
    // Returns corners in texture coordinates.
    std::array<vec2, 2> cornersOf(const Picture& picture) const;

    const vk::Device& mDevice;
    int mRoom; // Dear ImGui's id of the reserved rectangle
    // A row of pictures of one height; rows are listed from the top.
    struct Row {
        int top, height, used;
    };
    std::vector<Row> mRows;
    std::vector<Change> mChanges;
    vk::Buffer mStaging; // of the last record()
};

} // namespace relume
