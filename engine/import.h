// The public header of relume::import, which reads meshes, images, lights and scenes from files.
#pragma once

#include "engine/import/asset_info.h"
#include "engine/import/environment_file.h"
#include "engine/import/image_file.h"
#include "engine/import/light_file.h"
#include "engine/import/mesh_file.h"
#include "engine/import/scene.h"
#include "engine/import/texture_file.h"
