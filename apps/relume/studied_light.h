// The light that errors are studied under, as options name it.
#pragma once

#include "apps/relume/options.h"
#include "apps/relume/selection_arguments.h"
#include "precompute/error/error_study.h"

namespace relume {

struct StudiedLightArguments {
    LightArguments light;
    SelectionArguments selection;

    void add(CLI::App& command);
    // At the moment that the options name; a single environment's fine cube has all of its
    // resolution that 6 × kTruthFaceSize² texels can hold. Throws Error for light that is black.
    StudiedLight studied() const;

  private:
    StudiedLight sampled() const;
};

} // namespace relume
