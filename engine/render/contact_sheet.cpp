#include "engine/render/contact_sheet.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/render/background_pass.h"
#include "engine/render/ground_fade.h"
#include "engine/render/relighter.h"
#include "engine/render/view_pass.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

namespace {

constexpr int kGap = 4; // pixels between pictures
constexpr size_t kMostPixels = size_t(1) << 26;

Image whiteSheet(size_t columns, size_t rows, const SheetOptions& options) {
    const size_t wide = columns * size_t(options.width + kGap), high = rows * size_t(options.height + kGap);
    if (columns == 0 || rows == 0) throw Error("a sheet needs a bake and a light");
    if (wide * high > kMostPixels)
        throw UsageError(
            fmt::format("a sheet of {} rows and {} columns has {} x {} pixels: expected at most {} in "
                        "all; make the pictures smaller (relume sheet --size)",
                        rows, columns, wide, high, kMostPixels));
    Image sheet(int(wide) - kGap, int(high) - kGap);
    std::ranges::fill(sheet.pixels, vec4(1));
    return sheet;
}

} // namespace

std::vector<SheetRow> sheetRows(const Asset& asset, const std::string& name) {
    const Appearance first = defaultAppearance(asset);
    std::vector<SheetRow> rows{{name, first}};
    for (const std::string& material : materialNames(asset)) {
        Appearance appearance = first;
        bindMaterials(appearance, asset, std::vector<WeightedMaterial>{{material}});
        if (appearance != first) rows.push_back({fmt::format("{}, {}", name, material), appearance});
    }
    return rows;
}

ContactSheet::ContactSheet(std::vector<SheetColumn> columns, size_t rows, const SheetOptions& options)
    : mColumns(std::move(columns)), mOptions(options), mImage(whiteSheet(mColumns.size(), rows, options)),
      mExposures(mColumns.size()) {}

int ContactSheet::add(const vk::Device& device, const Asset& asset, std::span<const SheetRow> rows,
                      const Camera& camera, const std::function<void()>& drawn) {
    RELUME_CHECK_LE(int(mRows + rows.size()) * (mOptions.height + kGap), mImage.height + kGap);
    LightPass light(device, asset.faceSize);
    Relighter relighter(device, asset);
    ViewPass view(device, asset,
                  {.width = mOptions.width, .height = mOptions.height, .samples = mOptions.samples});
    BackgroundPass background(device);
    view.setGroundFade(makeGroundFade(asset, GroundStyle::Shadow));
    for (const SheetRow& row : rows) {
        for (size_t column = 0; column < mColumns.size(); column++) {
            const SheetColumn& lit = mColumns[column];
            light.setLight(lit.light);
            background.setLight(lit.light);
            view.setAppearance(row.appearance);
            vk::Commands commands(device, "sheet");
            commands.begin();
            light.record(commands, lit.rotation);
            relighter.record(commands, light, row.appearance);
            view.record(commands, camera, relighter);
            background.record(commands, view.image(), camera, lit.rotation);
            commands.submitAndWait();
            if (!mExposures[column]) mExposures[column] = autoExposure(view.read());
            const Image picture = toneMap(background.read(), mOptions.tone, *mExposures[column]);
            const int left = int(column) * (mOptions.width + kGap),
                      top = int(mRows) * (mOptions.height + kGap);
            for (int y = 0; y < picture.height; y++)
                for (int x = 0; x < picture.width; x++) mImage.at(left + x, top + y) = picture.at(x, y);
            drawn();
        }
        mRows++;
    }
    return view.samples();
}

} // namespace relume
