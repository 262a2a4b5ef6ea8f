// A contact sheet: small pictures of bakes, a row for each appearance, a column for each light.
#pragma once

#include "engine/light/light.h"
#include "engine/render/appearance.h"
#include "engine/render/pixel_samples.h"
#include "engine/render/tone_map.h"
#include "engine/scene/camera.h"
#include "engine/vk/device.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace relume {

struct SheetColumn {
    Light light;
    float rotation = 0; // radians about +Y, as LightPass::record() takes it
};

struct SheetRow {
    std::string name;
    Appearance appearance;
};

// Returns a bake as it is, then with each material that changes it. `name` begins the rows' names.
std::vector<SheetRow> sheetRows(const Asset& asset, const std::string& name);

struct SheetOptions {
    int width = 320, height = 240; // of one picture
    int samples = kDefaultSamples; // per pixel, as ViewPass::setSamples() takes them
    ToneCurve tone = ToneCurve::Agx;
};

class ContactSheet {
  public:
    // A white sheet with room for `rows` rows. Throws UsageError if it has more than 2^26
    // pixels.
    ContactSheet(std::vector<SheetColumn> columns, size_t rows, const SheetOptions& options);

    // Draws `rows` of one bake below those drawn before; each column is exposed for its first picture. Calls
    // `drawn` after each picture. Returns the samples per pixel in use. Throws as ViewPass does.
    int add(
        const vk::Device& device, const Asset& asset, std::span<const SheetRow> rows, const Camera& camera,
        const std::function<void()>& drawn = [] {});

    // Returns the sheet in display values.
    const Image& image() const { return mImage; }

  private:
    std::vector<SheetColumn> mColumns;
    SheetOptions mOptions;
    Image mImage;
    std::vector<std::optional<float>> mExposures; // per column, in stops; set by its first picture
    size_t mRows = 0;                             // drawn
};

} // namespace relume
