#include "engine/transport/asset.h"

namespace relume {

Bounds boundsOf(const Asset& asset) {
    Bounds bounds;
    for (const AssetPart& part : asset.parts) bounds.add(boundsOf(part.mesh));
    return bounds;
}

} // namespace relume
