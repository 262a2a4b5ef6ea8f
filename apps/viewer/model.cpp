#include "apps/viewer/model.h"

namespace relume {

Model::Model(const vk::Device& device, const std::filesystem::path& path)
    : file(path), asset(readAsset(path)), bounds(objectBounds(asset)), appearance(defaultAppearance(asset)),
      light(device, asset.faceSize), relighter(device, asset), view(device, asset) {}

} // namespace relume
