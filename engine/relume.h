// The public header of relume::runtime, which loads a bake, lights it and draws it.
//
//     relume::vk::Device device;                                  // or one on the host program's own
//     const relume::Asset asset = relume::readAsset("bunny.relume");
//     relume::LightPass light(device, asset.faceSize);
//     relume::Relighter relighter(device, asset);
//     relume::ViewPass view(device, asset, {.width = 960, .height = 540});
//
// Each frame records light, relighter and view into vk::Commands, in this order; see docs/engine.md.
#pragma once

#include "engine/base/error.h"
#include "engine/base/log.h"
#include "engine/render/appearance.h"
#include "engine/render/background_pass.h"
#include "engine/render/display_pass.h"
#include "engine/render/light_pass.h"
#include "engine/render/map_texture.h"
#include "engine/render/relighter.h"
#include "engine/render/tone_map.h"
#include "engine/render/view_pass.h"
#include "engine/scene/camera.h"
#include "engine/transport/asset.h"
#include "engine/vk/commands.h"
#include "engine/vk/device.h"
